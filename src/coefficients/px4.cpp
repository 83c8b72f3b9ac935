// PX4: corrected = (reading - thermal offset - offset) times scale, in the axes of the chip
// (sensor_calibration::Accelerometer::Correct), with a thermal offset that is a cubic of the temperature
// (TemperatureCompensation).
#include "../io/text_tools.hpp"
#include "parameter_file.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace coefficients {
namespace {

constexpr int kMostInstances = 10;
constexpr int kThermalSlots = 4;
constexpr const char* kAxis = "XYZ";

/// Adds the thermal offset of the slot that has the id of the chip.
void add_thermal(const Parameters& parameters, double id, ChipCoefficients& chip, std::vector<std::string>& notes) {
  for (int slot = 0; slot < kThermalSlots; ++slot) {
    const std::string prefix = "TC_A" + std::to_string(slot) + "_";
    if (id == 0.0 || parameters.value_or(prefix + "ID", 0.0) != id) continue;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::string axis = std::to_string(k);
      const std::string scale = prefix + "SCL_" + axis;
      if (parameters.value_or(scale, 1.0) != 1.0)
        parameters.refuse(scale, "scales the axis beside CAL_ACC, as older firmware does",
                          "state the coefficients as csv");
      for (std::size_t order = 0; order < 4; ++order)
        chip.offset[order][k] += parameters.need(prefix + "X" + std::to_string(order) + "_" + axis);
    }
    chip.reference_degc = parameters.need(prefix + "TREF");
    chip.span = TemperatureSpan{parameters.need(prefix + "TMIN"), parameters.need(prefix + "TMAX")};
    if (!(chip.span->min_degc <= chip.span->max_degc))
      parameters.refuse(prefix + "TMAX", "is below " + prefix + "TMIN", "calibrate the temperature drift again");
    return;
  }
  notes.push_back(chip.name + " has no thermal offset, though TC_A_ENABLE is 1");
}

void note_unused(const Parameters& parameters, const std::string& name, std::vector<std::string>& notes) {
  const double rotation = parameters.value_or(name + "_ROT", -1.0);
  if (rotation > 0.0)
    notes.push_back(name + "_ROT is " + io::brief(rotation) +
                    " and is not taken over: the axes are those of the array file");
  const bool disabled =
      parameters.value_or(name + "_EN", 1.0) == 0.0 || parameters.value_or(name + "_PRIO", 50.0) == 0.0;
  if (disabled) notes.push_back(name + " is disabled in the vehicle; its coefficients are taken all the same");
}

}  // namespace

std::vector<ChipCoefficients> px4_chips(const Parameters& parameters, std::vector<std::string>& notes) {
  std::vector<ChipCoefficients> out;
  for (int instance = 0; instance < kMostInstances; ++instance) {
    ChipCoefficients chip;
    chip.instance = instance;
    chip.name = parameter_prefix(Form::px4, instance);
    // A slot that no chip has is id 0, with the other parameters at their defaults.
    const double id = parameters.value_or(chip.name + "_ID", 0.0);
    const bool stated = parameters.has(chip.name + "_XOFF") && !parameters.has(chip.name + "_ID");
    if (id == 0.0 && !stated) continue;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::string scale = chip.name + "_" + kAxis[k] + "SCALE";
      chip.offset[0][k] = parameters.need(chip.name + "_" + kAxis[k] + "OFF");
      chip.matrix[4 * k] = parameters.need(scale);
      if (!(chip.matrix[4 * k] > 0.0))
        parameters.refuse(scale, "is " + io::brief(chip.matrix[4 * k]) + ", must be above 0",
                          "calibrate the accelerometers of the vehicle again");
    }
    if (is_untouched(chip)) notes.push_back(chip.name + kUntouched);
    note_unused(parameters, chip.name, notes);
    if (parameters.value_or("TC_A_ENABLE", 0.0) == 1.0) add_thermal(parameters, id, chip, notes);
    out.push_back(chip);
  }
  return out;
}

}  // namespace coefficients
}  // namespace PLUMB_ABI
}  // namespace plumb
