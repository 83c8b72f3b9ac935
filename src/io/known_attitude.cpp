#include "plumb/io/known_attitude.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

namespace plumb {
inline namespace PLUMB_ABI {
namespace io {
namespace {

constexpr const char* kForm =
    "write STATION:INCLINATION,TOOLFACE in deg, and ,TOLERANCE where it is not 5 deg: 7:60,40 or 7:60,40,2";

/// Reads one number and moves `at` behind it; false where there is none.
template <class T>
bool take_number(const char*& at, const char* end, T& value) {
  const auto read = std::from_chars(at, end, value);
  if (read.ec != std::errc{}) return false;
  at = read.ptr;
  return std::isfinite(static_cast<double>(value));
}

bool take_mark(const char*& at, const char* end, char mark) {
  if (at == end || *at != mark) return false;
  ++at;
  return true;
}

}  // namespace

tl::expected<KnownAttitude, std::string> parse_known_attitude(const std::string& text) {
  const auto refuse = [](const std::string& what) { return tl::unexpected<std::string>(what + "; " + kForm); };
  const char* at = text.data();
  const char* const end = at + text.size();
  KnownAttitude out;
  double inclination = 0.0, toolface = 0.0, tolerance = kKnownAttitudeTolerance_deg;
  bool read = take_number(at, end, out.station) && take_mark(at, end, ':') && take_number(at, end, inclination) &&
              take_mark(at, end, ',') && take_number(at, end, toolface);
  if (read && at != end) read = take_mark(at, end, ',') && take_number(at, end, tolerance) && at == end;
  if (!read) return refuse("\"" + text + "\" is not a station of known attitude");
  if (out.station < 1) return refuse("stations are counted from 1");
  if (!(inclination >= 0.0 && inclination <= 180.0)) return refuse("the inclination must be 0 to 180 deg");
  if (!(std::fabs(toolface) <= 360.0)) return refuse("the toolface must be -360 to 360 deg");
  if (!(tolerance >= kLeastTolerance_deg && tolerance <= kMostTolerance_deg))
    return refuse("the tolerance must be 0.01 to 45 deg");
  out.inclination_rad = rad_from_deg(inclination);
  out.toolface_rad = rad_from_deg(toolface < 0.0 ? toolface + 360.0 : toolface);
  out.tolerance_rad = rad_from_deg(tolerance);
  return out;
}

bool KnownAttitude::plausible() const noexcept {
  constexpr double kRounding = 1e-9;
  const double tolerance_deg = deg_from_rad(tolerance_rad);
  return station >= 1 && inclination_rad >= 0.0 && inclination_rad <= kPi + kRounding && toolface_rad >= 0.0 &&
         toolface_rad <= 2.0 * kPi + kRounding && tolerance_deg >= kLeastTolerance_deg - kRounding &&
         tolerance_deg <= kMostTolerance_deg + kRounding;
}

Vec3 down_of(const KnownAttitude& attitude, const Mat3& output_frame) noexcept {
  const double across = std::sin(attitude.inclination_rad);
  const Vec3 out = {-across * std::sin(attitude.toolface_rad), -across * std::cos(attitude.toolface_rad),
                    std::cos(attitude.inclination_rad)};
  const Mat3& f = output_frame;  // its rows are orthonormal, so its inverse is its transpose
  return times({f[0], f[3], f[6], f[1], f[4], f[7], f[2], f[5], f[8]}, out);
}

void add_known(const std::vector<KnownAttitude>& more, std::vector<KnownAttitude>& list) {
  for (const KnownAttitude& one : more) {
    if (std::find(list.begin(), list.end(), one) == list.end()) list.push_back(one);
  }
}

}  // namespace io
}  // namespace PLUMB_ABI
}  // namespace plumb
