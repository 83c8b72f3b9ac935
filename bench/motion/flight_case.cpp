#include "flight_case.hpp"

#include <cmath>
#include <memory>
#include <stdexcept>

#include "force_check.hpp"
#include "plumb/array/named.hpp"
#include "plumb/core/units.hpp"

namespace plumb_bench {
namespace {

using namespace plumb;
using scenario::Flight;
using scenario::FlightKind;
using scenario::FlightSample;
using scenario::FlightSpec;

constexpr double kNoise_mps2 = 0.02;
constexpr double kFullScale_mps2 = 16.0 * kG0_mps2;

/// splitmix64, for arms: a geometry is no part of the truth that is judged.
struct Draw {
  std::uint64_t state;
  double operator()() {
    state += 0x9E3779B97F4A7C15ULL;
    std::uint64_t z = state;
    z = (z ^ (z >> 30U)) * 0xBF58476D1CE4E5B9ULL;
    z = (z ^ (z >> 27U)) * 0x94D049BB133111EBULL;
    return static_cast<double>((z ^ (z >> 31U)) >> 11U) * 0x1.0p-52 - 1.0;
  }
};

std::vector<Vec3> axes_of(const FlightCase& one) {
  AxisList axes{};
  if (one.array == FlightArray::cone) {
    cone(axes, one.sensors);
  } else {
    for (std::size_t i = 0; i < static_cast<std::size_t>(one.sensors); ++i) axes[i][i % 3] = 1.0;
  }
  return {axes.begin(), axes.begin() + one.sensors};
}

/// 10 to 30 mm from the reference point; the axes of a triad within millimetres of each other.
std::vector<Vec3> arms_of(const FlightCase& one) {
  Draw draw{one.seed ^ 0xA5A5A5A5ULL};
  std::vector<Vec3> out;
  for (int i = 0; i < one.sensors; ++i) {
    if (one.array == FlightArray::triads && i % 3 != 0) {
      out.push_back(plus(out.back(), {0.001 * draw(), 0.001 * draw(), 0.001 * draw()}));
      continue;
    }
    Vec3 arm{};
    double length = 0.0;
    do {
      arm = {draw(), draw(), draw()};
      length = norm(arm);
    } while (length < 0.1 || length > 1.0);
    const double drawn_m = 0.02 + 0.01 * draw();
    out.push_back(scaled(arm, (one.arm_m > 0.0 ? one.arm_m : drawn_m) / length));
  }
  return out;
}

double rate_bound_of(FlightKind kind) {
  switch (kind) {
    case FlightKind::drone: return 8.0;
    case FlightKind::drilling: return 25.0;
    case FlightKind::car: return 2.0;
    case FlightKind::launch: return 6.0;
  }
  return 0.0;
}

SensorArray array_of(const std::vector<Vec3>& axes, bool triads) {
  std::array<SensorRow, kCapacity> rows{};
  for (std::size_t i = 0; i < axes.size(); ++i) {
    const auto chip = static_cast<std::uint8_t>(triads ? 1 + i / 3 : 0);
    rows[i] = {make_id(("a" + std::to_string(i + 1)).c_str()), axes[i], kNoise_mps2, chip};
  }
  const Expected<SensorArray> made = SensorArray::make(rows.data(), static_cast<int>(axes.size()));
  if (!made) throw std::runtime_error(describe(made.error().code));
  return *made;
}

MotionSample sample_of(const FlightSample& truth, const FlightCase& one) {
  MotionSample out;
  out.time_s = truth.time_s;
  out.delivered = SensorSet::first(one.sensors);
  out.reading_mps2 = truth.reading_mps2;
  for (int i = 0; i < one.sensors; ++i) {
    if (std::fabs(truth.reading_mps2[static_cast<std::size_t>(i)]) >= 0.999 * kFullScale_mps2)
      out.clipped = out.clipped.with(i);
  }
  for (std::size_t g = 0; g < static_cast<std::size_t>(one.gyros); ++g) {
    out.rate_radps[g] = truth.rate_radps[g];
    out.rate_given[g] = true;
  }
  return out;
}

FlightSpec spec_of(const FlightCase& one, const std::vector<Vec3>& axes, const std::vector<Vec3>& arms) {
  FlightSpec spec;
  spec.kind = one.kind;
  spec.seed = one.seed;
  spec.axis = axes;
  spec.lever_arm_m = arms;
  spec.noise_mps2 = kNoise_mps2;
  spec.full_scale_mps2 = kFullScale_mps2;
  spec.gyros = one.gyros;
  spec.vertices = one.seed % 2 == 1;
  spec.faults = one.faults;
  spec.gyro_faults = one.gyro_faults;
  const double f = one.error_factor;
  auto& box = spec.box;
  for (double* width :
       {&box.scale, &box.axis_rad, &box.bias_mps2, &box.lever_m, &box.skew_s, &box.bandwidth, &box.rectification,
        &box.gyro_scale, &box.gyro_axis_rad, &box.gyro_bias_radps, &box.gyro_skew_s, &box.gyro_bandwidth})
    *width *= f;
  return spec;
}

}  // namespace

MotionSetup stated_setup(const FlightCase& one, const std::vector<Vec3>& arms) {
  MotionSetup out;
  for (std::size_t i = 0; i < arms.size(); ++i) {
    out.lever_arm_m[i] = arms[i];
    out.errors[i] = {1e-3, 70e-6, 2e-5, 1e-3, 1.5e-3, 1e-3 * kG0_mps2};
  }
  out.gyros = one.gyros;
  out.gyro = {0.01, 0.01, rad_from_deg(0.35), rad_from_deg(0.1), 20e-6};
  out.rate_bound_radps = rate_bound_of(one.kind);
  out.gyro_corroborated = one.gyro_corroborated;
  out.max_faults = one.max_faults;
  out.shortest_block = one.shortest_block;
  return out;
}

FlightBrief brief_of(const FlightCase& one) {
  FlightBrief out;
  out.array = array_of(axes_of(one), one.array == FlightArray::triads);
  out.setup = stated_setup(one, arms_of(one));
  for (const auto& fault : one.faults) {
    out.onset_s = fault.onset_s < out.onset_s ? fault.onset_s : out.onset_s;
    out.faulty = out.faulty | fault.sensors;
  }
  for (const auto& fault : one.gyro_faults) out.onset_s = fault.onset_s < out.onset_s ? fault.onset_s : out.onset_s;
  out.may_blame = out.array.units().whole(out.faulty);
  return out;
}

void feed(const FlightCase& one, const FlightJudge& judge) {
  Flight flight(spec_of(one, axes_of(one), arms_of(one)));
  const auto samples = static_cast<std::uint64_t>(one.duration_s * 1000.0);
  for (std::uint64_t k = 0; k < samples; ++k) {
    const FlightSample truth = flight.next();
    judge(truth, sample_of(truth, one));
  }
}

void score(const FlightBrief& brief, double time_s, const FlightFinding& found, FlightOutcome* out) {
  const double after_s = time_s - brief.onset_s;
  if (found.alarm && after_s < 0.0) out->early_alarm = true;
  if (found.alarm && after_s >= 0.0 && out->detected_s < 0.0) out->detected_s = after_s;
  if (!(found.isolated & brief.faulty).empty() && out->isolated_s < 0.0) out->isolated_s = after_s;
  if (!(found.excluded & brief.faulty).empty() && out->excluded_s < 0.0) out->excluded_s = after_s;
  const SensorSet may_blame = after_s < 0.0 ? SensorSet() : brief.may_blame;  // before it fails, a unit is healthy
  out->wrongly_isolated = out->wrongly_isolated || !may_blame.contains(found.isolated);
  out->wrongly_excluded = out->wrongly_excluded || !may_blame.contains(found.excluded);
  out->all_excluded = !brief.faulty.empty() && found.excluded.contains(brief.faulty);
}

namespace {

/// A bound that holds while a gyro does promises nothing where that one has failed.
bool promises(const SpecificForce& force, bool gyro_failed) {
  return force.validity == ForceValidity::bounded && !(gyro_failed && force.gyro_assumed);
}

}  // namespace

FlightOutcome fly(const FlightCase& one) {
  const FlightBrief brief = brief_of(one);
  const auto monitor = std::make_unique<MotionMonitor>();
  if (const auto sound = monitor->configure(brief.array, brief.setup); !sound) {
    throw std::runtime_error(describe(sound.error().code));
  }
  FlightOutcome out;
  TrueForce past;
  feed(one, [&](const FlightSample& truth, const MotionSample& sample) {
    past.add(truth.specific_force_mps2);
    const MotionVerdict& v = monitor->step(sample);
    score(brief, truth.time_s, {v.alarm || v.gyros_disagree, v.isolated, v.excluded}, &out);
    const bool gyro_failed = !one.gyro_faults.empty() && truth.time_s >= brief.onset_s;
    if (past.count() > 2 && promises(v.sample, gyro_failed)) check_bound(v.sample, past.mean(1), &out.sample);
    if (v.block_ended && promises(v.block, gyro_failed)) check_bound(v.block, past.mean(kForceBlock), &out.block);
    out.last_cause = v.cause;
  });
  return out;
}

}  // namespace plumb_bench
