/// The verification report as one self-contained HTML file. It is made from the master JSON alone, so that every figure
/// on the page stands there too; pictures are drawn from the same JSON.
#pragma once

#include <map>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "plumb/render/fit_plot.hpp"
#include "plumb/render/geometry_plot.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace render {

using Json = nlohmann::ordered_json;

struct PagePicture {
  std::string svg;      ///< fit for inlining (`inline_svg`); empty: `missing` is shown
  std::string missing;  ///< why there is none
  std::string narrow;   ///< the same drawn for a phone; empty: there is the one only
};
/// By the name of its SVG file.
using PagePictures = std::map<std::string, PagePicture>;

/// Data and one gnuplot program, kVerificationScript, that draws every picture for which the report has data.
std::vector<PlotFile> verification_plot_files(const Json& report, const GeometryPictures& geometry);
inline constexpr const char* kVerificationScript = "charts.gp";
std::vector<std::string> verification_picture_names(const Json& report, const GeometryPictures& geometry);
/// Where the pictures and their data lie, relative to the page.
inline constexpr const char* kChartFolder = "charts";

/// A picture that is not among `pictures` is reported to be missing.
std::string verification_html(const Json& report, const PagePictures& pictures);

}  // namespace render
}  // namespace PLUMB_ABI
}  // namespace plumb
