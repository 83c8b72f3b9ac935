#include "adversary.hpp"

#include <cmath>
#include <type_traits>

#include "plays.hpp"

namespace plumb_bench {
inline namespace PLUMB_ABI {

using namespace plumb;
using namespace plumb_test;

static_assert(std::is_trivially_copyable_v<HealthMonitor>, "the adversary copies it");

Adversary::Adversary(Player& player, Aim aim, std::uint64_t stream) : player_(player), aim_(aim), noise_(stream) {}

Sample Adversary::told(const Sample& honest, const Lie& lie, int k) const {
  Sample out = honest;
  for (int i = 0; k >= lie.from && i < player_.n(); ++i) {
    if (player_.faulty.has(i)) out.raw[slot(i)] += lie.add_mps2[slot(i)];
  }
  return out;
}

Adversary::Lie Adversary::bias_of_one() {
  Lie out = last_;
  out.from = 0;
  int i = noise_.below(player_.n());
  while (!player_.faulty.has(i)) i = (i + 1) % player_.n();
  out.add_mps2[slot(i)] = noise_.sign() * noise_.log_between(0.02 * kMilligee_mps2, 2.0 * kG0_mps2);
  return out;
}

Adversary::Lie Adversary::common_vector(const Vec3& difference_mps2) const {
  Lie out;
  for (int i = 0; i < player_.n(); ++i) {
    out.add_mps2[slot(i)] = dot(player_.tool().law.tool.row[slot(i)], difference_mps2);
  }
  return out;
}

/// Gravity mirrored in the plane of two honest axes, less gravity.
Vec3 Adversary::mirror_image() {
  const int n = player_.n();
  int j = noise_.below(n), k = noise_.below(n);
  while (player_.faulty.has(j)) j = (j + 1) % n;
  while (player_.faulty.has(k) || k == j) k = (k + 1) % n;
  const auto& row = player_.tool().law.tool.row;
  const Vec3 across = cross(row[slot(j)], row[slot(k)]);
  const double square = dot(across, across);
  if (square < 1e-6) return {};
  return scaled(across, -2.0 * player_.g_mps2 * dot(player_.direction, across) / square);
}

Adversary::Lie Adversary::candidate(int number) {
  const Vec3 g = scaled(player_.direction, player_.g_mps2);
  switch (number) {
    case 0: return {};
    case 1: return last_;
    case 2:
    case 3:
    case 4:
    case 5: return bias_of_one();
    case 6:
    case 7: return common_vector(mirror_image());
    case 8:
    case 9: {
      const Vec3 to = turned(player_.direction, noise_.log_between(1e-4, kPi), noise_);
      return common_vector(minus(scaled(to, player_.g_mps2), g));
    }
    case 10: {
      Lie grown = last_;
      const double factor = noise_.log_between(0.3, 3.0);
      for (double& add : grown.add_mps2) add *= factor;
      return grown;
    }
    default: break;
  }
  Lie late = bias_of_one();
  late.from = noise_.below(player_.window());
  return late;
}

double Adversary::worth_of(const Verdict& v) const {
  const SensorSet liars = player_.faulty;
  const double found = 20.0 * (v.excluded & liars).size() + 5.0 * (v.provisionally_excluded & liars).size();
  switch (aim_) {
    case Aim::error: {
      const bool valid = v.validity == Validity::valid || v.validity == Validity::degraded;
      const double error_rad = angle_between_rad(v.gravity_mps2, player_.tool().seen(player_.direction));
      return (valid ? 1.0 + 100.0 * (error_rad - v.protection_level_calibrated_axes_rad) : 0.0) - found;
    }
    case Aim::accuse:
      return 1000.0 * (v.excluded - liars).size() + 100.0 * (v.provisionally_excluded - liars).size() +
             2.0 * (v.suspects - liars).size() - (v.suspects & liars).size() - found;
    case Aim::fail: break;
  }
  // Attitudes in doubt use up the isolation timeout, and the more sensors are suspected the longer the doubt lasts.
  return (v.state == HealthState::failed ? 1000.0 : 0.0) + 3.0 * v.stations_on_record + 0.5 * v.suspects.size() +
         (v.state == HealthState::suspect ? 1.0 : 0.0) - found;
}

double Adversary::worth(const Lie& lie) {
  *copy_ = player_.monitor();
  for (int k = 0; k < static_cast<int>(honest_.size()); ++k) copy_->step(told(honest_[slot(k)], lie, k));
  return worth_of(copy_->verdict());
}

void Adversary::block() {
  honest_.clear();
  for (int k = 0; k < player_.window(); ++k) honest_.push_back(player_.next());
  Lie best;
  double most = -1e300;
  for (int number = 0; number < kCandidates; ++number) {
    const Lie lie = candidate(number);
    const double gain = worth(lie) + 1e-3 * noise_.uniform();  // among equals, any
    if (gain <= most) continue;
    most = gain;
    best = lie;
  }
  for (int k = 0; k < static_cast<int>(honest_.size()); ++k) player_.offer(told(honest_[slot(k)], best, k));
  last_ = best;
}

}  // namespace PLUMB_ABI
}  // namespace plumb_bench
