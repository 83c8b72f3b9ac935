/// The pictures of a geometry, drawn by gnuplot: what one attitude isolates, over all attitudes, and the protection
/// level against the noise.
#pragma once

#include <string>
#include <vector>

#include "plumb/report/fit_plot.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace report {

struct GeometryPictures {
  /// One attitude of a regular grid; toolface varies fastest.
  struct Point {
    double inclination_deg = 0.0, toolface_deg = 0.0;
    double clear_from_g0 = 0.0;      ///< every larger fault of one sensor is isolated here
    double nearest_mirror_g0 = 0.0;  ///< least fault with a second explanation of the right length
    int blind_sensors = 0;
  };
  struct Level {
    double sigma_mg0 = 0.0;  ///< noise of a sample
    double one_sample_deg = 0.0, block_deg = 0.0;
  };
  std::string name;
  int samples = 0;            ///< of a block
  double sigma_mg0 = 0.0;     ///< of this array: marked
  std::vector<Point> map;     ///< empty: no such picture
  std::vector<Level> levels;  ///< empty: no such picture
};

/// Data and one gnuplot program, kGeometryScript.
std::vector<PlotFile> geometry_plot_files(const GeometryPictures& pictures);
inline constexpr const char* kGeometryScript = "geometry.gp";
/// Names of the pictures that the script draws.
std::vector<std::string> geometry_picture_names(const GeometryPictures& pictures);

}  // namespace report
}  // namespace PLUMB_ABI
}  // namespace plumb
