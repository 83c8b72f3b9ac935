/// The 23 experiments of the paper's Table 2, and the table as it is printed.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "plumb/core/sensor_set.hpp"
#include "plumb/study/survey.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace study {

/// Where the voltage of a faulty accelerometer stands.
enum class Level : std::uint8_t { none, zero, minus_3v, plus_3v, random };
const char* to_string(Level level) noexcept;

/// A row of Table 2 as it is printed.
struct Table2Row {
  int number;
  SensorSet faulty;
  Level level;
  double mae_all_g;                    ///< "MAE using 4 Acc."
  bool detected;                       ///< "Fault Detection"
  std::array<double, 4> mae_triple_g;  ///< 1-2-3, 1-2-4, 1-3-4, 2-3-4
  SensorSet isolated;                  ///< "Isolated Acc."; empty: a dash
};
inline constexpr int kExperiments = 23;
/// Seyed Moosavi, Moaveni, Moshiri, Arvan, Sensors 2018, Table 2; CC BY 4.0. In units of g.
extern const std::array<Table2Row, kExperiments> kTable2;

/// "Rand" of Table 2, "random amount between -3 and 3", can be read in two ways.
enum class RandomLaw : std::uint8_t {
  held,  ///< one level per attitude
  anew,  ///< another level every sample
};

/// The samples of one attitude with the fault of an experiment in them. `seed` draws the random levels.
StudyExpected<std::vector<Sample>> with_fault(const scenario::Tool& tool, const Table2Row& experiment, RandomLaw law,
                                              std::uint64_t seed, std::vector<Sample> samples);

}  // namespace study
}  // namespace PLUMB_ABI
}  // namespace plumb
