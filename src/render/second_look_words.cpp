#include "second_look_words.hpp"

#include <fmt/format.h>

#include <cmath>

#include "fit_words.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace render {
namespace {

using findings::Finding;
using Code = findings::FindingCode;

constexpr std::size_t kNamedMistakes = 3;

std::string axis_words(const Vec3& axis) { return fmt::format("{:g},{:g},{:g}", axis[0], axis[1], axis[2]); }

std::string either(const std::vector<std::string>& names) {
  std::string out = names.front();
  for (std::size_t k = 1; k < names.size(); ++k) out += (k + 1 == names.size() ? " or " : ", ") + names[k];
  return out;
}

std::string group_words(const std::vector<Finding>& settling) {
  std::vector<std::string> names;
  for (const Finding& f : settling) names.push_back(fmt::format("{:.0f}", f.value));
  return either(names);
}

std::string triad_names(const findings::TurnedTriad& t, const io::ArrayFile& array) {
  return fmt::format("{}, {}, {}", id_of(array, t.sensor[0]), id_of(array, t.sensor[1]), id_of(array, t.sensor[2]));
}

/// "+y2 -x2 +z2": what its channels carry.
std::string carried_words(const findings::TurnedTriad& t, const io::ArrayFile& array) {
  std::string out;
  for (std::size_t k = 0; k < 3; ++k) {
    const int sensor = t.sensor[static_cast<std::size_t>(t.source[k])];
    out += fmt::format("{}{}{}", k == 0 ? "" : ", ", t.sign[k] < 0 ? "-" : "+", id_of(array, sensor));
  }
  return out;
}

/// "the triad x2, y2, z2 turned by 90 deg about (0, 0, 1) of its own axes (its channels carry +y2, -x2, +z2)"
std::string turn_words(const findings::TurnedTriad& t, const io::ArrayFile& array) {
  std::string how = "mirrored";
  if (findings::is_turn(t)) {
    const findings::AxisAngle a = findings::axis_of(t);
    how = fmt::format("turned by {} deg about ({}, {}, {}) of its own axes", a.deg, a.axis[0], a.axis[1], a.axis[2]);
  }
  return fmt::format("the triad {} {} (its channels carry {})", triad_names(t, array), how, carried_words(t, array));
}

/// The lines of the array file, if it is so.
std::string mended_lines(const findings::TurnedTriad& t, const io::ArrayFile& array) {
  std::string out;
  for (int k = 0; k < 3; ++k) {
    const Vec3 axis = findings::mended_axis(array.array, t, k);
    const auto component = [](double v) { return fmt::format("{:.6g}", std::fabs(v) < 1e-9 ? 0.0 : v); };
    out += fmt::format("{}axis = [{}, {}, {}] for {}", k == 0 ? "" : ", ", component(axis[0]), component(axis[1]),
                       component(axis[2]), id_of(array, t.sensor[static_cast<std::size_t>(k)]));
  }
  return out;
}

std::string triads_remedy(const std::vector<findings::TurnedTriad>& turned, const io::ArrayFile& array) {
  std::string out =
      "check how the triads are mounted, and in which frame their axes are named (NED or ENU). In the array file it "
      "is ";
  for (std::size_t k = 0; k < turned.size() && k < kNamedMistakes; ++k)
    out += (k == 0 ? "" : ", or ") + mended_lines(turned[k], array);
  if (turned.size() > 1)
    out += ". Gravity does not tell which of them is turned against the others: a station of known attitude does";
  return out;
}

std::string mistake_words(const Finding& f, const io::ArrayFile& array) {
  return f.code == Code::accepted_if_reversed
             ? fmt::format("the sign of {} reversed", id_of(array, f.sensor))
             : fmt::format("the columns of {} and {} exchanged", id_of(array, f.sensor), id_of(array, f.other));
}

}  // namespace

std::string settling_words(const std::vector<Finding>& settling, const findings::CalibrationRun& run,
                           const io::ArrayFile& array) {
  switch (settling.front().code) {
    case Code::accepted_about_another_axis:
      return "; rolled about " + axis_words(*run.second_look.roll_axis) + " the fit would be accepted";
    case Code::accepted_without_roll_group:
      return "; without roll group " + group_words(settling) + " the fit would be accepted";
    case Code::accepted_without_roll_groups: return "; without the roll groups the fit would be accepted";
    default: break;
  }
  std::vector<std::string> mistakes;
  for (const findings::TurnedTriad& one : run.second_look.turned) {
    if (mistakes.size() < kNamedMistakes) mistakes.push_back(turn_words(one, array));
  }
  if (!mistakes.empty()) return "; with " + either(mistakes) + " the fit would be accepted";
  for (const Finding& f : settling) {
    if (mistakes.size() < kNamedMistakes) mistakes.push_back(mistake_words(f, array));
  }
  return "; with " + either(mistakes) + " the fit would be accepted";
}

std::string settling_remedy(const std::vector<Finding>& settling, const findings::CalibrationRun& run,
                            const io::ArrayFile& array) {
  const Finding& f = settling.front();
  switch (f.code) {
    case Code::accepted_about_another_axis:
      return "give --roll-axis " + axis_words(*run.second_look.roll_axis) +
             ", or correct the third row of [output] frame, from which inclination is counted";
    case Code::accepted_without_roll_group:
      return "look at the column `" + array.input.roll_group_column + "`: stations numbered " + group_words(settling) +
             " do not share an inclination";
    case Code::accepted_without_roll_groups:
      return "check that the stations of a group do share an inclination, and --roll-axis; an axis that is not held "
             "exactly needs --roll-axis-deviation-deg";
    case Code::accepted_if_turned: return triads_remedy(run.second_look.turned, array);
    default: break;
  }
  const std::string first =
      f.code == Code::accepted_if_reversed
          ? fmt::format("check the sign of {}: its `scale`, its `axis` and its wiring", id_of(array, f.sensor))
          : fmt::format("check `column` of {} and {} in the array file, and their wiring", id_of(array, f.sensor),
                        id_of(array, f.other));
  return first + "; two simultaneous errors can look like a third";
}

}  // namespace render
}  // namespace PLUMB_ABI
}  // namespace plumb
