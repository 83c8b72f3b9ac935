#include "plumb/render/basis_json.hpp"

#include <utility>

#include "plumb/render/alignment_words.hpp"
#include "plumb/render/calibration_notes.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace render {
namespace {

using io::Json;

Json coefficients_of(const Calibration& calibration) {
  Json out = Json::array();
  for (int i = 0; i < calibration.array.size(); ++i) {
    const auto a = static_cast<std::size_t>(i);
    const SensorCoefficients& c = calibration.model.sensor[a];
    out.push_back(io::object({{"id", calibration.array.row(i).id.data()},
                              {"bias_mps2", c.bias},
                              {"scale_raw_per_mps2", c.scale},
                              {"reference_degc", c.reference_degc},
                              {"axis", calibration.array.axis(i)},
                              {"sigma_mps2", calibration.array.sigma_mps2(i)},
                              {"e_cal_mps2", calibration.report.e_cal_mps2[a]},
                              {"residual_rms_mps2", calibration.report.residual_rms_mps2[a]}}));
  }
  return out;
}

/// The drift since the calibration that the limits allow for, of every sensor; 0 where it states no stability.
Json drift_of(const io::ArrayFile& array, double days) {
  const bool paper = array.monitor.mode == MonitorMode::paper;  // whose algorithm allows for none
  const Readings tolerance = io::tolerance_mps2(array, days);
  Json sensors = Json::array();
  for (int i = 0; i < array.array.size(); ++i)
    sensors.push_back(io::object({{"id", array.array.row(i).id.data()},
                                  {"tolerance_mps2", paper ? 0.0 : tolerance[static_cast<std::size_t>(i)]}}));
  return io::object({{"days_since_calibration", days},
                     {"text", paper ? "none allowed for: the paper's algorithm takes none" : drift_words(array, days)},
                     {"sensors", std::move(sensors)}});
}

}  // namespace

Json basis_json(const io::ArrayFile& array, const io::CalibrationFile* file, double days) {
  Json out = io::object({{"gravity", io::object({{"model", to_string(array.gravity.model)},
                                                 {"g_mps2", array.gravity.g_mps2},
                                                 {"sigma_mps2", array.gravity.sigma_mps2}})},
                         {"calibration", Json()},
                         {"drift", drift_of(array, days)},
                         {"alignment", alignment_json(array, findings::alignment_of(array, file))}});
  if (file == nullptr) return out;
  const FitReport& fit = file->calibration.report;
  const bool fitted = file->context.coefficients.empty();
  out["calibration"] = io::object({{"log", file->context.log_file},
                                   {"made_by", file->context.plumb_version},
                                   {"date", file->context.date},
                                   {"serial", file->context.serial},
                                   {"g_mps2", file->context.gravity.g_mps2},
                                   {"stations", fit.stations},
                                   {"norm_rms_mps2", fitted ? Json(fit.norm_rms_mps2) : Json()},
                                   {"parity_rms_mps2", fitted ? Json(fit.parity_rms_mps2) : Json()},
                                   {"p_value", fitted ? Json(fit.p_value) : Json()},
                                   {"temperature_min_degc", fit.temperature_min_degc},
                                   {"temperature_max_degc", fit.temperature_max_degc},
                                   {"sensors", coefficients_of(file->calibration)}});
  if (!fitted) out["calibration"]["coefficients"] = file->context.coefficients;
  return out;
}

}  // namespace render
}  // namespace PLUMB_ABI
}  // namespace plumb
