#include "fault_kinds.hpp"

#include <array>
#include <cmath>

namespace plumb {
inline namespace PLUMB_ABI {
namespace scenario {
namespace {

bool is_whole(double value) noexcept { return std::floor(value) == value; }
bool is_index(double value, int below) noexcept { return value >= 0.0 && value < below && is_whole(value); }

constexpr SizeRule kAny = {[](const Fault&, int) noexcept { return true; }, ""};
constexpr SizeRule kRange = {[](const Fault& f, int) noexcept { return f.magnitude < f.upper; },
                             "the range of the random value is empty. Remedy: give the lower end first, as in -3V..3V"};
constexpr SizeRule kLimits = {[](const Fault& f, int) noexcept { return f.magnitude < f.upper; },
                              "the lower limit is not below the upper one. Remedy: give the lower one first, as in "
                              "-1V..4V"};
constexpr SizeRule kDither = {[](const Fault& f, int) noexcept { return f.magnitude >= 0.0; },
                              "the dither is negative. Remedy: give its half width, or leave it out"};
constexpr SizeRule kFactor = {[](const Fault& f, int) noexcept { return f.magnitude != 1.0; },
                              "a scale factor times 1 changes nothing. Remedy: give another factor, as in scale=1.1"};
constexpr SizeRule kAboveZero = {[](const Fault& f, int) noexcept { return f.magnitude > 0.0; },
                                 "the size must be above zero. Remedy: give a positive size"};
constexpr SizeRule kChance = {[](const Fault& f, int) noexcept { return f.upper > 0.0 && f.upper <= 1.0; },
                              "the chance of a spike is not above 0 and at most 100 %. Remedy: write spikes=0.5g0*1%"};
constexpr SizeRule kTime = {[](const Fault& f, int) noexcept { return f.upper > 0.0; },
                            "the time is not above zero. Remedy: write chatter=50mg0*10s or warmup=2mg0*5min"};
constexpr SizeRule kShare = {[](const Fault& f, int) noexcept { return f.magnitude > 0.0 && f.magnitude <= 1.0; },
                             "the share is not above 0 and at most 100 %. Remedy: write 30%, or leave it out for all"};
constexpr SizeRule kRows = {[](const Fault& f, int) noexcept {
                              return f.magnitude >= 1.0 && f.magnitude <= kMostRowsLate && is_whole(f.magnitude);
                            },
                            "the number of rows is not from 1 to 100. Remedy: write it as in late=5"};
constexpr SizeRule kBit = {[](const Fault& f, int) noexcept { return is_index(f.magnitude, 41); },
                           "this bit does not exist. Remedy: give a bit number from 0, the lowest, to 40"};
constexpr SizeRule kPattern = {[](const Fault& f, int) noexcept { return is_index(f.magnitude, kBitPatterns); },
                               "unknown pattern. Remedy: give nan, inf, -inf, huge, denormal or -0"};
constexpr SizeRule kOther = {[](const Fault& f, int sensors) noexcept {
                               return is_index(f.magnitude, sensors) && static_cast<int>(f.magnitude) != f.sensor;
                             },
                             "the fault needs a second sensor of the array. Remedy: name another sensor, as in "
                             "exchange=a3"};
constexpr SizeRule kTwoSensors = {[](const Fault& f, int sensors) noexcept {
                                    return is_index(f.magnitude, sensors) && is_index(f.upper, sensors) &&
                                           f.magnitude != f.upper;
                                  },
                                  "the mirror needs two sensors. Remedy: name two of the array, as in mirror=a1*a3"};

using K = FaultKind;
using F = SizeForm;
using S = Strikes;
// clang-format off
constexpr std::array<FaultKindRow, kFaultKinds> kRowsOfKinds = {{
    {K::stuck_level,  "stuck",       S::channel, F::level,              kAny,        "is stuck at {}"},
    {K::stuck_last,   "last",        S::channel, F::dither,             kDither,     "is stuck at its last value[ with a dither of +-{}]"},
    {K::random_range, "random",      S::channel, F::range,              kRange,      "delivers random values from {}, new in every row"},
    {K::random_level, "held",        S::channel, F::range,              kRange,      "is stuck at a random value from {}"},
    {K::bias_step,    "bias",        S::channel, F::acceleration,       kAny,        "reads {} too high"},
    {K::drift,        "drift",       S::channel, F::drift,              kAny,        "drifts by {}"},
    {K::scale_change, "scale",       S::channel, F::factor,             kFactor,     "has its scale factor multiplied by {}"},
    {K::noise,        "noise",       S::channel, F::acceleration,       kAboveZero,  "has {} rms of additional noise"},
    {K::spikes,       "spikes",      S::channel, F::acceleration_share, kChance,     "has spikes of +-{1} in {2} of its rows"},
    {K::chatter,      "chatter",     S::channel, F::acceleration_time,  kTime,       "reads {1} too high in every second period of {2}"},
    {K::warm_up,      "warmup",      S::channel, F::acceleration_time,  kTime,       "reads {1} too high, decaying with time constant {2}"},
    {K::clip,         "clip",        S::channel, F::range,              kLimits,     "is clipped outside {}"},
    {K::coarse,       "coarse",      S::channel, F::step,               kAboveZero,  "is quantised in steps of {}"},
    {K::bit_flip,     "bit",         S::channel, F::count,              kBit,        "has bit {} inverted"},
    {K::pattern,      "pattern",     S::channel, F::pattern,            kPattern,    "delivers {}"},
    {K::missing,      "missing",     S::channel, F::share,              kShare,      "does not deliver {all} of its rows"},
    {K::late,         "late",        S::channel_or_link, F::count,      kRows,       "arrives {rows} late"},
    {K::slow,         "slow",        S::channel, F::count,              kRows,       "has a new value every {rows} only"},
    {K::exchange,     "exchange",    S::channel, F::sensor,             kOther,      "and {} are exchanged"},
    {K::cross_talk,   "cross",       S::channel, F::sensor_share,       kOther,      "picks up {2} of {1}"},
    {K::turned,       "turned",      S::channel, F::angle_angle,        kAny,        "is turned by {1}[ towards {2}]"},
    {K::ghost,        "ghost",       S::channel, F::angle_angle,        kAny,        "shows gravity turned by {1}[ about {2}]"},
    {K::mirror,       "mirror",      S::channel, F::sensor_sensor,      kTwoSensors, "shows gravity mirrored between {1} and {2}"},
    {K::shake,        "shake",       S::tool,    F::acceleration,       kAboveZero,  "shakes with {} rms per axis"},
    {K::gravity,      "gravity",     S::tool,    F::acceleration,       kAny,        "is under a true gravity that exceeds the configured value by {}"},
    {K::temperature,  "temperature", S::tool,    F::temperature,        kAny,        "has a temperature reading wrong by {}"},
    {K::drop,         "drop",        S::link,    F::share,              kShare,      "loses {all} of its rows"},
    {K::repeat,       "repeat",      S::link,    F::none,               kAny,        "has every row twice"},
    {K::swap,         "swap",        S::link,    F::none,               kAny,        "has its rows in the wrong order, two by two"},
    {K::back,         "back",        S::link,    F::time,               kAny,        "has its time behind by {}"},
}};
// clang-format on

constexpr bool rows_are_in_order() {
  for (std::size_t k = 0; k < kRowsOfKinds.size(); ++k) {
    if (kRowsOfKinds[k].kind != static_cast<FaultKind>(k) || kRowsOfKinds[k].word == nullptr) return false;
  }
  return true;
}
static_assert(rows_are_in_order(), "every kind has its row, in the order of FaultKind");

}  // namespace

const FaultKindRow& row_of(FaultKind kind) noexcept {
  const auto k = static_cast<std::size_t>(kind);
  return kRowsOfKinds[k < kRowsOfKinds.size() ? k : 0];
}

const char* to_string(FaultKind kind) noexcept {
  return static_cast<std::size_t>(kind) < kRowsOfKinds.size() ? row_of(kind).word : "unknown";
}

bool needs_whole_log(FaultKind kind) noexcept {
  return row_of(kind).strikes == Strikes::tool || row_of(kind).strikes == Strikes::link;
}

bool is_delivery(FaultKind kind, int sensor) noexcept {
  const Strikes strikes = row_of(kind).strikes;
  return strikes == Strikes::link || (strikes == Strikes::channel_or_link && sensor == kWholeLog);
}

}  // namespace scenario
}  // namespace PLUMB_ABI
}  // namespace plumb
