// What was counted, as the report shows it.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "plumb/campaign/replay.hpp"
#include "plumb/core/units.hpp"
#include "plumb/io/json_fields.hpp"
#include "plumb/render/trials_json.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace render {
namespace {

using campaign::Count;
using campaign::Plan;
using std::size_t;
using verification::rate_of;

constexpr size_t kShownOfAKind = 3;

/// Scenarios of one fault and one number of faulty sensors.
struct Group {
  std::string fault;
  int faulty = 0;
  bool lone_shift = false;
  std::vector<const verification::Trial*> trial;
};

const campaign::FaultPlan& fault_of(const Plan& plan, const verification::Trial& t) {
  return plan.faults[static_cast<size_t>(plan.cells[static_cast<size_t>(t.cell)].fault)];
}

int faulty_of(const Plan& plan, const verification::Trial& t) { return plan.cells[static_cast<size_t>(t.cell)].faulty; }

/// In the order of the file, fewest sensors first.
std::vector<Group> groups_of(const verification::Trials& trials) {
  const Plan& plan = trials.file.plan;
  std::map<std::pair<int, int>, Group> groups;
  for (const verification::Trial& t : trials.trial) {
    const campaign::Cell& cell = plan.cells[static_cast<size_t>(t.cell)];
    Group& group = groups[{cell.fault, cell.faulty}];
    group.fault = fault_of(plan, t).name;
    group.faulty = cell.faulty;
    group.trial.push_back(&t);
  }
  std::vector<Group> out;
  for (auto& [key, group] : groups) out.push_back(std::move(group));
  return out;
}

template <class Test>
std::uint64_t count_if(const std::vector<const verification::Trial*>& trials, Test&& test) {
  return static_cast<std::uint64_t>(
      std::count_if(trials.begin(), trials.end(), [&](const verification::Trial* t) { return test(*t); }));
}

/// The value below which so many of a hundred lie; null where there is none.
Json percentile(std::vector<int>& sorted, int percent) {
  if (sorted.empty()) return {};
  const size_t rank = (sorted.size() * static_cast<size_t>(percent) + 99) / 100;
  return sorted[std::max<size_t>(rank, 1) - 1];
}

/// Blocks from the onset on, the first counted as 1.
template <class Block>
Json times_json(const std::vector<const verification::Trial*>& trials, double block_s, Block&& block) {
  std::vector<int> blocks;
  for (const verification::Trial* t : trials) {
    const int at = block(*t);
    if (t->first_fault_block >= 0 && at >= t->first_fault_block) blocks.push_back(at - t->first_fault_block + 1);
  }
  std::sort(blocks.begin(), blocks.end());
  const auto seconds = [block_s](const Json& n) { return n.is_null() ? n : Json(n.get<int>() * block_s); };
  const Json half = percentile(blocks, 50), most = percentile(blocks, 95), last = percentile(blocks, 100);
  return io::object({{"cases", blocks.size()},
                     {"median_blocks", half},
                     {"p95_blocks", most},
                     {"last_blocks", last},
                     {"median_s", seconds(half)},
                     {"p95_s", seconds(most)},
                     {"last_s", seconds(last)}});
}

double largest_deg(const std::vector<const verification::Trial*>& trials, double verification::Trial::*angle_rad) {
  double out = 0.0;
  for (const verification::Trial* t : trials) out = std::fmax(out, t->*angle_rad);
  return deg_from_rad(out);
}

bool isolated(const verification::Trial& t) { return t.faulty != 0 && t.excluded == t.faulty; }
bool wrong(const verification::Trial& t) { return (t.ever_excluded & ~t.faulty) != 0; }

Json group_json(const Group& group, double block_s) {
  const std::uint64_t n = group.trial.size();
  const auto rate = [&](auto test) { return rate_json(rate_of(count_if(group.trial, test), n)); };
  return io::object(
      {{"fault", group.fault},
       {"faulty", group.faulty},
       {"scenarios", n},
       {"detected", rate([](const verification::Trial& t) { return t.detected(); })},
       {"isolated", rate(isolated)},
       {"wrong_exclusion", rate(wrong)},
       {"wrong_provisional_exclusion",
        rate([](const verification::Trial& t) { return (t.ever_provisionally_excluded & ~t.faulty) != 0; })},
       {"misleading", rate([](const verification::Trial& t) { return t.misleading; })},
       {"beyond_protection", rate([](const verification::Trial& t) { return t.beyond_protection; })},
       {"failed", rate([](const verification::Trial& t) { return t.failed; })},
       {"to_detect", times_json(group.trial, block_s, [](const verification::Trial& t) { return t.alarm_block; })},
       {"to_isolate", times_json(group.trial, block_s, [](const verification::Trial& t) { return t.isolated_block; })},
       {"tilt_before_alarm_deg", largest_deg(group.trial, &verification::Trial::tilt_before_alarm_rad)},
       {"tilt_usable_deg", largest_deg(group.trial, &verification::Trial::tilt_usable_rad)}});
}

/// What is the case against what the monitor says at the end; every scenario in one column.
Json confusion_json(const verification::Trials& trials) {
  const std::vector<std::string> columns = {"no alarm",
                                            "alarm, no sensor excluded",
                                            "provisionally excluded",
                                            "only some of the faulty sensors",
                                            "exactly the faulty sensors",
                                            "a healthy sensor excluded"};
  std::map<int, std::vector<std::uint64_t>> rows;
  for (const verification::Trial& t : trials.trial) {
    std::vector<std::uint64_t>& row = rows[static_cast<int>(SensorSet(t.faulty).size())];
    row.resize(columns.size());
    size_t column = 0;
    if (wrong(t)) {
      column = 5;
    } else if (isolated(t)) {
      column = 4;
    } else if (t.excluded != 0) {
      column = 3;
    } else if (t.ever_provisionally_excluded != 0) {
      column = 2;
    } else if (t.alarm_block >= 0) {
      column = 1;
    }
    ++row[column];
  }
  Json out = io::object({{"columns", columns}, {"rows", Json::array()}});
  for (const auto& [faulty, counts] : rows) out["rows"].push_back(io::object({{"faulty", faulty}, {"counts", counts}}));
  return out;
}

/// Single constant shifts by size, two bins an octave.
Json by_size_json(const verification::Trials& trials) {
  constexpr double kFirst = 0.25;
  constexpr int kBins = 16;
  std::array<std::vector<const verification::Trial*>, kBins> bin;
  for (const verification::Trial& t : trials.trial) {
    const campaign::FaultPlan& fault = fault_of(trials.file.plan, t);
    if (!(t.largest_mdb > 0.0) || fault.least_mdb == fault.most_mdb) continue;
    const int at = static_cast<int>(std::floor(2.0 * std::log2(t.largest_mdb / kFirst)));
    bin[static_cast<size_t>(std::clamp(at, 0, kBins - 1))].push_back(&t);
  }
  Json out = Json::array();
  for (int k = 0; k < kBins; ++k) {
    const auto& cases = bin[static_cast<size_t>(k)];
    if (cases.empty()) continue;
    const auto rate = [&cases](auto test) { return rate_json(rate_of(count_if(cases, test), cases.size())); };
    out.push_back(io::object({{"from_mdb", kFirst * std::exp2(0.5 * k)},
                              {"to_mdb", kFirst * std::exp2(0.5 * (k + 1))},
                              {"detected", rate([](const verification::Trial& t) { return t.detected(); })},
                              {"isolated", rate(isolated)}}));
  }
  return out;
}

Json stanford_json(const campaign::Tally& tally) {
  Json out = io::object({{"regions", Json::object()}, {"first_octave_ends_at_deg", 0.001}, {"counts", Json::array()}});
  std::uint64_t blocks = 0;
  for (int k = 0; k < campaign::kRegions; ++k) blocks += tally.region(static_cast<campaign::Region>(k));
  for (int k = 0; k < campaign::kRegions; ++k) {
    const auto region = static_cast<campaign::Region>(k);
    out["regions"][to_string(region)] = rate_json(rate_of(tally.region(region), blocks));
  }
  for (int level = 0; level <= campaign::kOctaves; ++level) {
    Json row = Json::array();
    for (int error = 0; error < campaign::kOctaves; ++error) row.push_back(tally.stanford(error, level));
    out["counts"].push_back(std::move(row));
  }
  return out;
}

/// The worst of each kind; ties go to the smaller number.
class Worst {
 public:
  Worst(const verification::Trials& trials, const std::string& command) : trials_(trials), command_(command) {}

  template <class Size>
  void add(const char* what, const char* unit, Size&& size) {
    std::vector<std::pair<double, const verification::Trial*>> found;
    for (const verification::Trial& t : trials_.trial) {
      const double value = size(t);
      if (value > 0.0) found.emplace_back(value, &t);
    }
    const size_t shown = std::min(found.size(), kShownOfAKind);
    std::partial_sort(found.begin(), found.begin() + static_cast<std::ptrdiff_t>(shown), found.end(),
                      [](const auto& a, const auto& b) {
                        return a.first > b.first || (a.first == b.first && a.second->number < b.second->number);
                      });
    for (size_t k = 0; k < shown; ++k) {
      const campaign::Spec spec = campaign::spec_of(trials_.file.plan, found[k].second->number);
      out_.push_back(io::object({{"what", what},
                                 {"value", found[k].first},
                                 {"unit", unit},
                                 {"scenario", spec.number},
                                 {"story", campaign::sentence_of(trials_.file.plan, spec)},
                                 {"replay", command_ + " --replay " + std::to_string(spec.number)}}));
    }
  }
  Json take() { return std::move(out_); }

 private:
  const verification::Trials& trials_;
  std::string command_;
  Json out_ = Json::array();
};

Json plan_json(const verification::Trials& trials) {
  const Plan& plan = trials.file.plan;
  Json attitudes = Json::array();
  for (const campaign::AttitudePlan& a : plan.attitudes) attitudes.push_back(a.name);
  return io::object({{"plan_hash", fmt::format("{:016x}", campaign::hash_of(plan))},
                     {"seed", plan.seed},
                     {"scenarios", plan.scenarios},
                     {"cells", plan.cells.size()},
                     {"stations", plan.stations},
                     {"block_samples", plan.window},
                     {"block_s", plan.window / plan.rate_hz},
                     {"attitudes", std::move(attitudes)},
                     {"gravity_sigma_mps2", plan.gravity_sigma_mps2},
                     {"calibration_bias_sigma_mps2", plan.calibration_mps2},
                     {"alert_limit_deg", deg_from_rad(plan.alert_limit_rad)}});
}

}  // namespace

Json rate_json(const verification::Rate& rate) {
  return io::object({{"count", rate.count}, {"of", rate.of}, {"low", rate.low}, {"high", rate.high}});
}

Json rates_json(const campaign::Tally& tally) {
  Json out = Json::object();
  for (int k = 1; k < campaign::kCounts; ++k) {
    const auto count = static_cast<Count>(k);
    out[to_string(count)] = rate_json(rate_of(tally.total(count), tally.total(Count::scenarios)));
    out[to_string(count)]["words"] = words_of(count);
  }
  return out;
}

Json fault_trials_json(const verification::Trials& trials, const std::string& command) {
  const Plan& plan = trials.file.plan;
  const campaign::Tally& tally = trials.counted.tally;
  const double block_s = plan.window / plan.rate_hz;
  Json out = io::object({{"played", true}, {"plan", plan_json(trials)}, {"rates", rates_json(tally)}});
  out["mdb_mps2"] = Json::array();
  for (int i = 0; i < plan.tools.front().sensors; ++i)
    out["mdb_mps2"].push_back(plan.tools.front().detectable_mps2[static_cast<size_t>(i)]);
  out["by_fault"] = Json::array();
  for (const Group& group : groups_of(trials)) out["by_fault"].push_back(group_json(group, block_s));
  out["confusion"] = confusion_json(trials);
  out["by_size"] = by_size_json(trials);
  out["blocks_to_detect"] = verification::up_to_the_last(tally.blocks_to_detect());
  out["blocks_to_isolate"] = verification::up_to_the_last(tally.blocks_to_isolate());
  out["stanford"] = stanford_json(tally);
  Worst worst(trials, command);
  worst.add("a healthy sensor excluded", "sensors", [](const verification::Trial& t) {
    return static_cast<double>(SensorSet(t.ever_excluded & ~t.faulty).size());
  });
  worst.add("misleading: error above the alert limit without an alert", "deg",
            [](const verification::Trial& t) { return t.misleading ? deg_from_rad(t.tilt_usable_rad) : 0.0; });
  worst.add("error above the protection level, by", "deg",
            [](const verification::Trial& t) { return deg_from_rad(t.excess_rad); });
  worst.add("largest error before any alarm", "deg",
            [](const verification::Trial& t) { return t.faulty != 0 ? deg_from_rad(t.tilt_before_alarm_rad) : 0.0; });
  worst.add("latest alarm after the onset", "blocks", [](const verification::Trial& t) {
    return t.detected() && t.faulty != 0 ? static_cast<double>(t.alarm_block - t.first_fault_block + 1) : 0.0;
  });
  out["worst"] = worst.take();
  out["largest_faulty"] = 0;
  for (const verification::Trial& t : trials.trial)
    out["largest_faulty"] = std::max(out["largest_faulty"].get<int>(), faulty_of(plan, t));
  return out;
}

Json healthy_trials_json(const verification::Trials& trials, const std::string& command) {
  const campaign::Tally& tally = trials.counted.tally;
  Json out = io::object({{"played", true}, {"plan", plan_json(trials)}});
  const std::uint64_t scenarios = tally.total(Count::scenarios), alarms = tally.total(Count::false_alarm);
  std::vector<const verification::Trial*> all;
  for (const verification::Trial& t : trials.trial) all.push_back(&t);
  out["false_alarm_per_block"] = rate_json(rate_of(alarms, blocks_at_risk(trials)));
  out["false_alarm_per_scenario"] = rate_json(rate_of(alarms, scenarios));
  for (const Count count :
       {Count::wrong_exclusion, Count::misleading, Count::beyond_protection, Count::unavailable, Count::failed})
    out[to_string(count)] = rate_json(rate_of(tally.total(count), scenarios));
  out["tilt_usable_deg"] = largest_deg(all, &verification::Trial::tilt_usable_rad);
  out["stanford"] = stanford_json(tally);
  Worst worst(trials, command);
  worst.add("false alarm, at block", "blocks", [](const verification::Trial& t) {
    return t.alarm_block >= 0 ? static_cast<double>(t.alarm_block + 1) : 0.0;
  });
  worst.add("error above the protection level, by", "deg",
            [](const verification::Trial& t) { return deg_from_rad(t.excess_rad); });
  out["worst"] = worst.take();
  return out;
}

}  // namespace render
}  // namespace PLUMB_ABI
}  // namespace plumb
