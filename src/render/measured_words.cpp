#include "plumb/render/measured_words.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "plumb/render/figures.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace render {
namespace {

constexpr int kUsualDecimals = 3;
/// A direction of doubles holds no more.
constexpr int kMostDecimals = 9;

bool is_known(double sigma_deg) { return std::isfinite(sigma_deg) && sigma_deg > 0.0; }

/// Of two significant digits of the standard deviation; 0.0996 is 0.10.
int decimals_of(double sigma_deg) {
  if (!is_known(sigma_deg)) return kUsualDecimals;
  const std::string two_digits = fmt::format("{:.1e}", sigma_deg);
  const int exponent = std::stoi(two_digits.substr(two_digits.find('e') + 1));
  return std::clamp(1 - exponent, 0, kMostDecimals);
}

}  // namespace

std::string fixed_words(double value, int decimals) { return unsigned_zero(fmt::format("{:.{}f}", value, decimals)); }

std::string depth_words(double depth_m) { return std::isfinite(depth_m) ? fixed_words(depth_m, 2) : "-"; }

std::string angle_words(double angle_deg, double sigma_deg) {
  return std::isfinite(angle_deg) ? fixed_words(angle_deg, decimals_of(sigma_deg)) : "-";
}

std::string angle_with_sigma(double angle_deg, double sigma_deg) {
  if (!std::isfinite(angle_deg)) return "-";
  const std::string angle = angle_words(angle_deg, sigma_deg);
  return is_known(sigma_deg) ? angle + fmt::format(" ± {:.{}f}", sigma_deg, decimals_of(sigma_deg)) : angle;
}

}  // namespace render
}  // namespace PLUMB_ABI
}  // namespace plumb
