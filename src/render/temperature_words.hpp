/// What a fit over temperature says, in sentences and figures (private to src/render).
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "plumb/findings/calibration_run.hpp"
#include "plumb/findings/finding.hpp"
#include "plumb/render/fit_report.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace render {

/// "25 and 60 degC".
std::string degc_words(const double* degc, int count);

/// What the temperatures of the stations leave open, one phrase each; empty where the fit is one at one temperature.
std::vector<std::string> temperature_unobservable(const findings::CalibrationRun& run, const io::ArrayFile& array);

/// Why the fit over temperature was refused, where temperature is why.
std::optional<Refusal> temperature_refusal(const findings::Finding& f, const findings::CalibrationRun& run);

/// One line a fact: levels, order, condition, expected error; empty where there is one level and no order was asked
/// for.
struct TemperatureFact {
  std::string label;
  std::string words;
};
std::vector<TemperatureFact> temperature_facts(const findings::CalibrationRun& run, const io::ArrayFile& array);

/// The coefficients of the orders above zero, one row each; empty where there are none.
std::string temperature_table(const findings::CalibrationRun& run, const io::ArrayFile& array);

}  // namespace render
}  // namespace PLUMB_ABI
}  // namespace plumb
