/// The pictures of a calibration, drawn by gnuplot: residuals by station, parameters with their sigmas, convergence,
/// and the attitudes on the sphere.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "plumb/core/vec3.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace render {

struct FitPictures {
  struct Station {
    Vec3 down{};                         ///< unit vector of gravity in the tool frame
    double norm_mg0 = 0.0;               ///< |x| - G
    std::optional<double> held_out_mg0;  ///< the same, by a fit without this station
    std::vector<double> residual_mg0;    ///< by sensor
    bool stands_out = false;
  };
  /// Found against the datasheet, 1 sigma of it, and 1 sigma of the datasheet.
  struct Value {
    double change = 0.0, sigma = 0.0, prior = 0.0;
  };
  struct Sensor {
    std::string id;
    Value bias_mg0, scale_pct, axis_deg;
  };
  std::vector<Station> stations;
  std::vector<Sensor> sensors;
  std::vector<double> cost;         ///< by iteration
  std::vector<Vec3> proposed_down;  ///< attitudes to record next
};

/// A file to write beside the others.
struct PlotFile {
  std::string name, text;
};

/// Data and one gnuplot program, kFitScript, that draws every picture of `fit_pictures` for which there is data.
std::vector<PlotFile> fit_plot_files(const FitPictures& pictures);
inline constexpr const char* kFitScript = "fit.gp";
/// Names of the pictures that the script draws.
std::vector<std::string> fit_picture_names(const FitPictures& pictures);

}  // namespace render
}  // namespace PLUMB_ABI
}  // namespace plumb
