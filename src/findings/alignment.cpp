#include "plumb/findings/alignment.hpp"

#include <algorithm>
#include <cmath>

#include "plumb/findings/frame_turn.hpp"
#include "plumb/numeric/symmetric_eigenvalues.hpp"
#include "plumb/numeric/tails.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace findings {
namespace {

/// A station of known attitude is a direction that is known no better than this.
constexpr double kSurestAttitude_rad = 1e-6;

/// Vectors w with (w - centre)' form (w - centre) at most `most`: how long they are at most.
double longest(Mat3 form, double most, double centre_rad) noexcept {
  double values[3] = {};
  if (!symmetric_eigenvalues(form.data(), 3, 3, values)) return HUGE_VAL;
  return values[0] > 0.0 ? centre_rad + std::sqrt(most / values[0]) : HUGE_VAL;
}

/// What stations of known attitude leave of a turn: the sum of one form for each, every one at most 1.
Mat3 of_attitudes(const io::ArrayFile& array, const std::vector<MeasuredAttitude>& measured) noexcept {
  Mat3 out{};
  for (const MeasuredAttitude& m : measured) {
    const Vec3 stated = io::down_of(m.stated, array.output_frame), d = scaled(m.down, 1.0 / norm(m.down));
    const double most = std::fmax(angle_between_rad(d, stated) + m.stated.tolerance_rad, kSurestAttitude_rad);
    for (std::size_t r = 0; r < 3; ++r) {
      for (std::size_t c = 0; c < 3; ++c) out[3 * r + c] += ((r == c ? 1.0 : 0.0) - d[r] * d[c]) / (most * most);
    }
  }
  return out;
}

/// Twice the sine of half an angle is what a turn moves a direction across its axis by, at most.
double angle_of_chord(double chord) noexcept { return chord < 2.0 ? 2.0 * std::asin(0.5 * chord) : kPi; }

double bound_of(const io::FrameAlignment& alignment, double integrity_risk) noexcept {
  double values[3] = {};
  Mat3 covariance = alignment.covariance_rad2;
  if (!symmetric_eigenvalues(covariance.data(), 3, 3, values)) return kPi;
  const double turn = std::sqrt(chi2_tail_quantile(integrity_risk, 3) * std::fmax(values[2], 0.0));
  return std::fmin(kPi, alignment.base_bound_rad + turn);
}

}  // namespace

const char* to_string(AlignmentSource source) noexcept {
  switch (source) {
    case AlignmentSource::stated: return "stated";
    case AlignmentSource::datasheet: return "datasheet";
    case AlignmentSource::roll_groups: return "roll_groups";
    case AlignmentSource::known_attitudes: return "known_attitudes";
    case AlignmentSource::dip: return "dip";
  }
  return "?";
}

Alignment alignment_of(const io::ArrayFile& array, const Calibration* calibration,
                       const std::vector<MeasuredAttitude>& measured) {
  const auto stated_rad = static_cast<double>(array.monitor.alignment_bound_rad);
  if (stated_rad > 0.0) return {stated_rad, AlignmentSource::stated};
  const FitReport* const fit = calibration != nullptr ? &calibration->report : nullptr;
  const bool rolled = fit != nullptr && norm(fit->roll_axis) > 0.0;
  // The axes may have been turned away from where that information has its centre.
  Vec3 turned{};
  if (calibration != nullptr) turned = turn_from_datasheet(array.datasheet, calibration->array);
  if (rolled) turned = scaled(fit->roll_axis, dot(turned, fit->roll_axis));
  const double squared_sigmas = chi2_tail_quantile(array.monitor.integrity_risk, 3);
  Mat3 drawn = information_of(array.datasheet, fit);
  for (double& entry : drawn) entry /= squared_sigmas;
  Alignment out{longest(drawn, 1.0, norm(turned)), rolled ? AlignmentSource::roll_groups : AlignmentSource::datasheet};
  if (!measured.empty()) {
    const auto stations = static_cast<double>(measured.size());
    const Mat3 known = of_attitudes(array, measured);
    Mat3 both = known;
    for (std::size_t k = 0; k < both.size(); ++k) both[k] += drawn[k];
    // Both ellipsoids hold the turn, and so does the one of the sum of their forms, about its own centre.
    const double centre_rad = norm(solved(both, times(drawn, turned)));
    const double least = std::fmin(longest(known, stations, 0.0), longest(both, stations + 1.0, centre_rad));
    if (least < out.bound_rad) out = {least, AlignmentSource::known_attitudes};
  }
  out.bound_rad = angle_of_chord(out.bound_rad);
  return out;
}

Alignment alignment_of(const io::ArrayFile& array, const io::CalibrationFile* file) {
  const auto stated_rad = static_cast<double>(array.monitor.alignment_bound_rad);
  if (file != nullptr && file->alignment && !(stated_rad > 0.0))
    return {bound_of(*file->alignment, array.monitor.integrity_risk), AlignmentSource::dip};
  return alignment_of(array, file != nullptr ? &file->calibration : nullptr, measured_attitudes_of(file, array));
}

io::ArrayFile with_alignment(const io::ArrayFile& array, const io::CalibrationFile* file) {
  io::ArrayFile out = array;
  constexpr float kMost = 3.1415925F;  // the largest float that is not above pi
  const auto bound = static_cast<float>(alignment_of(array, file).bound_rad);
  out.monitor.alignment_bound_rad = std::fmin(std::nextafter(bound, 4.0F), kMost);
  return out;
}

}  // namespace findings
}  // namespace PLUMB_ABI
}  // namespace plumb
