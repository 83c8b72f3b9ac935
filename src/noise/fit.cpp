#include "plumb/noise/fit.hpp"

#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <cmath>

#include "interval.hpp"
#include "likelihood.hpp"
#include "more_hours.hpp"
#include "power_bins.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace noise {
namespace {

/// An octave contradicts the terms where its power is off by a tenth, and by what chance does once in a million.
constexpr double kOff = 0.1, kChance = 1e-6;
/// The highest frequency of a fit is brought down in these steps, to a 64th of half the sampling rate at the most.
constexpr double kStepDown = 0.70710678118654752;
constexpr int kMostStepsDown = 12;

struct Misfit {
  double ratio = 1.0;
  double frequency_hz = 0.0;
};

/// Chance that chi-square of `freedom` degrees is as far from them as `sum`, on either side.
double chance_of(double sum, double freedom) {
  const boost::math::chi_squared law(freedom);
  return 2.0 * std::min(boost::math::cdf(law, sum), boost::math::cdf(boost::math::complement(law, sum)));
}

Misfit misfit_of(const std::vector<PowerBin>& bins, const Maximum& fit) {
  Misfit worst;
  double sum = 0.0, count = 0.0, first_hz = 0.0;
  const auto judge = [&](double last_hz) {
    if (!(count > 0.0)) return;
    const double ratio = sum / count;
    if (std::fabs(ratio - 1.0) > kOff && chance_of(sum, count) < kChance &&
        std::fabs(std::log(ratio)) > std::fabs(std::log(worst.ratio)))
      worst = {ratio, std::sqrt(first_hz * last_hz)};
    sum = count = 0.0;
  };
  std::vector<const PowerBin*> in_order;
  in_order.reserve(bins.size());
  for (const PowerBin& bin : bins) in_order.push_back(&bin);
  std::sort(in_order.begin(), in_order.end(),
            [](const PowerBin* a, const PowerBin* b) { return a->frequency_hz < b->frequency_hz; });
  double last_hz = 0.0;
  for (const PowerBin* bin : in_order) {
    if (bin->frequency_hz > 2.0 * first_hz) {
      judge(last_hz);
      first_hz = bin->frequency_hz;
    }
    double power = 0.0;
    for (std::size_t t = 0; t < kNoiseTerms; ++t) power += fit.squares[t] * bin->unit_power[t];
    const double line = fit.slope * bin->component_of_line;
    sum += (bin->power_sum + line * (line - 2.0 * bin->component)) / power;
    count += bin->count;
    last_hz = bin->frequency_hz;
  }
  judge(last_hz);
  return worst;
}

struct Fitted {
  Likelihood likelihood;
  Maximum maximum;
  Misfit misfit;
};

Fitted fit_up_to(const std::vector<PowerBin>& all, double highest_hz) {
  std::vector<PowerBin> bins;
  std::copy_if(all.begin(), all.end(), std::back_inserter(bins),
               [=](const PowerBin& bin) { return bin.frequency_hz <= highest_hz; });
  Likelihood likelihood(std::move(bins));
  Maximum maximum = likelihood.maximum({});
  const Misfit misfit = misfit_of(likelihood.bins(), maximum);
  return {std::move(likelihood), maximum, misfit};
}

/// Up to the highest frequency below which the terms describe the log; up to half the sampling rate where there is
/// none.
Fitted fit_where_it_holds(const std::vector<PowerBin>& all, double half_rate_hz, double& highest_hz) {
  Fitted whole = fit_up_to(all, half_rate_hz);
  highest_hz = half_rate_hz;
  if (whole.misfit.ratio == 1.0) return whole;
  double top = 1.0;
  for (int step = 0; step < kMostStepsDown; ++step) {
    top *= kStepDown;
    Fitted part = fit_up_to(all, top * half_rate_hz);
    if (part.misfit.ratio != 1.0 || part.likelihood.bins().size() < 2 * kNoiseTerms) continue;
    highest_hz = top * half_rate_hz;
    return part;
  }
  return whole;
}

}  // namespace

Coefficients NoiseFit::values() const noexcept {
  Coefficients out{};
  for (std::size_t t = 0; t < kTerms; ++t) out[t] = terms[t].value;
  return out;
}

NoiseFit fit_noise(const std::vector<double>& readings, double period_s, const std::vector<Band>& left_out) {
  std::vector<double> rest = readings;
  const double slope = take_line_off(rest, period_s);
  NoiseFit out;
  const Fitted fitted =
      fit_where_it_holds(power_bins(std::move(rest), period_s, left_out), 0.5 / period_s, out.highest_hz);
  out.misfit = fitted.misfit.ratio;
  out.misfit_hz = fitted.misfit.frequency_hz;
  const SquareIntervals squares = square_intervals(fitted.likelihood, fitted.maximum);
  for (std::size_t t = 0; t < kNoiseTerms; ++t) {
    TermEstimate& term = out.terms[t];
    term.value = std::sqrt(fitted.maximum.squares[t]);
    term.low = std::sqrt(squares[t].low);
    term.high = std::sqrt(squares[t].high);
    term.visible = term.low > 0.0;
  }
  const Interval slopes = slope_interval(fitted.likelihood, fitted.maximum, squares[index(Term::random_walk)]);
  TermEstimate& line = out.terms[index(Term::drift_rate)];
  line.value = slope + fitted.maximum.slope;
  line.low = std::min(line.value, slope + slopes.low);
  line.high = std::max(line.value, slope + slopes.high);
  line.visible = line.low > 0.0 || line.high < 0.0;
  Coefficients values = out.values();
  for (const Term term : kAllTerms) {
    TermEstimate& one = out.terms[index(term)];
    const double most = std::max(std::fabs(one.low), std::fabs(one.high));
    // A walk that the log does not exclude hides a drift.
    if (term == Term::drift_rate) values[index(Term::random_walk)] = out.of(Term::random_walk).high;
    if (!one.visible) one.more_hours = more_hours(term, 0.5 * most, values, readings.size(), period_s);
  }
  return out;
}

}  // namespace noise
}  // namespace PLUMB_ABI
}  // namespace plumb
