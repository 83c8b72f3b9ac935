#include "csv_names.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <vector>

#include "csv_cells.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace logs {
namespace {

constexpr double kG0_mps2 = 9.80665;
constexpr double kDegree_rad = 0.017453292519943295;

char lower(char c) noexcept { return static_cast<char>(std::tolower(static_cast<unsigned char>(c))); }
bool is_letter(char c) noexcept { return std::isalpha(static_cast<unsigned char>(c)) != 0; }
bool is_capital(char c) noexcept { return std::isupper(static_cast<unsigned char>(c)) != 0; }
bool is_digit(char c) noexcept { return c >= '0' && c <= '9'; }

struct NamedUnit {
  std::string_view name;
  ColumnUnit unit;
};
/// In small letters, without blanks and without ^, *, ., _ and brackets; "/" stays, and "s-1" stands for "/s".
constexpr std::array<NamedUnit, 48> kUnits = {{
    {"m/s2", ColumnUnit::mps2},
    {"m/s/s", ColumnUnit::mps2},
    {"m/ss", ColumnUnit::mps2},
    {"ms-2", ColumnUnit::mps2},
    {"mps2", ColumnUnit::mps2},
    {"ms2", ColumnUnit::mps2},
    {"mss", ColumnUnit::mps2},
    {"m/s\xC2\xB2", ColumnUnit::mps2},
    {"m/s\xB2", ColumnUnit::mps2},
    {"mpss", ColumnUnit::mps2},
    {"m/sec2", ColumnUnit::mps2},
    {"g", ColumnUnit::g},
    {"gs", ColumnUnit::g},
    {"g0", ColumnUnit::g},
    {"gn", ColumnUnit::g},
    {"gravity", ColumnUnit::g},
    {"mg", ColumnUnit::mg},
    {"milli-g", ColumnUnit::mg},
    {"gal", ColumnUnit::gal},
    {"cm/s2", ColumnUnit::gal},
    {"ft/s2", ColumnUnit::ftps2},
    {"rad/s", ColumnUnit::radps},
    {"rads-1", ColumnUnit::radps},
    {"radps", ColumnUnit::radps},
    {"rads", ColumnUnit::radps},
    {"rad", ColumnUnit::radps},
    {"rad/sec", ColumnUnit::radps},
    {"deg/s", ColumnUnit::degps},
    {"degs-1", ColumnUnit::degps},
    {"degps", ColumnUnit::degps},
    {"dps", ColumnUnit::degps},
    {"degs", ColumnUnit::degps},
    {"\xC2\xB0/s", ColumnUnit::degps},
    {"\xB0/s", ColumnUnit::degps},
    {"deg/sec", ColumnUnit::degps},
    {"s", ColumnUnit::s},
    {"sec", ColumnUnit::s},
    {"secs", ColumnUnit::s},
    {"seconds", ColumnUnit::s},
    {"ms", ColumnUnit::ms},
    {"msec", ColumnUnit::ms},
    {"milliseconds", ColumnUnit::ms},
    {"us", ColumnUnit::us},
    {"usec", ColumnUnit::us},
    {"microseconds", ColumnUnit::us},
    {"\xC2\xB5s", ColumnUnit::us},
    {"ns", ColumnUnit::ns},
    {"nsec", ColumnUnit::ns},
}};

/// Units written as parts of a name: "acc_m_s2_x", "gyro_rad_s". Longer ones first.
struct UnitTokens {
  std::array<std::string_view, 3> tokens;
  std::size_t count;
  ColumnUnit unit;
  bool of_time;
};
constexpr std::array<UnitTokens, 28> kUnitTokens = {{
    {{"nanosec", "", ""}, 1, ColumnUnit::ns, true},     {{"nsecs", "", ""}, 1, ColumnUnit::ns, true},
    {{"m", "s", "2"}, 3, ColumnUnit::mps2, false},      {{"m", "s", "s"}, 3, ColumnUnit::mps2, false},
    {{"mps", "2", ""}, 2, ColumnUnit::mps2, false},     {{"ms", "2", ""}, 2, ColumnUnit::mps2, false},
    {{"mss", "", ""}, 1, ColumnUnit::mps2, false},      {{"rad", "s", ""}, 2, ColumnUnit::radps, false},
    {{"radps", "", ""}, 1, ColumnUnit::radps, false},   {{"rads", "", ""}, 1, ColumnUnit::radps, false},
    {{"deg", "s", ""}, 2, ColumnUnit::degps, false},    {{"degps", "", ""}, 1, ColumnUnit::degps, false},
    {{"dps", "", ""}, 1, ColumnUnit::degps, false},     {{"rad", "", ""}, 1, ColumnUnit::radps, false},
    {{"mg", "", ""}, 1, ColumnUnit::mg, false},         {{"g", "", ""}, 1, ColumnUnit::g, false},
    {{"nanoseconds", "", ""}, 1, ColumnUnit::ns, true}, {{"ns", "", ""}, 1, ColumnUnit::ns, true},
    {{"nsec", "", ""}, 1, ColumnUnit::ns, true},        {{"us", "", ""}, 1, ColumnUnit::us, true},
    {{"usec", "", ""}, 1, ColumnUnit::us, true},        {{"micros", "", ""}, 1, ColumnUnit::us, true},
    {{"ms", "", ""}, 1, ColumnUnit::ms, true},          {{"msec", "", ""}, 1, ColumnUnit::ms, true},
    {{"millis", "", ""}, 1, ColumnUnit::ms, true},      {{"sec", "", ""}, 1, ColumnUnit::s, true},
    {{"seconds", "", ""}, 1, ColumnUnit::s, true},      {{"s", "", ""}, 1, ColumnUnit::s, true},
}};

using Tokens = std::vector<std::string>;

/// Words in small letters: parted by what is no letter, where small letters change to capitals, and letters to figures.
Tokens tokens_of(std::string_view name) {
  Tokens out;
  char before = '\0';
  for (std::size_t k = 0; k < name.size(); ++k) {
    const char c = name[k];
    if (!is_letter(c) && !is_digit(c)) {
      before = '\0';
      continue;
    }
    const bool is_before_small = k + 1 < name.size() && is_letter(name[k + 1]) && !is_capital(name[k + 1]);
    const bool is_new = before == '\0' || is_digit(c) != is_digit(before) ||
                        (is_capital(c) && (!is_capital(before) || is_before_small));  // "AccX", "IMUAcc"
    if (is_new) out.emplace_back();
    out.back() += lower(c);
    before = c;
  }
  return out;
}

template <class Words>
bool has(const Tokens& tokens, const Words& words) {
  return std::any_of(tokens.begin(), tokens.end(), [&](const std::string& token) {
    return std::find(words.begin(), words.end(), token) != words.end();
  });
}

int axis_of(std::string_view token) noexcept {
  return token.size() == 1 && token[0] >= 'x' && token[0] <= 'z' ? token[0] - 'x' : -1;
}

/// "ax", "accx", "xacc", "gyrx", "gfx": the kind and the axis in one word.
struct Fused {
  std::string_view word;
  ColumnKind kind;
  ColumnUnit unit;
};
constexpr std::array<Fused, 14> kFused = {{{"accl", ColumnKind::force, ColumnUnit::none},
                                           {"a", ColumnKind::force, ColumnUnit::none},
                                           {"acc", ColumnKind::force, ColumnUnit::none},
                                           {"accel", ColumnKind::force, ColumnUnit::none},
                                           {"acceleration", ColumnKind::force, ColumnUnit::none},
                                           {"accelerometer", ColumnKind::force, ColumnUnit::none},
                                           {"gf", ColumnKind::force, ColumnUnit::g},
                                           {"g", ColumnKind::rate, ColumnUnit::none},
                                           {"w", ColumnKind::rate, ColumnUnit::none},
                                           {"gyr", ColumnKind::rate, ColumnUnit::none},
                                           {"gyro", ColumnKind::rate, ColumnUnit::none},
                                           {"gyroscope", ColumnKind::rate, ColumnUnit::none},
                                           {"omega", ColumnKind::rate, ColumnUnit::none},
                                           {"angvel", ColumnKind::rate, ColumnUnit::none}}};

const Fused* fused(std::string_view token, int& axis) noexcept {
  for (const Fused& one : kFused) {
    if (token.size() != one.word.size() + 1) continue;
    const int behind = axis_of(token.substr(one.word.size()));
    const int before = axis_of(token.substr(0, 1));
    if (behind >= 0 && token.substr(0, one.word.size()) == one.word) return axis = behind, &one;
    if (before >= 0 && one.word.size() > 2 && token.substr(1) == one.word) return axis = before, &one;
  }
  return nullptr;
}

/// Takes the unit out of the words; `is_time` says which of two meanings "ms" and "s" have.
ColumnUnit take_unit(Tokens& tokens, bool is_time) {
  for (const UnitTokens& unit : kUnitTokens) {
    if (unit.of_time != is_time) continue;
    for (std::size_t at = 1; at + unit.count <= tokens.size(); ++at) {  // the first word is no unit
      if (!std::equal(unit.tokens.begin(), unit.tokens.begin() + unit.count,
                      tokens.begin() + static_cast<std::ptrdiff_t>(at)))
        continue;
      const auto begin = tokens.begin() + static_cast<std::ptrdiff_t>(at);
      tokens.erase(begin, begin + static_cast<std::ptrdiff_t>(unit.count));
      return unit.unit;
    }
  }
  return ColumnUnit::none;
}

constexpr std::array<std::string_view, 12> kTimeWords = {"time",     "timestamp", "stamp", "date",
                                                         "datetime", "epoch",     "zeit",  "unixtime",
                                                         "secs",     "seconds",   "datum", "uhrzeit"};
constexpr std::array<std::string_view, 8> kForceWords = {
    "acc", "accel", "acceleration", "accelerations", "accelerometer", "accelerometers", "beschleunigung", "accl"};
constexpr std::array<std::string_view, 6> kRateWords = {"gyr", "gyro", "gyroscope", "gyroscopes", "angular", "omega"};
/// In "linear_acceleration.x", "angular velocity x", "ax_cnt".
constexpr std::array<std::string_view, 9> kWordsBesides = {"linear", "velocity", "axis", "cnt", "count",
                                                           "counts", "raw",      "lsb",  "adc"};
constexpr std::array<std::string_view, 3> kTemperatureWords = {"temp", "temperature", "temperatur"};
constexpr std::array<std::string_view, 4> kDegreeWords = {"degc", "deg", "c", "celsius"};
/// Of numbers that are derived from readings, or of other sensors.
constexpr std::array<std::string_view, 32> kOtherWords = {
    "mag",         "magnetometer", "magnetic",   "compass", "covariance", "cov",           "var",      "variance",
    "std",         "sigma",        "bias",       "offset",  "error",      "errors",        "err",      "user",
    "orientation", "quat",         "quaternion", "delta",   "norm",       "abs",           "absolute", "clip",
    "clipping",    "rms",          "setpoint",   "health",  "counter",    "inconsistency", "pressure", "relative"};

template <class Words>
void erase_words(Tokens& tokens, const Words& words) {
  tokens.erase(std::remove_if(tokens.begin(), tokens.end(),
                              [&](const std::string& token) {
                                return std::find(words.begin(), words.end(), token) != words.end();
                              }),
               tokens.end());
}

/// The content of the last pair of brackets, which is taken out of the name.
std::string take_bracket(std::string& name) {
  const std::size_t begin = name.find_last_of("[({");
  if (begin == std::string::npos) return {};
  // "(m/(s^2))": from the first of brackets within brackets.
  std::size_t first = begin;
  const std::size_t outer = name.find_first_of("[({");
  if (outer < begin && name.find_first_of("])}") > begin) first = outer;
  const std::size_t end = name.find_last_of("])}");
  if (end == std::string::npos || end < first) return {};
  std::string out = name.substr(first + 1, end - first - 1);
  name.erase(first, end - first + 1);
  return out;
}

/// "imu0_left"
std::string joined(const Tokens& tokens) {
  std::string out;
  for (const std::string& token : tokens) {
    const bool is_number = is_digit(token[0]) && !out.empty() && !is_digit(out.back());
    out += (out.empty() || is_number ? "" : "_") + token;
  }
  return out;
}

/// Takes the axis and the kind out of the words. `index` stood in brackets: an axis where no letter says which, else a
/// chip.
void take_kind(Tokens& tokens, int index, ColumnName& out) {
  for (std::size_t k = 0; k < tokens.size(); ++k) {
    int axis = -1;
    const Fused* found = fused(tokens[k], axis);
    if (found == nullptr) continue;
    out.kind = found->kind;
    out.axis = axis;
    if (found->unit != ColumnUnit::none) out.unit = found->unit;
    tokens.erase(tokens.begin() + static_cast<std::ptrdiff_t>(k));
    if (index >= 0) tokens.push_back(std::to_string(index));
    erase_words(tokens, kWordsBesides);
    return;
  }
  for (std::size_t k = tokens.size(); k > 0 && out.axis < 0; --k) {
    out.axis = axis_of(tokens[k - 1]);
    if (out.axis >= 0) tokens.erase(tokens.begin() + static_cast<std::ptrdiff_t>(k - 1));
  }
  if (out.axis >= 0 && index >= 0) tokens.push_back(std::to_string(index));
  if (out.axis < 0 && index < 3) out.axis = index;
  if (out.axis < 0) return;
  // "a1_x", "a_RS_S_x", "w_RS_S_x": one letter in front.
  const bool is_letter_a = !tokens.empty() && tokens.front() == "a";
  const bool is_letter_w = !tokens.empty() && tokens.front() == "w";
  if (has(tokens, kForceWords) || is_letter_a)
    out.kind = ColumnKind::force;
  else if (has(tokens, kRateWords) || is_letter_w)
    out.kind = ColumnKind::rate;
  else if (tokens.empty() && index < 0)
    out.kind = ColumnKind::axis_alone;
  if (is_letter_a || is_letter_w) tokens.erase(tokens.begin());
  erase_words(tokens, kForceWords);
  erase_words(tokens, kRateWords);
  erase_words(tokens, kWordsBesides);
}

}  // namespace

ColumnUnit unit_of(std::string_view text) {
  std::string plain;
  for (const char c : bare(text)) {
    if (std::string_view("^*._ ()[]{}").find(c) == std::string_view::npos) plain += lower(c);
  }
  if (plain.empty() || plain == "-") return ColumnUnit::none;
  const auto* const found =
      std::find_if(kUnits.begin(), kUnits.end(), [&](const NamedUnit& unit) { return unit.name == plain; });
  return found == kUnits.end() ? ColumnUnit::unknown : found->unit;
}

double factor_of(ColumnUnit unit) noexcept {
  switch (unit) {
    case ColumnUnit::mps2:
    case ColumnUnit::radps: return 1.0;
    case ColumnUnit::g: return kG0_mps2;
    case ColumnUnit::mg: return 1e-3 * kG0_mps2;
    case ColumnUnit::gal: return 0.01;
    case ColumnUnit::ftps2: return 0.3048;
    case ColumnUnit::degps: return kDegree_rad;
    default: return 0.0;
  }
}

const char* to_string(ColumnUnit unit) noexcept {
  switch (unit) {
    case ColumnUnit::mps2: return "m/s^2";
    case ColumnUnit::g: return "g";
    case ColumnUnit::mg: return "mg";
    case ColumnUnit::gal: return "Gal";
    case ColumnUnit::ftps2: return "ft/s^2";
    case ColumnUnit::radps: return "rad/s";
    case ColumnUnit::degps: return "deg/s";
    case ColumnUnit::s: return "s";
    case ColumnUnit::ms: return "ms";
    case ColumnUnit::us: return "us";
    case ColumnUnit::ns: return "ns";
    case ColumnUnit::none:
    case ColumnUnit::unknown: break;
  }
  return "";
}

ColumnName column_name(std::string_view header) {
  ColumnName out;
  std::string name(bare(header));
  const std::size_t begin = name.find_first_not_of("#%; \t");
  name.erase(0, std::min(begin, name.size()));
  const std::string bracket = take_bracket(name);
  const bool is_index = bracket.size() == 1 && is_digit(bracket[0]);
  if (!bracket.empty() && !is_index) out.unit = unit_of(bracket);
  Tokens tokens = tokens_of(name);
  if (tokens.empty() || has(tokens, kOtherWords)) return out;
  const bool is_g_force = tokens.size() == 2 && tokens[0] == "g" && tokens[1].size() == 2 && tokens[1][0] == 'f';
  if (is_g_force) tokens = {"g" + tokens[1]};  // "gFx"
  if (has(tokens, kTemperatureWords)) {
    out.kind = ColumnKind::temperature;
    erase_words(tokens, kTemperatureWords);
    erase_words(tokens, kDegreeWords);
    out.group = joined(tokens);
    return out;
  }
  const bool is_alone = tokens.size() == 1;
  if (is_alone && (tokens[0] == "i" || tokens[0] == "instance")) return out.kind = ColumnKind::instance, out;
  if (tokens.size() == 2 && tokens[0] == "device" && tokens[1] == "id") return out.kind = ColumnKind::device, out;
  const bool is_time = has(tokens, kTimeWords) || (tokens[0] == "t" && tokens.size() <= 3);
  if (out.unit == ColumnUnit::none) out.unit = take_unit(tokens, is_time);
  if (is_time) return out.kind = ColumnKind::time, out;
  take_kind(tokens, is_index ? bracket[0] - '0' : -1, out);
  if (out.kind != ColumnKind::other) out.group = joined(tokens);
  return out;
}

}  // namespace logs
}  // namespace PLUMB_ABI
}  // namespace plumb
