#include "plumb/coefficients/adoption.hpp"

#include <algorithm>
#include <cmath>
#include <exception>

#include "../io/refusal.hpp"
#include "../io/text_tools.hpp"
#include "chip_form.hpp"
#include "plumb/core/units.hpp"
#include "plumb/io/hash.hpp"
#include "plumb/io/units.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace coefficients {
namespace {

/// What a calibration file may hold.
constexpr double kMostNumber = 1e15;
constexpr double kColdest_degc = -273.15, kHottest_degc = 1000.0;

constexpr std::size_t at(int i) noexcept { return static_cast<std::size_t>(i); }

[[noreturn]] void refuse_adoption(const std::string& file, const std::string& field, const std::string& what,
                                  const std::string& remedy, io::ExitCode code = io::ExitCode::invalid_input) {
  throw io::Refusal(io::FileError{file, 0, field, what, remedy, code});
}

template <class T>
T taken(io::FileExpected<T> value) {
  if (!value) throw io::Refusal(value.error());
  return *std::move(value);
}

std::string id_of(const io::ArrayFile& array, int i) { return array.array.row(i).id.data(); }

SensorSet named_in(const std::vector<CoefficientFile>& files) {
  SensorSet out;
  for (const CoefficientFile& file : files) {
    for (const SensorStatement& one : file.sensors) out = out | SensorSet::of(one.sensor);
  }
  return out;
}

/// One kind of chips: their numbers would be ambiguous else.
void check_forms(const std::vector<CoefficientFile>& files) {
  const CoefficientFile* chips = nullptr;
  for (const CoefficientFile& file : files) {
    if (!is_of_chips(file.form)) continue;
    const bool beside = chips == nullptr || (chips->form == Form::imu_tk && file.form == Form::imu_tk);
    if (!beside)
      refuse_adoption(
          file.path, "",
          std::string("is a file of ") + to_string(file.form) + " beside one of " + to_string(chips->form) + " (" +
              chips->path + "): which chip is which cannot be told",
          "give one file of an autopilot, or files of imu_tk, and the coefficients of other sensors as csv");
    chips = &file;
  }
}

bool is_of_autopilot(const CoefficientFile& file) noexcept {
  return file.form == Form::px4 || file.form == Form::ardupilot;
}

/// An autopilot's parameters are for readings before them: a second time they would add what they take away.
void check_not_applied(const io::ArrayFile& array, const std::vector<CoefficientFile>& files,
                       std::vector<std::string>& notes) {
  for (const CoefficientFile& file : files) {
    if (!is_of_autopilot(file)) continue;
    if (array.input.corrected)
      refuse_adoption(file.path, "",
                      "holds the autopilot's own calibration, which the readings have already (corrected = true in "
                      "[input] of " +
                          array.path + "): applied twice it would be wrong by all that it corrects",
                      "give the coefficients.csv that plumb import wrote beside the array file; or import readings "
                      "from before the calibration, where the log has them (PX4: --message sensor_accel)");
    notes.emplace_back(file.form == Form::px4
                           ? "these parameters are for readings before them (sensor_accel); vehicle_imu and "
                             "sensor_combined have them applied already"
                           : "these parameters are for readings before them; IMU and ACC of a DataFlash log have them "
                             "applied already");
  }
}

/// Chips as statements of sensors.
void place_all(const io::ArrayFile& array, const std::vector<CoefficientFile>& files,
               const std::vector<InstanceChoice>& choices, Adoption& out, std::vector<SensorStatement>& found) {
  std::vector<const ChipCoefficients*> chips;
  std::vector<int> instances;
  Form form = Form::px4;
  std::string path;
  for (const CoefficientFile& file : files) {
    for (const ChipCoefficients& chip : file.chips) {
      chips.push_back(&chip);
      instances.push_back(chip.instance);
      form = file.form;
      path = file.path;
    }
  }
  if (chips.empty()) {
    if (!choices.empty())
      refuse_adoption("--instance", "", "belongs to files of chips, and none is given", "leave it out",
                      io::ExitCode::usage);
    return;
  }
  out.chips = taken(place_chips(array, instances, choices, path, named_in(files)));
  for (const PlacedChip& placed : out.chips) {
    const auto which = std::find(instances.begin(), instances.end(), placed.instance) - instances.begin();
    const ChipCoefficients& chip = *chips[static_cast<std::size_t>(which)];
    if (form != Form::imu_tk) {
      const io::FileExpected<void> handed = check_handedness(array, placed.place, form);
      if (!handed) throw io::Refusal(handed.error());
    }
    out.chip_names.push_back(chip.name);
    for (SensorStatement& one : sensors_of(array, chip, placed.place)) {
      if (form != Form::imu_tk) one.source = path + ": " + one.source;  // a chip of imu_tk is called like its file
      found.push_back(std::move(one));
    }
    if (chip.has_temperature_terms() && array.input.temperature_column.empty())
      out.notes.push_back(chip.name +
                          " states a drift with temperature, and the log has none: the offset at t_ref counts");
  }
  for (std::size_t k = 0; k < chips.size(); ++k) {
    const bool used = std::any_of(out.chips.begin(), out.chips.end(),
                                  [&](const PlacedChip& one) { return one.instance == instances[k]; });
    if (!used) out.notes.push_back(chips[k]->name + " is of no sensor named, and is left out");
  }
}

/// Each sensor once, in the order of the array.
std::vector<SensorStatement> in_order(const io::ArrayFile& array, const std::vector<SensorStatement>& found,
                                      const std::string& path) {
  std::vector<SensorStatement> out;
  std::vector<std::string> missing;
  for (int i = 0; i < array.array.size(); ++i) {
    const SensorStatement* of_it = nullptr;
    for (const SensorStatement& one : found) {
      if (one.sensor != i) continue;
      if (of_it != nullptr)
        refuse_adoption(one.source, id_of(array, i), "is stated by " + of_it->source + " already",
                        "give the coefficients of every sensor once");
      of_it = &one;
    }
    if (of_it == nullptr) {
      missing.push_back(id_of(array, i));
    } else {
      out.push_back(*of_it);
    }
  }
  if (!missing.empty())
    refuse_adoption(path, "", "states no coefficients of " + io::joined(missing),
                    "add them as a table (--from more.csv), or say which chip they are with --instance");
  return out;
}

void complete(const io::ArrayFile& array, const Uncertainty& usual, SensorStatement& one) {
  Uncertainty& sigma = one.sigma;
  if (!sigma.bias_mps2) sigma.bias_mps2 = usual.bias_mps2;
  if (!sigma.scale) sigma.scale = usual.scale;
  if (!sigma.axis_rad) sigma.axis_rad = usual.axis_rad;
  std::vector<std::string> missing;
  if (!sigma.bias_mps2) missing.emplace_back("bias");
  if (!sigma.scale) missing.emplace_back("scale");
  if (!sigma.axis_rad) missing.emplace_back("axis");
  if (missing.empty()) return;
  refuse_adoption(
      one.source, id_of(array, one.sensor),
      "states no uncertainty of " + io::joined(missing) + ", and every limit of the monitor rests on it",
      "state 1 sigma of what the coefficients may be off by: --uncertainty \"bias=5 mg, scale=1000 ppm, axis=0.5 "
      "deg\", or sigma_bias, sigma_scale and sigma_axis of each sensor in a table");
}

/// By the limits of a fit: beyond them it is another unit, another sensor or another order of channels.
void check_plausible(const io::ArrayFile& array, const SensorStatement& one) {
  const FitOptions limits;
  const DatasheetSensor& sheet = array.datasheet.sensor[at(one.sensor)];
  const std::string id = id_of(array, one.sensor);
  for (std::size_t k = 0; k < 4; ++k) {
    const bool sound = std::fabs(one.model.scale[k]) <= kMostNumber && std::fabs(one.model.bias[k]) <= kMostNumber;
    if (!sound) refuse_adoption(one.source, id, "has a coefficient that is out of range, or no number", "correct it");
  }
  const double ratio = one.model.scale[0] / sheet.coefficients.scale[0];
  const bool scale_fits = ratio > 0.0 && std::fmax(ratio, 1.0 / ratio) - 1.0 <= limits.max_scale_change;
  if (!scale_fits)
    refuse_adoption(
        one.source, id,
        "has a scale of " + io::brief(one.model.scale[0]) + " " + array.input.unit.name + "/(m/s^2), " +
            io::brief(ratio) + " times the nominal one of " + array.path,
        "check that the coefficients are in the unit of the log and of this sensor; the nominal scale may be 25 % "
        "off");
  const double turned = angle_between_rad(one.axis, sheet.row.axis);
  if (!(turned <= limits.max_axis_change_rad))
    refuse_adoption(
        one.source, id, "has an axis " + io::brief(deg_from_rad(turned), 3) + " deg from that of " + array.path,
        "check order and signs of the channels (--instance \"1=a1,-a2,a3\"), and the axis lines; 15 deg are allowed");
  // As the nominal coefficients would read it at no acceleration: what a fit calls bias.
  const double moved = std::fabs(ratio * one.model.bias[0] - sheet.coefficients.bias[0]);
  if (!(moved <= limits.max_bias_sigmas * sheet.prior.bias_mps2))
    refuse_adoption(
        one.source, id,
        "has a bias " + io::brief(1e3 * g0_from_mps2(moved), 3) + " mg0 from that of " + array.path +
            ", more than 8 sigma of its prior (" + io::brief(1e3 * g0_from_mps2(sheet.prior.bias_mps2), 3) + " mg0)",
        "check the unit of the coefficients; or state in the array file how far a bias may lie from its nominal "
        "one: prior = {bias = \"50 mg\"}");
}

TemperatureSpan span_of(const io::ArrayFile& array, const std::vector<SensorStatement>& sensors,
                        const AdoptionChoice& choice, std::vector<std::string>& notes) {
  if (choice.span) return *choice.span;
  TemperatureSpan out{-HUGE_VAL, HUGE_VAL};
  bool stated = false;
  for (const SensorStatement& one : sensors) {
    if (!one.span) continue;
    stated = true;
    out.min_degc = std::fmax(out.min_degc, one.span->min_degc);
    out.max_degc = std::fmin(out.max_degc, one.span->max_degc);
  }
  if (stated) {
    if (out.min_degc <= out.max_degc && out.min_degc >= kColdest_degc && out.max_degc <= kHottest_degc) return out;
    refuse_adoption(array.path, "", "the coefficients of its sensors hold at no common temperature that there is",
                    "state over which they hold together: --use-range-degc LO,HI");
  }
  const double t_ref = sensors.front().model.reference_degc;
  if (!array.input.temperature_column.empty())
    notes.push_back("they hold at " + io::brief(t_ref) +
                    " degC alone, as far as stated: a monitor confirms nothing more than 5 degC away. State the range "
                    "with --use-range-degc");
  return {t_ref, t_ref};
}

/// PX4 (commander/accelerometer_calibration) and ArduPilot (AccelCalibrator) take 9.80665 m/s^2 for the length of
/// gravity where they calibrate, and nobody says where that was: near here, as far as one can tell.
double common_scale_of(const io::ArrayFile& array, const std::vector<CoefficientFile>& files,
                       std::vector<std::string>& notes) {
  if (std::none_of(files.begin(), files.end(), is_of_autopilot)) return 0.0;
  const double off = std::fabs(kG0_mps2 / array.gravity.g_mps2 - 1.0);
  notes.push_back("autopilots calibrate against 9.80665 m/s^2, and gravity here is " + io::brief(array.gravity.g_mps2) +
                  ": a scale common to all sensors of " + io::brief(1e6 * off, 3) + " ppm is allowed for, 1 sigma");
  return off;
}

/// In the covariance of the array, as the priors of a datasheet are.
Calibration calibration_of(const io::ArrayFile& array, const std::vector<SensorStatement>& sensors,
                           const TemperatureSpan& span, double common_scale) {
  Datasheet stated = array.datasheet;
  for (const SensorStatement& one : sensors) {
    DatasheetSensor& sensor = stated.sensor[at(one.sensor)];
    sensor.row.axis = one.axis;
    sensor.row.sigma_mps2 *= std::fabs(sensor.coefficients.scale[0] / one.model.scale[0]);
    sensor.coefficients = one.model;
    sensor.prior.bias_mps2 = *one.sigma.bias_mps2;
    sensor.prior.scale = *one.sigma.scale;
    sensor.prior.axis_rad = *one.sigma.axis_rad;
  }
  const Expected<SensorArray> rows = stated.array();
  if (!rows) {
    io::FileError error = io::from_error(rows.error());
    error.file = array.path;
    throw io::Refusal(error);
  }
  Calibration out;
  out.model = stated.model();
  out.array = *rows;
  RowUncertainty uncertainty = stated.uncertainty();
  uncertainty.common_scale = common_scale;
  out.array.set_uncertainty(uncertainty);
  FitReport& report = out.report;
  report.parameters = 4 * stated.size;
  report.temperature_min_degc = span.min_degc;
  report.temperature_max_degc = span.max_degc;
  const double g_mps2 = array.gravity.g_mps2;
  for (int i = 0; i < stated.size; ++i) {
    double along = 0.0;
    for (int k = 0; k < 4; ++k) {
      const double variance = out.array.row_covariance(4 * i + k, 4 * i + k);
      report.sigma[at(4 * i + k)] = std::sqrt(variance);
      along += k < 3 ? variance : 0.0;
    }
    const double bias = report.sigma[at(4 * i + 3)];
    report.e_cal_mps2[at(i)] = std::sqrt(g_mps2 * g_mps2 * along / 3.0 + bias * bias);
  }
  return out;
}

/// Which files, in the words of the calibration file.
void note_origin(const std::vector<CoefficientFile>& files, Adoption& out) {
  std::vector<std::string> forms, names;
  std::string hashes;
  for (const CoefficientFile& file : files) {
    const std::string form = to_string(file.form);
    if (std::find(forms.begin(), forms.end(), form) == forms.end()) forms.push_back(form);
    names.push_back(io::last_part(file.path));
    out.bytes += file.bytes;
    hashes += std::to_string(file.hash) + "\n";
    for (const std::string& note : file.notes) out.notes.push_back(names.back() + ": " + note);
  }
  out.forms = io::joined(forms);
  out.file_name = io::joined(names);
  out.hash = files.size() == 1 ? files.front().hash : io::fnv1a(hashes.data(), hashes.size());
}

Adoption adopted(const io::ArrayFile& array, const std::vector<CoefficientFile>& files, const AdoptionChoice& choice) {
  Adoption out;
  if (files.empty()) refuse_adoption("--from", "", "names no file", "give a file of coefficients", io::ExitCode::usage);
  note_origin(files, out);
  check_forms(files);
  check_not_applied(array, files, out.notes);
  std::vector<SensorStatement> found;
  place_all(array, files, choice.instances, out, found);
  for (const CoefficientFile& file : files) found.insert(found.end(), file.sensors.begin(), file.sensors.end());
  out.sensors = in_order(array, found, out.file_name);
  for (SensorStatement& one : out.sensors) {
    complete(array, choice.usual, one);
    check_plausible(array, one);
  }
  out.span = span_of(array, out.sensors, choice, out.notes);
  out.common_scale = common_scale_of(array, files, out.notes);
  out.calibration = calibration_of(array, out.sensors, out.span, out.common_scale);
  return out;
}

}  // namespace

io::FileExpected<Adoption> adopt(const io::ArrayFile& array, const std::vector<CoefficientFile>& files,
                                 const AdoptionChoice& choice) {
  try {
    return adopted(array, files, choice);
  } catch (const io::Refusal& refusal) {
    io::FileError error = refusal.error();
    if (error.file.empty() && !files.empty()) error.file = files.front().path;
    return tl::unexpected<io::FileError>(error);
  }
}

io::FileExpected<void> save_adoption(const std::string& path, const Adoption& adoption, const io::ArrayFile& array,
                                     const std::string& date, const std::string& serial) {
  io::CalibrationContext context;
  context.date = date;
  context.serial = serial;
  context.log_file = adoption.file_name;
  context.log_bytes = adoption.bytes;
  context.log_hash = adoption.hash;
  context.coefficients = adoption.forms;
  context.plumb_version = PLUMB_VERSION;
  context.gravity = array.gravity;
  return io::write_calibration(path, adoption.calibration, array, context);
}

}  // namespace coefficients
}  // namespace PLUMB_ABI
}  // namespace plumb
