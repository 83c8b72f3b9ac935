#include "second_look_words.hpp"

#include <fmt/format.h>

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
