#include "plumb/findings/unit_guess.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <vector>

#include "plumb/array/geometry.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace findings {
namespace {

/// A datasheet and its unit are right where they give the length of gravity within this factor.
constexpr double kNear = 1.2;
/// A unit that is wrong by a factor spoils everything that a fit could say.
constexpr double kWrongUnit = 2.0;
/// Numbers of a converter: beyond what any voltage shows.
constexpr double kCounts = 50.0;

bool near_one(double factor) { return factor > 1.0 / kNear && factor < kNear; }

const char* const kVoltages[] = {"V", "mV", "uV"};
const char* const kAccelerations[] = {"g0", "m/s^2", "mg0", "ug0", "mm/s^2", "ft/s^2", "Gal", "mGal"};

const char* const kFields[] = {"nT", "uT", "mG", "G", "mT", "T"};

double base_of(const char* unit, io::FieldKind field) { return io::parse_raw_unit(unit, field)->base_per_unit; }

/// The units in which such a vector is logged.
std::vector<const char*> log_units(io::FieldKind field) {
  if (field == io::FieldKind::magnetic) return {std::begin(kFields), std::end(kFields)};
  return {std::begin(kAccelerations), std::end(kAccelerations)};
}

}  // namespace

double length_factor(const io::ArrayFile& array, const std::vector<Station>& stations) {
  const SensorModel model = array.datasheet.model();
  std::vector<double> length;
  for (const Station& station : stations) {
    const SensorSet used = station.delivered & array.array.all();
    const LeastSquares map = least_squares(array.array, used);
    if (!map.valid) continue;
    const double value = norm(map.estimate(model.apply(station.mean, station.temperature_degc, used)));
    if (std::isfinite(value)) length.push_back(value);
  }
  if (length.empty()) return 0.0;
  const auto middle = length.begin() + static_cast<std::ptrdiff_t>(length.size() / 2);
  std::nth_element(length.begin(), middle, length.end());
  return *middle / array.gravity.g_mps2;
}

bool of_another_unit(const io::ArrayFile& array, const std::vector<Station>& stations) {
  const double factor = length_factor(array, stations);
  return factor >= kWrongUnit || (factor > 0.0 && factor <= 1.0 / kWrongUnit);
}

UnitGuess likely_unit(const io::ArrayFile& array, double factor) {
  using Kind = UnitGuess::Kind;
  if (near_one(factor) || !(factor > 0.0)) return {};
  const io::RawUnit& stated = array.input.unit;
  if (stated.kind == io::RawUnit::Kind::voltage) {
    for (const char* unit : kVoltages) {
      if (near_one(factor * base_of(unit, array.field) / stated.base_per_unit)) return {Kind::unit, unit};
    }
  }
  // What the numbers would be were they accelerations already; the scales are about alike.
  double scale = 0.0;
  for (int i = 0; i < array.array.size(); ++i) {
    scale += std::fabs(array.datasheet.sensor[static_cast<std::size_t>(i)].coefficients.scale[0]) / array.array.size();
  }
  const double numbers = factor * array.gravity.g_mps2 * scale;
  for (const char* unit : log_units(array.field)) {
    if (near_one(numbers * base_of(unit, array.field) / array.gravity.g_mps2)) return {Kind::unit, unit};
  }
  if (stated.kind != io::RawUnit::Kind::count && numbers > kCounts) return {Kind::counts};
  if (stated.kind == io::RawUnit::Kind::count && numbers < kCounts) return {Kind::volts};
  return {};
}

}  // namespace findings
}  // namespace PLUMB_ABI
}  // namespace plumb
