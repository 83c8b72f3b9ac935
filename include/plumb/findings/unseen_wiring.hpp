/// Wirings that gravity cannot see: exchanged and reversed channels that amount to a turn or a mirror image of the
/// whole array. A calibration fits them as well as the right one, so that only a station of known attitude shows them.
/// Sensors have the axes of the datasheet, but for what a fit may turn them; a fit shows where the channels have
/// theirs.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "plumb/array/wiring.hpp"
#include "plumb/calibration/calibration.hpp"
#include "plumb/core/vec3.hpp"
#include "plumb/io/array_file.hpp"
#include "plumb/io/calibration_file.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace findings {

struct UnseenWiring {
  Wiring wiring;
  Mat3 turn{};  ///< orthogonal: where down is d, such a tool shows turn * d
  /// How far off that may be: 5 deg, for the turn of the datasheet axes; more where an axis lies further from where the
  /// wiring puts it, or a turn that is listed with this one shows more. A station excludes the wiring beyond this only.
  double known_to_rad = 0.0;
};

/// How far an axis may lie from where a wiring puts it, so that a calibration takes that for an error of mounting: what
/// an accepted fit may turn an axis, whatever its prior (docs/calibration.md).
inline const double kUnseenAxis_rad = FitOptions{}.max_axis_change_rad;

/// The turn or mirror image that `wiring` amounts to, if the channels of a recording show the axes `shown` and the
/// sensors have those of `nominal`: without a fit the same array. Nothing where an axis lies further than the tolerance
/// from it, so that a calibration refuses it, and where the turn itself is too small for a known attitude to show.
std::optional<Mat3> unseen_turn(const SensorArray& nominal, const SensorArray& shown, const Wiring& wiring,
                                double tolerance_rad) noexcept;

/// All of them but the right one, one for each turn or mirror image: every combination of exchanged and reversed
/// channels is tried. That all channels are reversed (`reads` the wrong way round) is always among them.
std::vector<UnseenWiring> unseen_wirings(const SensorArray& nominal, const SensorArray& shown, double tolerance_rad);

/// A station of known attitude, and what the fit shows there.
struct MeasuredAttitude {
  io::KnownAttitude stated;
  Vec3 down{};  ///< by the fit, in the frame of the tool
};

/// `open`: another wiring explains the fit as well. `contradicted`: the right one does not.
enum class WiringStatus : std::uint8_t { open, confirmed, contradicted };
const char* to_string(WiringStatus status) noexcept;

/// An attitude at which every wiring that is left shows another direction.
struct SeparatingAttitude {
  double inclination_deg = 0.0, toolface_deg = 0.0;
  double separation_deg = 0.0;  ///< between what the right wiring shows there and any other
};

struct WiringCheck {
  WiringStatus status = WiringStatus::open;
  std::vector<UnseenWiring> unseen;        ///< for the datasheet axes, and for those of the fit
  std::vector<std::size_t> left;           ///< of those, the ones that no station contradicts
  std::vector<MeasuredAttitude> measured;  ///< the stations that were given
  SeparatingAttitude take;                 ///< what to record
};

/// `fitted`: the axes that the channels showed, null without a calibration. With sensors whose true axes lie off the
/// datasheet's, a wiring may be unseen that is seen of exact ones (docs/theory.md, section 1.5). By how much these axes
/// have been turned into the housing, a station must tell another wiring apart by more.
WiringCheck check_wiring(const io::ArrayFile& array, const SensorArray* fitted, std::vector<MeasuredAttitude> measured);

/// The known attitudes with the directions of their stations in a fit (`down`, by station). The error is the first
/// station that has none.
tl::expected<std::vector<MeasuredAttitude>, io::KnownAttitude> measured_attitudes(
    const std::vector<io::KnownAttitude>& known, const std::vector<Vec3>& down);

/// The stations of known attitude that a calibration file states, and those of the array file that it has a station
/// for. Null, or a file that keeps no attitudes: none.
std::vector<MeasuredAttitude> measured_attitudes_of(const io::CalibrationFile* file, const io::ArrayFile& array);

/// What a calibration file knows of the wiring, by those stations.
WiringCheck check_wiring_of(const io::CalibrationFile* file, const io::ArrayFile& array);

}  // namespace findings
}  // namespace PLUMB_ABI
}  // namespace plumb
