#include <fmt/format.h>

#include <algorithm>

#include "plumb/array/geometry.hpp"
#include "plumb/detection/isolation.hpp"
#include "plumb/render/field_words.hpp"
#include "plumb/render/geometry_report.hpp"
#include "plumb/render/words.hpp"
#include "plumb/scenario/count_text.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace render {
namespace {

using Code = findings::FindingCode;

/// "a1, a2, a3 carry a2, a3, a1"
std::string turn_words(const std::array<int, 3>& turn, const SensorArray& array) {
  std::array<int, 3> sorted = turn;
  std::sort(sorted.begin(), sorted.end());
  std::string whose, carried;
  for (const int i : sorted) {
    const auto place = static_cast<std::size_t>(std::find(turn.begin(), turn.end(), i) - turn.begin());
    whose += (whose.empty() ? "" : ", ") + std::string(array.row(i).id.data());
    carried += (carried.empty() ? "" : ", ") + std::string(array.row(turn[(place + 1) % 3]).id.data());
  }
  return whose + " carry " + carried;
}

std::string as_of_gravity(const findings::Finding& f, const findings::GeometrySubject& subject,
                          const findings::GeometryStudy& study);

}  // namespace

std::string wiring_words(const findings::HiddenWiring& wiring, const SensorArray& array) {
  using Kind = findings::HiddenWiring::Kind;
  if (wiring.kind == Kind::turned) return turn_words(wiring.sensor, array);
  const std::string first = array.row(wiring.sensor[0]).id.data();
  if (wiring.kind == Kind::reversed) return first + " reversed";
  const std::string both = first + " and " + array.row(wiring.sensor[1]).id.data() + " exchanged";
  return wiring.kind == Kind::exchanged ? both : both + " and reversed";
}

std::string geometry_words(const findings::Finding& f, const findings::GeometrySubject& subject,
                           const findings::GeometryStudy& study) {
  if (f.code == Code::common_rotation && subject.field() == io::FieldKind::magnetic)
    return "the magnetic field alone does not show the mounting of the axes in the housing; its angle to gravity does, "
           "but for a turn about the vertical (plumb monitor --group)";
  return in_field_words(as_of_gravity(f, subject, study), subject.field());
}

namespace {

std::string as_of_gravity(const findings::Finding& f, const findings::GeometrySubject& subject,
                          const findings::GeometryStudy& study) {
  const SensorArray& array = subject.array;
  const bool chips = array.units().grouped();
  switch (f.code) {
    case Code::near_singular_triples:
      return fmt::format(
          "{} of {} {} nearly in one plane (|det| below {}): no alarm and no isolation come from "
          "{}. Turn or move one axis of each group out of the plane",
          f.value, count_text(array.triple_count(), "group of three", "groups of three"),
          by_count(f.value, "lies", "lie"), f.limit, by_count(f.value, "it", "them"));
    case Code::weak_isolation:
      return fmt::format(
          "in the worst case a fault must exceed {:.0f} errors of a reading before it can be isolated (more than "
          "{:.0f}). Spread the axes more evenly",
          f.value, f.limit);
    case Code::no_isolation:
      return chips ? "one faulty chip cannot be isolated: another chip is needed"
                   : "one faulty sensor cannot be isolated";
    case Code::critical_sensors:
      return fmt::format("without {} the vector is undetermined",
                         sensor_names(critical_sensors(array, array.all()), array));
    case Code::gravity_needed:
      if (chips)
        return "the parity test detects but cannot isolate a faulty chip: isolation needs the length of gravity and "
               "several attitudes, and a chip that keeps the length, as a turned one does, is detected only. With one "
               "chip more it is isolated";
      return "the parity test detects but cannot isolate a fault: isolation needs the length of gravity and several "
             "attitudes";
    case Code::correlated_faults:
      return chips ? "an error of one chip that keeps the length of gravity leaves two hypotheses"
                   : "an error of one sensor that matches a mirror image leaves two hypotheses at that attitude";
    case Code::common_bias_unobservable:
      return fmt::format("a bias common to all sensors is invisible in parity and moves the vector by {:.2f} of it",
                         f.value);
    case Code::unobservable_permutations:
      return fmt::format(
          "{} {} not detectable at any attitude; give plumb calibrate one known attitude (--known-attitude)",
          count_text(study.hidden.size(), "wiring error"), by_count(study.hidden.size(), "is", "are"));
    case Code::many_sensors:
      return fmt::format("above {} {} the monitor has no confirmed grade, and no provisional grade above {}",
                         kStrictCapacity, chips ? "units" : "sensors", kScanDepth);
    case Code::common_rotation:
      return "gravity shows neither the mounting of the axes in the housing nor a wrong sign convention (`reads`)";
    case Code::common_scale: return "a common scale error is detectable only against the value of gravity";
    default: return findings::to_string(f.code);
  }
}

}  // namespace
}  // namespace render
}  // namespace PLUMB_ABI
}  // namespace plumb
