#include "plumb/study/proportion.hpp"

#include <algorithm>
#include <array>
#include <boost/math/distributions/binomial.hpp>
#include <cmath>
#include <cstdio>
#include <cstdlib>

namespace plumb {
inline namespace PLUMB_ABI {
namespace study {
namespace {

constexpr int kMostDigits = 15;
/// From here on what is missing to the whole is counted by digits, not what is there.
constexpr double kNearWhole = 0.99;

/// Without zeros at the end of what stands behind the point.
std::string printed(const char* form, int digits, double value) {
  std::array<char, 64> text{};
  std::snprintf(text.data(), text.size(), form, digits, value);
  std::string out = text.data();
  if (out.find('.') == std::string::npos || out.find('e') != std::string::npos) return out;
  while (out.back() == '0') out.pop_back();
  if (out.back() == '.') out.pop_back();
  return out;
}

double value_of(const std::string& text) { return std::strtod(text.c_str(), nullptr); }

/// Size of the last of so many digits.
double last_place(double value, int digits) {
  return std::pow(10.0, std::floor(std::log10(std::fabs(value))) - (digits - 1));
}

/// `value` in `form`, moved by whole last places towards `direction` until it is not on the other side of it.
std::string outwards(const char* form, int digits, double value, double step, double direction) {
  std::string out = printed(form, digits, value);
  for (int k = 1; k <= 4 && direction * (value_of(out) - value) < 0.0; ++k)
    out = printed(form, digits, value + direction * step * k);
  return out;
}

std::string rounded(double value, int digits, double whole, double direction) {
  if (!std::isfinite(value) || value == 0.0 || value == whole) return printed("%.*g", digits, value);
  if (value > kNearWhole * whole && value < whole) {
    const double step = last_place(whole - value, digits);
    const int decimals = std::clamp(static_cast<int>(std::lround(-std::log10(step))), 0, kMostDigits);
    std::string out = outwards("%.*f", decimals, value, step, direction);
    // Where the whole itself lies within half a place the next digit is needed.
    for (int more = decimals + 1; direction > 0.0 && value_of(out) >= whole && more <= kMostDigits; ++more)
      out = outwards("%.*f", more, value, std::pow(10.0, -more), direction);
    return out;
  }
  return outwards("%.*g", digits, value, last_place(value, digits), direction);
}

}  // namespace

std::string rounded_down(double value, int digits, double whole) { return rounded(value, digits, whole, -1.0); }

std::string rounded_up(double value, int digits, double whole) { return rounded(value, digits, whole, 1.0); }

std::string rounded_share(const Proportion& p, int digits, double whole) {
  const double value = whole * p.share();
  const std::string out = printed("%.*g", digits, value);
  const bool falls_on_whole = value < whole && value_of(out) >= whole;
  return falls_on_whole ? rounded_down(value, digits, whole) : out;
}

std::string interval_text(const Proportion& p, int digits, double whole) {
  return "[" + rounded_down(whole * p.low, digits, whole) + ", " + rounded_up(whole * p.high, digits, whole) + "]";
}

std::string interval_words(const Proportion& p, int digits, double whole) {
  const std::string low = rounded_down(whole * p.low, digits, whole), high = rounded_up(whole * p.high, digits, whole);
  const char* const unit = whole == 100.0 ? " %" : "";
  if (p.trials == 0) return "no trials";
  if (p.count == 0) return "at most " + high + unit + " with 97.5 % confidence";
  if (p.count == p.trials) return "at least " + low + unit + " with 97.5 % confidence";
  return "95 % interval " + low + " to " + high + unit;
}

Proportion proportion(std::uint64_t count, std::uint64_t trials, double confidence) {
  Proportion out;
  out.count = std::min(count, trials);
  out.trials = trials;
  if (trials == 0) return out;
  const double inside = confidence > 0.0 && confidence < 1.0 ? confidence : 0.95;
  const double tail = 0.5 * (1.0 - inside);
  const auto n = static_cast<double>(trials);
  const auto k = static_cast<double>(out.count);
  using Binomial = boost::math::binomial_distribution<>;
  if (out.count > 0) out.low = Binomial::find_lower_bound_on_p(n, k, tail);
  if (out.count < trials) out.high = Binomial::find_upper_bound_on_p(n, k, tail);
  return out;
}

}  // namespace study
}  // namespace PLUMB_ABI
}  // namespace plumb
