#include "plumb/study/experiments.hpp"

#include "plumb/scenario/injector.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace study {
namespace {

constexpr SensorSet kNobody{};
constexpr SensorSet k1 = SensorSet::of(0);
constexpr SensorSet k2 = SensorSet::of(1);
constexpr SensorSet k3 = SensorSet::of(2);
constexpr SensorSet k4 = SensorSet::of(3);

constexpr double kLevel_v = 3.0;

}  // namespace

// clang-format off
const std::array<Table2Row, kExperiments> kTable2 = {{
    { 1, kNobody, Level::none,     0.000212, false, {0.000705, 0.000763, 0.000512, 0.000758}, kNobody},
    { 2, k1,      Level::zero,     0.1454,   true,  {0.2063,   0.1456,   0.1312,   0.000758}, k1},
    { 3, k1,      Level::minus_3v, 0.2073,   true,  {0.2830,   1.0463,   0.9643,   0.000758}, k1},
    { 4, k1,      Level::plus_3v,  0.1462,   true,  {0.3541,   0.2404,   0.2503,   0.000758}, k1},
    { 5, k1,      Level::random,   0.1225,   true,  {0.2080,   0.2837,   0.2285,   0.000758}, k1},
    { 6, k2,      Level::zero,     0.1369,   true,  {0.2131,   0.1537,   0.000512, 0.1417},   k2},
    { 7, k2,      Level::minus_3v, 0.2042,   true,  {0.2703,   1.0223,   0.000512, 0.9959},   k2},
    { 8, k2,      Level::plus_3v,  0.1522,   true,  {0.3517,   0.2534,   0.000512, 0.2743},   k2},
    { 9, k2,      Level::random,   0.1282,   true,  {0.2645,   0.2073,   0.000512, 0.1918},   k2},
    {10, k3,      Level::zero,     0.1523,   true,  {0.1721,   0.000763, 0.1469,   0.1471},   k3},
    {11, k3,      Level::minus_3v, 0.1950,   true,  {0.8378,   0.000763, 0.9747,   1.0218},   k3},
    {12, k3,      Level::plus_3v,  0.1472,   true,  {0.4670,   0.000763, 0.2477,   0.2560},   k3},
    {13, k3,      Level::random,   0.1264,   true,  {0.2343,   0.000763, 0.1927,   0.2304},   k3},
    {14, k4,      Level::zero,     0.3107,   true,  {0.000705, 0.3669,   0.3390,   0.3323},   k4},
    {15, k4,      Level::minus_3v, 0.1736,   true,  {0.000705, 0.8509,   0.9739,   0.8332},   k4},
    {16, k4,      Level::plus_3v,  0.1850,   true,  {0.000705, 0.2332,   0.2636,   0.2347},   k4},
    {17, k4,      Level::random,   0.1979,   true,  {0.000705, 0.2722,   0.4745,   0.4751},   k4},
    {18, k1 | k2, Level::random,   0.2310,   true,  {0.3291,   0.7170,   0.3398,   0.2550},   kNobody},
    {19, k1 | k3, Level::random,   0.2381,   true,  {0.3591,   0.2520,   0.5747,   0.3349},   kNobody},
    {20, k1 | k4, Level::random,   0.2296,   true,  {0.2496,   0.4378,   0.4715,   0.3351},   kNobody},
    {21, k2 | k3, Level::random,   0.2148,   true,  {0.3052,   0.4401,   0.2454,   0.3970},   kNobody},
    {22, k2 | k4, Level::random,   0.2268,   true,  {0.2169,   0.5142,   0.4373,   0.3788},   kNobody},
    {23, k3 | k4, Level::random,   0.2457,   true,  {0.3235,   0.4539,   0.2616,   0.2775},   kNobody},
}};
// clang-format on

const char* to_string(Level level) noexcept {
  switch (level) {
    case Level::none: return "-";
    case Level::zero: return "0 V";
    case Level::minus_3v: return "-3 V";
    case Level::plus_3v: return "+3 V";
    case Level::random: return "random";
  }
  return "unknown";
}

StudyExpected<std::vector<Sample>> with_fault(const scenario::Tool& tool, const Table2Row& experiment, RandomLaw law,
                                              std::uint64_t seed, std::vector<Sample> samples) {
  std::vector<scenario::Fault> faults;
  for (int i = 0; i < tool.datasheet.size; ++i) {
    if (!experiment.faulty.has(i)) continue;
    scenario::Fault fault;
    fault.sensor = i;
    fault.clock = scenario::Clock::row;
    fault.onset = 1.0;
    if (experiment.level == Level::random) {
      fault.kind = law == RandomLaw::held ? scenario::FaultKind::random_level : scenario::FaultKind::random_range;
      fault.magnitude = -kLevel_v;
      fault.upper = kLevel_v;
    } else {
      fault.kind = scenario::FaultKind::stuck_level;
      if (experiment.level == Level::plus_3v) fault.magnitude = kLevel_v;
      if (experiment.level == Level::minus_3v) fault.magnitude = -kLevel_v;
    }
    faults.push_back(fault);
  }
  auto injector = scenario::Injector::make(tool.datasheet, tool.model, std::move(faults), seed);
  if (!injector) return tl::unexpected<std::string>(injector.error());
  for (Sample& sample : samples) injector->apply(sample);
  return samples;
}

}  // namespace study
}  // namespace PLUMB_ABI
}  // namespace plumb
