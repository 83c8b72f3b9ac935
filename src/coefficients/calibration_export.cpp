#include "plumb/coefficients/calibration_export.hpp"

#include <charconv>
#include <cmath>

#include "../io/text_tools.hpp"
#include "chip_form.hpp"
#include "export_losses.hpp"
#include "imu_tk.hpp"
#include "parameter_file.hpp"
#include "plumb/io/printable.hpp"
#include "plumb/io/units.hpp"
#include "sensor_table.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace coefficients {
namespace {

[[noreturn]] void refuse_export(const std::string& file, const std::string& field, const std::string& what,
                                const std::string& remedy) {
  throw io::Refusal(io::FileError{file, 0, field, what, remedy});
}

/// What one export works on.
struct Subject {
  const io::ArrayFile& array;
  const io::CalibrationFile& file;
  const SensorModel& model() const { return file.calibration.model; }
  std::string id(int i) const { return array.array.row(i).id.data(); }
};

struct InstanceRange {
  int first, last;
};
InstanceRange range_of(Form form) {
  if (form == Form::px4) return {0, 3};
  if (form == Form::ardupilot) return {1, 5};
  return {0, 99};
}

std::vector<PlacedChip> chips_of(const Subject& s, Form form, const std::vector<InstanceChoice>& choices) {
  std::vector<int> instances;
  if (choices.empty()) {
    const io::FileExpected<std::vector<ChipPlace>> places = places_of(s.array);
    if (!places) throw io::Refusal(places.error());
    for (std::size_t k = 0; k < places->size(); ++k)
      instances.push_back(static_cast<int>(k) + (form == Form::px4 ? 0 : 1));
  }
  io::FileExpected<std::vector<PlacedChip>> out = place_chips(s.array, instances, choices, s.array.path);
  if (!out) throw io::Refusal(out.error());
  const InstanceRange range = range_of(form);
  for (const PlacedChip& one : *out) {
    if (one.instance >= range.first && one.instance <= range.last) continue;
    refuse_export("--instance", "", "chip " + std::to_string(one.instance) + " is none of " + to_string(form),
                  "its chips are " + std::to_string(range.first) + " to " + std::to_string(range.last));
  }
  if (form == Form::imu_tk && out->size() != 1)
    refuse_export(s.array.path, "", "has " + std::to_string(out->size()) + " chips, and a file of imu_tk holds one",
                  "name one: --instance 1=" + io::shell_word(out->empty() ? "imu1" : out->front().place.name));
  return *std::move(out);
}

/// As the autopilot holds it, in single precision.
std::string single_text(const Subject& s, const std::string& name, double value) {
  const auto single = static_cast<float>(value);
  if (!std::isfinite(value) || !std::isfinite(single))
    refuse_export(s.array.path, name, "would be " + io::shortest(value) + ", which no parameter can hold",
                  "check the calibration");
  char text[32];
  const auto end = std::to_chars(text, text + sizeof text, single);
  return {text, end.ptr};
}

/// One line of a parameter file.
std::string parameter_line(Form form, const std::string& name, const std::string& value) {
  constexpr const char* kRealParameter = "9";  // MAV_PARAM_TYPE_REAL32
  if (form == Form::px4) return "1\t1\t" + name + "\t" + value + "\t" + kRealParameter + "\n";
  return name + "," + value + "\n";
}

std::string parameters_of(const Subject& s, Form form, const PlacedChip& placed) {
  const io::FileExpected<void> handed = check_handedness(s.array, placed.place, form);
  if (!handed) throw io::Refusal(handed.error());
  const ChipCoefficients chip = diagonal_chip(s.array, s.model(), placed.place);
  const std::string prefix = parameter_prefix(form, placed.instance);
  std::string out;
  for (std::size_t k = 0; k < 3; ++k) {
    if (placed.place.sensor[k] < 0) continue;
    const std::string axis(1, "XYZ"[k]);
    const std::string offset = form == Form::px4 ? prefix + "_" + axis + "OFF" : prefix + "OFFS_" + axis;
    const std::string scale = form == Form::px4 ? prefix + "_" + axis + "SCALE" : prefix + "SCAL_" + axis;
    if (!(chip.matrix[4 * k] > 0.0))
      refuse_export(s.array.path, scale, "would be " + io::brief(chip.matrix[4 * k]) + ", must be above 0",
                    "a channel that reads the other way round is named so: --instance 0=a1,-a2,a3");
    out += parameter_line(form, offset, single_text(s, offset, chip.offset[0][k]));
    out += parameter_line(form, scale, single_text(s, scale, chip.matrix[4 * k]));
  }
  return out;
}

std::string comment(const std::string& text) { return "# " + io::printable_line(text) + "\n"; }

std::string sensors_words(const Subject& s, const ChipPlace& place) {
  std::vector<std::string> out;
  for (std::size_t k = 0; k < 3; ++k)
    out.push_back(place.sensor[k] < 0 ? "-" : (place.sign[k] < 0 ? "-" : "") + s.id(place.sensor[k]));
  return io::joined(out);
}

void export_chips(const Subject& s, Form form, const std::vector<InstanceChoice>& choices, CalibrationExport& out) {
  out.chips = chips_of(s, form, choices);
  SensorSet written;
  for (const PlacedChip& placed : out.chips) {
    for (const int sensor : placed.place.sensor) {
      if (sensor < 0) continue;
      written = written | SensorSet::of(sensor);
      if (form != Form::imu_tk) lose_axis(s.array, s.file.calibration, sensor, out.losses);
      lose_drift(s.array, s.file.calibration, sensor, out.losses);
    }
  }
  for (int i = 0; i < s.array.array.size(); ++i) {
    if (!written.has(i)) out.left_out = out.left_out | SensorSet::of(i);
  }
  if (form == Form::imu_tk) {
    out.text = imu_tk_text(full_chip(s.array, s.model(), s.file.calibration.array, out.chips.front().place));
    out.notes.emplace_back("the uncertainty of the coefficients is not in this form");
    return;
  }
  std::string values;
  out.text = comment("accelerometer calibration of " + s.file.array_name + ", written by plumb");
  for (const PlacedChip& placed : out.chips) {
    values += parameters_of(s, form, placed);
    out.text += comment(parameter_prefix(form, placed.instance) + ": x, y, z are " + sensors_words(s, placed.place));
  }
  if (form == Form::px4) out.text += comment("Vehicle-Id Component-Id Name Value Type");
  out.text += values;
  out.notes.emplace_back(
      "x, y and z are the channels as the log reads them, forward, right and down where the log is the "
      "autopilot's; the ids of the chips are not written: see that each number is the chip that it "
      "was");
  out.notes.emplace_back("the uncertainty of the coefficients is not in this form");
}

void export_table(const Subject& s, Form form, CalibrationExport& out) {
  const Calibration& calibration = s.file.calibration;
  double factor = 1.0;
  const std::vector<Uncertainty> sigmas = separate_sigmas(calibration.array, factor);
  std::vector<TableRow> rows;
  for (int i = 0; i < s.array.array.size(); ++i) {
    SensorStatement one;
    one.sensor = i;
    one.model = calibration.model.sensor[static_cast<std::size_t>(i)];
    one.axis = calibration.array.axis(i);
    one.sigma = sigmas[static_cast<std::size_t>(i)];
    one.span = TemperatureSpan{calibration.report.temperature_min_degc, calibration.report.temperature_max_degc};
    rows.push_back(row_of(s.array, one));
    const bool whole = one.sigma.bias_mps2 && one.sigma.scale && one.sigma.axis_rad;
    if (!whole)
      out.notes.push_back(s.id(i) + " has values that the calibration takes for exact: no sigma is written of them");
  }
  if (factor > 1.0)
    out.notes.push_back("each sigma is " + io::brief(factor, 3) +
                        " times that of the calibration: a table keeps no correlations, and so wide it claims no more");
  out.text =
      form == Form::json
          ? json_text(rows)
          : csv_text(rows, comment("calibration of " + s.file.array_name + ", written by plumb; sigmas are 1 sigma"),
                     s.array.path);
}

}  // namespace

io::FileExpected<CalibrationExport> export_calibration(const io::ArrayFile& array,
                                                       const io::CalibrationFile& calibration, Form form,
                                                       const std::vector<InstanceChoice>& choices) {
  try {
    const Subject subject{array, calibration};
    CalibrationExport out;
    out.form = form;
    if (is_of_chips(form)) {
      export_chips(subject, form, choices, out);
    } else {
      if (!choices.empty())
        return tl::unexpected<io::FileError>(io::FileError{
            "--instance", 0, "",
            std::string("belongs to forms of chips, and ") + to_string(form) + " names sensors by their ids",
            "leave it out", io::ExitCode::usage});
      export_table(subject, form, out);
    }
    return out;
  } catch (const io::Refusal& refusal) {
    return tl::unexpected<io::FileError>(refusal.error());
  }
}

}  // namespace coefficients
}  // namespace PLUMB_ABI
}  // namespace plumb
