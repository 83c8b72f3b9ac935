#include "plumb/survey/wiring.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "algebra.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace survey {
namespace {

constexpr double kOff = 3.0;
constexpr double kBetter = 4.0;
constexpr double kNext = 2.0;
constexpr std::size_t kFewestStations = 4;

struct Naming {
  std::array<int, 3> axis{{0, 1, 2}};
  std::array<int, 3> sign{{1, 1, 1}};
  double rms_rad = 0.0;
};

Vec3 named(const Naming& naming, const Vec3& v) {
  Vec3 out{};
  for (std::size_t k = 0; k < 3; ++k) out[k] = naming.sign[k] * v[static_cast<std::size_t>(naming.axis[k])];
  return out;
}

double rms_of(const Naming& naming, const std::vector<ReferencedStation>& stations) {
  double squares = 0.0;
  for (const ReferencedStation& at : stations) {
    const double dip = totals_of(at.measured.gravity_mps2, named(naming, at.measured.field_tesla)).dip_rad;
    const double off = dip - at.reference.field.dip_rad;
    squares += off * off;
  }
  return std::sqrt(squares / static_cast<double>(stations.size()));
}

/// Root mean square of the sigma of the dip.
double allowed_of(const std::vector<ReferencedStation>& stations, const ToolErrors& tool) {
  double squares = 0.0;
  for (const ReferencedStation& at : stations) {
    const double sigma =
        check_station(at.measured, total_covariance(at.measured, tool), at.reference, CheckSettings{}).dip.sigma;
    squares += sigma * sigma;
  }
  return std::sqrt(squares / static_cast<double>(stations.size()));
}

std::vector<Naming> all_namings(const std::vector<ReferencedStation>& stations) {
  std::vector<Naming> out;
  Naming naming;
  do {
    for (int signs = 0; signs < 8; ++signs) {
      for (int k = 0; k < 3; ++k) naming.sign[static_cast<std::size_t>(k)] = (signs >> k & 1) != 0 ? -1 : 1;
      naming.rms_rad = rms_of(naming, stations);
      out.push_back(naming);
    }
  } while (std::next_permutation(naming.axis.begin(), naming.axis.end()));
  return out;
}

}  // namespace

WiringStudy study_wiring(const std::vector<ReferencedStation>& stations, const ToolErrors& tool) {
  WiringStudy out;
  if (stations.empty()) return out;
  std::vector<Naming> namings = all_namings(stations);
  out.rms_as_is_rad = out.rms_best_rad = namings.front().rms_rad;
  if (!std::all_of(namings.begin(), namings.end(), [](const Naming& n) { return std::isfinite(n.rms_rad); }))
    return out;
  std::stable_sort(namings.begin(), namings.end(),
                   [](const Naming& a, const Naming& b) { return a.rms_rad < b.rms_rad; });
  const Naming& best = namings.front();
  out.rms_best_rad = best.rms_rad;
  out.axis = best.axis;
  out.sign = best.sign;
  const double allowed = kOff * allowed_of(stations, tool);
  out.swapped = stations.size() >= kFewestStations && out.rms_as_is_rad > allowed && best.rms_rad <= allowed &&
                kBetter * best.rms_rad <= out.rms_as_is_rad && namings[1].rms_rad >= kNext * best.rms_rad;
  return out;
}

std::string WiringStudy::text() const {
  if (!swapped) return "";
  const char names[] = "xyz";
  const bool same_signs = sign == std::array<int, 3>{1, 1, 1};
  std::vector<char> moved;
  for (std::size_t k = 0; k < 3; ++k) {
    if (axis[k] != static_cast<int>(k)) moved.push_back(names[k]);
  }
  std::string what;
  if (same_signs && moved.size() == 2) {
    what = fmt::format("{} and {} of one triad are exchanged", moved[0], moved[1]);
  } else {
    what = "axes of one triad are named or signed otherwise: the magnetometers fit as";
    for (std::size_t k = 0; k < 3; ++k)
      what += fmt::format(" {} = {}{}{}", names[k], sign[k] < 0 ? "-" : "", names[axis[k]], k < 2 ? "," : "");
  }
  return what + fmt::format(" (dip is off by {:.2f} deg rms as it stands, by {:.2f} deg so)",
                            deg_from_rad(rms_as_is_rad), deg_from_rad(rms_best_rad));
}

}  // namespace survey
}  // namespace PLUMB_ABI
}  // namespace plumb
