#include "plumb/health/calibration_check.hpp"

#include <cmath>

#include "plumb/core/angles.hpp"
#include "plumb/detection/isolation.hpp"
#include "plumb/health/reference_study.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

namespace {

using std::size_t;

/// Mean square, in units of what noise and covariance allow, up to which a set is consistent. Noise alone gives 1, and
/// errors that the covariance admits leave one tool in a hundred beyond 6.6 however few of them there are; a standard
/// deviation stated a tenth of what it is gives 30 to 100.
constexpr double kConsistent = 6.0;
/// Who speaks against others has to agree better: one set in many does so by chance.
constexpr double kVouching = 4.0;
/// More faults than this at once are rarer than a wrong covariance: they have to explain what is on record all the
/// better.
constexpr double kVouchingFew = 2.5;
/// Arrays of up to so many sensors are searched for every fault set of their grade.
constexpr int kSearched = 8;
/// Degrees of freedom below which chance decides.
constexpr int kLeastDegrees = 6;
/// Attitudes below which nobody is convicted, however many degrees of freedom they have: of many sensors there are many
/// sets that might be innocent by chance.
constexpr int kLeastVouching = 4;
/// What is learned explains its own attitudes to the noise, and leaves as much again for others.
constexpr double kExplained = 1.5;
constexpr double kLearnedFactor = 2.0;
constexpr double kFinestTolerance_mps2 = 6.25e-5 * kG0_mps2;
constexpr int kMostDoublings = 8;

constexpr size_t at(int i) noexcept { return static_cast<size_t>(i); }

double square(double x) noexcept { return x * x; }
double beyond(double x, double bound) noexcept { return std::fmax(0.0, x - bound); }

}  // namespace

bool CalibrationCheck::Fit::within(double mean_square) const noexcept { return sum <= mean_square * degrees; }

bool CalibrationCheck::add(const Vec3& direction, const BlockEvidence& block, double apart_rad) noexcept {
  const double length = norm(direction);
  if (size_ == kMost || !(length > 0.0) || !(block.samples > 0.0)) return false;
  for (int k = 0; k < size_; ++k) {
    const auto& u = entry_[at(k)].u;
    const Vec3 before = {static_cast<double>(u[0]), static_cast<double>(u[1]), static_cast<double>(u[2])};
    if (!(angle_between_rad(before, direction) >= apart_rad)) return false;
  }
  Entry& e = entry_[at(size_)];
  e = Entry{};
  for (size_t i = 0; i < 3; ++i) e.u[i] = static_cast<float>(direction[i] / length);
  for (int i = 0; i < kCapacity; ++i) {
    if (block.usable.has(i)) e.mean_mps2[at(i)] = static_cast<float>(block.mean_mps2[at(i)]);
  }
  for (const float tolerance : block.tolerance_mps2) e.tolerance_mps2 = std::fmax(e.tolerance_mps2, tolerance);
  e.samples = static_cast<float>(block.samples);
  e.moved_mps2 = static_cast<float>(block.spread_mps2_sq / (2.0 * kG0_mps2));
  e.usable = block.usable;
  ++size_;
  return true;
}

/// Residuals of the set over the attitudes on record. Hard bounds - stability, tolerance, motion, acceleration - are
/// taken off each residual; one length that is off alike at all attitudes is gravity's matter and taken off, too.
CalibrationCheck::Fit CalibrationCheck::fit(const Terms& terms, SensorSet set, double tolerance_mps2) const noexcept {
  Fit out;
  GravityReference gravity = terms.gravity;
  gravity.sigma_mps2 = 0.0;
  TestLimits limits = terms.limits;
  limits.acceleration_mps2 = 0.0;
  std::array<double, kMost> off{}, sigma{}, hard{};
  double weights = 0.0, mean = 0.0;
  int lengths = 0;
  for (int k = 0; k < size_; ++k) {
    const Entry& e = entry_[at(k)];
    if (!e.usable.contains(set)) continue;
    BlockEvidence block;
    block.usable = e.usable;
    block.samples = static_cast<double>(e.samples);
    for (int i = 0; i < kCapacity; ++i) block.mean_mps2[at(i)] = static_cast<double>(e.mean_mps2[at(i)]);
    const SetTest t = test_set(terms.array, gravity, limits, block, set);
    if (!t.tested) continue;
    block.tolerance_mps2.fill(e.tolerance_mps2 + static_cast<float>(tolerance_mps2));
    const ToleranceBound bound = tolerance_bound(terms.array, block, set, t);
    const double parity_variance = 1.0 + square(t.parity_systematic / limits.calibration);
    out.sum += square(beyond(t.parity, bound.parity)) / parity_variance;
    out.degrees += t.parity_rows;
    const size_t n = at(lengths++);
    const double norm_variance = 1.0 + square(t.norm_systematic / limits.calibration);
    off[n] = t.norm_error_mps2;
    sigma[n] = t.norm_sigma_mps2 * std::sqrt(norm_variance / block.samples);
    hard[n] = bound.norm_mps2 + static_cast<double>(e.moved_mps2) + terms.limits.acceleration_mps2;
    const double weight = 1.0 / square(sigma[n]);
    weights += weight;
    mean += weight * off[n];
  }
  if (lengths == 0) return out;
  const double most_mps2 = kMostGravityOffset_mps2 + TestLimits::gravity * terms.gravity.sigma_mps2;
  mean = std::fmax(-most_mps2, std::fmin(most_mps2, mean / weights));
  for (size_t n = 0; n < at(lengths); ++n) out.sum += square(beyond(std::fabs(off[n] - mean), hard[n]) / sigma[n]);
  out.degrees += lengths - 1;
  out.attitudes = lengths;
  return out;
}

bool CalibrationCheck::vouches(const Terms& terms, SensorSet set) const noexcept {
  const Fit found = fit(terms, set, 0.0);
  return found.attitudes >= kLeastVouching && found.degrees >= kLeastDegrees && found.within(kVouching);
}

void CalibrationCheck::corroborate(const Terms& terms, SensorSet posed) noexcept {
  const Fit found = fit(terms, posed, 0.0);
  corroborated_ = found.degrees >= kLeastDegrees && found.within(kConsistent);
}

double CalibrationCheck::least_tolerance_mps2(const Terms& terms, SensorSet posed) const noexcept {
  double tau = kFinestTolerance_mps2;
  for (int doubled = 0; doubled < kMostDoublings && kLearnedFactor * tau <= kMostLearnedTolerance_mps2; ++doubled) {
    const Fit found = fit(terms, posed, tau);
    if (found.within(kExplained)) return tau;
    tau *= 2.0;
  }
  return 0.0;
}

bool CalibrationCheck::contradict(const Terms& terms, SensorSet posed, int grade) noexcept {
  if (size_ < kLeast || refused()) return false;
  const Fit all = fit(terms, posed, 0.0);
  if (all.within(kConsistent)) return false;
  // Contradicted once, it is likelier to be so again than for a sensor to have failed meanwhile.
  const int most = finding_.contradicted ? 0 : grade;
  const bool all_sizes = most < kScanDepth || terms.array.size() <= kSearched;
  const int depth = all_sizes ? most : kScanDepth;
  const SensorSet every = terms.array.all();
  for (int size = 1; size <= depth; ++size) {
    for (SensorSet f = SensorSet::first(size); every.contains(f); f = next_of_same_size(f)) {
      if (!posed.contains(f)) continue;
      const Fit rest = fit(terms, posed - f, 0.0);
      // Too few attitudes at which the rest delivered refute nothing.
      if (rest.degrees < kLeastDegrees || rest.within(size > kScanDepth ? kVouchingFew : kVouching)) return false;
    }
  }
  finding_.contradicted = true;
  finding_.attitudes = size_;
  finding_.ratio = std::sqrt(all.sum / all.degrees);
  const double learned_mps2 = kLearnedFactor * least_tolerance_mps2(terms, posed);
  finding_.tolerance_mps2 += learned_mps2;
  finding_.refused = !(learned_mps2 > 0.0) || finding_.tolerance_mps2 > kMostLearnedTolerance_mps2;
  if (finding_.refused) finding_.tolerance_mps2 = 0.0;
  size_ = 0;
  return true;
}

}  // namespace PLUMB_ABI
}  // namespace plumb
