#include "plumb/motion/motion_window.hpp"

#include <cmath>
#include <new>

namespace plumb {
inline namespace PLUMB_ABI {
namespace {

constexpr int kSettlingSamples = 4;  // after a reading at full scale

/// Whether it can be what interpolation adds at most: what is beyond says nothing.
bool bounds(double interpolation) noexcept { return interpolation >= 0.0 && interpolation <= kMostReading_mps2; }

Symmetric product_of(const Vec3& w) noexcept {
  return {w[0] * w[0], w[1] * w[1], w[2] * w[2], w[0] * w[1], w[0] * w[2], w[1] * w[2]};
}

}  // namespace

double MotionMeans::noise_share() const noexcept {
  const double n = samples;
  return (4.0 * n * n - 1.0) / (6.0 * n * n * n);
}

MotionWindow::MotionWindow(int sensors, int gyros, double sample_period_s, const BlockSamples& blocks) noexcept
    : sensors_(sensors), gyros_(gyros), blocks_(blocks), period_s_(sample_period_s) {}

/// In place: a second window would not be small on a stack.
void MotionWindow::clear() noexcept {
  const int sensors = sensors_, gyros = gyros_;
  const double period_s = period_s_;
  const BlockSamples blocks = blocks_;
  new (this) MotionWindow(sensors, gyros, period_s, blocks);
}

MotionWindow::Sums MotionWindow::sums_of(const MotionSample& sample) noexcept {
  Sums out;
  out.count = 1;
  out.time_s = sample.time_s - origin_s_;
  for (int i = 0; i < sensors_; ++i) {
    const auto k = static_cast<std::size_t>(i);
    const double y = sample.reading_mps2[k];
    if (!sample.delivered.has(i) || !(std::fabs(y) <= kMostReading_mps2)) continue;
    const bool clipped = sample.clipped.has(i);
    if (clipped_.has(i) && !clipped) continue;  // it has not recovered yet
    const double interpolation = sample.interpolation_mps2[k];
    if (interpolation != 0.0) {
      if (!bounds(interpolation)) continue;
      interpolated_ = true;
      out.interpolation[k] = interpolation;
    }
    SensorSet& kind = !clipped ? out.usable : (y > 0.0 ? out.at_least : out.at_most);
    kind = kind.with(i);
    out.reading[k] = {y, 0.5 * y};
    out.square[k] = {y * y, 0.5 * y * y};
  }
  for (std::size_t g = 0; g < static_cast<std::size_t>(gyros_); ++g) {
    out.given[g] = sample.rate_given[g] && norm(sample.rate_radps[g]) <= kMostRate_radps;
    const double interpolation = sample.interpolation_radps[g];
    if (interpolation != 0.0) {
      out.given[g] = out.given[g] && bounds(interpolation);
      interpolated_ = true;
    }
    if (!out.given[g]) continue;
    out.rate_interpolation[g] = interpolation;
    out.rate[g] = sample.rate_radps[g];
    out.product[g][0] = product_of(out.rate[g]);
    for (std::size_t c = 0; c < 6; ++c) out.product[g][1][c] = 0.5 * out.product[g][0][c];
  }
  return out;
}

/// A part of a larger block: (k + 1/2) / N of its members is `first_share` where it begins, and `part_share` of what it
/// was within the part.
void MotionWindow::append(Sums& to, const Sums& part, double first_share, double part_share) const noexcept {
  const auto add = [&](auto& x, const auto& y) {
    x[0] += y[0];
    x[1] += first_share * y[0] + part_share * y[1];
  };
  const bool first = to.count == 0;
  to.usable = first ? part.usable : to.usable & part.usable;
  to.at_least = first ? part.at_least : to.at_least & part.at_least;
  to.at_most = first ? part.at_most : to.at_most & part.at_most;
  for (std::size_t i = 0; i < static_cast<std::size_t>(sensors_); ++i) {
    add(to.reading[i], part.reading[i]);
    add(to.square[i], part.square[i]);
    if (part.bend[i] > to.bend[i]) to.bend[i] = part.bend[i];
  }
  for (std::size_t g = 0; g < static_cast<std::size_t>(gyros_); ++g) {
    to.given[g] = (to.count == 0 || to.given[g]) && part.given[g];
    to.rate[g] = plus(to.rate[g], part.rate[g]);
    RateEdges& edges = to.edges[g];
    const RateEdges& more = part.edges[g];
    if (to.count == 0) edges = more;
    edges.end = more.end;
    edges.end_step = more.end_step;
    if (more.step > edges.step) edges.step = more.step;
    if (more.bend > edges.bend) edges.bend = more.bend;
    for (std::size_t c = 0; c < 6; ++c) {
      to.product[g][0][c] += part.product[g][0][c];
      to.product[g][1][c] += first_share * part.product[g][0][c] + part_share * part.product[g][1][c];
    }
  }
  to.count += part.count;
  to.time_s += part.time_s;
  if (!interpolated_) return;
  const auto largest = [](auto& most, const auto& more) {
    for (std::size_t k = 0; k < most.size(); ++k) most[k] = more[k] > most[k] ? more[k] : most[k];
  };
  largest(to.interpolation, part.interpolation);
  largest(to.rate_interpolation, part.rate_interpolation);
}

/// From the middle of one block to that of the next.
double MotionWindow::span_s(const Scale& scale) noexcept {
  return (scale.last.time_s - scale.before.time_s) / scale.last.count;
}

Vec3 MotionWindow::acceleration(const Scale& scale, std::size_t gyro) noexcept {
  return scaled(minus(scale.last.rate[gyro], scale.before.rate[gyro]), 1.0 / (scale.last.count * span_s(scale)));
}

void MotionWindow::close(Scale& scale, const Sums& full) const noexcept {
  scale.acceleration_known = scale.before.count > 0;
  for (std::size_t g = 0; g < static_cast<std::size_t>(gyros_) && scale.acceleration_known; ++g) {
    scale.acceleration_known = scale.acceleration_known && scale.last.given[g] && scale.before.given[g];
    scale.acceleration_before[g] = acceleration(scale, g);
  }
  scale.before = scale.last;
  scale.last = full;
}

void MotionWindow::add(const MotionSample& sample) noexcept {
  ended_ = 0;
  const double step_s = sample.time_s - time_s_;
  if (begun_ > 0 && !(step_s > 0.5 * period_s_ && step_s < 1.5 * period_s_)) clear();
  if (!std::isfinite(sample.time_s)) return;
  time_s_ = sample.time_s;
  if (!sample.clipped.empty()) {
    clipped_ = clipped_ | sample.clipped;
    settling_ = kSettlingSamples + 1;
  }
  if (begun_ == 0) origin_s_ = sample.time_s;
  const Sums next = sums_of(sample);
  if (settling_ > 0 && --settling_ == 0) clipped_ = SensorSet{};
  for (std::size_t i = 0; i < static_cast<std::size_t>(sensors_) && begun_ > 0; ++i) {
    const double step = next.reading[i][0] - newest_.reading[i][0];
    if (begun_ > 1) newest_.bend[i] = std::fabs(step - step_mps2_[i]);
    step_mps2_[i] = step;
  }
  for (std::size_t g = 0; g < static_cast<std::size_t>(gyros_) && begun_ > 0; ++g) {
    const Vec3 step = minus(next.rate[g], newest_.rate[g]), before = begun_ > 1 ? step_radps_[g] : step;
    const double now = norm(step), last = norm(before);
    newest_.edges[g] = {minus(newest_.rate[g], scaled(before, 0.5)),
                        plus(newest_.rate[g], scaled(step, 0.5)),
                        before,
                        step,
                        now > last ? now : last,
                        norm(minus(step, before)),
                        begun_ == 1};
    step_radps_[g] = step;
  }
  if (begun_ > 0) take(newest_);
  newest_ = next;
  if (begun_ < 2) ++begun_;
}

/// Into the blocks of all scales, as far as they fill.
void MotionWindow::take(const Sums& sample) noexcept {
  close(scales_[0], sample);  // a block of one sample
  for (std::size_t s = 1; s < kMotionScales; ++s) {
    if (scales_[s - 1].before.count > 0) ended_ |= 1U << (s - 1);
    Scale& scale = scales_[s];
    const int samples = blocks_[s];
    const Sums& part = scales_[s - 1].last;
    append(scale.filling, part, static_cast<double>(scale.filling.count) / samples,
           static_cast<double>(part.count) / samples);
    if (scale.filling.count < samples) return;
    close(scale, scale.filling);
    scale.filling = Sums{};
  }
  if (scales_[kMotionScales - 1].before.count > 0) ended_ |= 1U << (kMotionScales - 1);
}

MotionMeans MotionWindow::means(int scale) const noexcept {
  MotionMeans out;
  const Scale& pair = scales_[static_cast<std::size_t>(scale)];
  if (pair.before.count == 0) return out;
  const Sums &a = pair.before, &b = pair.last;
  const double inverse = 1.0 / b.count;
  const auto triangle = [&](const auto& x, const auto& y) { return (x[1] + y[0] - y[1]) * inverse; };
  out.samples = b.count;
  out.span_s = span_s(pair);
  out.time_s = origin_s_ + 0.5 * inverse * (a.time_s + b.time_s);
  out.usable = a.usable & b.usable;
  out.at_least = a.at_least & b.at_least;
  out.at_most = a.at_most & b.at_most;
  for (std::size_t i = 0; i < static_cast<std::size_t>(sensors_); ++i) {
    out.reading_mps2[i] = triangle(a.reading[i], b.reading[i]);
    out.square_m2ps4[i] = triangle(a.square[i], b.square[i]);
    out.bend_mps2[i] = a.bend[i] > b.bend[i] ? a.bend[i] : b.bend[i];
    if (interpolated_) out.interpolation_mps2[i] = std::fmax(a.interpolation[i], b.interpolation[i]);
    out.slope_mps3[i] = (b.reading[i][0] - a.reading[i][0]) * inverse / out.span_s;
  }
  for (std::size_t g = 0; g < static_cast<std::size_t>(gyros_); ++g) {
    GyroMeans& gyro = out.gyro[g];
    gyro.given = a.given[g] && b.given[g];
    gyro.acceleration_radps2 = acceleration(pair, g);
    // Where no pair came before: as much as from the same to the other side.
    gyro.acceleration_change_radps2 = pair.acceleration_known
                                          ? minus(gyro.acceleration_radps2, pair.acceleration_before[g])
                                          : scaled(gyro.acceleration_radps2, 2.0);
    const RateEdges &before = a.edges[g], &after = b.edges[g];
    const auto change = [](const Vec3& end, const Vec3& middle, const Vec3& begin) {
      return plus(minus(end, scaled(middle, 2.0)), begin);
    };
    gyro.edge_change_radps = change(after.end, after.begin, before.begin);
    gyro.step_change_radps = change(after.end_step, after.begin_step, before.begin_step);
    gyro.begun = before.first;
    if (interpolated_) gyro.interpolation_radps = std::fmax(a.rate_interpolation[g], b.rate_interpolation[g]);
    gyro.step_radps = before.step > after.step ? before.step : after.step;
    gyro.bend_radps = before.bend > after.bend ? before.bend : after.bend;
    for (std::size_t c = 0; c < 6; ++c) {
      gyro.product_change[c] = (b.product[g][0][c] - a.product[g][0][c]) * inverse;
      gyro.rate_product[c] = (a.product[g][1][c] + b.product[g][0][c] - b.product[g][1][c]) * inverse;
    }
  }
  return out;
}

}  // namespace PLUMB_ABI
}  // namespace plumb
