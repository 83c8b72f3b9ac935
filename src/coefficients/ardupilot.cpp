// ArduPilot: corrected = (reading - P(T) + P(T_cal) - offset) times scale, in the axes of the chip as its driver turns
// them (AP_InertialSensor_Backend::_rotate_and_correct_accel, AP_InertialSensor_TCal::correct_sensor), P a cubic of
// T - 35 degC without a constant.
#include <algorithm>

#include "../io/text_tools.hpp"
#include "parameter_file.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace coefficients {
namespace {

constexpr int kMostInstances = 5;
constexpr double kReference_degc = 35.0;
/// Of the coefficients in INS_TCALn_ACCk.
constexpr double kUnit = 1e-6;
constexpr double kNotCalibrated_degc = -300.0;
constexpr const char* kAxis = "XYZ";

/// How the parameters of one accelerometer are called; they have other names from the fourth on.
struct Names {
  explicit Names(int instance) {
    const std::string number = std::to_string(instance);
    const bool late = instance > 3;
    chip = parameter_prefix(Form::ardupilot, instance);
    temperature = late ? "INS" + number + "_ACC_CALTEMP" : "INS_ACC" + number + "_CALTEMP";
    thermal = late ? "INS" + number + "_TCAL_" : "INS_TCAL" + number + "_";
  }
  std::string chip, temperature, thermal;
};

void add_thermal(const Parameters& parameters, const Names& names, ChipCoefficients& chip) {
  const TemperatureSpan span{parameters.need(names.thermal + "TMIN"), parameters.need(names.thermal + "TMAX")};
  if (!(span.min_degc <= span.max_degc))
    parameters.refuse(names.thermal + "TMAX", "is below " + names.thermal + "TMIN",
                      "calibrate the temperature drift again");
  const double calibrated_degc =
      std::clamp(parameters.value_or(names.temperature, kNotCalibrated_degc), span.min_degc, span.max_degc);
  const double from = calibrated_degc - kReference_degc;
  for (std::size_t k = 0; k < 3; ++k) {
    double power = 1.0;
    for (std::size_t order = 1; order < 4; ++order) {
      const double coefficient =
          kUnit * parameters.need(names.thermal + "ACC" + std::to_string(order) + "_" + kAxis[k]);
      power *= from;
      chip.offset[order][k] = coefficient;
      chip.offset[0][k] -= coefficient * power;
    }
  }
  chip.reference_degc = kReference_degc;
  chip.span = span;
}

}  // namespace

std::vector<ChipCoefficients> ardupilot_chips(const Parameters& parameters, std::vector<std::string>& notes) {
  std::vector<ChipCoefficients> out;
  for (int instance = 1; instance <= kMostInstances; ++instance) {
    const Names names(instance);
    ChipCoefficients chip;
    chip.instance = instance;
    chip.name = names.chip;
    // Instances that the vehicle does not have are id 0, with the other parameters at their defaults.
    const bool stated = parameters.has(names.chip + "OFFS_X") && !parameters.has(names.chip + "_ID");
    if (parameters.value_or(names.chip + "_ID", 0.0) == 0.0 && !stated) continue;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::string scale = names.chip + "SCAL_" + kAxis[k];
      chip.offset[0][k] = parameters.need(names.chip + "OFFS_" + kAxis[k]);
      chip.matrix[4 * k] = parameters.need(scale);
      if (!(chip.matrix[4 * k] > 0.0))
        parameters.refuse(scale, "is " + io::brief(chip.matrix[4 * k]) + ", must be above 0",
                          "calibrate the accelerometers of the vehicle again");
    }
    if (is_untouched(chip)) notes.push_back(chip.name + kUntouched);
    const double thermal = parameters.value_or(names.thermal + "ENABLE", 0.0);
    if (thermal == 1.0) add_thermal(parameters, names, chip);
    if (thermal == 2.0)
      notes.push_back(names.thermal + "ENABLE is 2: the drift was being learned, and is not taken over");
    out.push_back(chip);
  }
  return out;
}

}  // namespace coefficients
}  // namespace PLUMB_ABI
}  // namespace plumb
