// [motion], [gyro] and the bounds of the sensors: plain numbers, whose units stand in the keys.
#include <algorithm>
#include <string>

#include "array_parts.hpp"
#include "motion_figure.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace io {
namespace {

struct BoundKey {
  Figure figure;
  std::optional<double> MotionBounds::*field;
};

constexpr const char* kLag = "lag_bound_s";

constexpr BoundKey kBounds[] = {
    {{"lever_arm_bound_m", "m", 0.0, 1.0, "0.001"}, &MotionBounds::lever_arm_m},
    {{kLag, "s", 0.0, 1.0, "70e-6"}, &MotionBounds::lag_s},
    {{"vibration_rectification_per_mps2", "1/(m/s^2)", 0.0, 1.0, "2e-5"}, &MotionBounds::rectification_per_mps2},
    {{"scale_bound", "", 0.0, 0.5, "0.001"}, &MotionBounds::scale},
    {{"axis_bound_rad", "rad", 0.0, 0.5, "0.0015"}, &MotionBounds::axis_rad},
    {{"bias_bound_mps2", "m/s^2", 0.0, 100.0, "0.01"}, &MotionBounds::bias_mps2},
};

struct GyroKey {
  Figure figure;
  std::optional<double> GyroSpec::*field;
};

constexpr GyroKey kGyro[] = {
    {{"scale_bound", "", 0.0, 0.4, "0.01"}, &GyroSpec::scale},
    {{"axis_bound_rad", "rad", 0.0, 0.4, "0.01"}, &GyroSpec::axis_rad},
    {{"bias_bound_radps", "rad/s", 0.0, 10.0, "0.006"}, &GyroSpec::bias_radps},
    {{"noise_radps", "rad/s", 0.0, 10.0, "0.002"}, &GyroSpec::noise_radps},
    {{kLag, "s", 0.0, 1.0, "20e-6"}, &GyroSpec::lag_s},
};

constexpr Figure kPeriod{"sample_period_s", "s", 1e-5, 1.0, "0.001"};
constexpr Figure kRate{"rate_bound_radps", "rad/s", 0.0, 1000.0, "8"};
constexpr Figure kVelocity{"velocity_bound_mps", "m/s", 0.0, 100.0, "0.3"};
constexpr Figure kWindow{"inclination_window_s", "s", 0.01, 600.0, "10"};
/// As far as that of any clock may be: five periods of 10 us to forty of a second.
constexpr Figure kWait{"clock_wait_s", "s", 5e-5, 40.0, "0.01"};

struct LimitKey {
  Figure figure;
  double MotionSetup::*field;
};

constexpr LimitKey kLimits[] = {
    {{"force_bound_mps2", "m/s^2", 0.0, 1e5, "160"}, &MotionSetup::force_bound_mps2},
    {{"false_alarms_per_hour", "", 1e-9, 1.0, "0.001"}, &MotionSetup::false_alarms_per_hour},
    {{"dwell_s", "s", 0.0, 10.0, "0.064"}, &MotionSetup::dwell_s},
    {{"quiet_s", "s", 0.0, 3600.0, "5"}, &MotionSetup::quiet_s},
};

struct CountKey {
  const char* key;
  int most;
  const char* words;
  int MotionSetup::*field;
};

constexpr CountKey kCounts[] = {
    {"max_faults", kMotionDepth, "the most units that may be faulty at once", &MotionSetup::max_faults},
    {"shortest_block", kLongestBlock / 2, "the samples of the shortest blocks to be judged",
     &MotionSetup::shortest_block},
};

constexpr const char* kBlocks = "block_samples";
constexpr const char* kGyroGroup = "group";

std::vector<std::string> known_motion_keys() {
  std::vector<std::string> out = {kPeriod.key, kRate.key, kVelocity.key, kWindow.key, kWait.key, kBlocks};
  for (const CountKey& key : kCounts) out.emplace_back(key.key);
  for (const LimitKey& key : kLimits) out.emplace_back(key.figure.key);
  return with_motion_keys(std::move(out));
}

std::vector<std::string> known_gyro_keys() {
  std::vector<std::string> out = {kGyroGroup, "corroborated"};
  for (const GyroKey& key : kGyro) out.emplace_back(key.figure.key);
  return out;
}

void read_count(const TomlTable& table, const CountKey& count, MotionSetup& limits) {
  const std::int64_t value = table.integer(count.key, limits.*count.field);
  if (value < 1 || value > count.most)
    table.fail(table.line_of(count.key), count.key, "is " + std::to_string(value) + ", out of range",
               std::string("give ") + count.words + ", 1 to " + std::to_string(count.most));
  limits.*count.field = static_cast<int>(value);
}

/// Each longer block is put together from the shorter ones before it.
void read_blocks(const TomlTable& table, MotionSetup& limits) {
  const std::string remedy = "write four whole numbers, each a multiple of the one before: " + std::string(kBlocks) +
                             " = [1, 4, 32, 256]; the first is 1, the last at most " + std::to_string(kLongestBlock);
  if (const TomlNode* list = table.find(kBlocks); list != nullptr) {
    if (list->kind != TomlNode::Kind::array || list->items.size() != limits.block_samples.size())
      table.fail(list->line, kBlocks, "must be a list of four lengths", remedy);
    for (std::size_t k = 0; k < limits.block_samples.size(); ++k) {
      const TomlNode& item = list->items[k];
      const int part = k == 0 ? 1 : limits.block_samples[k - 1];
      const bool whole = item.kind == TomlNode::Kind::integer && item.integer >= 1 && item.integer <= kLongestBlock;
      const int samples = whole ? static_cast<int>(item.integer) : 0;
      if (!whole || samples % part != 0 || samples == (k == 0 ? 0 : part) || (k == 0 && samples != 1))
        table.fail(item.line, kBlocks, "has a length that does not fit, number " + std::to_string(k + 1), remedy);
      limits.block_samples[k] = samples;
    }
  }
  if (limits.shortest_block > limits.block_samples[2])
    table.fail(table.line_of("shortest_block"), "shortest_block",
               "is " + std::to_string(limits.shortest_block) + ", longer than the third of the blocks (" +
                   std::to_string(limits.block_samples[2]) + ")",
               "give 1 to " + std::to_string(limits.block_samples[2]) + ", or longer block_samples");
}

/// The gyros of a group have bounds of their own, and check each other.
void refuse_beside_group(const TomlTable& table, const InputSpec& input) {
  if (!input.rotation_columns.empty())
    table.fail(table.line_of(kGyroGroup), kGyroGroup, "names a group of gyros, and [input] rotation_radps another gyro",
               "keep one of them: the rates of the group, or the columns of rotation_radps");
  for (const std::string& key : known_gyro_keys()) {
    if (key == kGyroGroup || key == kLag || !table.has(key.c_str())) continue;
    table.fail(
        table.line_of(key.c_str()), key.c_str(), "is stated beside group, whose gyros have bounds of their own",
        std::string("remove it; state only ") + kLag + " here, what the group lags the accelerometers by at most");
  }
}

GyroSpec read_gyro(const TomlTable& table, const InputSpec& input) {
  GyroSpec out;
  out.stated = true;
  out.group = table.text(kGyroGroup, "");
  if (!out.group.empty()) refuse_beside_group(table, input);
  if (out.group.empty() && input.rotation_columns.empty())
    table.fail(
        table.line(), "", "describes a gyro, but [input] names no columns with its rates",
        "add rotation_radps = [\"wx\", \"wy\", \"wz\"] to [input], or group with the name of a [[group]] of gyros, "
        "or remove the table");
  for (const GyroKey& key : kGyro) read_into(table, key.figure, out.*key.field);
  const TomlNode* corroborated = table.find("corroborated");
  if (corroborated == nullptr) return out;
  if (corroborated->kind != TomlNode::Kind::boolean)
    table.fail(corroborated->line, "corroborated",
               std::string("is ") + corroborated->kind_name() + ", must be true or false",
               "write corroborated = true where the host compares several gyros, else leave it out");
  out.corroborated = corroborated->boolean;
  return out;
}

}  // namespace

std::vector<std::string> with_motion_keys(std::vector<std::string> names) {
  for (const BoundKey& key : kBounds) names.emplace_back(key.figure.key);
  return names;
}

bool read_motion_bounds(const TomlTable& table, MotionBounds& bounds) {
  bool stated = false;
  for (const BoundKey& key : kBounds) {
    stated = stated || table.has(key.figure.key);
    read_into(table, key.figure, bounds.*key.field);
  }
  return stated;
}

MotionSpec read_motion(const TomlNode& root, const std::string& file, const InputSpec& input) {
  MotionSpec out;
  if (const TomlNode* node = root.find("motion"); node != nullptr) {
    const TomlTable table(*node, file, "motion", known_motion_keys());
    out.stated = true;
    read_into(table, kPeriod, out.sample_period_s);
    read_into(table, kRate, out.rate_bound_radps);
    read_into(table, kVelocity, out.velocity_bound_mps);
    read_into(table, kWait, out.clock_wait_s);
    std::optional<double> window_s;
    read_into(table, kWindow, window_s);
    out.inclination_window_s = window_s.value_or(out.inclination_window_s);
    for (const LimitKey& key : kLimits) read_into(table, key.figure, out.limits.*key.field);
    for (const CountKey& key : kCounts) read_count(table, key, out.limits);
    read_blocks(table, out.limits);
    MotionBounds usual;
    (void)read_motion_bounds(table, usual);
    out.sensor.fill(usual);
  }
  if (const TomlNode* node = root.find("gyro"); node != nullptr)
    out.gyro = read_gyro(TomlTable(*node, file, "gyro", known_gyro_keys()), input);
  out.mentioned = out.stated || out.gyro.stated;
  return out;
}

}  // namespace io
}  // namespace PLUMB_ABI
}  // namespace plumb
