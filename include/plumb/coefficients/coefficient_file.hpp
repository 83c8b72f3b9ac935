/// Coefficients of accelerometers that somebody else has found: what a maker's certificate, the parameters of an
/// autopilot or a file of imu_tk says of each sensor. Readers only; what becomes of it is in adoption.hpp. Contract:
/// docs/calibration.md, "Known coefficients".
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "plumb/calibration/sensor_model.hpp"
#include "plumb/core/vec3.hpp"
#include "plumb/io/array_file.hpp"
#include "plumb/io/file_error.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace coefficients {

enum class Form : std::uint8_t {
  px4,        ///< CAL_ACC* of a parameter file (QGroundControl, or name and value a line)
  ardupilot,  ///< INS_ACC* of a parameter file
  imu_tk,     ///< misalignment, scale and bias of one chip
  csv,        ///< plumb's own table, one row a sensor
  json        ///< the same as JSON
};
inline constexpr std::array<Form, 5> kForms = {Form::px4, Form::ardupilot, Form::imu_tk, Form::csv, Form::json};
const char* to_string(Form form) noexcept;
std::optional<Form> form_of(std::string_view word) noexcept;
/// Whether it speaks of chips by number rather than of sensors by id.
constexpr bool is_of_chips(Form form) noexcept { return form != Form::csv && form != Form::json; }

/// 1 sigma of what is stated; empty where nothing is.
struct Uncertainty {
  std::optional<double> bias_mps2;
  std::optional<double> scale;     ///< relative
  std::optional<double> axis_rad;  ///< about each of the two directions across the axis
};

/// Temperatures over which coefficients and uncertainty hold [degC].
struct TemperatureSpan {
  double min_degc = 0.0, max_degc = 0.0;
};

/// What the numbers are that the coefficients of a chip correct.
enum class ReadingUnit : std::uint8_t {
  mps2,  ///< m/s^2 as the driver gives them: log values over the nominal scale, less the nominal bias
  log    ///< the values of the log
};

inline constexpr Mat3 kNoTurn = {1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0};

/// a = matrix (reading - offset(T)) along x, y and z of a chip, offset(T) = sum of offset[k] (T - reference)^k.
struct ChipCoefficients {
  int instance = 0;  ///< as the form counts: PX4 from 0, ArduPilot from 1, files of imu_tk from 1 in their order
  std::string name;  ///< in messages: "CAL_ACC0", "INS_ACC2", a path
  Mat3 matrix = kNoTurn;
  std::array<Vec3, 4> offset{};
  double reference_degc = std::numeric_limits<double>::quiet_NaN();  ///< NaN: the offset states no temperature
  std::optional<TemperatureSpan> span;
  ReadingUnit unit = ReadingUnit::mps2;

  bool has_temperature_terms() const noexcept { return reference_degc == reference_degc; }
  /// No axis depends on another.
  bool is_diagonal() const noexcept;
};

/// What is stated of one sensor of the array, in plumb's model.
struct SensorStatement {
  int sensor = 0;      ///< of the array
  std::string source;  ///< in messages: "cert.csv:3", "CAL_ACC0 x"
  SensorCoefficients model;
  Vec3 axis{};  ///< unit, tool frame
  Uncertainty sigma;
  std::optional<TemperatureSpan> span;
};

struct CoefficientFile {
  std::string path;
  Form form = Form::csv;
  std::vector<ChipCoefficients> chips;   ///< of forms of chips
  std::vector<SensorStatement> sensors;  ///< of csv and json
  std::vector<std::string> notes;        ///< what is not taken over, a sentence each
  std::uint64_t bytes = 0, hash = 0;     ///< FNV-1a of the file
};

/// Larger files are refused before they are read: no file of coefficients has 16 MiB.
inline constexpr std::uint64_t kLargestFile = std::uint64_t{16} << 20U;

/// `form` empty: found out from the content. `file_number`: of imu_tk files, from 1. Refuses, with line, field and
/// remedy: what is of another form, parameters that are missing or no numbers, scales of 0 or below in autopilots'
/// forms, sensors that the array does not have, keys that are not known.
io::FileExpected<CoefficientFile> read_coefficients(const std::string& path, const io::ArrayFile& array,
                                                    std::optional<Form> form = std::nullopt, int file_number = 1);

/// The same of text; `path` is used in messages only.
io::FileExpected<CoefficientFile> parse_coefficients(const std::string& text, const std::string& path,
                                                     const io::ArrayFile& array,
                                                     std::optional<Form> form = std::nullopt, int file_number = 1);

/// Parameters by name, as a log of the autopilot holds them. Others than those of accelerometers may be among them.
/// `form`: px4 or ardupilot.
io::FileExpected<CoefficientFile> coefficients_of(const std::map<std::string, double>& parameters, Form form,
                                                  const std::string& path);

/// "bias=5 mg, scale=1000 ppm, axis=0.5 deg"; any of them may be absent. Each above 0 and at most `kMostSigma...`.
io::FileExpected<Uncertainty> parse_uncertainty(std::string_view text);

/// Beyond these a statement says too little for the limits of a monitor [m/s^2, 1, rad].
inline constexpr double kMostSigmaBias_mps2 = 0.1 * 9.80665;
inline constexpr double kMostSigmaScale = 0.1;
inline constexpr double kMostSigmaAxis_rad = 0.1;

}  // namespace coefficients
}  // namespace PLUMB_ABI
}  // namespace plumb
