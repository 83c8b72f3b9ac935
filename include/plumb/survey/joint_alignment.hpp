/// How the magnetometers are turned against the accelerometers, from the dip at many stations.
///
/// Gravity calibrates one triad and the length of the field the other; either leaves a common rotation of its axes
/// open. The dip is the one figure in which both meet. With G and B the readings, R = exp(w) the rotation that brings
/// the magnetometers' frame into the accelerometers' (the tool frame), x the tool's errors and d what the references
/// are off by,
///   r_i = totals((G_i - b) / (1 + s), R (B_i - b) / (1 + s)) - reference_i - d
/// is minimised as in multi_station.hpp; w has no prior, nor has d of the dip where the dip is unknown. The dip changes
/// with w by -e_i . w, e_i magnetic east at station i in tool axes: each station gives one equation. So a rotation
/// about n shows in nothing where e_i . n = 0 at all stations, and, the dip unknown, where e_i . n is alike at all.
#pragma once

#include <string>
#include <vector>

#include "plumb/survey/multi_station.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace survey {

struct AlignmentSettings {
  ToolErrors tool = iscwsa_tool();  ///< what calibration left, alike at all stations: unknowns, these their priors
  bool dip_known = true;            ///< false: the references' dip may be off by any amount
  double stated_rad = rad_from_deg(0.5);  ///< 1 sigma about each axis, known beforehand. Judges; takes no part
  double misfit_false_alarm = 1e-6;       ///< of the chi-square of the residuals, and of a rotation beyond `stated_rad`
};

/// A principal axis of what the stations tell of the rotation.
struct AlignmentAxis {
  Vec3 direction{};              ///< unit vector, tool frame
  double sigma_rad = 0.0;        ///< of the rotation about it; infinite where nothing is told
  double sigma_alone_rad = 0.0;  ///< the same for a tool without errors of its own, of noise and references alone
  double seen = 0.0;  ///< rms over the stations of the component of magnetic east along it; about its mean, dip unknown
  double mean = 0.0;  ///< mean of that component
  double blur = 0.0;  ///< how sure that component is, rms
  std::string with;   ///< error that the rotation about it correlates with most; empty where there is none
  double correlation = 0.0;
  bool told = false;  ///< sigma_rad is below what is stated, and east turns by more than kUndefinedWithinSigmas blurs

  std::string name() const;  ///< "tool z", or "(0.71, 0.00, 0.71) of the tool"
};

enum class NoAlignment : std::uint8_t {
  too_few_stations,  ///< `value` of them, `limit` needed
  not_finite,        ///< station `value`
  no_random_error,   ///< station `value` states no noise: it cannot be weighed
  not_converged,
  not_observable,  ///< no error of the tool has to be blamed: the attitudes do not show the rotation about axes not
                   ///< told
  correlated,      ///< they would, but for errors of the tool that look alike
  misfit,          ///< chi-square `value`, at most `limit`: another error is in the data
  implausible,     ///< the rotation is `value` rad, and beyond what is stated: another error is in the data
};

/// Why there is none.
struct AlignmentRefusal {
  NoAlignment why = NoAlignment::too_few_stations;
  double value = 0.0;
  double limit = 0.0;  ///< not_observable, correlated: what is stated [rad], and `value` the sigma of the weakest axis
  bool dip_known = true;
  int rank = 0;                         ///< axes that are told
  std::array<AlignmentAxis, 3> axis{};  ///< not_observable, correlated: the weakest first

  std::string text() const;
};

/// Each station's dip, predicted from the others.
struct HeldOut {
  double rms_rad = 0.0;
  double normalised = 0.0;  ///< rms of residual over its sigma: 1 is as stated
  int worst = -1;           ///< station of the largest one; -1: none could be held out
  double worst_normalised = 0.0;
  int decisive = 0;  ///< stations without which the rest does not tell all axes: not among the above
};

inline constexpr std::size_t kAlignmentUnknowns = 3 + kTermCount;

struct JointAlignment {
  Mat3 rotation{};     ///< R: the field in the tool frame is R times the readings
  Vec3 turn_rad{};     ///< w, its rotation vector
  Vec3 sigma_rad{};    ///< 1 sigma about x, y and z of the tool frame
  TermValues value{};  ///< errors of the tool, near their prior, 0
  /// Of a further small rotation about x, y and z of the tool frame [rad] and of the terms; row-major.
  std::array<double, kAlignmentUnknowns * kAlignmentUnknowns> covariance{};
  double gravity_offset_mps2 = 0.0, field_offset_tesla = 0.0, dip_offset_rad = 0.0;  ///< of the references
  double dip_sigma_rad = 0.0;                                                        ///< of reference plus offset
  std::array<AlignmentAxis, 3> axis{};                                               ///< the weakest first
  double chi_square = 0.0;
  int freedom = 0;
  double chance = 1.0;  ///< of a chi-square as large
  int steps = 0;
  HeldOut held_out;
};

tl::expected<JointAlignment, AlignmentRefusal> align_magnetometers(const std::vector<ReferencedStation>& stations,
                                                                   const AlignmentSettings& settings);

/// The station with the tool's errors taken off and the field turned into the tool frame, and the covariance that is
/// left: random, and that of the alignment. For `judge_corrected`.
CorrectedStation aligned(const Measurement& station, const JointAlignment& alignment);

/// What the six components of the station so aligned change with a further small rotation about x, y and z of the tool
/// frame [rad] and with the terms, row-major 6 x 15.
using CarriedWeights = std::array<double, 6 * kAlignmentUnknowns>;
CarriedWeights alignment_weights(const Measurement& station, const JointAlignment& alignment);

}  // namespace survey
}  // namespace PLUMB_ABI
}  // namespace plumb
