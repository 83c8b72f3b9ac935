// The report of a fit as text for people and as JSON for machines.
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "fit_summary.hpp"
#include "plumb/core/units.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace cli {
namespace {

constexpr double kMilliG0_mps2 = 1e-3 * kG0_mps2;

std::string stations_text(const CalibrationRun& run) {
  std::string out =
      fmt::format("\n  {:>7}  {:>12} {:>12}  {:>8}  {:>11}\n", "station", "begin s", "end s", "samples", "temperature");
  int number = 0;
  for (const Station& s : run.stations) {
    out += fmt::format("  {:>7}  {:>12.3f} {:>12.3f}  {:>8}  {:>6.1f} degC\n", ++number, s.begin_s, s.end_s, s.count,
                       s.temperature_degc);
  }
  return out;
}

std::string sensors_text(const CalibrationRun& run, const io::ArrayFile& array) {
  const bool known = run.accepted != nullptr;
  std::string out = fmt::format("\n  {:<15} {:>10} {:>8} {:>14} {:>9} {:>10} {:>9} {:>9} {:>9}\n", "sensor", "bias",
                                "sigma", "scale", "change", "axis shift", "e_cal", "residual", "from data");
  out += fmt::format("  {:<15} {:>10} {:>8} {:>14} {:>9} {:>10} {:>9} {:>9} {:>9}\n", "", "mg0", "mg0",
                     array.input.unit.name + "/g0", "%", "deg", "mg0", "mg0 rms", "%");
  for (const SensorFigures& f : sensor_figures(run, array)) {
    const auto figure = [known](const char* format, double value) {
      return known ? fmt::format(fmt::runtime(format), value) : std::string("-");
    };
    out += fmt::format("  {:<15} {:>10} {:>8.3f} {:>14} {:>9} {:>10} {:>9.3f} {:>9.3f} {:>9.1f}\n", f.id,
                       figure("{:.3f}", f.bias_mg), f.bias_sigma_mg, figure("{:.7g}", f.scale),
                       figure("{:+.3f}", 100.0 * f.scale_change), figure("{:.3f}", f.axis_shift_deg), f.e_cal_mg,
                       f.residual_rms_mg, 100.0 * f.data_share);
  }
  return out +
         "  e_cal: what calibration leaves in a reading (1 sigma). from data: how much of the least known of the "
         "sensor's four\n"
         "  parameters comes from the log rather than from the datasheet.\n";
}

std::string gaps_text(const CalibrationRun& run, const io::ArrayFile& array) {
  std::string out;
  if (run.report.gauge > 0) {
    out +=
        "\nnot seen by gravity, and no loss: a common rotation of all axes about x, y and z (the nominal axes of the "
        "array\nfile fix it)\n";
  }
  for (const std::string& line : unobservable(run.report, array))
    out += "not determined by these stations: " + line + "\n";
  return out;
}

std::string paper_text(const PaperCalibration& paper, const io::ArrayFile& array) {
  std::string out = fmt::format("\n  {:<20} {:<16} {:>10} {:>6} {:>12} {:>12} {:>12}\n", "the paper's fit of", "",
                                "iterations", "rank", "E_g before", "E_g after", "|g| error");
  out += fmt::format("  {:<20} {:<16} {:>10} {:>6} {:>12} {:>12} {:>12}\n", "", "", "", "", "(m/s^2)^4", "(m/s^2)^4",
                     "mg0 rms");
  bool silent = false;
  for (const PaperFigures& f : paper_figures(paper, array)) {
    out += fmt::format("  {:<20} {:<16} {:>10} {:>6} {:>12.4g} {:>12.4g} {:>12.3f}\n", f.sensors, f.outcome,
                       f.iterations, f.rank, f.start_cost, f.cost, f.length_error_mg);
    silent = silent || !f.sound;
  }
  if (silent) out += fmt::format("  three that did not converge with rank {} have no say in paper mode\n", kPaperRank);
  return out;
}

nlohmann::ordered_json paper_json(const PaperCalibration& paper, const io::ArrayFile& array) {
  nlohmann::ordered_json out = nlohmann::ordered_json::array();
  for (const PaperFigures& f : paper_figures(paper, array)) {
    out.push_back({{"sensors", f.sensors},
                   {"sound", f.sound},
                   {"stop", f.outcome},
                   {"iterations", f.iterations},
                   {"rank", f.rank},
                   {"start_cost_m4ps8", f.start_cost},
                   {"cost_m4ps8", f.cost},
                   {"length_error_rms_mps2", f.length_error_mg * kMilliG0_mps2}});
  }
  return out;
}

}  // namespace

std::string fit_text(const CalibrationRun& run, const io::ArrayFile& array, bool with_stations) {
  const FitReport& r = run.report;
  std::string out = fmt::format("array       {} ({} sensors), gravity {:.6f} m/s^2 ({})\n", array.name,
                                array.array.size(), array.gravity.g_mps2, to_string(array.gravity.model));
  out += fmt::format("log         {} rows used, {} bad rows skipped, {} stations\n", run.log.rows, run.log.rows_bad,
                     run.stations.size());
  if (with_stations) out += stations_text(run) + "\n";
  out +=
      fmt::format("fit         {} in {} iterations; {} of {} parameters seen by the data ({} are a common rotation)\n",
                  to_string(r.stop), r.iterations, r.rank, r.parameters, r.gauge);
  out +=
      fmt::format("residuals   length of gravity {:.3f} mg0 rms, parity {:.3f} mg0 rms, beyond the noise {:.3f} mg0\n",
                  r.norm_rms_mps2 / kMilliG0_mps2, r.parity_rms_mps2 / kMilliG0_mps2, r.misfit_mps2 / kMilliG0_mps2);
  out += fmt::format(
      "check       chi^2 {:.4g} for {} degrees of freedom (p = {:.3g}), condition {:.3g}, excitation {:.3g} (evenly "
      "spread = 1)\n",
      r.chi2, r.degrees_of_freedom, r.p_value, r.condition, r.excitation);
  out += sensors_text(run, array) + gaps_text(run, array);
  if (run.paper) out += paper_text(*run.paper, array);
  if (run.interrupted) out += "\ninterrupted: the fit uses the stations up to then\n";
  if (run.accepted) return out + "\naccepted\n";
  const Refusal refusal = refusal_of(run, array);
  return out + "\nNOT ACCEPTED: " + refusal.reason + "\nwhat to do:   " + refusal.next + "\n";
}

std::string fit_json(const CalibrationRun& run, const io::ArrayFile& array) {
  using Json = nlohmann::ordered_json;
  const FitReport& r = run.report;
  Json out;
  out["array"] = array.name;
  out["accepted"] = run.accepted != nullptr;
  if (!run.accepted) {
    const Refusal refusal = refusal_of(run, array);
    out["refusal"] = {{"reason", refusal.reason}, {"next", refusal.next}};
  }
  out["interrupted"] = run.interrupted;
  out["rows"] = run.log.rows;
  out["rows_bad"] = run.log.rows_bad;
  Json stations = Json::array();
  for (const Station& s : run.stations) {
    stations.push_back(
        {{"begin_s", s.begin_s}, {"end_s", s.end_s}, {"samples", s.count}, {"temperature_degc", s.temperature_degc}});
  }
  out["stations"] = std::move(stations);
  out["fit"] = {{"stop", to_string(r.stop)},
                {"iterations", r.iterations},
                {"parameters", r.parameters},
                {"rank", r.rank},
                {"gauge", r.gauge},
                {"norm_rms_mps2", r.norm_rms_mps2},
                {"parity_rms_mps2", r.parity_rms_mps2},
                {"misfit_mps2", r.misfit_mps2},
                {"chi2", r.chi2},
                {"degrees_of_freedom", r.degrees_of_freedom},
                {"p_value", r.p_value},
                {"condition", r.condition},
                {"excitation", r.excitation}};
  out["unobservable"] = unobservable(r, array);
  Json sensors = Json::array();
  for (const SensorFigures& f : sensor_figures(run, array)) {
    Json one;
    one["id"] = f.id;
    const auto known = [&run](double value) { return run.accepted ? Json(value) : Json(); };
    one["bias_mps2"] = known(f.bias_mg * kMilliG0_mps2);
    one["bias_sigma_mps2"] = f.bias_sigma_mg * kMilliG0_mps2;
    one["scale_per_g0"] = known(f.scale);
    one["scale_change"] = known(f.scale_change);
    one["axis_shift_deg"] = known(f.axis_shift_deg);
    one["e_cal_mps2"] = f.e_cal_mg * kMilliG0_mps2;
    one["residual_rms_mps2"] = f.residual_rms_mg * kMilliG0_mps2;
    one["data_share"] = f.data_share;
    sensors.push_back(std::move(one));
  }
  out["sensors"] = std::move(sensors);
  if (run.paper) out["paper"] = paper_json(*run.paper, array);
  return out.dump(2) + "\n";
}

}  // namespace cli
}  // namespace PLUMB_ABI
}  // namespace plumb
