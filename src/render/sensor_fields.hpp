/// What is reported of every sensor of a fit, and of every fit by the paper's method (private to src/render).
#pragma once

#include <limits>

#include "field_table.hpp"
#include "plumb/findings/fit_figures.hpp"
#include "plumb/render/figures.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace render {

using SensorField = FieldOf<findings::SensorFigures>;

/// Nothing is known of a sensor where no fit converged.
template <double findings::SensorFigures::*Figure>
double figure(const findings::SensorFigures& f) {
  return f.known ? f.*Figure : std::numeric_limits<double>::quiet_NaN();
}

// clang-format off
inline constexpr double kMilli = findings::kMilliG0_mps2;
inline constexpr SensorField kSensorFields[] = {
    {"bias_mps2",         figure<&findings::SensorFigures::bias_mg>,         kMilli, "bias",     "mg0",     1.0,   "{:.3f}",  10, "bias, mg0",        kMg0},
    {"bias_sigma_mps2",   figure<&findings::SensorFigures::bias_sigma_mg>,   kMilli, "sigma",    "mg0",     1.0,   "{:.3f}",   8, "1 sigma",          kMg0},
    {"bias_data_share",   figure<&findings::SensorFigures::bias_share>,      1.0,    "data",     "%",       100.0, "{:.0f}",   5, nullptr,            0.0},
    {"scale_per_g0",      figure<&findings::SensorFigures::scale>,           1.0,    "scale",    nullptr,   1.0,   "{:.7g}",  13, nullptr,            0.0},
    {"scale_change",      figure<&findings::SensorFigures::scale_change>,    1.0,    "change",   "%",       100.0, "{:+.3f}",  8, "scale change, %",  100.0},
    {"scale_sigma",       figure<&findings::SensorFigures::scale_sigma>,     1.0,    "sigma",    "%",       100.0, "{:.4f}",   7, "1 sigma",          100.0},
    {"scale_data_share",  figure<&findings::SensorFigures::scale_share>,     1.0,    "data",     "%",       100.0, "{:.0f}",   5, nullptr,            0.0},
    {"axis_shift_deg",    figure<&findings::SensorFigures::axis_shift_deg>,  1.0,    "axis",     "deg",     1.0,   "{:.3f}",   8, "axis turned, deg", 1.0},
    {"axis_sigma_deg",    figure<&findings::SensorFigures::axis_sigma_deg>,  1.0,    "sigma",    "deg",     1.0,   "{:.4f}",   7, "1 sigma",          1.0},
    {"axis_data_share",   figure<&findings::SensorFigures::axis_share>,      1.0,    "data",     "%",       100.0, "{:.0f}",   5, nullptr,            0.0},
    {"e_cal_mps2",        figure<&findings::SensorFigures::e_cal_mg>,        kMilli, "e_cal",    "mg0",     1.0,   "{:.3f}",   8, nullptr,            0.0},
    {"residual_rms_mps2", figure<&findings::SensorFigures::residual_rms_mg>, kMilli, "residual", "mg0 rms", 1.0,   "{:.3f}",   8, nullptr,            0.0},
};

/// Behind the words of its outcome.
inline constexpr FieldOf<findings::PaperFigures> kPaperFields[] = {
    {"start_cost_m4ps8",      [](const findings::PaperFigures& f) { return f.start_cost; },      1.0,    "E_g before", "(m/s^2)^4", 1.0, "{:.4g}", 12, nullptr, 0.0},
    {"cost_m4ps8",            [](const findings::PaperFigures& f) { return f.cost; },            1.0,    "E_g after",  "(m/s^2)^4", 1.0, "{:.4g}", 12, nullptr, 0.0},
    {"length_error_rms_mps2", [](const findings::PaperFigures& f) { return f.length_error_mg; }, kMilli, "|g| error",  "mg0 rms",   1.0, "{:.3f}", 12, nullptr, 0.0},
};
// clang-format on

}  // namespace render
}  // namespace PLUMB_ABI
}  // namespace plumb
