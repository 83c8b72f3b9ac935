// [[clock]]: chips and gyros that sample by clocks of their own, each with the column of its time stamps.
#include <algorithm>
#include <cmath>
#include <string>

#include "array_parts.hpp"
#include "motion_figure.hpp"
#include "refusal.hpp"
#include "text_tools.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace io {
namespace {

constexpr Figure kSamplePeriod{"sample_period_s", "s", 1e-5, 1.0, "0.00125"};
constexpr Figure kOffsetBound{"offset_bound_s", "s", 0.0, 1.0, "20e-6"};
constexpr Figure kRateBound{"rate_bound", "", 0.0, 0.05, "1e-6"};

struct ClockKey {
  Figure figure;
  double MotionClock::*field;
};

constexpr ClockKey kWithDefault[] = {
    {{"offset_s", "s", -kMostTime_s, kMostTime_s, "0.0123"}, &MotionClock::offset_s},
    {{"rate", "", -0.05, 0.05, "30e-6"}, &MotionClock::rate},
    {{"since_s", "s", -kMostTime_s, kMostTime_s, "0"}, &MotionClock::since_s},
    {{"valid_s", "s", 0.0, kMostTime_s, "60"}, &MotionClock::valid_s},
};

/// What `plumb::check` takes of the wait, in sample periods of each chip; and what is taken where none is stated.
constexpr double kLeastWait = 5.0, kMostWait = 40.0, kUsualWait = 10.0;

std::vector<std::string> known_clock_keys() {
  std::vector<std::string> out = {"package", "gyro", "time", kSamplePeriod.key, kOffsetBound.key, kRateBound.key};
  for (const ClockKey& key : kWithDefault) out.emplace_back(key.figure.key);
  return out;
}

std::string path_of(std::size_t c) { return "clock[" + std::to_string(c + 1) + "]"; }

/// The sensors of the chip that the table names.
SensorSet read_package(const TomlTable& table, const ArrayFile& array) {
  const std::string form = "name the chip as its sensors do: package = \"imu2\"";
  const std::string name = table.need_text("package", form);
  SensorSet out;
  std::vector<std::string> known;
  for (std::size_t i = 0; i < array.package.size(); ++i) {
    if (!array.package[i].empty() && array.package[i] == name) out = out.with(static_cast<int>(i));
    const bool is_new = std::find(known.begin(), known.end(), array.package[i]) == known.end();
    if (!array.package[i].empty() && is_new) known.push_back(array.package[i]);
  }
  if (!out.empty()) return out;
  table.fail(table.line_of("package"), "package", in_quotes(name) + " is the package of no sensor",
             known.empty() ? "add package = " + in_quotes(name) + " to the [[sensor]] of each of its axes"
                           : did_you_mean(name, known) + "packages of this file: " + joined(known));
}

/// Which gyros the table names.
std::array<bool, kGyros> read_gyros(const TomlTable& table, const InputSpec& input) {
  if (!table.has("gyro")) return {};
  const int which = table.need_choice("gyro", {"first", "second", "both"}, "name the gyros of this clock");
  const std::array<bool, kGyros> out = {which != 1, which != 0};
  const char* missing = out[0] && input.rotation_columns.empty()          ? "rotation_radps"
                        : out[1] && input.second_rotation_columns.empty() ? "second_rotation_radps"
                                                                          : nullptr;
  if (missing != nullptr)
    table.fail(table.line_of("gyro"), "gyro", std::string("names a gyro, but [input] names no ") + missing,
               std::string("add ") + missing + " = [\"wx\", \"wy\", \"wz\"] to [input], or remove this key");
  return out;
}

std::string name_of(const std::string& package, const std::array<bool, kGyros>& gyro, bool two) {
  if (!package.empty()) return package;
  if (gyro[0] && gyro[1]) return "both gyros";
  return !two ? "the gyro" : gyro[0] ? "the first gyro" : "the second gyro";
}

/// What [input] or [[sensor]] takes the column for; empty: nothing that is no time.
std::string other_role(const std::string& column, const InputSpec& input) {
  const auto among = [&column](const std::vector<std::string>& names) {
    return std::find(names.begin(), names.end(), column) != names.end();
  };
  if (among(input.sensor_columns)) return "a sensor's column";
  if (among(input.rotation_columns)) return "in input.rotation_radps";
  if (among(input.second_rotation_columns)) return "in input.second_rotation_radps";
  if (column == input.station_column) return "input.station";
  if (column == input.roll_group_column) return "input.roll_group";
  if (column == input.count_column) return "input.count";
  if (column == input.temperature_column) return "input.temperature";
  return column == input.depth_column ? "input.depth" : "";
}

std::string read_column(const TomlTable& table, const InputSpec& input) {
  const std::string form = "name the column with the time stamps of this clock: time = \"t2_s\"";
  const std::string column = table.need_text("time", form);
  if (column.empty()) table.fail(table.line_of("time"), "time", "is empty", form);
  if (const std::string role = other_role(column, input); !role.empty())
    table.fail(table.line_of("time"), "time", in_quotes(column) + " is " + role + " already", form);
  return column;
}

void need_figure(const TomlTable& table, const Figure& figure, double& out) {
  (void)table.need(figure.key, std::string("state by how much this clock may be off: ") + figure.key + " = " +
                                   figure.example + "; 0 where it cannot be");
  read_into(table, figure, out);
}

ClockSpec read_clock(const TomlTable& table, const ArrayFile& array) {
  ClockSpec out;
  if (!table.has("package") && !table.has("gyro"))
    table.fail(table.line(), "", "says neither which chip nor which gyro it belongs to",
               "add package = \"imu2\", gyro = \"first\", or both");
  if (table.has("package")) out.clock.sensors = read_package(table, array);
  out.clock.gyro = read_gyros(table, array.input);
  out.name = name_of(table.text("package", ""), out.clock.gyro, !array.input.second_rotation_columns.empty());
  out.column = read_column(table, array.input);
  read_into(table, kSamplePeriod, out.sample_period_s);
  for (const ClockKey& key : kWithDefault) read_into(table, key.figure, out.clock.*key.field);
  need_figure(table, kOffsetBound, out.clock.offset_bound_s);
  need_figure(table, kRateBound, out.clock.rate_bound);
  return out;
}

/// What an earlier table names already.
void refuse_twice(const std::vector<TomlTable>& tables, const std::vector<ClockSpec>& clocks) {
  const TomlTable& table = tables.back();
  const MotionClock& now = clocks.back().clock;
  const std::string remedy = "state one clock for each chip and each gyro";
  for (std::size_t c = 0; c + 1 < clocks.size(); ++c) {
    const MotionClock& before = clocks[c].clock;
    const std::string there = " (" + path_of(c) + ", line " + std::to_string(tables[c].line()) + ")";
    if (!(now.sensors & before.sensors).empty())
      table.fail(table.line_of("package"), "package", in_quotes(clocks.back().name) + " has a clock already" + there,
                 remedy);
    for (std::size_t g = 0; g < now.gyro.size(); ++g) {
      if (now.gyro[g] && before.gyro[g])
        table.fail(table.line_of("gyro"), "gyro",
                   std::string("the ") + (g == 0 ? "first" : "second") + " gyro has a clock already" + there, remedy);
    }
  }
}

/// What T14 and `plumb::check` ask of a clock beside the common instants, where [motion] says how far apart they are.
void check_lag(const TomlTable& table, const MotionClock& clock, double period_s) {
  const double lag_s = clock.offset_bound_s + clock.rate_bound * clock.valid_s;
  if (lag_s <= period_s) return;
  table.fail(table.line_of("offset_bound_s"), "offset_bound_s",
             "and rate_bound over valid_s = " + brief(clock.valid_s) + " s come to " + brief(lag_s) +
                 " s, more than one common sample period (" + brief(period_s) + " s)",
             "state a shorter valid_s, for which the bounds hold, or smaller bounds");
}

/// A sample period, and the key that states it.
struct Period {
  double s;
  std::string field;
  int line;
};

/// Whether a sensor or a gyro is left to the clock of the log.
bool any_left(const ArrayFile& array) {
  SensorSet sensors = array.array.all();
  std::array<bool, kGyros> gyro = {!array.input.rotation_columns.empty(), !array.input.second_rotation_columns.empty()};
  for (const ClockSpec& one : array.motion.clocks) {
    sensors = sensors - one.clock.sensors;
    for (std::size_t g = 0; g < gyro.size(); ++g) gyro[g] = gyro[g] && !one.clock.gyro[g];
  }
  return !sensors.empty() || gyro[0] || gyro[1];
}

/// Of every clock, that of the log among them.
std::vector<Period> periods_of(const std::vector<TomlTable>& tables, const ArrayFile& array, const Period& common) {
  std::vector<Period> out;
  for (std::size_t c = 0; c < tables.size(); ++c)
    out.push_back({array.motion.clocks[c].sample_period_s.value_or(common.s), path_of(c) + ".sample_period_s",
                   tables[c].line_of("sample_period_s")});
  if (any_left(array)) out.push_back(common);
  return out;
}

/// The wait that suits all: stated, or ten periods of the slowest chip.
void settle_wait(const TomlNode& root, const std::string& file, const std::vector<Period>& periods, MotionSpec& out) {
  const auto [fast, slow] =
      std::minmax_element(periods.begin(), periods.end(), [](const Period& a, const Period& b) { return a.s < b.s; });
  const double least_s = kLeastWait * slow->s, most_s = kMostWait * fast->s;
  if (least_s > most_s)
    throw Refusal(FileError{file, slow->line, slow->field,
                            "is " + brief(slow->s) + " s, more than eight times " + fast->field + " = " +
                                brief(fast->s) + " s, and no wait suits both",
                            "log the faster chip at a lower rate, or leave the slower one out"});
  if (!out.clock_wait_s) {
    out.clock_wait_s = std::fmin(kUsualWait * slow->s, most_s);
    return;
  }
  if (*out.clock_wait_s >= least_s && *out.clock_wait_s <= most_s) return;
  throw Refusal(
      FileError{file, root.find("motion")->find("clock_wait_s")->line, "motion.clock_wait_s",
                "is " + brief(*out.clock_wait_s) + " s, out of range",
                "give 5 to 40 sample periods of each chip, here " + brief(least_s) + " to " + brief(most_s) + " s"});
}

/// Only where [motion] says how far common instants are apart; else the session says what is missing.
void check_together(const TomlNode& root, const std::string& file, const std::vector<TomlTable>& tables,
                    ArrayFile& out) {
  const TomlNode* motion = root.find("motion");
  if (motion == nullptr || (!out.motion.sample_period_s && !(out.input.rate_hz > 0.0))) return;
  const TomlNode* key = motion->find("sample_period_s");
  const Period common{out.motion.sample_period_s ? *out.motion.sample_period_s : 1.0 / out.input.rate_hz,
                      "motion.sample_period_s", key != nullptr ? key->line : motion->line};
  for (std::size_t c = 0; c < tables.size(); ++c) check_lag(tables[c], out.motion.clocks[c].clock, common.s);
  settle_wait(root, file, periods_of(tables, out, common), out.motion);
}

}  // namespace

void read_clocks(const TomlNode& root, const std::string& file, ArrayFile& out) {
  const TomlNode* list = root.find("clock");
  if (list == nullptr || (list->kind == TomlNode::Kind::array && list->items.empty())) {
    if (out.motion.clock_wait_s)
      throw Refusal(FileError{file, root.find("motion")->find("clock_wait_s")->line, "motion.clock_wait_s",
                              "is given without a [[clock]]", "add a [[clock]], or remove this key"});
    return;
  }
  if (list->kind != TomlNode::Kind::array)
    throw Refusal(FileError{file, list->line, "clock", "is " + std::string(list->kind_name()) + ", must be a list",
                            "write [[clock]] with two brackets"});
  constexpr auto kMost = static_cast<std::size_t>(kMotionClocks);
  const auto refuse_more = [&file, list](std::size_t table) {
    throw Refusal(FileError{
        file, list->items[table].line, path_of(table),
        "is more than the " + std::to_string(kMost) + " clocks that can be told apart, that of the log included",
        "state one for each chip and gyro, and leave out what is too many"});
  };
  if (list->items.size() > kMost) refuse_more(kMost);
  std::vector<TomlTable> tables;
  for (std::size_t c = 0; c < list->items.size(); ++c) {
    tables.emplace_back(list->items[c], file, path_of(c), known_clock_keys());
    out.motion.clocks.push_back(read_clock(tables.back(), out));
    out.input.clock_columns.push_back(out.motion.clocks.back().column);
    refuse_twice(tables, out.motion.clocks);
  }
  if (tables.size() == kMost && any_left(out)) refuse_more(kMost - 1);
  out.motion.mentioned = true;
  check_together(root, file, tables, out);
}

}  // namespace io
}  // namespace PLUMB_ABI
}  // namespace plumb
