/// All that `plumb geometry` has to say about one array, before it becomes text, JSON or pictures.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "plumb/array/common_bias.hpp"
#include "plumb/array/wiring.hpp"
#include "plumb/detection/one_attitude.hpp"
#include "plumb/detection/thresholds.hpp"
#include "plumb/findings/detection_sizes.hpp"
#include "plumb/findings/finding.hpp"
#include "plumb/io/array_file.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace findings {

/// What is judged: an array file, or a built-in geometry with a noise.
struct GeometrySubject {
  std::string name;
  std::unique_ptr<const io::ArrayFile> file;  ///< null for a built-in geometry
  SensorArray array;                          ///< calibrated, where a calibration was given
  SensorModel model;                          ///< of a file: raw values to m/s^2
  bool calibrated = false;
  Visited visited;  ///< attitudes of the stations of the calibration, where it keeps them
  GravityReference gravity;
  TestSettings settings;
  io::FieldKind field() const noexcept { return file ? file->field : io::FieldKind::gravity; }
};

/// What a sensor shows while the tool stands or lies; a mistake of sign or column is seen here.
struct ExpectedReading {
  double down_mps2[3] = {};  ///< along the axis, gravity sense: vertical; horizontal at toolface 0 and 90 deg
  double raw[3] = {};        ///< the same as the log would have it
};

/// A wiring mistake that neither parity nor the length of gravity can see, at any attitude.
struct HiddenWiring {
  enum class Kind : std::uint8_t { reversed, exchanged, exchanged_and_reversed, turned };
  Kind kind = Kind::reversed;
  std::array<int, 3> sensor{-1, -1, -1};  ///< turned: each carries the channel of the next, the last that of the first
  WiringEffect effect;
};

/// One attitude of a regular grid; toolface varies fastest. Of a magnetic group the attitude is that of the field.
struct AttitudePoint {
  double inclination_deg = 0.0, toolface_deg = 0.0;
  double guaranteed_above_g0 = 0.0;  ///< every larger fault of one sensor is isolated here
  double nearest_mirror_g0 = 0.0;    ///< least fault with a second explanation of the right length
  int not_guaranteed_sensors = 0;
};

/// The protection level of the same axes with another noise.
struct ProtectionPoint {
  double sigma_fine = 0.0;  ///< noise of a sample in the fine unit of the field: mg0, nT
  double one_sample_deg = 0.0, block_deg = 0.0;
};

/// One attitude, from the map: shares of the sphere.
struct MapSummary {
  double not_guaranteed_share = 0.0;  ///< of attitudes without guaranteed isolation of some sensor
  double least_clear_mps2 = 0.0;      ///< at the best attitude
  double largest_clear_mps2 = 0.0;
  double best_inclination_deg = 0.0, best_toolface_deg = 0.0;
};

struct SensorStudy {
  std::string id;
  ExpectedReading expected;
  double blind_half_width_mps2 = 0.0;
  double any_attitude_mps2 = 0.0;
  double guaranteed_isolation_mps2 = 0.0;  ///< over E attitudes
  double nearest_remount_rad = 0.0;        ///< from the axis to its nearest mirror axis; 0 where there is none
};

/// The worst case of so many faulty sensors, in errors e of a healthy reading (T7): any attitude, any values of the
/// other faulty ones. Not finite where there is no such figure.
struct WorstCase {
  int faults = 0;
  double detected = 0.0;    ///< above it
  double told_apart = 0.0;  ///< above it
  double vector_error = 0.0;
};

struct GeometryStudy {
  FiguresOfMerit merit;
  FaultBounds constants;  ///< in units of e
  ErrorBudget budget;
  Thresholds thresholds;
  Readings full_scale_mps2{};  ///< of each sensor; 0 where none is stated
  SizeTable sizes;
  CommonBias common;
  PolarityPlan polarity;
  int correlated_grade = 0;      ///< largest m with n >= 2m + c + 1
  std::vector<WorstCase> worst;  ///< of one fault and more
  std::vector<SensorStudy> sensors;
  std::vector<HiddenWiring> hidden;
  std::vector<ProtectionPoint> levels;
  std::vector<AttitudePoint> map;
  MapSummary one_attitude;
  std::vector<Finding> warnings;  ///< `--check` refuses these
  std::vector<Finding> limits;    ///< known limits of such an array
};

/// How the array file has its array judged, so many days after the calibration.
TestSettings settings_of(const io::ArrayFile& array, double days_since_calibration = 0.0);

/// By the nominal scale; 0 where the array file states none.
Readings full_scale_of(const io::ArrayFile& array);

/// How many mistakes of wiring show at no attitude, by the nominal axes.
int hidden_wiring_count(const io::ArrayFile& array);

GeometryStudy study_geometry(const GeometrySubject& subject);

}  // namespace findings
}  // namespace PLUMB_ABI
}  // namespace plumb
