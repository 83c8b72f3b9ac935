// Alignments in words.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "plumb/survey/joint_alignment.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace survey {
namespace {

constexpr double kBlurred = 0.1;   // of a component of magnetic east
constexpr double kAlong = 0.9986;  // cosine of 3 degrees: an axis of the tool

std::string name_of(const Vec3& direction) {
  for (std::size_t k = 0; k < 3; ++k) {
    if (std::fabs(direction[k]) > kAlong) return fmt::format("tool {}", "xyz"[k]);
  }
  // 0.0 + turns -0 into 0
  return fmt::format("({:.2f}, {:.2f}, {:.2f}) of the tool", 0.0 + std::round(direction[0] * 100.0) / 100.0,
                     0.0 + std::round(direction[1] * 100.0) / 100.0, 0.0 + std::round(direction[2] * 100.0) / 100.0);
}

/// "rotation about tool z", of the axes that are not told.
std::string open_axes(const AlignmentRefusal& refusal) {
  if (refusal.rank == 0) return "any rotation";
  const bool first = !refusal.axis[0].told, second = !refusal.axis[1].told, third = !refusal.axis[2].told;
  const std::size_t one = first ? 0 : second ? 1 : 2;
  if (refusal.rank == 2) return "the rotation about " + refusal.axis[one].name();
  const std::size_t other = third ? 2 : 1;
  return "rotations about axes across " + name_of(cross(refusal.axis[one].direction, refusal.axis[other].direction));
}

std::string sigma_text(double rad) {
  return rad < kPi ? fmt::format("its sigma would be {:.2g} deg", deg_from_rad(rad))
                   : std::string("nothing is told of it");
}

const AlignmentAxis& weakest_open(const AlignmentRefusal& refusal) {
  return *std::find_if(refusal.axis.begin(), refusal.axis.end(), [](const AlignmentAxis& a) { return !a.told; });
}

std::string not_shown(const AlignmentRefusal& refusal) {
  const AlignmentAxis& weakest = weakest_open(refusal);
  const std::string what = "these stations do not show " + open_axes(refusal) + ": ";
  const std::string along = refusal.rank == 2 ? "that axis" : weakest.name();
  if (!(weakest.blur < kBlurred))
    return what +
           "gravity and field are almost parallel here, so that magnetic east is hardly known. Record stations where "
           "the dip is further from 90 deg";
  const std::string sigma =
      fmt::format("{}, {:.2g} deg are stated", sigma_text(weakest.sigma_rad), deg_from_rad(refusal.limit));
  const bool like_a_dip = !refusal.dip_known || weakest.with == "the reference of the dip";
  const std::string part = fmt::format("the component of magnetic east along {} is ", along);
  if (!like_a_dip)
    return what + part +
           fmt::format(
               "{:.3f} (rms; 0.58 at scattered attitudes); {}. Add stations with that axis towards magnetic east or "
               "west",
               weakest.seen, sigma);
  const double spread = refusal.dip_known
                            ? std::sqrt(std::max(0.0, std::pow(weakest.seen, 2) - std::pow(weakest.mean, 2)))
                            : weakest.seen;
  return what + part +
         fmt::format(
             "{:.3f} at all of them, within {:.3f} (rms; 0.58 at scattered attitudes), which looks like another dip; "
             "{}. "
             "Add stations with that axis towards magnetic east and others with it towards west",
             0.0 + std::round(weakest.mean * 1000.0) / 1000.0, spread, sigma);
}

std::string look_alike(const AlignmentRefusal& refusal) {
  const AlignmentAxis& open = weakest_open(refusal);
  return fmt::format(
      "these stations do not tell {} from {} (correlation {:.2f}): {}, {:.2g} deg are stated. Survey at other "
      "inclinations, azimuths and toolfaces, or calibrate the magnetometers first",
      open_axes(refusal), open.with, open.correlation, sigma_text(open.sigma_rad), deg_from_rad(refusal.limit));
}

}  // namespace

std::string AlignmentAxis::name() const { return name_of(direction); }

std::string AlignmentRefusal::text() const {
  switch (why) {
    case NoAlignment::too_few_stations:
      return fmt::format("{:.0f} stations are too few: each gives one equation, and {:.0f} are needed", value, limit);
    case NoAlignment::not_finite:
      return fmt::format("station {:.0f} (counted from 0) holds a number that is not finite: leave it out", value);
    case NoAlignment::no_random_error:
      return fmt::format(
          "station {:.0f} (counted from 0) states no random error, so that it cannot be weighed: state the noise of "
          "its "
          "means",
          value);
    case NoAlignment::not_converged:
      return "the estimate does not settle: test the stations for gross errors and swapped axes first";
    case NoAlignment::not_observable: return not_shown(*this);
    case NoAlignment::correlated: return look_alike(*this);
    case NoAlignment::misfit:
      return fmt::format(
          "chi-square of the residuals is {:.1f}, at most {:.1f} is allowed: another error is in the data. Test the "
          "stations for gross errors, or state larger errors of the tool",
          value, limit);
    case NoAlignment::implausible:
      return fmt::format(
          "the magnetometers would be turned by {:.2f} deg, where {:.2g} deg (1 sigma) are stated: check the names and "
          "signs of the axes, or state how far the magnetometers may be turned",
          deg_from_rad(value), deg_from_rad(limit));
  }
  return "?";
}

}  // namespace survey
}  // namespace PLUMB_ABI
}  // namespace plumb
