/// All that `plumb geometry` has to say about one array, before it becomes text, JSON or pictures.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "plumb/array/common_bias.hpp"
#include "plumb/array/wiring.hpp"
#include "plumb/detection/one_attitude.hpp"
#include "plumb/detection/thresholds.hpp"
#include "plumb/io/array_file.hpp"
#include "plumb/report/geometry_plot.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace cli {

/// What is judged: an array file, or a built-in geometry with a noise.
struct GeometrySubject {
  std::string name;
  std::unique_ptr<const io::ArrayFile> file;  ///< null for a built-in geometry
  SensorArray array;                          ///< calibrated, where a calibration was given
  SensorModel model;                          ///< of a file: raw values to m/s^2
  bool calibrated = false;
  GravityReference gravity;
  TestSettings settings;
};

/// What a sensor shows while the tool stands or lies; a mistake of sign or column is seen here.
struct ExpectedReading {
  double down_mps2[3] = {};  ///< along the axis, gravity sense: vertical; horizontal at toolface 0 and 90 deg
  double raw[3] = {};        ///< the same as the log would have it
};

/// A wiring mistake that neither parity nor the length of gravity can see, at any attitude.
struct HiddenWiring {
  std::string what;  ///< "a1 and a2 swapped"
  WiringEffect effect;
};

/// Something that a user has to know, by name.
struct Finding {
  const char* name;
  std::string text;
};

/// One attitude, from the map: shares of the sphere.
struct MapSummary {
  double blind_share = 0.0;       ///< of attitudes at which some sensor is blind
  double least_clear_mps2 = 0.0;  ///< at the best attitude
  double largest_clear_mps2 = 0.0;
  double best_inclination_deg = 0.0, best_toolface_deg = 0.0;
};

struct SensorStudy {
  std::string id;
  ExpectedReading expected;
  double blind_half_width_mps2 = 0.0;
  double any_attitude_mps2 = 0.0;
  double nearest_remount_rad = 0.0;  ///< from the axis to its nearest mirror axis; 0 where there is none
};

struct GeometryStudy {
  FiguresOfMerit merit;
  FaultBounds constants;  ///< in units of e
  ErrorBudget budget;
  Thresholds thresholds;
  CommonBias common;
  PolarityPlan polarity;
  int collusion_grade = 0;  ///< largest m with n >= 2m + c + 1
  std::vector<SensorStudy> sensors;
  std::vector<HiddenWiring> hidden;
  std::vector<report::GeometryPictures::Level> levels;
  std::vector<report::GeometryPictures::Point> map;
  MapSummary one_attitude;
  std::vector<Finding> warnings;  ///< `--check` refuses these
  std::vector<Finding> limits;    ///< known limits of such an array
};

/// How the array file has its array judged, so many days after the calibration.
TestSettings settings_of(const io::ArrayFile& array, double days_since_calibration = 0.0);

/// How many mistakes of wiring show at no attitude, by the nominal axes.
int hidden_wiring_count(const io::ArrayFile& array);

GeometryStudy study_geometry(const GeometrySubject& subject);

std::string geometry_text(const GeometrySubject& subject, const GeometryStudy& study);
std::string geometry_json(const GeometrySubject& subject, const GeometryStudy& study);

}  // namespace cli
}  // namespace PLUMB_ABI
}  // namespace plumb
