/// What a calibration is to be, as it is written on a command line or in a call from Python.
#pragma once

#include <string>

#include "plumb/calibration/temperature_fit.hpp"
#include "plumb/findings/fit_study.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace session {

/// "8" (folds), "0.25" (fraction, once), "one" (leave-one-out) or "none"; the reason where the text is none of these.
std::string read_hold_out(const std::string& text, findings::HoldOutChoice& choice);
/// "auto" or 0 .. 3; the reason where the text is neither.
std::string read_temperature_order(const std::string& text, int& order);
/// "20,150": lowest and highest [degC]; the reason where the text is not such a span.
std::string read_use_range(const std::string& text, ChebyshevSpan& use_degc);

}  // namespace session
}  // namespace PLUMB_ABI
}  // namespace plumb
