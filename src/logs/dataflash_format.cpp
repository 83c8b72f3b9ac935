#include "dataflash_format.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

#include "plumb/io/printable.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace logs {
namespace {

template <std::size_t n>
std::string_view text_in(const std::array<char, n>& chars) noexcept {
  const void* end = std::memchr(chars.data(), 0, n);
  return {chars.data(), end == nullptr ? n : static_cast<std::size_t>(static_cast<const char*>(end) - chars.data())};
}

std::size_t bytes_of(char letter) noexcept {
  switch (letter) {
    case 'a':
    case 'Z': return 64;  // NOLINT(bugprone-branch-clone): one line a size
    case 'b':
    case 'B':
    case 'M': return 1;
    case 'h':
    case 'H':
    case 'c':
    case 'C':
    case 'g': return 2;
    case 'i':
    case 'I':
    case 'f':
    case 'e':
    case 'E':
    case 'L':
    case 'n': return 4;
    case 'd':
    case 'q':
    case 'Q': return 8;
    case 'N': return 16;
    default: return 0;
  }
}

bool is_text(char letter) noexcept { return letter == 'n' || letter == 'N' || letter == 'Z'; }

struct Named {
  std::string_view name;
  Family family;
  int instance;
};

constexpr std::array<Named, 14> kNamed = {{{"IMU", Family::imu, 0},
                                           {"IMU2", Family::imu, 1},
                                           {"IMU3", Family::imu, 2},
                                           {"ACC", Family::acc, 0},
                                           {"ACC1", Family::acc, 0},
                                           {"ACC2", Family::acc, 1},
                                           {"ACC3", Family::acc, 2},
                                           {"VIBE", Family::vibe, -1},
                                           {"PARM", Family::parm, -1},
                                           {"UNIT", Family::unit, -1},
                                           {"MULT", Family::mult, -1},
                                           {"FMTU", Family::fmtu, -1},
                                           {"DSF", Family::dsf, -1},
                                           {"", Family::other, -1}}};

/// The label at `index` of a comma separated list; false where the list is shorter.
bool label_at(std::string_view labels, std::size_t index, std::string_view& out) noexcept {
  for (; index > 0; --index) {
    const std::size_t comma = labels.find(',');
    if (comma == std::string_view::npos) return false;
    labels.remove_prefix(comma + 1);
  }
  out = labels.substr(0, labels.find(','));
  return !out.empty();
}

/// What an FMT says that cannot be; empty where it is sound.
std::string contradiction(const Layout& layout) {
  std::size_t sum = kHeadBytes;
  const std::string_view letters = text_in(layout.letters);
  const std::string_view labels = text_in(layout.labels);
  for (const char letter : letters) {
    if (bytes_of(letter) == 0) {
      return "has the unknown format letter '" + io::printable_line({&letter, 1}) +
             "': the columns from there on are left out";
    }
    sum += bytes_of(letter);
  }
  if (sum != layout.length) {
    return "is " + std::to_string(layout.length) + " bytes long, its format letters need " + std::to_string(sum) +
           ": its messages are passed over";
  }
  const auto commas = static_cast<std::size_t>(std::count(labels.begin(), labels.end(), ','));
  const std::size_t named = labels.empty() ? 0 : commas + 1;
  if (named == letters.size()) return {};
  return "has " + std::to_string(letters.size()) + " format letters and " + std::to_string(named) +
         " labels: what has no pair is left out";
}

}  // namespace

std::string Layout::name_text() const { return io::printable_line(text_in(name)); }

DataflashFormats::DataflashFormats(DataflashNotes& notes) : notes_(notes) {
  layouts_[kFmtType].length = kFmtLength;
  layouts_[kFmtType].settled = true;
  // What ArduPilot writes where a log does not say it itself (LogStructure.h).
  multipliers_.fill(-1.0);
  for (const char silent : {'-', '?'}) multipliers_[static_cast<unsigned char>(silent)] = 0.0;
  constexpr std::array<std::pair<char, double>, 10> kMultipliers = {{{'2', 1e2},
                                                                     {'1', 1e1},
                                                                     {'0', 1.0},
                                                                     {'A', 1e-1},
                                                                     {'B', 1e-2},
                                                                     {'C', 1e-3},
                                                                     {'D', 1e-4},
                                                                     {'E', 1e-5},
                                                                     {'F', 1e-6},
                                                                     {'G', 1e-7}}};
  for (const auto& [id, value] : kMultipliers) multipliers_[static_cast<unsigned char>(id)] = value;
  constexpr std::array<std::pair<char, std::string_view>, 5> kUnits = {
      {{'s', "s"}, {'o', "m/s/s"}, {'E', "rad/s"}, {'k', "deg/s"}, {'O', "degC"}}};
  for (const auto& [id, label] : kUnits) label.copy(unit_labels_[static_cast<unsigned char>(id)].data(), label.size());
}

void DataflashFormats::unsettle() noexcept {
  for (Layout& layout : layouts_) layout.settled = false;
  layouts_[kFmtType].settled = true;
}

void DataflashFormats::fmt(const unsigned char* message, std::uint64_t offset) {
  const std::uint8_t type = message[3];
  Layout next;
  next.length = message[4];
  std::memcpy(next.name.data(), message + 5, next.name.size());
  std::memcpy(next.letters.data(), message + 9, next.letters.size());
  std::memcpy(next.labels.data(), message + 25, next.labels.size());
  Layout& layout = layouts_[type];
  const auto about = [&] { return "FMT of type " + std::to_string(type) + " (" + next.name_text() + ") "; };
  if (next.length < kHeadBytes || (type == kFmtType && next.length != kFmtLength)) {
    if (!notes_.wanted(DataflashTrouble::bad_format, offset)) return;
    notes_.say(offset, about() + "gives a length of " + std::to_string(next.length) +
                           " bytes, which cannot be: it is passed over");
    return;
  }
  if (type == kFmtType) return;
  const bool known = layout.length != 0;
  if (known && layout.length == next.length && layout.name == next.name && layout.letters == next.letters &&
      layout.labels == next.labels) {
    return;
  }
  if (known && notes_.wanted(DataflashTrouble::redefined, offset)) {
    notes_.say(offset, about() + "differs from the one before (" + layout.name_text() + "): from here on it holds");
  }
  if (known) unit_chars_[type] = UnitChars{};
  for (const Named& named : kNamed) {
    if (named.name != text_in(next.name)) continue;
    next.family = named.family;
    next.instance = named.instance;
    break;
  }
  layout = next;
}

void DataflashFormats::fmtu(const unsigned char* message, const Columns& columns) {
  const double type = number_at(message, columns.id);
  if (!(type >= 0.0 && type <= 255.0)) return;
  UnitChars& chars = unit_chars_[static_cast<std::size_t>(type)];
  chars = UnitChars{};
  const std::string_view units = text_at(message, columns.unit_ids);
  const std::string_view multipliers = text_at(message, columns.multiplier_ids);
  units.copy(chars.units.data(), chars.units.size());
  multipliers.copy(chars.multipliers.data(), chars.multipliers.size());
  if (static_cast<std::size_t>(type) != kFmtType) layouts_[static_cast<std::size_t>(type)].settled = false;
}

void DataflashFormats::unit(const unsigned char* message, const Columns& columns) {
  const double id = number_at(message, columns.id);
  if (!(id > 0.0 && id <= 127.0)) return;
  UnitLabel label{};
  text_at(message, columns.name).copy(label.data(), label.size());
  UnitLabel& known = unit_labels_[static_cast<std::size_t>(id)];
  if (known == label) return;
  known = label;
  unsettle();
}

void DataflashFormats::multiplier(const unsigned char* message, const Columns& columns) {
  const double id = number_at(message, columns.id);
  if (!(id > 0.0 && id <= 127.0)) return;
  const double read = number_at(message, columns.value);
  // ArduPilot writes 0 for "none", and 1 for "not worked out yet", '?'.
  const bool silent = read == 0.0 || static_cast<char>(id) == '?' || static_cast<char>(id) == '-';
  const double value = silent ? 0.0 : std::isfinite(read) && read > 0.0 ? read : -1.0;
  double& known = multipliers_[static_cast<std::size_t>(id)];
  if (!(std::abs(known - value) > 0.0)) return;
  known = value;
  unsettle();
}

void DataflashFormats::settle(std::uint8_t type, Layout& layout, std::uint64_t offset) {
  layout.settled = true;
  layout.columns = Columns{};
  layout.usable = false;
  if (layout.family == Family::other) return;
  find_columns(type, layout, offset);
  // The units may come after the first message.
  layout.units_told = layout.units_told || unit_chars_[type].units[0] != 0;
  if (layout.faults_told) return;
  layout.faults_told = true;
  std::string wrong = contradiction(layout);
  if (wrong.empty() && !layout.usable) wrong = "lacks a column that is needed: its messages are passed over";
  if (wrong.empty() || !notes_.wanted(DataflashTrouble::bad_format, offset)) return;
  notes_.say(offset, "FMT of " + layout.name_text() + " " + wrong);
}

void DataflashFormats::find_columns(std::uint8_t type, Layout& layout, std::uint64_t offset) {
  const auto plain = [&](std::string_view label) { return find(type, layout, label, Quantity::none, offset); };
  Columns& c = layout.columns;
  c.time = find(type, layout, "TimeUS", Quantity::time, offset);
  if (!c.time.present()) c.time = find(type, layout, "TimeMS", Quantity::time, offset);
  switch (layout.family) {
    case Family::imu:
    case Family::acc: find_reading(type, layout, offset); return;
    case Family::vibe:
      c.instance = plain("IMU");
      if (!c.instance.present()) c.instance = plain("I");
      c.clips = c.instance.present() ? std::array<Field, 3>{plain("Clip")}
                                     : std::array<Field, 3>{plain("Clip0"), plain("Clip1"), plain("Clip2")};
      c.vibration = {plain("VibeX"), plain("VibeY"), plain("VibeZ")};
      layout.usable = c.clips[0].present();
      return;
    case Family::parm:
      c.name = plain("Name");
      c.value = plain("Value");
      layout.usable = is_text(c.name.letter) && c.value.present();
      return;
    case Family::unit:
      c.id = plain("Id");
      c.name = plain("Label");
      layout.usable = c.id.present() && is_text(c.name.letter);
      return;
    case Family::mult:
      c.id = plain("Id");
      c.value = plain("Mult");
      layout.usable = c.id.present() && c.value.present();
      return;
    case Family::fmtu:
      c.id = plain("FmtType");
      c.unit_ids = plain("UnitIds");
      c.multiplier_ids = plain("MultIds");
      layout.usable = c.id.present() && (c.unit_ids.present() || c.multiplier_ids.present());
      return;
    case Family::dsf:
      c.value = plain("Dp");
      layout.usable = c.value.present();
      return;
    case Family::other: return;
  }
}

void DataflashFormats::find_reading(std::uint8_t type, Layout& layout, std::uint64_t offset) {
  const auto either = [&](std::string_view label, std::string_view older, Quantity quantity) {
    const Field field = find(type, layout, label, quantity, offset);
    return field.present() ? field : find(type, layout, older, quantity, offset);
  };
  Columns& c = layout.columns;
  constexpr std::array<std::string_view, 3> kForce = {"AccX", "AccY", "AccZ"};
  constexpr std::array<std::string_view, 3> kRate = {"GyrX", "GyrY", "GyrZ"};
  for (std::size_t k = 0; k < 3; ++k) c.force[k] = find(type, layout, kForce[k], Quantity::force, offset);
  for (std::size_t k = 0; k < 3; ++k) c.rate[k] = find(type, layout, kRate[k], Quantity::rate, offset);
  c.sample_time = find(type, layout, "SampleUS", Quantity::time, offset);
  c.instance = find(type, layout, "I", Quantity::none, offset);
  c.temperature = either("T", "Temp", Quantity::temperature);
  c.gyro_errors = either("EG", "ErrG", Quantity::none);
  c.force_errors = either("EA", "ErrA", Quantity::none);
  c.force_health = either("AH", "AcHlt", Quantity::none);
  const auto is_number = [](const Field& field) { return field.present() && !is_text(field.letter); };
  layout.usable = is_number(c.time) && std::all_of(c.force.begin(), c.force.end(), is_number);
}

Field DataflashFormats::find(std::uint8_t type, Layout& layout, std::string_view label, Quantity quantity,
                             std::uint64_t offset) {
  const std::string_view letters = text_in(layout.letters);
  const std::string_view labels = text_in(layout.labels);
  std::size_t at = kHeadBytes;
  Field found;
  std::size_t index = 0;
  bool open_end = false;
  for (std::size_t k = 0; k < letters.size(); ++k) {
    const std::size_t bytes = bytes_of(letters[k]);
    open_end = bytes == 0;  // nobody knows how long the rest is
    if (open_end) break;
    std::string_view here;
    if (!found.present() && label_at(labels, k, here) && here == label && letters[k] != 'a' &&
        at + bytes <= layout.length) {
      found.offset = static_cast<std::uint8_t>(at);
      found.letter = letters[k];
      index = k;
    }
    at += bytes;
  }
  if (open_end ? at > layout.length : at != layout.length)
    return Field{};  // length and letters disagree: nobody knows which is right
  if (found.present()) found.factor = factor(type, layout, index, label, quantity, offset);
  return found;
}

}  // namespace logs
}  // namespace PLUMB_ABI
}  // namespace plumb
