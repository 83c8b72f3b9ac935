#include "plumb/findings/geometry_study.hpp"

#include <cmath>
#include <limits>

#include "plumb/core/units.hpp"
#include "plumb/detection/isolation.hpp"
#include "plumb/findings/unseen_wiring.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace findings {
namespace {

/// A geometry that needs more errors than this to tell two sensors apart is of no use (docs/theory.md, section 8.2).
constexpr double kMostErrors = 40.0;
constexpr double kUnseenBias = 0.05;
/// Two axes closer than this are the same for wiring: to exchange them changes nothing.
constexpr double kHarmless_rad = 1e-6;
constexpr int kMapStep_deg = 5;

constexpr std::size_t at(int i) noexcept { return static_cast<std::size_t>(i); }

/// ISCWSA axes: what `tilt_of` takes apart.
Vec3 down_at(double inclination_deg, double toolface_deg) {
  const double i = rad_from_deg(inclination_deg), t = rad_from_deg(toolface_deg);
  return {-std::sin(i) * std::sin(t), -std::sin(i) * std::cos(t), std::cos(i)};
}

/// Without the last digits of an axis that was computed: 0 rather than 1e-17.
double rounded(double cosine) { return std::round(1e12 * cosine) * 1e-12; }

std::vector<SensorStudy> sensors_of(const GeometrySubject& subject) {
  const SensorArray& array = subject.array;
  const Vec3 down[3] = {{0.0, 0.0, 1.0}, {0.0, -1.0, 0.0}, {-1.0, 0.0, 0.0}};
  std::vector<SensorStudy> out(at(array.size()));
  for (std::size_t a = 0; a < 3; ++a) {
    Readings along{};
    for (int i = 0; i < array.size(); ++i) along[at(i)] = subject.gravity.g_mps2 * rounded(dot(array.axis(i), down[a]));
    Expected<std::array<double, kCapacity>> raw = along;
    if (subject.file) raw = subject.model.raw_from(along, subject.model.sensor[0].reference_degc);
    for (int i = 0; i < array.size(); ++i) {
      out[at(i)].expected.down_mps2[a] = along[at(i)];
      if (raw) out[at(i)].expected.raw[a] = (*raw)[at(i)];
    }
  }
  for (int i = 0; i < array.size(); ++i) out[at(i)].id = array.row(i).id.data();
  return out;
}

void find_remounts(const SensorArray& array, std::vector<SensorStudy>& sensors) {
  for (int t = 0; t < array.triple_count(); ++t) {
    if (!array.triple(t).votes) continue;
    for (int m = 0; m < 3; ++m) {
      const int i = array.triple(t).sensors[at(m)];
      const double away = angle_between_rad(array.axis(i), mirror_axis(array, t, m));
      double& nearest = sensors[at(i)].nearest_remount_rad;
      if (!(nearest > 0.0) || away < nearest) nearest = away;
    }
  }
}

/// Reversals, exchanges of two, turns of three: those that stay below the limits of a block, and those that a
/// calibration takes for errors of mounting within `axis_tolerance_rad`.
std::vector<HiddenWiring> hidden_wirings(const SensorArray& array, const GravityReference& gravity,
                                         const ErrorBudget& budget, double axis_tolerance_rad) {
  const int n = array.size();
  double noise = 0.0;
  for (int i = 0; i < n; ++i) noise = std::fmax(noise, budget.noise_mps2[at(i)] + budget.systematic_mps2[at(i)]);
  const double parity = n > 3 ? budget.limits.parity_alarm[at(n - 3)] * noise / gravity.g_mps2 : 0.0;
  const double gain = figures_of_merit(array).gdop;
  const double length = (budget.limits.norm_alarm * gain * noise + budget.gravity_mps2) / gravity.g_mps2;
  std::vector<HiddenWiring> out;
  using Kind = HiddenWiring::Kind;
  const auto consider = [&](const Wiring& wiring, Kind kind, const std::array<int, 3>& sensor) {
    const WiringEffect effect = wiring_effect(array, wiring);
    const bool unseen = effect.unseen(parity + 1e-12, length) || unseen_turn(array, array, wiring, axis_tolerance_rad);
    if (unseen && effect.turn_rad > kHarmless_rad) out.push_back({kind, sensor, effect});
  };
  for (int i = 0; i < n; ++i) {
    consider(Wiring::reversed(i), Kind::reversed, {i, -1, -1});
    for (int j = i + 1; j < n; ++j) {
      consider(Wiring::swapped(i, j), Kind::exchanged, {i, j, -1});
      consider(Wiring::swapped_reversed(i, j), Kind::exchanged_and_reversed, {i, j, -1});
      for (int k = j + 1; k < n; ++k) {
        consider(Wiring::cycled(i, j, k), Kind::turned, {i, j, k});
        consider(Wiring::cycled(i, k, j), Kind::turned, {i, k, j});
      }
    }
  }
  return out;
}

/// The same axes with the noise of all sensors changed alike.
Expected<SensorArray> with_noise(const SensorArray& array, double factor) {
  std::array<SensorRow, kCapacity> rows{};
  for (int i = 0; i < array.size(); ++i) {
    rows[at(i)] = array.row(i);
    rows[at(i)].sigma_mps2 *= factor;
  }
  Expected<SensorArray> out = SensorArray::make(rows.data(), array.size());
  if (out) out->set_uncertainty(array.uncertainty());
  return out;
}

double largest_sigma(const SensorArray& array) {
  double out = 0.0;
  for (int i = 0; i < array.size(); ++i) out = std::fmax(out, array.sigma_mps2(i));
  return out;
}

std::vector<ProtectionPoint> levels_of(const GeometrySubject& subject) {
  std::vector<ProtectionPoint> out;
  if (subject.array.size() < 4) return out;
  // In the fine unit of the field: mg0, and nT.
  const double unit = subject.field() == io::FieldKind::magnetic ? 50.0 : 1.0;
  for (const double level : {0.02, 0.05, 0.1, 0.2, 0.5, 1.0, 2.0, 5.0}) {
    const double sigma = unit * level;
    const double factor = sigma / io::units_of(subject.field()).fine_per_inside / largest_sigma(subject.array);
    const Expected<SensorArray> array = with_noise(subject.array, factor);
    if (!array) continue;
    TestSettings one = subject.settings;
    one.samples = 1.0;
    out.push_back({sigma, deg_from_rad(protection_level_rad(*array, subject.gravity, one)),
                   deg_from_rad(protection_level_rad(*array, subject.gravity, subject.settings))});
  }
  return out;
}

void map_attitudes(const OneAttitude& one, GeometryStudy& study) {
  MapSummary& s = study.one_attitude;
  s.least_clear_mps2 = std::numeric_limits<double>::infinity();
  double weight = 0.0, blind = 0.0;
  for (int inclination = 0; inclination <= 180; inclination += kMapStep_deg) {
    for (int toolface = 0; toolface <= 360; toolface += kMapStep_deg) {
      const AttitudeFigures figures = one.at(down_at(inclination, toolface));
      study.map.push_back({static_cast<double>(inclination), static_cast<double>(toolface),
                           g0_from_mps2(figures.clear_from_mps2), g0_from_mps2(figures.nearest_mirror_mps2),
                           figures.blind.size()});
      if (figures.clear_from_mps2 < s.least_clear_mps2) {
        s.least_clear_mps2 = figures.clear_from_mps2;
        s.best_inclination_deg = inclination;
        s.best_toolface_deg = toolface;
      }
      s.largest_clear_mps2 = std::fmax(s.largest_clear_mps2, figures.clear_from_mps2);
      if (toolface == 360) continue;  // the same attitude as 0
      const double area = std::sin(rad_from_deg(inclination));
      weight += area;
      if (!figures.blind.empty()) blind += area;
    }
  }
  s.not_guaranteed_share = blind / weight;
}

std::vector<WorstCase> worst_cases(const GeometryStudy& study) {
  const int most = study.merit.units - 1 - study.merit.coplanarity;
  std::vector<WorstCase> out;
  for (int m = 1; m <= most; ++m) {
    out.push_back({m, study.constants.worst_fault(m),
                   2 * m <= most ? study.constants.worst_fault(2 * m) : std::numeric_limits<double>::infinity(),
                   study.constants.vector_error[at(m)]});
  }
  return out;
}

void find_warnings(GeometryStudy& study) {
  const int near_singular = study.merit.near_singular_triples;
  // Axes of chips are parallel by design, and each chip determines a vector or not, whatever the others do.
  const bool chips = study.merit.units < static_cast<int>(study.sensors.size());
  if (study.merit.min_triple_det < kMinTripleDet && !chips) {
    study.warnings.push_back(
        {FindingCode::near_singular_triples, -1, static_cast<double>(near_singular), kMinTripleDet});
  }
  const double apart = study.constants.worst_fault(2);
  if (std::isfinite(apart) && apart > kMostErrors)
    study.warnings.push_back({FindingCode::weak_isolation, -1, apart, kMostErrors});
}

void find_limits(const SensorArray& array, GeometryStudy& study) {
  const auto add = [&study](FindingCode code, double value = 0.0, double limit = 0.0) {
    study.limits.push_back({code, -1, value, limit});
  };
  const int critical = critical_sensors(array, array.all()).size();
  if (study.merit.confirmed_grade < 1) add(FindingCode::no_isolation);
  if (critical > 0) add(FindingCode::critical_sensors, critical);
  if (study.merit.provisional_grade < 1 && study.merit.confirmed_grade >= 1) add(FindingCode::gravity_needed);
  if (study.correlated_grade < 1) add(FindingCode::correlated_faults);
  if (study.common.visibility < kUnseenBias)
    add(FindingCode::common_bias_unobservable, norm(study.common.vector_error));
  if (!study.hidden.empty()) add(FindingCode::unobservable_permutations, static_cast<double>(study.hidden.size()));
  if (study.merit.units > kStrictCapacity) add(FindingCode::many_sensors, study.merit.units, kStrictCapacity);
  add(FindingCode::common_rotation);  // of every array
  add(FindingCode::common_scale);
}

}  // namespace

TestSettings settings_of(const io::ArrayFile& array, double days_since_calibration) {
  TestSettings out;
  out.samples = array.monitor.window;
  out.false_alarm_rate = array.monitor.false_alarm_rate;
  out.rejection_rate = array.monitor.rejection_rate;
  out.integrity_risk = array.monitor.integrity_risk;
  out.isolation_attitudes = array.monitor.isolation_stations;
  out.acceleration_mps2 = array.monitor.acceleration_bound_mps2;
  out.tolerance_mps2 = io::tolerance_mps2(array, days_since_calibration);
  return out;
}

Readings full_scale_of(const io::ArrayFile& array) {
  Readings out{};
  for (int i = 0; i < array.datasheet.size; ++i) {
    const DatasheetSensor& sensor = array.datasheet.sensor[at(i)];
    out[at(i)] = sensor.full_scale_raw / std::fabs(sensor.coefficients.scale[0]);
  }
  return out;
}

int hidden_wiring_count(const io::ArrayFile& array) {
  const ErrorBudget budget = error_budget(array.array, array.gravity, settings_of(array));
  return static_cast<int>(hidden_wirings(array.array, array.gravity, budget, kUnseenAxis_rad).size());
}

namespace {

/// By the axes of the datasheet: those of a calibration have been fitted to whatever the wiring was.
std::vector<HiddenWiring> hidden_wirings_of(const GeometrySubject& subject, const ErrorBudget& budget) {
  if (!subject.file) return hidden_wirings(subject.array, subject.gravity, budget, kUnseenAxis_rad);
  const SensorArray& nominal = subject.file->array;
  return hidden_wirings(nominal, subject.gravity, error_budget(nominal, subject.gravity, subject.settings),
                        kUnseenAxis_rad);
}

}  // namespace

GeometryStudy study_geometry(const GeometrySubject& subject) {
  const SensorArray& array = subject.array;
  GeometryStudy out;
  out.merit = figures_of_merit(array);
  out.constants = fault_bounds(array);
  out.budget = error_budget(array, subject.gravity, subject.settings);
  out.thresholds = thresholds_of(array, subject.gravity, subject.settings);
  out.common = common_bias(array);
  out.polarity = best_polarity(array);
  const int spare = out.merit.units - 1 - out.merit.coplanarity;
  out.correlated_grade = spare > 0 ? spare / 2 : 0;
  out.sensors = sensors_of(subject);
  find_remounts(array, out.sensors);
  out.hidden = hidden_wirings_of(subject, out.budget);
  out.levels = levels_of(subject);
  if (subject.file) out.full_scale_mps2 = full_scale_of(*subject.file);
  out.sizes =
      size_table(array, subject.gravity, subject.settings, subject.calibrated, subject.visited, out.full_scale_mps2);
  std::unique_ptr<const OneAttitude> one;
  if (out.merit.confirmed_grade > 0) {
    one = std::make_unique<const OneAttitude>(array, subject.gravity, out.budget);
    for (int i = 0; i < array.size(); ++i) {
      out.sensors[at(i)].blind_half_width_mps2 = one->blind_half_width_mps2(i);
      out.sensors[at(i)].any_attitude_mps2 = one->any_attitude_mps2(i);
    }
    map_attitudes(*one, out);
  }
  const Readings isolated = guaranteed_isolation_mps2(array, subject.settings, out.thresholds, one.get());
  for (int i = 0; i < array.size(); ++i) out.sensors[at(i)].guaranteed_isolation_mps2 = isolated[at(i)];
  out.worst = worst_cases(out);
  find_warnings(out);
  find_limits(array, out);
  return out;
}

}  // namespace findings
}  // namespace PLUMB_ABI
}  // namespace plumb
