#include "fit_pictures.hpp"

#include <cmath>

#include "plot_files.hpp"
#include "plumb/core/units.hpp"
#include "plumb/findings/fit_figures.hpp"
#include "plumb/render/figures.hpp"
#include "plumb/render/fit_plot.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace cli {
namespace {

using render::in_mg0;

render::FitPictures pictures_of(const session::CalibrationRun& run, const io::ArrayFile& array) {
  render::FitPictures out;
  for (std::size_t k = 0; k < run.study.attitudes.size(); ++k) {
    if (!(norm(run.study.attitudes[k].direction) > 0.0)) continue;
    render::FitPictures::Station s;
    s.down = run.study.attitudes[k].direction;
    if (k < run.study.residuals.size()) {
      s.norm_mg0 = in_mg0(run.study.residuals[k].norm_error_mps2);
      for (int i = 0; i < array.array.size(); ++i)
        s.residual_mg0.push_back(in_mg0(run.study.residuals[k].residual_mps2[static_cast<std::size_t>(i)]));
    }
    if (k < run.study.predicted.size() && run.study.predicted[k].judged) {
      s.held_out_mg0 = in_mg0(run.study.predicted[k].norm_error_mps2);
      s.stands_out = run.study.predicted[k].sigmas > findings::kOddStation_sigmas;
    }
    out.stations.push_back(std::move(s));
  }
  for (const findings::SensorFigures& f : findings::sensor_figures(run, array)) {
    const DatasheetSensor& nominal = array.datasheet.sensor[out.sensors.size()];
    out.sensors.push_back(
        {f.id,
         {f.bias_mg - in_mg0(nominal.coefficients.bias[0]), f.bias_sigma_mg, in_mg0(nominal.prior.bias_mps2)},
         {100.0 * f.scale_change, 100.0 * f.scale_sigma, 100.0 * nominal.prior.scale},
         {f.axis_shift_deg, f.axis_sigma_deg, deg_from_rad(nominal.prior.axis_rad)}});
  }
  out.cost = run.study.cost;
  for (const PlannedAttitude& p : run.study.next) out.proposed_down.push_back(p.direction);
  return out;
}

}  // namespace

io::FileExpected<std::vector<std::string>> draw_fit(const std::string& directory, const session::CalibrationRun& run,
                                                    const io::ArrayFile& array, std::string& missing) {
  const render::FitPictures pictures = pictures_of(run, array);
  return draw_files(directory, render::fit_plot_files(pictures), render::kFitScript,
                    render::fit_picture_names(pictures), missing);
}

}  // namespace cli
}  // namespace PLUMB_ABI
}  // namespace plumb
