#include "clocked_flight.hpp"

#include <algorithm>
#include <cmath>

#include "clock_plan.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace session {
namespace {

using scenario::FlightSample;
using scenario::Purpose;
using scenario::Stream;

/// As fast as the simulator flies: 40 samples a period of what its filters of some 250 Hz pass, so that a cubic between
/// four of them is off by 1e-5 of it.
constexpr double kCourse_hz = 10000.0;
/// A second of course is kept: longer than any sample period.
constexpr std::size_t kCourse = 10000;
/// Full scale counts behind the interpolation.
constexpr double kNoFullScale_mps2 = 1e5;
/// Sub-streams: the clocks, then noise of sensors and of gyros.
constexpr std::uint32_t kSensorNoise = 100, kGyroNoise = 200;

scenario::FlightSpec course_of(scenario::FlightSpec spec) {
  spec.rate_hz = kCourse_hz;
  spec.noise_mps2 = 0.0;
  spec.gyro_noise_radps = 0.0;
  spec.full_scale_mps2 = kNoFullScale_mps2;
  return spec;
}

void add(FlightSample& sum, const FlightSample& one, double weight) {
  for (std::size_t i = 0; i < sum.reading_mps2.size(); ++i) sum.reading_mps2[i] += weight * one.reading_mps2[i];
  for (std::size_t g = 0; g < sum.rate_radps.size(); ++g)
    sum.rate_radps[g] = plus(sum.rate_radps[g], scaled(one.rate_radps[g], weight));
  sum.specific_force_mps2 = plus(sum.specific_force_mps2, scaled(one.specific_force_mps2, weight));
  sum.true_rate_radps = plus(sum.true_rate_radps, scaled(one.true_rate_radps, weight));
  sum.true_angular_acceleration_radps2 =
      plus(sum.true_angular_acceleration_radps2, scaled(one.true_angular_acceleration_radps2, weight));
}

}  // namespace

double ClockedFlight::Chip::due_s() const noexcept { return common_time_of(real, stamp_s()); }

ClockedFlight::Chip ClockedFlight::drawn_chip(const MotionClock& stated, std::size_t number, bool of_the_log) const {
  Chip out;
  out.real = stated;
  out.of_the_log = of_the_log;
  if (of_the_log) return out;
  const Stream draw(spec_.seed, Purpose::clock, static_cast<std::uint32_t>(number));
  out.real.offset_s += draw.uniform(0, -stated.offset_bound_s, stated.offset_bound_s);
  out.real.rate += draw.uniform(1, -stated.rate_bound, stated.rate_bound);
  out.start_s = stamp_of(out.real, 0.0) + draw.uniform(2, 0.0, stated.sample_period_s);
  return out;
}

ClockedFlight::ClockedFlight(const scenario::FlightSpec& spec, const ClockPlan& clocks)
    : spec_(spec), flight_(course_of(spec)) {
  for (std::size_t c = 0; c < clocks.name.size(); ++c)
    chips_.push_back(drawn_chip(clocks.setup.clock[c], c, c >= clocks.stated));
}

/// By the cubic through four samples of the course.
FlightSample ClockedFlight::at(double time_s) {
  const double place = time_s * kCourse_hz;
  const auto before = static_cast<std::uint64_t>(std::fmax(1.0, std::floor(place)));
  while (first_ + course_.size() < before + 3) {
    course_.push_back(flight_.next());
    if (course_.size() <= kCourse) continue;
    course_.pop_front();
    ++first_;
  }
  FlightSample out;
  out.time_s = time_s;
  for (std::uint64_t a = before - 1; a < before + 3; ++a) {
    double weight = 1.0;
    for (std::uint64_t b = before - 1; b < before + 3; ++b) {
      if (a != b) weight *= (place - static_cast<double>(b)) / (static_cast<double>(a) - static_cast<double>(b));
    }
    add(out, course_[static_cast<std::size_t>(a - first_)], weight);
  }
  return out;
}

/// The chip takes a sample, which stands in all rows until its next one.
void ClockedFlight::sample(std::size_t chip, double time_s) {
  Chip& one = chips_[chip];
  const FlightSample flown = at(time_s);
  for (std::size_t i = 0; i < spec_.axis.size(); ++i) {
    if (!one.real.sensors.has(static_cast<int>(i))) continue;
    const Stream noise(spec_.seed, Purpose::clock, kSensorNoise + static_cast<std::uint32_t>(i));
    now_.flown.reading_mps2[i] = std::clamp(flown.reading_mps2[i] + spec_.noise_mps2 * noise.normal(one.number),
                                            -spec_.full_scale_mps2, spec_.full_scale_mps2);
  }
  for (std::size_t g = 0; g < one.real.gyro.size(); ++g) {
    if (!one.real.gyro[g]) continue;
    for (std::size_t k = 0; k < 3; ++k) {
      const Stream noise(spec_.seed, Purpose::clock, kGyroNoise + static_cast<std::uint32_t>(3 * g + k));
      now_.flown.rate_radps[g][k] = flown.rate_radps[g][k] + spec_.gyro_noise_radps * noise.normal(one.number);
    }
    now_.rate_given[g] = true;
  }
  now_.delivered = now_.delivered | one.real.sensors;
  if (!one.of_the_log) now_.clock_s[chip] = one.stamp_s();
  one.fresh = true;
  ++one.number;
}

std::size_t ClockedFlight::first_due(double before_s) const noexcept {
  std::size_t out = chips_.size();
  for (std::size_t c = 0; c < chips_.size(); ++c) {
    if (chips_[c].of_the_log || !(chips_[c].due_s() < before_s)) continue;
    if (out == chips_.size() || chips_[c].due_s() < chips_[out].due_s()) out = c;
  }
  return out;
}

ClockedFlight::Row ClockedFlight::row_at(double time_s) {
  const FlightSample truth = at(time_s);
  now_.flown.time_s = time_s;
  now_.flown.specific_force_mps2 = truth.specific_force_mps2;
  now_.flown.true_rate_radps = truth.true_rate_radps;
  now_.flown.true_angular_acceleration_radps2 = truth.true_angular_acceleration_radps2;
  const Row out = now_;
  for (Chip& chip : chips_) {
    chip.fresh = false;
    if (!chip.of_the_log) continue;
    now_.delivered = now_.delivered - chip.real.sensors;
    for (std::size_t g = 0; g < chip.real.gyro.size(); ++g)
      now_.rate_given[g] = now_.rate_given[g] && !chip.real.gyro[g];
  }
  return out;
}

/// A row at every whole period, and one more where a chip has a second sample before that: a row holds one of each.
ClockedFlight::Row ClockedFlight::next() {
  const double tick_s = static_cast<double>(ticks_) / spec_.rate_hz;
  for (std::size_t c = first_due(tick_s); c < chips_.size(); c = first_due(tick_s)) {
    const double due_s = chips_[c].due_s();
    if (chips_[c].fresh) return row_at(due_s);
    sample(c, due_s);
  }
  for (std::size_t c = 0; c < chips_.size(); ++c) {
    if (chips_[c].of_the_log) sample(c, tick_s);
  }
  ++ticks_;
  return row_at(tick_s);
}

}  // namespace session
}  // namespace PLUMB_ABI
}  // namespace plumb
