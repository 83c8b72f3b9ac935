#include "plumb/render/wiring_words.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "plumb/core/units.hpp"
#include "plumb/io/records.hpp"
#include "plumb/navigation/tilt.hpp"
#include "plumb/render/figures.hpp"
#include "plumb/render/words.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace render {
namespace {

using findings::MeasuredAttitude;
using findings::WiringCheck;
using findings::WiringStatus;
using io::Json;

constexpr std::size_t kMostNamed = 6;

std::string id(const SensorArray& array, int i) { return array.row(i).id.data(); }

bool changed(const Wiring& w, int i) { return w.source[at(i)] != i || w.sign[at(i)] < 0; }

/// How many mistakes it takes, about: channels that are not as they should be, and of those the reversed ones. That all
/// sensors are reversed is one mistake, of the sign convention.
int mistakes(const Wiring& w, int n) {
  int wrong = 0, reversed = 0, moved = 0;
  for (int i = 0; i < n; ++i) {
    wrong += changed(w, i) ? 1 : 0;
    moved += w.source[at(i)] != i ? 1 : 0;
    reversed += w.sign[at(i)] < 0 ? 1 : 0;
  }
  return moved == 0 && reversed == n ? 1 : 2 * wrong + reversed;
}

/// Those that are left, the simplest mistakes first.
std::vector<std::size_t> simplest_first(const WiringCheck& check, int n) {
  std::vector<std::size_t> out = check.left;
  std::stable_sort(out.begin(), out.end(), [&check, n](std::size_t a, std::size_t b) {
    const Wiring &first = check.unseen[a].wiring, &second = check.unseen[b].wiring;
    const int x = mistakes(first, n), y = mistakes(second, n);
    return x != y ? x < y : first.source < second.source;
  });
  return out;
}

std::string stations(const WiringCheck& check) {
  std::vector<std::string> numbers;
  for (const MeasuredAttitude& m : check.measured) numbers.push_back(std::to_string(m.stated.station));
  return (numbers.size() == 1 ? "station " : "stations ") + listed(numbers);
}

/// Of the station from what the calibration shows there.
double off_rad(const MeasuredAttitude& m, const Mat3& frame) {
  return angle_between_rad(m.down, down_of(m.stated, frame));
}

std::string named(const WiringCheck& check, const SensorArray& array) {
  const std::vector<std::size_t> order = simplest_first(check, array.size());
  std::string out;
  for (std::size_t k = 0; k < order.size() && k < kMostNamed; ++k)
    out += (k == 0 ? "" : "; ") + wiring_words(check.unseen[order[k]].wiring, array);
  if (order.size() > kMostNamed) out += fmt::format("; and {} more", order.size() - kMostNamed);
  return out;
}

double least_tolerance_deg(const WiringCheck& check) {
  double out = io::kKnownAttitudeTolerance_deg;
  for (const MeasuredAttitude& m : check.measured) out = std::fmin(out, deg_from_rad(m.stated.tolerance_rad));
  return out;
}

std::string what_to_record(const WiringCheck& check) {
  const findings::SeparatingAttitude& take = check.take;
  std::string out = fmt::format(
      "hold the tool still at a known attitude, inclination {0:.0f} deg and toolface {1:.0f} deg say, and give "
      "--known-attitude STATION:{0:.0f},{1:.0f}",
      take.inclination_deg, take.toolface_deg);
  if (take.separation_deg > 2.0 * least_tolerance_deg(check)) return out;
  return out + fmt::format(",{:.2g}: another wiring shows a direction only {:.1f} deg away there",
                           0.4 * take.separation_deg, take.separation_deg);
}

/// Two known attitudes of which not both can be right, whatever the wiring: no turn changes the angle between them.
struct Contradiction {
  const MeasuredAttitude *first = nullptr, *second = nullptr;
  double stated_rad = 0.0, shown_rad = 0.0;
};

/// The pair that is furthest beyond the tolerances of both; none: null.
Contradiction contradicting_pair(const WiringCheck& check, const Mat3& frame) {
  Contradiction out;
  double worst = 0.0;
  for (std::size_t a = 0; a < check.measured.size(); ++a) {
    for (std::size_t b = a + 1; b < check.measured.size(); ++b) {
      const MeasuredAttitude &one = check.measured[a], &other = check.measured[b];
      const double stated_rad = angle_between_rad(down_of(one.stated, frame), down_of(other.stated, frame));
      const double shown_rad = angle_between_rad(one.down, other.down);
      const double beyond = std::fabs(stated_rad - shown_rad) - one.stated.tolerance_rad - other.stated.tolerance_rad;
      if (beyond <= worst) continue;
      worst = beyond;
      out = {&one, &other, stated_rad, shown_rad};
    }
  }
  return out;
}

std::string stated_words(const MeasuredAttitude& m) {
  return fmt::format("station {} at inclination {:.1f} deg, toolface {:.1f} deg", m.stated.station,
                     deg_from_rad(m.stated.inclination_rad), deg_from_rad(m.stated.toolface_rad));
}

std::string contradiction(const WiringCheck& check, const io::ArrayFile& array) {
  if (const Contradiction pair = contradicting_pair(check, array.output_frame); pair.first != nullptr)
    return fmt::format(
        "the known attitudes contradict one another: {} and {} are {:.1f} deg apart, and the calibration "
        "shows these stations {:.1f} deg apart (tolerances {:.2g} and {:.2g} deg)",
        stated_words(*pair.first), stated_words(*pair.second), deg_from_rad(pair.stated_rad),
        deg_from_rad(pair.shown_rad), deg_from_rad(pair.first->stated.tolerance_rad),
        deg_from_rad(pair.second->stated.tolerance_rad));
  const auto further = [&array](const MeasuredAttitude& a, const MeasuredAttitude& b) {
    return off_rad(a, array.output_frame) / a.stated.tolerance_rad <
           off_rad(b, array.output_frame) / b.stated.tolerance_rad;
  };
  const MeasuredAttitude& m = *std::max_element(check.measured.begin(), check.measured.end(), further);
  const std::string out = fmt::format(
      "station {} is known to stand at inclination {:.1f} deg, toolface {:.1f} deg, and the calibration shows it "
      "{:.1f} "
      "deg away (tolerance {:.2g} deg)",
      m.stated.station, deg_from_rad(m.stated.inclination_rad), deg_from_rad(m.stated.toolface_rad),
      deg_from_rad(off_rad(m, array.output_frame)), deg_from_rad(m.stated.tolerance_rad));
  if (check.left.empty())
    return out +
           ", and no exchange or reversal that leaves every axis within 15 deg of its datasheet axis explains that";
  return out + ", as if the sensors were wired otherwise (" + named(check, array.array) + ")";
}

}  // namespace

std::string wiring_words(const Wiring& wiring, const SensorArray& array) {
  const int n = array.size();
  std::vector<int> other;
  bool moved = false;
  for (int i = 0; i < n; ++i) {
    if (changed(wiring, i)) other.push_back(i);
    moved = moved || wiring.source[at(i)] != i;
  }
  if (!moved) {
    if (static_cast<int>(other.size()) == n) return "all sensors reversed";
    std::vector<std::string> ids;
    for (const int i : other) ids.push_back(id(array, i));
    return listed(ids) + " reversed";
  }
  if (other.size() == 2) {
    const int i = other[0], j = other[1];
    const bool first = wiring.sign[at(i)] < 0, second = wiring.sign[at(j)] < 0;
    if (first == second) return id(array, i) + " and " + id(array, j) + " exchanged" + (first ? " and reversed" : "");
  }
  std::string out;
  for (const int i : other)
    out += (out.empty() ? "" : ", ") + id(array, i) +
           (wiring.source[at(i)] == i ? "" : " carries " + id(array, wiring.source[at(i)])) +
           (wiring.sign[at(i)] < 0 ? " reversed" : "");
  return out;
}

std::string wiring_found(const WiringCheck& check) {
  switch (check.status) {
    case WiringStatus::confirmed: return "confirmed by " + stations(check);
    case WiringStatus::contradicted: return "contradicted by a known attitude";
    case WiringStatus::open: break;
  }
  return fmt::format("{} other wiring{} give{} the same residuals", check.left.size(),
                     check.left.size() == 1 ? "" : "s", check.left.size() == 1 ? "s" : "");
}

std::string wiring_reason(const WiringCheck& check, const io::ArrayFile& array) {
  const std::size_t left = check.left.size();
  switch (check.status) {
    case WiringStatus::confirmed:
      return fmt::format("the known attitude of {} excludes the {} other wirings that leave the same residuals",
                         stations(check), check.unseen.size());
    case WiringStatus::contradicted: return contradiction(check, array);
    case WiringStatus::open: break;
  }
  return fmt::format(
      "the wiring is not confirmed: {} other wiring{} (exchanged or reversed channels){} leave{} the same "
      "residuals in every recording of this array ({})",
      left, left == 1 ? "" : "s", check.measured.empty() ? "" : ", not excluded by " + stations(check) + ",",
      left == 1 ? "s" : "", named(check, array.array));
}

std::string wiring_remedy(const WiringCheck& check, const io::ArrayFile& array) {
  switch (check.status) {
    case WiringStatus::confirmed: return "";
    case WiringStatus::contradicted:
      if (contradicting_pair(check, array.output_frame).first != nullptr)
        return "check the stated angles and the numbers of both stations";
      return check.left.empty()
                 ? "check the stated angles, the number of the station, and `axis` and `frame` in the "
                   "array file"
                 : "check the wiring, `column`, `scale` and `reads` of " + array.path + ", and the stated angles";
    case WiringStatus::open: break;
  }
  return array.field == io::FieldKind::magnetic ? kAlignByAccelerometers : what_to_record(check);
}

std::string wiring_text(const WiringCheck& check, const io::ArrayFile& array) {
  const std::string remedy = wiring_remedy(check, array);
  return wiring_reason(check, array) + (remedy.empty() ? "" : "; " + remedy);
}

Json wiring_items(const WiringCheck& check, const io::ArrayFile& array) {
  Json out = Json::array();
  if (check.status != WiringStatus::confirmed)
    out.push_back(io::object({{"name", kWiringItem}, {"text", wiring_text(check, array)}}));
  return out;
}

Json wiring_json(const WiringCheck& check, const io::ArrayFile& array) {
  Json known = Json::array(), left = Json::array();
  for (const MeasuredAttitude& m : check.measured) {
    const Tilt shown = tilt_of(io::in_frame(array.output_frame, m.down), Mat3{});
    known.push_back(io::object({{"station", m.stated.station},
                                {"inclination_deg", deg_from_rad(m.stated.inclination_rad)},
                                {"toolface_deg", deg_from_rad(m.stated.toolface_rad)},
                                {"tolerance_deg", deg_from_rad(m.stated.tolerance_rad)},
                                {"shown_inclination_deg", deg_from_rad(shown.inclination_rad)},
                                {"shown_toolface_deg", deg_from_rad(shown.toolface_rad)},
                                {"off_deg", deg_from_rad(off_rad(m, array.output_frame))}}));
  }
  for (const std::size_t k : simplest_first(check, array.array.size()))
    left.push_back(wiring_words(check.unseen[k].wiring, array.array));
  return io::object(
      {{"name", kWiringItem},
       {"status", to_string(check.status)},
       {"unseen_by_gravity", check.unseen.size()},
       {"not_excluded", std::move(left)},
       {"known_attitudes", std::move(known)},
       {"attitude_to_record", check.left.empty() ? Json()
                                                 : io::object({{"inclination_deg", check.take.inclination_deg},
                                                               {"toolface_deg", check.take.toolface_deg},
                                                               {"separation_deg", check.take.separation_deg}})},
       {"text", wiring_text(check, array)}});
}

}  // namespace render
}  // namespace PLUMB_ABI
}  // namespace plumb
