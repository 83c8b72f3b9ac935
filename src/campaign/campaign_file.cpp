#include "plumb/campaign/campaign_file.hpp"

#include <cmath>

#include "../io/array_parts.hpp"
#include "../io/refusal.hpp"
#include "../io/text_tools.hpp"
#include "campaign_parts.hpp"
#include "plumb/core/detail/archive.hpp"
#include "plumb/io/hash.hpp"
#include "plumb/io/output_file.hpp"
#include "plumb/scenario/count_text.hpp"

namespace plumb {
namespace campaign {
namespace {

using io::Quantity;
using io::TomlNode;
using io::TomlTable;
using std::size_t;

constexpr std::uint64_t kMostCells = 20000;
constexpr std::int64_t kMostScenarios = 1000000000000000;

/// Monitors on the plan's time axis must not meet a gap that they take for an interruption.
void read_run(const TomlTable& top, const MonitorConfig& monitor, Plan& plan) {
  const TomlTable table =
      section_of(top, "run", {"stations", "samples", "rate", "move", "onset", "start", "validation_stations"});
  plan.window = monitor.window;
  plan.stations = whole(table, "stations", 8, 1, kMostStations);
  plan.samples = whole(table, "samples", monitor.window, 1, kMostSamples);
  if (plan.samples % plan.window != 0) {
    table.fail(table.line_of("samples"), "samples",
               "must be a multiple of the monitor's window, " + std::to_string(plan.window),
               "give a multiple of the window, so that each block lies in one station");
  }
  if (plan.stations * (plan.samples / plan.window) > kMostBlocks) {
    table.fail(table.line_of("samples"), "samples", "makes more than " + std::to_string(kMostBlocks) + " blocks",
               "use fewer stations, or fewer samples at each station");
  }
  plan.rate_hz = table.quantity(Quantity::rate, "rate", 100.0);
  plan.move_s = table.quantity(Quantity::time, "move", 1.0);
  if (!(plan.rate_hz >= 1e-3 && plan.rate_hz <= 1e6)) {
    table.fail(table.line_of("rate"), "rate", "is out of range", "give 1e-3 to 1e6 Hz, as in \"100 Hz\"");
  }
  if (!(plan.move_s >= 0.0 && plan.move_s < monitor.max_gap_s)) {
    table.fail(table.line_of("move"), "move", "must be shorter than the monitor's max_gap",
               "give the time between two stations, as in \"1 s\"");
  }
  const std::string when =
      "give the station at which faults begin, or the first and the last such station: onset = [1, 3]";
  const std::vector<double> onset = numbers(table, "onset", {1.0}, 1.0, plan.stations, when);
  plan.first_onset = static_cast<int>(onset.front());
  plan.last_onset = static_cast<int>(onset.back());
  if (onset.size() > 2 || plan.last_onset < plan.first_onset) {
    table.fail(table.line_of("onset"), "onset", "must be one station, or two in ascending order", when);
  }
  plan.start = static_cast<Start>(table.choice("start", {"validated", "power-on"}, 0));
  plan.validation_stations = whole(table, "validation_stations", 8, 1, kMostStations);
}

/// The length of the magnetic field: the range that an array file takes (docs/array-file.md).
std::vector<double> read_reference(const TomlTable& top, Plan& plan) {
  const TomlTable table = section_of(top, "reference", {"value", "sigma", "errors"});
  constexpr double kLeast_ut = 20.0, kMost_ut = 70.0, kMostSigma_ut = 0.4, kUsualSigma_ut = 0.13;
  plan.gravity_mps2 = table.need_quantity(Quantity::acceleration, "value",
                                          "give the length of the field: [reference] with value = \"50.8 uT\"");
  plan.gravity_sigma_mps2 = table.quantity(Quantity::acceleration, "sigma", io::kInside_per_ut * kUsualSigma_ut);
  const double value_ut = plan.gravity_mps2 / io::kInside_per_ut;
  if (!(value_ut >= kLeast_ut && value_ut <= kMost_ut)) {
    table.fail(table.line_of("value"), "value", "is out of range", "give 20 to 70 uT");
  }
  const double sigma_ut = plan.gravity_sigma_mps2 / io::kInside_per_ut;
  if (!(sigma_ut >= 0.0 && sigma_ut <= kMostSigma_ut)) {
    table.fail(table.line_of("sigma"), "sigma", "is out of range", "give 0 to 400 nT, as in \"130 nT\"");
  }
  return numbers(table, "errors", {0.0}, -100.0, 100.0,
                 "give true field minus configured field, in sigmas: errors = [0, 1, 3]");
}

std::vector<double> read_gravity(const TomlTable& top, Plan& plan) {
  if (plan.magnetic) return read_reference(top, plan);
  const TomlTable table = section_of(top, "gravity", {"value", "sigma", "errors"});
  plan.gravity_mps2 = table.quantity(Quantity::acceleration, "value", kG0_mps2);
  plan.gravity_sigma_mps2 = table.quantity(Quantity::acceleration, "sigma", 1e-4 * kG0_mps2);
  if (!(plan.gravity_mps2 >= 9.5 && plan.gravity_mps2 <= 10.2)) {
    table.fail(table.line_of("value"), "value", "is out of range", "give 9.5 to 10.2 m/s^2");
  }
  if (!(plan.gravity_sigma_mps2 >= 0.0 && plan.gravity_sigma_mps2 <= 0.1)) {
    table.fail(table.line_of("sigma"), "sigma", "is out of range", "give 0 to 0.1 m/s^2, as in \"0.1 mg0\"");
  }
  return numbers(table, "errors", {0.0}, -100.0, 100.0,
                 "give true gravity minus configured gravity, in sigmas: errors = [0, 1, 3]");
}

void read_calibration(const TomlTable& top, Plan& plan) {
  const TomlTable table = section_of(top, "calibration", {"left", "days"});
  plan.calibration_mps2 = table.quantity(Quantity::acceleration, "left", 0.0);
  if (!(plan.calibration_mps2 >= 0.0 && plan.calibration_mps2 <= 0.1)) {
    table.fail(table.line_of("left"), "left", "is out of range",
               std::string("give the error that calibration left in a reading, 1 sigma, ") +
                   (plan.magnetic ? "0 to 400 nT: left = \"20 nT\"" : "0 to 0.1 m/s^2: left = \"0.03 mg0\""));
  }
  plan.days_since_calibration = table.quantity(Quantity::ratio, "days", 0.0);
  if (!(plan.days_since_calibration >= 0.0 && plan.days_since_calibration <= kMostDaysSinceCalibration)) {
    table.fail(table.line_of("days"), "days", "is out of range",
               "give the days since the calibration, 0 or more: days = 30");
  }
}

std::vector<Expectation> read_expectations(const TomlTable& top) {
  std::vector<std::string> names;
  for (int k = 0; k < kCounts; ++k) names.emplace_back(to_string(static_cast<Count>(k)));
  const TomlTable table = section_of(top, "expect", names);
  std::vector<Expectation> out;
  for (int k = 0; k < kCounts; ++k) {
    const auto count = static_cast<Count>(k);
    if (!table.has(to_string(count))) continue;
    const std::int64_t most = table.integer(to_string(count), 0);
    if (most < 0) table.fail(table.line_of(to_string(count)), to_string(count), "is negative", "give 0 or more");
    out.push_back({count, static_cast<std::uint64_t>(most)});
  }
  return out;
}

/// Every combination, less those that ask for more faults than there are units to lie, or than the grade bears.
void lay_cells(const TomlTable& top, const std::vector<FaultFamily>& families, const std::vector<double>& gravity,
               bool within_grade, Plan& plan) {
  for (const FaultFamily& family : families) {
    const size_t first = plan.faults.size();
    plan.faults.insert(plan.faults.end(), family.faults.begin(), family.faults.end());
    for (size_t fault = first; fault < plan.faults.size(); ++fault) {
      const bool alone = plan.faults[fault].healthy || plan.faults[fault].whole_log;
      const std::vector<int> counts = alone ? std::vector<int>{0} : family.sensors;
      for (const int faulty : counts) {
        for (size_t tool = 0; tool < plan.tools.size(); ++tool) {
          const ToolPlan& t = plan.tools[tool];
          if (faulty > (within_grade ? t.grade : t.units() - 1)) continue;
          for (size_t attitude = 0; attitude < plan.attitudes.size(); ++attitude) {
            for (const double error : gravity) {
              plan.cells.push_back(
                  {static_cast<int>(tool), static_cast<int>(attitude), static_cast<int>(fault), faulty, error});
            }
          }
        }
      }
    }
  }
  if (plan.cells.empty()) {
    top.fail(top.line_of("fault"), "fault",
             "leaves no combination: each has more faulty sensors than its tool can isolate",
             "use fewer faulty sensors at once, a tool with more sensors, or within_grade = \"no\"");
  }
  if (plan.cells.size() > kMostCells) {
    top.fail(0, "",
             "makes " + count_text(plan.cells.size(), "combination") + ", more than " + std::to_string(kMostCells),
             "use fewer tools, attitudes, faults or gravity errors");
  }
}

/// What the sensors of a campaign measure: one field for all of its tools.
io::FieldKind field_of(const TomlTable& any) {
  const int which = any.choice("field", {"gravity", "magnetic", "rate"}, 0);
  if (which == 2) {
    any.fail(any.line_of("field"), "field",
             "is \"rate\", and a campaign judges by the length of the vector, which a rate does not have",
             "plumb geometry FILE#GROUP has the sizes of gyros, and plumb simulate with plumb monitor --group plays "
             "faults against them; fields of a campaign: gravity, magnetic");
  }
  const bool magnetic = which == 1;
  if (const char* const other = magnetic ? "gravity" : "reference"; any.has(other)) {
    any.fail(any.line_of(other), other,
             magnetic ? "is a section of a campaign of accelerometers" : "is a section of a campaign of magnetometers",
             magnetic ? "state the length of the field in [reference]"
                      : "state gravity in [gravity], or set field = \"magnetic\"");
  }
  return magnetic ? io::FieldKind::magnetic : io::FieldKind::gravity;
}

CampaignFile parsed(const TomlNode& root, const std::string& path, const io::FieldLookup& lookup) {
  const std::vector<std::string> sections = {"name",     "field",     "scenarios",   "seed",    "cells",
                                             "tool",     "run",       "gravity",     "monitor", "within_grade",
                                             "attitude", "reference", "calibration", "fault",   "expect"};
  const io::FieldKind field = field_of(TomlTable(root, path, "", sections));
  const TomlTable top(root, path, "", sections, field);
  CampaignFile out;
  out.path = path;
  Plan& plan = out.plan;
  const std::string file_name = io::last_part(path);
  plan.name = top.text("name", file_name.substr(0, file_name.rfind('.')));
  top.need("scenarios", "give the number of scenarios: scenarios = 100000");
  const std::int64_t scenarios = top.integer("scenarios", 1), seed = top.integer("seed", 1);
  if (scenarios < 1 || scenarios > kMostScenarios) {
    top.fail(top.line_of("scenarios"), "scenarios", "is out of range", "give 1 to 1e15");
  }
  if (seed < 0) top.fail(top.line_of("seed"), "seed", "is negative", "give a whole number from 0 up");
  plan.scenarios = static_cast<std::uint64_t>(scenarios);
  plan.seed = static_cast<std::uint64_t>(seed);
  plan.sweep = top.choice("cells", {"sweep", "drawn"}, 0) == 0;
  const bool within_grade = top.choice("within_grade", {"no", "yes"}, 0) == 1;
  plan.magnetic = field == io::FieldKind::magnetic;
  const MonitorConfig monitor = io::read_monitor({root, path, field, ""});
  if (monitor.mode != MonitorMode::plumb) {
    top.fail(top.line_of("monitor"), "monitor", "has mode = \"paper\", and a campaign runs plumb's own monitor",
             "set mode = \"plumb\", or remove the key");
  }
  plan.alert_limit_rad = monitor.alert_limit_rad;
  ArchiveWriter counting(nullptr, 0, kCapacity);
  counting.put(monitor);
  plan.monitor.resize(counting.used());
  ArchiveWriter writer(plan.monitor.data(), plan.monitor.size(), kCapacity);
  writer.put(monitor);
  read_run(top, monitor, plan);
  const std::vector<double> gravity = read_gravity(top, plan);
  read_calibration(top, plan);
  plan.tools = read_tools(top, monitor, io::read_usual_stability({root, path, field, ""}), lookup);
  plan.attitudes = read_attitudes(top);
  lay_cells(top, read_faults(top), gravity, within_grade, plan);
  out.expect = read_expectations(top);
  return out;
}

/// Hashes numbers one by one, so that padding does not enter.
class PlanHash {
 public:
  void add(const void* data, size_t size) { value_ = io::fnv1a(data, size, value_); }
  void add(double number) { add(&number, sizeof number); }
  void add(std::uint64_t number) { add(&number, sizeof number); }
  void add(int number) { add(static_cast<std::uint64_t>(static_cast<std::int64_t>(number))); }
  std::uint64_t value() const { return value_; }

 private:
  std::uint64_t value_ = io::kFnvStart;
};

}  // namespace

std::vector<TomlTable> tables_of(const TomlTable& top, const char* key, const std::vector<std::string>& known) {
  std::vector<TomlTable> out;
  const TomlNode* node = top.find(key);
  if (node == nullptr) return out;
  if (node->kind == TomlNode::Kind::table) return {TomlTable(*node, top.file(), key, known, top.field_of())};
  if (node->kind != TomlNode::Kind::array) {
    top.fail(node->line, key, "is not a table", std::string("write [[") + key + "]] and its keys below");
  }
  for (size_t k = 0; k < node->items.size(); ++k) {
    if (node->items[k].kind != TomlNode::Kind::table) {
      top.fail(node->line, key, "is not a list of tables", std::string("write [[") + key + "]] and its keys below");
    }
    out.emplace_back(node->items[k], top.file(), std::string(key) + "[" + std::to_string(k + 1) + "]", known,
                     top.field_of());
  }
  return out;
}

TomlTable section_of(const TomlTable& top, const char* key, const std::vector<std::string>& known) {
  static const TomlNode nothing = [] {
    TomlNode node;
    node.kind = TomlNode::Kind::table;
    return node;
  }();
  const TomlNode* node = top.find(key);
  if (node != nullptr && node->kind != TomlNode::Kind::table) {
    top.fail(node->line, key, "is not a table", std::string("write [") + key + "] and its keys below");
  }
  return TomlTable(node == nullptr ? nothing : *node, top.file(), key, known, top.field_of());
}

int whole(const TomlTable& table, const char* key, int fallback, int least, int most) {
  const std::int64_t value = table.integer(key, fallback);
  if (value < least || value > most) {
    table.fail(table.line_of(key), key, "is " + std::to_string(value) + ", out of range",
               "give " + std::to_string(least) + " to " + std::to_string(most));
  }
  return static_cast<int>(value);
}

std::vector<double> numbers(const TomlTable& table, const char* key, const std::vector<double>& fallback, double least,
                            double most, const std::string& remedy) {
  const TomlNode* node = table.find(key);
  if (node == nullptr) return fallback;
  std::vector<const TomlNode*> items;
  if (node->kind == TomlNode::Kind::array) {
    for (const TomlNode& item : node->items) items.push_back(&item);
  } else {
    items.push_back(node);
  }
  std::vector<double> out;
  for (const TomlNode* item : items) {
    const bool number = item->kind == TomlNode::Kind::number || item->kind == TomlNode::Kind::integer;
    if (!number || !(item->number >= least && item->number <= most)) {
      table.fail(item->line, key, number ? "is out of range" : "is not a number", remedy);
    }
    out.push_back(item->number);
  }
  if (out.empty()) table.fail(node->line, key, "is empty", remedy);
  return out;
}

io::FileExpected<CampaignFile> parse_campaign_text(const std::string& text, const std::string& path,
                                                   const io::FieldLookup& lookup) {
  const io::FileExpected<TomlNode> root = io::parse_toml(text, path);
  if (!root) return tl::unexpected<io::FileError>(root.error());
  try {
    return parsed(*root, path, lookup);
  } catch (const io::Refusal& refusal) {
    return tl::unexpected<io::FileError>(refusal.error());
  }
}

io::FileExpected<CampaignFile> read_campaign(const std::string& path, const io::FieldLookup& lookup) {
  const io::FileExpected<std::string> text = io::read_file(path);
  if (!text) return tl::unexpected<io::FileError>(text.error());
  return parse_campaign_text(*text, path, lookup);
}

std::uint64_t hash_of(const Plan& plan) {
  PlanHash hash;
  hash.add(plan.seed);
  hash.add(plan.scenarios);
  if (plan.magnetic) hash.add(1);  // of gravity nothing, so that the results of earlier versions go on
  for (const int number : {plan.sweep ? 1 : 0, plan.stations, plan.samples, plan.first_onset, plan.last_onset,
                           static_cast<int>(plan.start), plan.validation_stations, plan.window}) {
    hash.add(number);
  }
  for (const double number : {plan.rate_hz, plan.move_s, plan.gravity_mps2, plan.gravity_sigma_mps2,
                              plan.calibration_mps2, plan.alert_limit_rad, plan.days_since_calibration}) {
    hash.add(number);
  }
  hash.add(plan.monitor.data(), plan.monitor.size());
  for (const ToolPlan& tool : plan.tools) {
    hash.add(tool.sensors);
    for (const auto& axis : tool.axis) hash.add(axis.data(), sizeof axis);
    hash.add(tool.sigma_mps2.data(), sizeof tool.sigma_mps2);
    hash.add(tool.detectable_mps2.data(), sizeof tool.detectable_mps2);
    hash.add(tool.volt_per_mps2);
    hash.add(tool.resolution_raw);
    if (tool.units() < tool.sensors) hash.add(tool.chip.data(), sizeof tool.chip);
    for (const auto& stability : tool.stability) hash.add(stability.data(), sizeof stability);
  }
  for (const AttitudePlan& a : plan.attitudes) {
    hash.add(static_cast<int>(a.kind));
    for (const double number : {a.inclination_rad, a.build_rad, a.turn_rad, a.toolface_step_rad, a.toolface_jitter_rad,
                                a.direction[0], a.direction[1], a.direction[2]}) {
      hash.add(number);
    }
  }
  for (const FaultPlan& f : plan.faults) {
    hash.add(f.kind);
    hash.add((f.healthy ? 1 : 0) + (f.whole_log ? 2 : 0));
    for (const double number : {f.magnitude, f.upper, f.duration_stations, f.least_mdb, f.most_mdb}) hash.add(number);
  }
  for (const Cell& cell : plan.cells) {
    for (const int number : {cell.tool, cell.attitude, cell.fault, cell.faulty}) hash.add(number);
    hash.add(cell.gravity_sigmas);
  }
  return hash.value();
}

}  // namespace campaign
}  // namespace plumb
