/// The pictures of a geometry, drawn by gnuplot: what one attitude isolates, over all attitudes, and the protection
/// level against the noise.
#pragma once

#include <string>
#include <vector>

#include "plumb/findings/geometry_study.hpp"
#include "plumb/render/fit_plot.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace render {

struct GeometryPictures {
  using Point = findings::AttitudePoint;
  using Level = findings::ProtectionPoint;

  std::string name;
  io::FieldKind field = io::FieldKind::gravity;
  int samples = 0;            ///< of a block
  double sigma_fine = 0.0;    ///< of this array: marked
  std::vector<Point> map;     ///< empty: no such picture
  std::vector<Level> levels;  ///< empty: no such picture
};

GeometryPictures geometry_pictures(const findings::GeometrySubject& subject, const findings::GeometryStudy& study);

/// Data and one gnuplot program, kGeometryScript.
std::vector<PlotFile> geometry_plot_files(const GeometryPictures& pictures);
inline constexpr const char* kGeometryScript = "geometry.gp";
/// Names of the pictures that the script draws.
std::vector<std::string> geometry_picture_names(const GeometryPictures& pictures);

}  // namespace render
}  // namespace PLUMB_ABI
}  // namespace plumb
