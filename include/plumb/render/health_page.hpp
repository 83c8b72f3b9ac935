/// The health report of a run: a master JSON, and a page made from it alone.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "plumb/array/sensor_array.hpp"
#include "plumb/render/verification_page.hpp"
#include "plumb/verification/residual_trace.hpp"
#include "plumb/verification/tool_health.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace render {

inline constexpr const char* kHealthSchema = "plumb-health";
inline constexpr int kHealthVersion = 1;

/// Stations, events, extremes, answer. Identity and what tells of the run are the caller's to add. `beside`: what else
/// is to be done.
Json health_json(const verification::ToolHealth& health, const SensorArray& array,
                 const std::vector<std::string>& beside = {});

/// What every sensor said beside the others, for the charts.
Json residuals_json(const verification::ResidualTrace& trace, const SensorArray& array);

/// Data and one gnuplot program, kHealthScript, that draws every picture for which there is data.
std::vector<PlotFile> health_plot_files(const Json& report);
inline constexpr const char* kHealthScript = "health.gp";
std::vector<std::string> health_picture_names(const Json& report);

/// `data`: the name of the JSON file beside the page.
std::string health_html(const Json& report, const PagePictures& pictures, const std::string& data);

}  // namespace render
}  // namespace PLUMB_ABI
}  // namespace plumb
