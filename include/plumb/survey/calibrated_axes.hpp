/// The axes of calibrated magnetometers in the frame of calibrated accelerometers.
///
/// Each calibration leaves a common rotation of its axes open. At stations that both have seen, the dip shows the one
/// between the two: joint_alignment.hpp, with the vectors of the two calibrations for readings.
#pragma once

#include <vector>

#include "plumb/calibration/calibration.hpp"
#include "plumb/io/field.hpp"
#include "plumb/survey/joint_alignment.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace survey {

/// A group of sensors on the tool; figures of magnetometers are in units of 4 uT (plumb/io/field.hpp).
struct CalibratedGroup {
  const Calibration& calibration;
  GravityReference reference;
  const std::vector<Station>& stations;
};

/// Stations that both groups held still in, and what is known of them.
struct CommonStations {
  std::vector<ReferencedStation> stations;
  ToolErrors tool;  ///< what the two calibrations leave: as biases and, in proportion, as scales
};

/// Each station of the magnetometers with the first of the accelerometers that shares time with it; those that have
/// none, or where either group has no vector, are left out. The covariance of a vector is that of the noise of its
/// means, and of the misfit of its calibration.
CommonStations common_stations(const CalibratedGroup& accelerometers, const CalibratedGroup& magnetometers,
                               const io::MagneticReference& field);

/// `stated_rad`: 1 sigma about each axis, of what the axes of the datasheet say of the rotation.
tl::expected<JointAlignment, AlignmentRefusal> align_axes(const CommonStations& common,
                                                          const io::MagneticReference& field, double stated_rad);

/// Of the rotation alone, row-major 3 x 3 [rad^2], symmetric to the bit.
std::array<double, 9> rotation_covariance(const JointAlignment& alignment) noexcept;

}  // namespace survey
}  // namespace PLUMB_ABI
}  // namespace plumb
