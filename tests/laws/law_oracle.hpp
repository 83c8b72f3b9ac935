/// What a case ought to show, worked out from noise-free readings by Cramer's rule and without any code that the
/// monitor decides with. It errs on the side of "cannot be told".
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "laws/law_case.hpp"

namespace plumb_test {
inline namespace PLUMB_ABI {

/// A wrong hypothesis must be so many sigmas beyond its limit.
inline constexpr double kFarSigmas = 8.0;

class LawOracle {
 public:
  LawOracle(const TrialTool& tool, const plumb::Vec3& direction) : tool_(&tool) {
    // k_c sqrt(trace C) bounds every systematic part that calibration leaves at this attitude.
    const int n = tool.array.size();
    const plumb::Vec3 g = plumb::scaled(direction, plumb::kG0_mps2);
    double trace = 0.0;
    for (int i = 0; i < n; ++i) trace += tool.array.uncertainty().at(i, i, g);
    calibration_mps2_ = 1.6 * std::sqrt(4.0 * n * trace);  // 1.6: the 0.99 quantile of chi-square, from above
  }

  /// The set cannot be healthy: parity and norm together are far beyond any limit that bounds put on them.
  bool refutes(plumb::SensorSet set, const plumb::Readings& y) const { return beyond(set, y, false); }
  /// The same by parity alone.
  bool parity_refutes(plumb::SensorSet set, const plumb::Readings& y) const { return beyond(set, y, true); }

  /// Every set of `size` of n sensors that holds one of `faulty`.
  static std::vector<plumb::SensorSet> wrong_sets(int n, int size, plumb::SensorSet faulty) {
    std::vector<plumb::SensorSet> out;
    for (std::uint32_t bits = 0; bits < (1U << static_cast<unsigned>(n)); ++bits) {
      plumb::SensorSet set;
      set.bits = bits;
      if (set.size() == size && !(set & faulty).empty()) out.push_back(set);
    }
    return out;
  }

  /// Parity refutes every set of `size` that holds a faulty sensor, and thereby all larger ones.
  bool parity_tells(plumb::SensorSet faulty, int size, const plumb::Readings& y) const {
    const auto wrong = wrong_sets(tool_->array.size(), size, faulty);
    return std::all_of(wrong.begin(), wrong.end(), [&](plumb::SensorSet s) { return parity_refutes(s, y); });
  }

 private:
  bool beyond(plumb::SensorSet set, const plumb::Readings& y, bool parity_only) const {
    const int n = tool_->array.size();
    plumb::Vec3 r0{}, r1{}, r2{}, right{};
    double sigma = 0.0;
    for (int i = 0; i < n; ++i) {
      if (!set.has(i)) continue;
      const plumb::Vec3& h = tool_->array.axis(i);
      r0 = plumb::plus(r0, plumb::scaled(h, h[0]));
      r1 = plumb::plus(r1, plumb::scaled(h, h[1]));
      r2 = plumb::plus(r2, plumb::scaled(h, h[2]));
      right = plumb::plus(right, plumb::scaled(h, y[slot(i)]));
      sigma = tool_->array.sigma_mps2(i) / std::sqrt(kTrialSamples);
    }
    const double det = plumb::dot(r0, plumb::cross(r1, r2));
    if (det < 1e-4) return false;
    const plumb::Vec3 c0 = plumb::scaled(plumb::cross(r1, r2), 1.0 / det);
    const plumb::Vec3 c1 = plumb::scaled(plumb::cross(r2, r0), 1.0 / det);
    const plumb::Vec3 c2 = plumb::scaled(plumb::cross(r0, r1), 1.0 / det);
    const plumb::Vec3 x = {plumb::dot(c0, right), plumb::dot(c1, right), plumb::dot(c2, right)};
    double square = 0.0;
    for (int i = 0; i < n; ++i) {
      if (!set.has(i)) continue;
      const double r = y[slot(i)] - plumb::dot(tool_->array.axis(i), x);
      square += r * r;
    }
    const double parity = std::sqrt(square) / sigma;
    const double limit = 6.5 + kFarSigmas;  // 6.4 is the largest quantile that a set of eight meets
    const double calibration = calibration_mps2_ / sigma;
    if (parity_only) return parity > limit + calibration;
    const double length = plumb::norm(x);
    if (length < 0.05 * plumb::kG0_mps2) return false;  // no direction to speak of: the linear figures mean nothing
    const plumb::Vec3 u = plumb::scaled(x, 1.0 / length);
    const plumb::Vec3 cu = {plumb::dot(c0, u), plumb::dot(c1, u), plumb::dot(c2, u)};
    const double gain = std::sqrt(plumb::dot(u, cu));  // of one reading's error into the length
    const double off = std::abs(length - plumb::kG0_mps2) / (sigma * gain);
    const double reference = 3.0 * tool_->gravity.sigma_mps2 / (sigma * gain);
    return std::sqrt(parity * parity + off * off) > limit + calibration + reference;
  }

  const TrialTool* tool_;
  double calibration_mps2_ = 0.0;
};

}  // namespace PLUMB_ABI
}  // namespace plumb_test
