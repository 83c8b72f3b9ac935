// Estimates in words, and taken off.
#include <fmt/format.h>

#include <cmath>

#include "algebra.hpp"
#include "plumb/survey/multi_station.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace survey {
namespace {

constexpr double kNamedFrom = 0.2;  // components of a direction of unit length

std::string combination(const TermValues& direction) {
  std::string out;
  for (std::size_t k = 0; k < direction.size(); ++k) {
    if (std::fabs(direction[k]) < kNamedFrom) continue;
    if (!out.empty()) out += ", ";
    out += to_string(static_cast<Term>(k));
  }
  return out;
}

}  // namespace

std::string EstimateRefusal::text() const {
  switch (why) {
    case NoEstimate::nothing_asked: return "no term is asked for, or one twice: name each term once";
    case NoEstimate::too_few_stations:
      return fmt::format("{:.0f} stations are too few: {:.0f} are needed for these terms", value, limit);
    case NoEstimate::not_finite:
      return fmt::format("station {:.0f} (counted from 0) holds a number that is not finite: leave it out", value);
    case NoEstimate::no_random_error:
      return fmt::format(
          "station {:.0f} (counted from 0) states no random error, so that it cannot be weighed: state "
          "the noise of its means",
          value);
    case NoEstimate::not_converged:
      return "the estimate does not settle: test the stations for gross errors and swapped axes first";
    case NoEstimate::not_observable:
      return fmt::format(
          "these stations do not tell {} from an error of the reference: the estimate would have {} times the stated "
          "sigma. Survey at other inclinations, azimuths and toolfaces, or ask for fewer terms",
          combination(direction), std::isfinite(value) ? fmt::format("{:.2g}", value) : std::string("infinitely many"));
    case NoEstimate::correlated:
      return fmt::format(
          "{} and {} correlate by {:.2f}, at most {:.2f} is allowed: one would be taken for the other. Ask for one of "
          "them, or survey at other attitudes",
          to_string(first), to_string(second), value, limit);
    case NoEstimate::misfit:
      return fmt::format(
          "chi-square of the residuals is {:.1f}, at most {:.1f} is allowed: another error is in the data. Test the "
          "stations for gross errors, or state larger errors of the tool",
          value, limit);
  }
  return "?";
}

CorrectedStation corrected(const Measurement& station, const Estimate& estimate) {
  CorrectedStation out;
  out.measured = without(estimate.value, station);
  const std::array<double, 72> weights = term_weights(out.measured);
  const auto w = matrix_of<6, static_cast<int>(kTermCount)>(weights);
  const auto c = matrix_of<static_cast<int>(kTermCount), static_cast<int>(kTermCount)>(estimate.covariance);
  const Matrix6 total = matrix_of<6, 6>(station.random) + w * c * w.transpose();
  std::copy_n(total.data(), 36, out.total.begin());
  return out;
}

SurveyStation judge_corrected(const CorrectedStation& station, const Reference& reference,
                              const StationSettings& settings) {
  StationSettings without_tool = settings;
  without_tool.tool = {};
  Measurement measured = station.measured;
  measured.random = station.total;
  SurveyStation out = judge_station(measured, reference, without_tool);
  out.measured = station.measured;
  return out;
}

}  // namespace survey
}  // namespace PLUMB_ABI
}  // namespace plumb
