/// How far the frame of the calibrated axes may be turned from that of the housing. Gravity does not show it: a common
/// rotation of all axes leaves every reading as it is. What is known of it stands in the datasheet's axes, in roll
/// groups and in stations of known attitude (docs/theory.md, section 1.6). It holds for the stated wiring.
#pragma once

#include <cstdint>
#include <vector>

#include "plumb/findings/unseen_wiring.hpp"
#include "plumb/io/array_file.hpp"
#include "plumb/io/calibration_file.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace findings {

enum class AlignmentSource : std::uint8_t { stated, datasheet, roll_groups, known_attitudes, dip };
const char* to_string(AlignmentSource source) noexcept;

/// A bound on the angle of the turn, about any axis.
struct Alignment {
  double bound_rad = 0.0;                               ///< pi: nothing is known
  AlignmentSource source = AlignmentSource::datasheet;  ///< what it rests on
};

/// `alignment_bound` of the array file where that states one. Else the least that follows from the prior of the axes,
/// or the roll groups of the fit, to all but the integrity risk, and from the known attitudes, with what the fit shows
/// there. `calibration` null: the axes in use are the datasheet's.
Alignment alignment_of(const io::ArrayFile& array, const Calibration* calibration,
                       const std::vector<MeasuredAttitude>& measured);
/// The same of a calibration file, or of none. Of magnetometers that were aligned by the dip: what that leaves, to all
/// but the integrity risk, on top of what the accelerometers' own frame leaves.
Alignment alignment_of(const io::ArrayFile& array, const io::CalibrationFile* file);

/// The array as a monitor is set up from it: that bound is its `alignment_bound`.
io::ArrayFile with_alignment(const io::ArrayFile& array, const io::CalibrationFile* file);

}  // namespace findings
}  // namespace PLUMB_ABI
}  // namespace plumb
