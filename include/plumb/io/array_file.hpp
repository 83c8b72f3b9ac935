/// The array file (TOML): one array of sensors, where it is, how its log looks, how it is watched.
/// Contract: docs/array-file.md, "The array file".
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "plumb/array/sensor_array.hpp"
#include "plumb/calibration/datasheet.hpp"
#include "plumb/core/vec3.hpp"
#include "plumb/gravity/gravity.hpp"
#include "plumb/health/monitor_config.hpp"
#include "plumb/health/stability.hpp"
#include "plumb/io/array_motion.hpp"
#include "plumb/io/field.hpp"
#include "plumb/io/file_error.hpp"
#include "plumb/io/known_attitude.hpp"
#include "plumb/io/units.hpp"
#include "plumb/motion/rate_monitor.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace io {

enum class RowKind : std::uint8_t { samples, stations };
const char* to_string(RowKind rows) noexcept;

/// Only rows whose `column` holds this value are read ([input] where).
struct ColumnFilter {
  std::string column;
  std::string text;  ///< as written
  double number = 0.0;
  bool numeric = false;  ///< compare as numbers (1 == 1.0) rather than as text
};

/// [input] and the `column` keys of the sensors.
struct InputSpec {
  RowKind rows = RowKind::samples;
  std::string time_column;        ///< empty: time follows from `rate_hz`, or is the row number (stations)
  double time_unit_s = 1.0;       ///< seconds per unit of the time column
  double rate_hz = 0.0;           ///< 0: not given
  std::string station_column;     ///< empty: none
  std::string roll_group_column;  ///< empty: none; stations of one group share an inclination
  std::string count_column;       ///< empty: every row stands for one sample
  /// The autopilot has applied its own calibration to the readings: it is not adopted a second time.
  bool corrected = false;
  std::string temperature_column;  ///< empty: every row gets `default_temperature_degc`
  double default_temperature_degc = 25.0;
  std::vector<std::string> rotation_columns;  ///< x, y, z of the rate of turn [rad/s], tool frame; empty: not logged
  std::vector<std::string> second_rotation_columns;  ///< the same of a second gyro, for motion; empty: none
  std::vector<std::string> clock_columns;            ///< one a [[clock]], may repeat: the time by it, in `time_unit_s`
  std::string depth_column;                          ///< measured depth, for reports; empty: not logged
  double depth_unit_m = 1.0;                         ///< metres per unit of that column
  std::vector<ColumnFilter> where;
  std::vector<KnownAttitude> known_attitudes;  ///< stations of the calibration log
  RawUnit unit;
  std::vector<std::string> sensor_columns;  ///< one per sensor, in the order of the array
};

inline constexpr Mat3 kIdentity3 = {1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0};

/// What a length was computed from, for whoever needs it elsewhere: a survey at the depth of each station.
struct ReferenceBasis {
  std::optional<NormalGravityInput> normal_gravity;  ///< of gravity by the model "normal"
  std::optional<MagneticPlace> place;                ///< of a field by the model "wmm"
  /// Which sigmas of a field the file states: else they are the usual ones, or the model's.
  bool total_sigma_stated = false, dip_sigma_stated = false;
};

/// One group of sensors that measure one vector. The accelerometers of a file, with its other groups beside them, or
/// one of those: then figures "in m/s^2" are in the group's inside unit (plumb/io/field.hpp).
struct ArrayFile {
  std::string path;  ///< of a group: with its name, "tool.toml#magnetometers"
  std::string name;
  std::string group;  ///< empty: the accelerometers of the file
  FieldKind field = FieldKind::gravity;
  MagneticReference magnetic;     ///< of a magnetic group; its length is in `gravity` too
  RateSetup rate;                 ///< of a rate group
  std::vector<ArrayFile> groups;  ///< the [[group]]s of the file, beside its accelerometers only
  Datasheet datasheet;
  SensorArray array;         ///< nominal axes, checked
  GravityReference gravity;  ///< length of the vector at rest
  MonitorConfig monitor;
  InputSpec input;
  std::array<Stability, kCapacity> stability{};  ///< of each sensor since its calibration; all zero: not stated
  std::vector<Vec3> lever_arm_m;     ///< of each sensor from the axis of rotation, tool frame; empty: not known
  std::vector<std::string> package;  ///< the chip that each sensor is on; empty: not stated, of one or of all
  MotionSpec motion;                 ///< what is judged while the tool moves
  Mat3 output_frame = kIdentity3;    ///< rows; applied to vectors at output only
  std::uint64_t fingerprint = 0;     ///< binds a calibration to this array, see fingerprint_of
  std::string text;                  ///< the file as read
  ReferenceBasis basis;              ///< of `gravity`, or of `magnetic`
};

/// "tool.toml#NAME" is the [[group]] of that name. `lookup` answers where a magnetic group states a place and a date;
/// without one it is refused.
FileExpected<ArrayFile> read_array_file(const std::string& path, const FieldLookup& lookup = {});

/// The same from text; `path` is used in messages only.
FileExpected<ArrayFile> parse_array_text(const std::string& text, const std::string& path,
                                         const FieldLookup& lookup = {}, const std::string& group = "");

/// Empty where the sensor states none.
std::string package_of(const ArrayFile& array, int sensor);

/// The sensors that state no stability.
SensorSet without_stability(const ArrayFile& array) noexcept;

/// tau of every sensor so many days after its calibration, at its reference temperature and with that at rest: what the
/// limits of a monitor allow for at least.
Readings tolerance_mps2(const ArrayFile& array, double days_since_calibration) noexcept;

/// The keys that state it, one a line, as the reader takes them; empty where nothing is stated.
std::string stability_toml(const Stability& stability);

/// FNV-1a (64 bit) over ids, axes, nominal coefficients, `reads` and the field: what a calibration depends on.
/// Names, limits, noise, priors, stability and the layout of the log do not enter.
std::uint64_t fingerprint_of(const Datasheet& datasheet, FieldKind field = FieldKind::gravity) noexcept;

}  // namespace io
}  // namespace PLUMB_ABI
}  // namespace plumb
