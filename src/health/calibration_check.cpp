#include "plumb/health/calibration_check.hpp"

#include <cmath>

#include "plumb/core/angles.hpp"
#include "plumb/core/detail/numbers.hpp"
#include "plumb/detection/estimate_error.hpp"
#include "plumb/detection/isolation.hpp"
#include "plumb/health/reference_study.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

using numbers::at;

namespace {

using std::size_t;

/// Mean square, in units of what noise and covariance allow, up to which a set is consistent. Noise alone gives 1, and
/// errors that the covariance admits leave one tool in a hundred beyond 6.6 however few of them there are; a standard
/// deviation stated a tenth of what it is gives 30 to 100.
constexpr double kConsistent = 6.0;
/// Who speaks against others has to agree better: one set in many does so by chance.
constexpr double kCorroborating = 4.0;
/// More faults than this at once are rarer than a wrong covariance: they have to explain what is on record all the
/// better.
constexpr double kCorroboratingFew = 2.5;
/// Arrays of up to so many units are searched for every fault set of their grade.
constexpr int kSearched = 8;
/// Sets tested at an attitude in one block of the search: less work than a vote of eight sensors.
constexpr int kTestsPerBlock = 150;
/// Degrees of freedom below which chance decides.
constexpr int kLeastDegrees = 6;
/// Attitudes below which none is excluded, however many degrees of freedom they have: of many sensors there are many
/// sets that might be innocent by chance.
constexpr int kLeastCorroborating = 4;
/// What is learned explains its own attitudes to the noise, and leaves as much again for others.
constexpr double kExplained = 1.5;
constexpr double kLearnedFactor = 2.0;
constexpr double kFinestTolerance_mps2 = 6.25e-5 * kG0_mps2;
constexpr int kMostDoublings = 8;

/// Of right calibrations one in a hundred agrees worse, and waits for `CalibrationCheck::kLeast` attitudes before all
/// rests on it: fewer attitudes agree by chance, the better the seldomer. In standard deviations of a normal number.
constexpr double kWellSigmas = 2.326;
/// Of a right calibration one attitude in 1e5 is held back: as seldom as a false alarm by default.
constexpr double kDoubtSigmas = 4.265;

/// Sensors that agree by chance where all are off exclude one in so many: ln(1e-4).
constexpr double kLnMostChance = -9.21;

double square(double x) noexcept { return x * x; }
double beyond(double x, double bound) noexcept { return std::fmax(0.0, x - bound); }

/// chi^2 over its degrees of freedom that is exceeded as often as a normal number exceeds `sigmas` (Wilson and
/// Hilferty: at most 12 % too much).
double mean_square_beyond(double sigmas, double degrees) noexcept {
  const double spread = 2.0 / (9.0 * degrees);
  const double root = 1.0 - spread + sigmas * std::sqrt(spread);
  return root * root * root;
}

/// ln of a bound of the probability that chi^2 over its degrees of freedom is `ratio` at most (first term of the series
/// of the incomplete gamma function, Stirling's lower bound for the gamma function in it).
double ln_chance(double ratio, double degrees) noexcept {
  return 0.5 * degrees * (1.0 + std::log(ratio)) - 0.5 * std::log(kPi * degrees);
}

/// ln of the number of fault sets of `size` among `units`: each may be innocent by chance.
double ln_sets(int units, int size) noexcept {
  double sets = 1.0;
  for (int k = 1; k <= size; ++k) sets *= static_cast<double>(units - size + k) / k;
  return std::log(sets);
}

}  // namespace

bool CalibrationCheck::Fit::within(double mean_square) const noexcept { return sum <= mean_square * degrees; }

bool CalibrationCheck::add(const Vec3& direction, const BlockEvidence& block, double apart_rad) noexcept {
  const double length = norm(direction);
  if (!(length > 0.0) || !(block.samples > 0.0)) return false;
  for (int k = 0; k < size_; ++k) {
    const auto& u = entry_[at(k)].u;
    const Vec3 before = {static_cast<double>(u[0]), static_cast<double>(u[1]), static_cast<double>(u[2])};
    if (!(angle_between_rad(before, direction) >= apart_rad)) return false;
  }
  if (size_ == kMost) {
    for (int k = 1; k < kMost; ++k) entry_[at(k - 1)] = entry_[at(k)];
    --size_;
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
CalibrationCheck::Fit CalibrationCheck::fit(const Terms& terms, SensorSet set, double tolerance_mps2,
                                            double most) const noexcept {
  Fit out;
  int usable = 0;
  for (int k = 0; k < size_; ++k) usable += entry_[at(k)].usable.contains(set) ? 1 : 0;
  const int most_degrees = usable * (set.size() - 2) - 1;
  GravityReference gravity = terms.gravity;
  gravity.sigma_mps2 = 0.0;
  TestLimits limits = terms.limits;
  limits.acceleration_mps2 = 0.0;
  // Neither does the gravity at which it was calibrated differ between attitudes.
  const double common_mps2 = TestLimits::gravity * terms.array.uncertainty().common_scale * gravity.g_mps2;
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
    ++out.tests;
    const SetTest t = test_set(terms.array, gravity, limits, block, set);
    if (!t.tested) continue;
    block.tolerance_mps2.fill(e.tolerance_mps2 + static_cast<float>(tolerance_mps2));
    const ToleranceBound bound = tolerance_bound(terms.array, block, set, t);
    const double growth = noise_growth(largest_misfit(terms.array, terms.array.uncertainty(), set, block.samples));
    const double noise_variance = square(1.0 + growth);
    const double parity_left = t.parity_systematic - limits.reject[at(t.parity_rows)] * growth;
    const double parity_variance = noise_variance + square(parity_left / limits.parity_calibration);
    out.sum += square(beyond(t.parity, bound.parity)) / parity_variance;
    out.degrees += t.parity_rows;
    if (out.sum > most * most_degrees) {
      out.degrees = most_degrees;
      return out;
    }
    const size_t n = at(lengths++);
    const double norm_left =
        t.norm_systematic - limits.reject[1] * growth - std::sqrt(block.samples) * common_mps2 / t.norm_sigma_mps2;
    const double norm_variance = noise_variance + square(norm_left / limits.norm_calibration);
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

bool CalibrationCheck::corroborates(const Terms& terms, SensorSet monitored, SensorSet isolated) const noexcept {
  const SensorSet set = monitored - isolated;
  const Fit rest = fit(terms, set, 0.0);
  // A calibration that has been corroborated is believed until there is enough on record to say otherwise.
  if (rest.degrees < kLeastDegrees) return corroborated_;
  if ((!corroborated_ && rest.attitudes < kLeastCorroborating) || !rest.within(kCorroborating)) return false;
  // Were all sensors off by what they are together, and the rest of them by chance no more than this?
  const Fit all = fit(terms, monitored, 0.0);
  const double ratio = std::fmax(rest.sum / rest.degrees, 1.0) / std::fmax(all.sum / all.degrees, 1.0);
  const SensorUnits& units = terms.array.units();
  return ln_chance(ratio, independent(rest, set)) + ln_sets(units.count(monitored), units.count(isolated)) <=
         kLnMostChance;
}

/// An error of bias and axis, alike in size, makes at two attitudes u and v errors of a sensor correlated by
/// (1 + u.v) / 2, and of the length by (1 + u.v) u.v / 2. K attitudes so correlated are worth tr(G)^2 / tr(G^2)
/// independent ones (Satterthwaite). One length is taken off.
double CalibrationCheck::independent(const Fit& found, SensorSet set) const noexcept {
  double parity = 0.0, length = 0.0;
  int count = 0;
  for (int j = 0; j < size_; ++j) {
    if (!entry_[at(j)].usable.contains(set)) continue;
    ++count;
    for (int k = 0; k < size_; ++k) {
      if (!entry_[at(k)].usable.contains(set)) continue;
      const auto &u = entry_[at(j)].u, &v = entry_[at(k)].u;
      const auto cosine = static_cast<double>(u[0] * v[0] + u[1] * v[1] + u[2] * v[2]);
      parity += square(0.5 * (1.0 + cosine));
      length += square(0.5 * (1.0 + cosine) * cosine);
    }
  }
  if (count == 0) return 1.0;
  const double rows = std::fmax(0.0, static_cast<double>(found.degrees + 1 - count) / count);
  const double attitudes = square(count);
  return std::fmax(1.0, rows * attitudes / parity + attitudes / length - 1.0);
}

void CalibrationCheck::weigh(const Terms& terms, SensorSet monitored, SensorSet in_service, bool episode) noexcept {
  const Fit all = fit(terms, monitored, 0.0);
  if (!episode && all.degrees >= kLeastDegrees && all.within(kConsistent)) {
    corroborated_ = Flag(true);
    const bool well = all.within(mean_square_beyond(kWellSigmas, independent(all, monitored)));
    closed_ = Flag(well || all.attitudes >= kLeast);
  }
  forget_doubt();
  if (!corroborated_) {
    const Fit serving = in_service == monitored ? all : fit(terms, in_service, 0.0);
    const double most = mean_square_beyond(kDoubtSigmas, independent(serving, in_service));
    doubted_ = Flag(serving.degrees > 0 && !serving.within(most));
  }
  if (!open() || size_ < kLeast || all.within(kConsistent)) return;
  next_ = SensorSet::first(1);
  searched_ = monitored;
}

double CalibrationCheck::least_tolerance_mps2(const Terms& terms, SensorSet monitored) const noexcept {
  double tau = kFinestTolerance_mps2;
  for (int doubled = 0; doubled < kMostDoublings && kLearnedFactor * tau <= kMostLearnedTolerance_mps2; ++doubled) {
    const Fit found = fit(terms, monitored, tau);
    if (found.within(kExplained)) return tau;
    tau *= 2.0;
  }
  return 0.0;
}

bool CalibrationCheck::explained_without(const Terms& terms, SensorSet monitored, SensorSet faulty,
                                         int& tests) const noexcept {
  const double most = terms.array.units().count(faulty) > kScanDepth ? kCorroboratingFew : kCorroborating;
  const Fit rest = fit(terms, monitored - faulty, 0.0, most);
  tests += rest.tests;
  // Too few attitudes at which the rest delivered refute nothing.
  return rest.degrees < kLeastDegrees || rest.within(most);
}

bool CalibrationCheck::search(const Terms& terms, SensorSet monitored, int grade) noexcept {
  // Of others than those among whom it began it tells nothing: the next attitude begins anew.
  const SensorSet first = searched_ == monitored ? next_ : SensorSet{};
  next_ = SensorSet{};
  if (first.empty() || refused()) return false;
  // Contradicted once, it is likelier to be so again than for a sensor to have failed meanwhile. And on a full record
  // four faults at once are no explanation any more.
  const int most = finding_.contradicted ? 0 : grade;
  const SensorUnits& units = terms.array.units();
  const bool all_sizes = most < kScanDepth || (units.size() <= kSearched && size_ < kMost);
  const int depth = all_sizes ? most : kScanDepth;
  const SensorSet every = units.all(), asked = units.units_of(monitored);
  SensorSet f = first;
  int tests = 0;
  for (int size = first.size(); size <= depth; f = SensorSet::first(++size)) {
    for (; every.contains(f); f = next_of_same_size(f)) {
      if (!asked.contains(f)) continue;
      if (tests >= kTestsPerBlock) {
        next_ = f;
        return false;
      }
      if (explained_without(terms, monitored, units.sensors_of(f), tests)) return false;
    }
  }
  contradict(terms, monitored);
  return true;
}

void CalibrationCheck::contradict(const Terms& terms, SensorSet monitored) noexcept {
  const Fit all = fit(terms, monitored, 0.0);
  finding_.contradicted = true;
  finding_.attitudes = size_;
  finding_.ratio = std::sqrt(all.sum / all.degrees);
  const double learned_mps2 = kLearnedFactor * least_tolerance_mps2(terms, monitored);
  finding_.tolerance_mps2 += learned_mps2;
  finding_.refused = !(learned_mps2 > 0.0) || finding_.tolerance_mps2 > kMostLearnedTolerance_mps2;
  if (finding_.refused) finding_.tolerance_mps2 = 0.0;
  corroborated_ = Flag();
  forget_readings();
  forget_doubt();
}

}  // namespace PLUMB_ABI
}  // namespace plumb
