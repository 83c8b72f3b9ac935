#include "plumb/render/nothing_judged_words.hpp"

#include <fmt/format.h>

#include "finding_words.hpp"
#include "plumb/render/figures.hpp"
#include "plumb/render/words.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace render {
namespace {

using findings::NothingJudged;

/// "the columns `x` (a1) and `y` (a2) have"
std::string columns_with(const char* singular, const char* plural, SensorSet sensors, const io::ArrayFile& array) {
  std::vector<std::string> names;
  for (int i = 0; i < array.array.size(); ++i) {
    if (sensors.has(i))
      names.push_back("`" + array.input.sensor_columns[at(i)] + "` (" + array.array.row(i).id.data() + ")");
  }
  const bool one = names.size() == 1;
  return (one ? "the column " : "the columns ") + listed(names) + (one ? singular : plural);
}

/// "410 of 4100 rows lack a number (NaN or empty cells), 400 of them from every sensor"
std::string lacking_words(const findings::NothingJudgedStudy& study) {
  return fmt::format("{} of {} rows lack a number (NaN or empty cells), {} of them from every sensor",
                     study.rows_lacking, study.rows, study.rows_empty);
}

/// By what the rows look like.
Refusal at_rest_words(const findings::NothingJudgedStudy& study, const io::ArrayFile& array) {
  const findings::Finding& first = study.log.front();
  const int window = array.monitor.window;
  const std::string hold = fmt::format("hold the tool still for at least {} samples at each attitude", window);
  switch (first.code) {
    case findings::FindingCode::tool_not_at_rest:
      return {fmt::format("the tool never rested for a block of {} samples; noise, unit and time column look as "
                          "declared",
                          window),
              hold};
    case findings::FindingCode::log_too_short:
      if (study.log.size() == 1)
        return {fmt::format("the tool did not rest for a block of {} samples in {} rows", window, study.rows), hold};
      return {log_words(study.log[1], array), "correct the array file, or " + hold};
    case findings::FindingCode::noise_at_rest: {
      const double mg0 = kMg0 * first.value, declared_mg0 = kMg0 * first.limit;
      return {fmt::format("the tool was not at rest for a block of {} samples: {} scatters by {:.3g} mg0 even in the "
                          "quietest tenth of the log, {:.3g} times the {:.3g} mg0 declared",
                          window, array.array.row(first.sensor).id.data(), mg0, mg0 / declared_mg0, declared_mg0),
              hold + fmt::format("; if it was still, `noise` in {} is too small: declare it as it is; {}", array.path,
                                 measure_noise_words(array))};
    }
    default: return {log_words(first, array), "correct the array file where it is wrong; else " + hold};
  }
}

}  // namespace

Refusal nothing_judged_words(const findings::NothingJudgedStudy& study, const io::ArrayFile& array) {
  const int window = array.monitor.window;
  switch (study.cause) {
    case NothingJudged::too_few_sensors:
      return {columns_with(" has", " have", study.sensors, array) +
                  " no number in most rows, and a direction needs three sensors",
              "look at how the log was written, and at `column` of these sensors in " + array.path};
    case NothingJudged::rows_are_stations:
      return {fmt::format("every row is a station (rows = \"stations\"), and [monitor] window joins {} of them to one "
                          "block",
                          window),
              "set window = 1 below [monitor] in " + array.path};
    case NothingJudged::too_short:
      return {fmt::format("the log has {} rows, and a block has {}", study.rows, window),
              fmt::format("record at least {} rows at rest, or set a smaller `window` below [monitor] in {}", window,
                          array.path)};
    case NothingJudged::rows_without_numbers:
      return {lacking_words(study) + (study.longest_run < static_cast<std::uint64_t>(window)
                                          ? fmt::format(", and at most {} in a row are between those without any; a "
                                                        "block has {}",
                                                        study.longest_run, window)
                                          : fmt::format("; a block has {} with a number from every sensor", window)),
              "log all sensors in every row: look at how the log was written, and at the connection of the sensors"};
    case NothingJudged::unknown_rotation:
      return {
          "the tool turns in most rows, by the columns of `rotation_radps`, and what that adds to each sensor is not "
          "known without its lever arm",
          "state `lever_arm_m` of every [[sensor]] in " + array.path +
              ", hold the tool still, or remove `rotation_radps` if the columns are not rates of turn in rad/s"};
    case NothingJudged::full_scale:
      return {columns_with(" is", " are", study.sensors, array) + " at full scale in most rows",
              "check `full_scale`, `scale` and `unit` in " + array.path +
                  " against the log; if they are right, the channel is overloaded or dead"};
    case NothingJudged::never_at_rest: break;
  }
  Refusal out = at_rest_words(study, array);
  if (study.rows_lacking > 0) out.reason += "; " + lacking_words(study);
  return out;
}

}  // namespace render
}  // namespace PLUMB_ABI
}  // namespace plumb
