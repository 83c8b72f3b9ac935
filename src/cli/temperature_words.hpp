/// What a fit over temperature says, in sentences and figures.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "fit_words.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace cli {

/// "auto" or 0 .. 3; the reason where the text is neither.
std::string read_temperature_order(const std::string& text, int& order);
/// "20,150": lowest and highest [degC]; the reason where the text is not such a span.
std::string read_use_range(const std::string& text, ChebyshevSpan& use_degc);

/// "25 and 60 degC".
std::string degc_words(const double* degc, int count);

/// What the temperatures of the stations leave open, one phrase each; empty where the fit is one at one temperature.
std::vector<std::string> temperature_unobservable(const CalibrationRun& run, const io::ArrayFile& array);

/// Why the fit over temperature was refused, where temperature is why.
std::optional<Refusal> temperature_refusal(const CalibrationRun& run);

/// One line a fact: levels, order, condition, expected error; empty where there is one level and no order was asked
/// for.
struct TemperatureFact {
  std::string label;
  std::string words;
};
std::vector<TemperatureFact> temperature_facts(const CalibrationRun& run, const io::ArrayFile& array);

/// The coefficients of the orders above zero, one row each; empty where there are none.
std::string temperature_table(const CalibrationRun& run, const io::ArrayFile& array);

/// The direction whose component of gravity says the temperature of the stations; axis 0 where none does, or where
/// nothing was estimated over temperature.
struct FollowedDirection {
  char axis = 0;  ///< 'x', 'y' or 'z' of the tool frame
  double correlation = 0.0;
};
FollowedDirection followed_direction(const CalibrationRun& run);

}  // namespace cli
}  // namespace PLUMB_ABI
}  // namespace plumb
