// The reports of calibrations that were not fitted, and of those that go to others.
#include "plumb/render/coefficients_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "plumb/render/figures.hpp"
#include "plumb/render/words.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace render {
namespace {

using coefficients::Adoption;
using coefficients::CalibrationExport;
using coefficients::ExportLoss;
using coefficients::PlacedChip;
using coefficients::SensorStatement;

constexpr const char* kNotFitted =
    "nothing was fitted, and no station of this array has tested these values: a monitor has to validate them first, "
    "and its limits rest on the stated uncertainty";

/// A label and words, wrapped.
std::string report_line(const std::string& label, const std::string& text) {
  constexpr std::size_t kReportLabel = 20, kReportWidth = 118;
  std::string out = fmt::format("{:<{}}", "  " + label, kReportLabel);
  std::size_t column = kReportLabel;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find(' ', begin), text.size());
    const bool first = column == kReportLabel;
    const bool fits = first || column + 1 + end - begin <= kReportWidth;
    if (!fits) {
      out += "\n" + std::string(kReportLabel, ' ');
      column = kReportLabel;
    } else if (!first) {
      out += ' ';
      ++column;
    }
    out.append(text, begin, end - begin);
    column += end - begin;
    begin = end + 1;
  }
  return out + "\n";
}

std::string id_at(const io::ArrayFile& array, int i) { return array.array.row(i).id.data(); }

std::vector<std::string> channels_of(const PlacedChip& chip, const io::ArrayFile& array) {
  std::vector<std::string> out;
  for (std::size_t k = 0; k < 3; ++k) {
    const int sensor = chip.place.sensor[k];
    out.push_back(sensor < 0 ? "-" : (chip.place.sign[k] < 0 ? "-" : "") + id_at(array, sensor));
  }
  return out;
}

std::string chip_words(const std::string& name, const PlacedChip& chip, const io::ArrayFile& array) {
  const std::vector<std::string> channels = channels_of(chip, array);
  return fmt::format("{}: x, y, z are {}, {}, {}", name, channels[0], channels[1], channels[2]);
}

/// The chips by their names where there are any, else by number.
std::string chip_lines(const std::vector<PlacedChip>& chips, const std::vector<std::string>& names,
                       const io::ArrayFile& array) {
  std::string out;
  for (std::size_t k = 0; k < chips.size(); ++k) {
    const std::string name = k < names.size() ? names[k] : fmt::format("chip {}", chips[k].instance);
    out += report_line(k == 0 ? "chips" : "", chip_words(name, chips[k], array));
  }
  return out;
}

io::Json chips_json(const std::vector<PlacedChip>& chips, const std::vector<std::string>& names,
                    const io::ArrayFile& array) {
  io::Json out = io::Json::array();
  for (std::size_t k = 0; k < chips.size(); ++k)
    out.push_back(io::object({{"instance", chips[k].instance},
                              {"name", k < names.size() ? names[k] : ""},
                              {"channels", channels_of(chips[k], array)}}));
  return out;
}

double turned_deg(const SensorStatement& one, const io::ArrayFile& array) {
  return deg_from_rad(angle_between_rad(one.axis, array.array.axis(one.sensor)));
}

std::string sensor_table(const Adoption& adoption, const io::ArrayFile& array) {
  const std::string unit = array.input.unit.name + "/(m/s^2)";
  std::string out =
      fmt::format("\n  {:<15}  {:>22}  {:>10}  {:>10}   {:>9}  {:>9}  {:>9}  {:>9}\n", "sensor", "scale, " + unit,
                  "bias, mg0", "turned,deg", "1 sigma:", "bias, mg0", "axis, deg", "e_cal,mg0");
  for (const SensorStatement& one : adoption.sensors) {
    out += fmt::format("  {:<15}  {:>22.9g}  {:>10}  {:>10}   {:>5.4g} ppm  {:>9.4g}  {:>9.3g}  {:>9.4g}\n",
                       id_at(array, one.sensor), one.model.scale[0], fixed_words(in_mg0(one.model.bias[0]), 3),
                       fixed_words(turned_deg(one, array), 4), 1e6 * one.sigma.scale.value_or(0.0),
                       in_mg0(one.sigma.bias_mps2.value_or(0.0)), deg_from_rad(one.sigma.axis_rad.value_or(0.0)),
                       in_mg0(adoption.calibration.report.e_cal_mps2[at(one.sensor)]));
  }
  return out + "  turned: from the nominal axis; e_cal: what the stated uncertainty leaves in a reading at rest\n";
}

std::string note_lines(const std::vector<std::string>& notes) {
  std::string out;
  for (const std::string& note : notes) out += report_line("note", note);
  return out;
}

/// The worst loss of each kind, over all sensors.
std::vector<ExportLoss> worst_losses(const CalibrationExport& made) {
  std::vector<ExportLoss> out;
  for (const ExportLoss& one : made.losses) {
    const auto found = std::find_if(out.begin(), out.end(), [&one](const ExportLoss& o) { return o.what == one.what; });
    if (found == out.end()) {
      out.push_back(one);
    } else if (one.worst_mps2 > found->worst_mps2) {
      *found = one;
    }
  }
  return out;
}

}  // namespace

std::string adoption_text(const Adoption& adoption, const io::ArrayFile& array) {
  std::string out =
      fmt::format("{}: calibration from known coefficients ({}, {})\n", array.name, adoption.forms, adoption.file_name);
  out += report_line("not validated", kNotFitted);
  out += chip_lines(adoption.chips, adoption.chip_names, array);
  out += report_line("holds",
                     adoption.span.min_degc < adoption.span.max_degc
                         ? fmt::format("from {:.4g} to {:.4g} degC", adoption.span.min_degc, adoption.span.max_degc)
                         : fmt::format("at {:.4g} degC", adoption.span.min_degc));
  out += note_lines(adoption.notes);
  return out + sensor_table(adoption, array);
}

io::Json adoption_json(const Adoption& adoption, const io::ArrayFile& array) {
  io::Json sensors = io::Json::array();
  for (const SensorStatement& one : adoption.sensors)
    sensors.push_back(io::object({{"id", id_at(array, one.sensor)},
                                  {"source", one.source},
                                  {"scale", one.model.scale},
                                  {"bias_mps2", one.model.bias},
                                  {"reference_degc", one.model.reference_degc},
                                  {"axis", one.axis},
                                  {"turned_deg", turned_deg(one, array)},
                                  {"sigma", io::object({{"bias_mps2", one.sigma.bias_mps2.value_or(0.0)},
                                                        {"scale", one.sigma.scale.value_or(0.0)},
                                                        {"axis_rad", one.sigma.axis_rad.value_or(0.0)}})},
                                  {"e_cal_mps2", adoption.calibration.report.e_cal_mps2[at(one.sensor)]}}));
  return io::object({{"coefficients", adoption.forms},
                     {"file", adoption.file_name},
                     {"fitted", false},
                     {"validated", false},
                     {"temperature_min_degc", adoption.span.min_degc},
                     {"temperature_max_degc", adoption.span.max_degc},
                     {"common_scale_sigma", adoption.common_scale},
                     {"chips", chips_json(adoption.chips, adoption.chip_names, array)},
                     {"sensors", std::move(sensors)},
                     {"notes", adoption.notes}});
}

std::string export_text(const CalibrationExport& made, const io::ArrayFile& array) {
  std::string out = fmt::format("{}: calibration as {}\n", array.name, to_string(made.form));
  out += chip_lines(made.chips, {}, array);
  for (const ExportLoss& one : worst_losses(made))
    out += report_line("lost", fmt::format("{}: at worst {:.3g} mg0 of a reading at rest ({})", one.what,
                                           in_mg0(one.worst_mps2), id_at(array, one.sensor)));
  if (made.losses.empty()) out += report_line("lost", "nothing of scale, bias, axis and drift");
  if (!made.left_out.empty()) out += report_line("left out", sensor_names(made.left_out, array.array));
  return out + note_lines(made.notes);
}

io::Json export_json(const CalibrationExport& made, const io::ArrayFile& array) {
  io::Json losses = io::Json::array();
  for (const ExportLoss& one : made.losses)
    losses.push_back(
        io::object({{"id", id_at(array, one.sensor)}, {"what", one.what}, {"worst_mps2", one.worst_mps2}}));
  return io::object({{"form", to_string(made.form)},
                     {"chips", chips_json(made.chips, {}, array)},
                     {"losses", std::move(losses)},
                     {"left_out", io::ids_of(made.left_out, array.array)},
                     {"notes", made.notes}});
}

}  // namespace render
}  // namespace PLUMB_ABI
}  // namespace plumb
