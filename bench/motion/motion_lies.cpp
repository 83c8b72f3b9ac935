#include "motion_lies.hpp"

#include <cmath>
#include <limits>

#include "plumb/core/units.hpp"

namespace plumb_bench {
namespace {

using namespace plumb;

constexpr double kLeast_mps2 = 1e-3 * kG0_mps2, kMost_mps2 = 20.0 * kG0_mps2;
constexpr double kPi = 3.14159265358979323846;
/// Of a gyro's lie, per m/s^2 of the size that is drawn.
constexpr double kRate_radps = 0.1;

/// -1 to 1, a pure function of its argument.
double hashed(std::uint64_t seed) { return Draw(seed).between(-1.0, 1.0); }

/// About the lengths of the blocks that are judged, and beside them.
int drawn_period(Draw& draw) {
  constexpr int kPeriods[] = {1, 2, 3, 4, 5, 8, 16, 31, 32, 33, 64, 128, 255, 256, 257, 512};
  return kPeriods[draw.below(static_cast<int>(sizeof kPeriods / sizeof *kPeriods))];
}

/// Across two honest axes, so that these two agree with the lie.
Vec3 framing_direction(const LieScene& scene, Draw& draw) {
  const int n = scene.array.size();
  const SensorSet honest = scene.array.all() - scene.liars;
  if (honest.size() < 2 || draw.below(2) == 0) return draw.direction();
  int a = draw.below(n), b = draw.below(n);
  while (!honest.has(a)) a = (a + 1) % n;
  while (!honest.has(b) || a == b) b = (b + 1) % n;
  const Vec3 across = cross(scene.array.axis(a), scene.array.axis(b));
  const double length = norm(across);
  return length > 1e-3 ? scaled(across, 1.0 / length) : draw.direction();
}

double course_of(const Lie& lie, std::size_t k) {
  const auto period = static_cast<std::size_t>(lie.period);
  const double at = static_cast<double>(k) / static_cast<double>(period);
  switch (lie.course) {
    case LieCourse::constant: return 1.0;
    case LieCourse::ramp: return static_cast<double>(k) * 1e-3;
    case LieCourse::sine: return std::sin(2.0 * kPi * at + 3.0 * hashed(lie.seed));
    case LieCourse::square: return k / period % 2 == 0 ? 1.0 : -1.0;
    case LieCourse::pulses: return Draw(lie.seed ^ k).bits() % (4 * period) == 0 ? 1.0 : 0.0;
    case LieCourse::stairs: return hashed(lie.seed ^ (k / period * 0x9E37ULL));
    case LieCourse::noise: return hashed(lie.seed ^ (k * 0x9E37ULL));
  }
  return 0.0;
}

double garbage_of(const Lie& lie, std::size_t k) {
  constexpr double kInfinite = std::numeric_limits<double>::infinity();
  constexpr double kWords[] = {std::numeric_limits<double>::quiet_NaN(),  kInfinite, -kInfinite, 1e300, -1e300, 1e38,
                               std::numeric_limits<double>::denorm_min(), -0.0};
  return kWords[Draw(lie.seed ^ k).bits() % (sizeof kWords / sizeof *kWords)];
}

double lied_reading(const std::vector<MotionSample>& told, std::size_t begin, std::size_t k, const LieScene& scene,
                    const Lie& lie, int sensor) {
  const auto i = static_cast<std::size_t>(sensor);
  const MotionSample& now = told[begin + k];
  const double honest = now.reading_mps2[i], course = course_of(lie, k), size = lie.size_mps2 * course;
  const Vec3& axis = scene.array.axis(sensor);
  switch (lie.shape) {
    case LieShape::force: return honest + size * dot(axis, lie.direction);
    case LieShape::turned:
      return honest + size / kG0_mps2 * dot(axis, cross(lie.direction, scene.map.estimate(now.reading_mps2)));
    case LieShape::apart: return honest + size * hashed(lie.seed ^ i);
    case LieShape::scale: return honest * (1.0 + size / kG0_mps2);
    case LieShape::copy: {
      const double other = now.reading_mps2[static_cast<std::size_t>(lie.other)];
      return course > 0.0 ? other : (course < 0.0 ? -other : honest);
    }
    case LieShape::late: {
      const auto delay = static_cast<std::size_t>(lie.period);
      return begin + k >= delay ? told[begin + k - delay].reading_mps2[i] : honest;
    }
    case LieShape::stuck: return course > 0.0 ? told[begin].reading_mps2[i] : honest;
    case LieShape::garbage: return course > 0.3 ? garbage_of(lie, k) : honest;
    case LieShape::clipped: return course > 0.0 ? std::copysign(16.0 * kG0_mps2, honest) : honest;
    case LieShape::silent: break;
  }
  return honest;
}

void lie_of_gyro(const std::vector<MotionSample>& told, std::size_t begin, std::size_t k, const Lie& lie, int gyro,
                 MotionSample* out) {
  const auto g = static_cast<std::size_t>(gyro);
  Vec3& rate = out->rate_radps[g];
  const double course = course_of(lie, k), size = kRate_radps * lie.size_mps2 * course;
  switch (lie.shape) {
    case LieShape::scale: rate = scaled(rate, 1.0 + lie.size_mps2 / kG0_mps2 * course); return;
    case LieShape::copy: rate = {rate[1], rate[2], rate[0]}; return;
    case LieShape::late:
      if (begin + k >= static_cast<std::size_t>(lie.period))
        rate = told[begin + k - static_cast<std::size_t>(lie.period)].rate_radps[g];
      return;
    case LieShape::stuck:
      if (course > 0.0) rate = told[begin].rate_radps[g];
      return;
    case LieShape::garbage:
      if (course > 0.3) rate = {garbage_of(lie, k), garbage_of(lie, 2 * k + 1), rate[2]};
      return;
    case LieShape::silent:
    case LieShape::clipped:
      if (course > 0.0) out->rate_given[g] = false;
      return;
    default: rate = plus(rate, scaled(lie.direction, size)); return;
  }
}

}  // namespace

double Draw::scale(double low, double high) { return low * std::exp(uniform() * std::log(high / low)); }

Vec3 Draw::direction() {
  for (;;) {
    const Vec3 v{between(-1.0, 1.0), between(-1.0, 1.0), between(-1.0, 1.0)};
    const double length = norm(v);
    if (length > 0.1 && length <= 1.0) return scaled(v, 1.0 / length);
  }
}

const char* to_string(LieShape shape) noexcept {
  switch (shape) {
    case LieShape::force: return "one false force";
    case LieShape::turned: return "force turned";
    case LieShape::apart: return "each its own error";
    case LieShape::scale: return "another scale";
    case LieShape::copy: return "copy of another";
    case LieShape::late: return "late";
    case LieShape::stuck: return "stuck";
    case LieShape::garbage: return "garbage";
    case LieShape::silent: return "silent";
    case LieShape::clipped: return "clipped";
  }
  return "";
}

const char* to_string(LieCourse course) noexcept {
  switch (course) {
    case LieCourse::constant: return "constant";
    case LieCourse::ramp: return "ramp";
    case LieCourse::sine: return "sine";
    case LieCourse::square: return "square wave";
    case LieCourse::pulses: return "pulses";
    case LieCourse::stairs: return "stairs";
    case LieCourse::noise: return "noise";
  }
  return "";
}

Lie drawn_lie(const LieScene& scene, Draw& draw) {
  Lie out;
  out.shape = static_cast<LieShape>(draw.below(kLieShapes));
  out.course = static_cast<LieCourse>(draw.below(kLieCourses));
  out.size_mps2 = draw.scale(kLeast_mps2, kMost_mps2) * (draw.below(2) == 0 ? 1.0 : -1.0);
  out.direction = framing_direction(scene, draw);
  out.other = draw.below(scene.array.size());
  out.period = drawn_period(draw);
  out.seed = draw.bits();
  return out;
}

Lie changed_lie(const Lie& lie, const LieScene& scene, Draw& draw) {
  Lie out = lie;
  switch (draw.below(6)) {
    case 0: out.size_mps2 *= draw.between(1.0, 1.5); break;
    case 1: out.size_mps2 *= draw.between(0.5, 1.0); break;
    case 2: out.size_mps2 = -out.size_mps2; break;
    case 3: out.direction = framing_direction(scene, draw); break;
    case 4: out.course = static_cast<LieCourse>(draw.below(kLieCourses)); break;
    default: out.period = drawn_period(draw); break;
  }
  return out;
}

MotionSample with_lie(const std::vector<MotionSample>& told, std::size_t begin, std::size_t k, const LieScene& scene,
                      const Lie& sensors, const Lie& gyro) {
  MotionSample out = told[begin + k];
  for (int i = 0; i < scene.array.size(); ++i) {
    if (!scene.liars.has(i)) continue;
    out.reading_mps2[static_cast<std::size_t>(i)] = lied_reading(told, begin, k, scene, sensors, i);
    const bool acts = course_of(sensors, k) > 0.0;
    if (sensors.shape == LieShape::silent && acts) out.delivered = out.delivered - SensorSet::of(i);
    if (sensors.shape == LieShape::clipped && acts) out.clipped = out.clipped.with(i);
  }
  if (scene.gyro >= 0) lie_of_gyro(told, begin, k, gyro, scene.gyro, &out);
  return out;
}

}  // namespace plumb_bench
