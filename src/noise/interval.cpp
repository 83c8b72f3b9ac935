#include "interval.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include "plumb/numeric/tails.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace noise {
namespace {

/// Deviance above its least at the ends of a 95 % interval. Chi-square of one degree of freedom has 3.84 (Wilks). Slow
/// terms show in few components (Bartlett's correction), and a term that may be 0 is at the end of what it can be
/// (mixtures of chi-squares: Self and Liang, 1987): with 4.0 intervals hold 93 to 97 % in all cases of docs/noise.md.
constexpr double kRise = 4.0;
/// Ends are found within this part of the interval's half, or of the rise.
constexpr double kWithin = 1e-3;
constexpr int kMostDoublings = 60, kMostSections = 40;

/// Where `rise`, which is below kRise at `inside` and above at `outside`, is kRise: the false position, with the weight
/// of an end that stays twice halved (Illinois).
double crossing(const std::function<double(double)>& rise, double inside, double at_inside, double outside,
                double at_outside) {
  double low = at_inside - kRise, high = at_outside - kRise, x = inside;
  int stayed = 0;  // > 0: so many times outside, < 0: inside
  for (int k = 0; k < kMostSections; ++k) {
    x = std::isfinite(high) ? inside - low * (outside - inside) / (high - low) : 0.5 * (inside + outside);
    const double y = rise(x) - kRise;
    if (std::fabs(y) < kWithin * kRise || std::fabs(outside - inside) < kWithin * kWithin * std::fabs(outside)) break;
    if (y > 0.0) {
      outside = x;
      high = y;
      stayed = stayed < 0 ? stayed - 1 : -1;
      if (stayed < -1) low *= 0.5;
    } else {
      inside = x;
      low = y;
      stayed = stayed > 0 ? stayed + 1 : 1;
      if (stayed > 1) high *= 0.5;
    }
  }
  return x;
}

/// From `from`, where the rise is 0, in steps that double until the rise is beyond kRise.
double far_end(const std::function<double(double)>& rise, double from, double step) {
  double inside = from, at_inside = 0.0;
  for (int k = 0; k < kMostDoublings; ++k) {
    const double outside = from + step, at_outside = rise(outside);
    if (at_outside > kRise) return crossing(rise, inside, at_inside, outside, at_outside);
    inside = outside;
    at_inside = at_outside;
    step *= 2.0;
  }
  return inside;
}

/// A normal law with the weight that it has among others.
struct Weighed {
  double weight = 0.0;
  double mean = 0.0;
  double sigma = 0.0;
};

/// Sizes of the walk on the grid, and how far that goes beyond the most likely one, in halves of the 95 % interval.
constexpr int kGrid = 24;
constexpr double kGridReach = 1.8;

/// What is below x, of all weight.
double share_below(const std::vector<Weighed>& laws, double x) {
  double below = 0.0, all = 0.0;
  for (const Weighed& law : laws) {
    below += law.weight * (1.0 - normal_tail((x - law.mean) / law.sigma));
    all += law.weight;
  }
  return below / all;
}

double quantile(const std::vector<Weighed>& laws, double share) {
  constexpr double kFar = 8.0;  // sigmas: beyond any quantile asked for
  double low = laws.front().mean, high = low;
  for (const Weighed& law : laws) {
    low = std::min(low, law.mean - kFar * law.sigma);
    high = std::max(high, law.mean + kFar * law.sigma);
  }
  for (int k = 0; k < kMostSections; ++k) {
    const double middle = 0.5 * (low + high);
    (share_below(laws, middle) < share ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

}  // namespace

SquareIntervals square_intervals(const Likelihood& likelihood, const Maximum& best) {
  const Variances variances = precision(likelihood.bins(), best.squares).of_squares;
  SquareIntervals out{};
  for (std::size_t t = 0; t < kNoiseTerms; ++t) {
    Maximum last = best;
    const auto rise = [&](double square) {
      Held held;
      held.term = t;
      held.square = square;
      last = likelihood.maximum(held, &last);
      return last.deviance - best.deviance;
    };
    const double square = best.squares[t];
    out[t].high = far_end(rise, square, 2.0 * std::max(std::sqrt(variances[t]), 1e-9 * square));
    if (!(square > 0.0)) continue;
    last = best;
    const double at_zero = rise(0.0);
    last = best;
    if (at_zero > kRise) out[t].low = crossing(rise, square, 0.0, 0.0, at_zero);
  }
  return out;
}

Interval slope_interval(const Likelihood& likelihood, const Maximum& best, const Interval& walk_squares) {
  // What the log says of the walk decides how sure the slope is: normal laws, one for each size of the walk, weighed by
  // its likelihood, which is 0 where the grid ends.
  const std::size_t walk = index(Term::random_walk);
  const double size = std::sqrt(best.squares[walk]), low = std::sqrt(walk_squares.low),
               high = std::sqrt(walk_squares.high);
  const double from = std::max(0.0, size - kGridReach * (size - low)), to = size + kGridReach * (high - size);
  std::vector<Weighed> laws;
  Maximum last = best;
  for (int k = 0; k < kGrid; ++k) {
    Held held;
    held.term = walk;
    held.square = std::pow(from + (to - from) * (k + 0.5) / kGrid, 2);
    last = likelihood.maximum(held, &last);
    laws.push_back({std::exp(-0.5 * (last.deviance - best.deviance)), last.slope, std::sqrt(last.slope_variance)});
  }
  return {quantile(laws, 0.025), quantile(laws, 0.975)};
}

}  // namespace noise
}  // namespace PLUMB_ABI
}  // namespace plumb
