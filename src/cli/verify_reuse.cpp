#include "verify_reuse.hpp"

#include <algorithm>
#include <filesystem>

#include "plumb/campaign/result_file.hpp"
#include "plumb/io/json_fields.hpp"
#include "plumb/io/output_file.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace cli {
namespace {

using campaign::Count;

tl::unexpected<io::FileError> refuse(const std::string& path, const std::string& what, const std::string& remedy) {
  return tl::unexpected<io::FileError>(io::FileError{path, 0, "--reuse", what, remedy});
}

/// Blocks of a scenario where all have as many; 0 where they differ.
int blocks_of_each(const report::Trials& trials) {
  const int first = trials.trial.empty() ? 0 : trials.trial.front().blocks;
  const bool same =
      std::all_of(trials.trial.begin(), trials.trial.end(), [first](const auto& t) { return t.blocks == first; });
  return same ? first : 0;
}

Json rates_of(const campaign::Tally& tally) {
  Json out = Json::object();
  const std::uint64_t scenarios = tally.total(Count::scenarios);
  for (int k = 1; k < campaign::kCounts; ++k) {
    const auto count = static_cast<Count>(k);
    out[to_string(count)] = report::rate_json(tally.total(count), scenarios);
    out[to_string(count)]["words"] = words_of(count);
  }
  return out;
}

}  // namespace

io::FileExpected<void> take_reused(const std::vector<std::string>& paths, const Verification& played, Json& section) {
  for (const std::string& path : paths) {
    const std::string remedy =
        "play faults.toml or healthy.toml of this report: plumb campaign faults.toml --scenarios N --out faults.json";
    const io::FileExpected<std::string> text = io::read_file(path);
    if (!text) return tl::unexpected<io::FileError>(text.error());
    const Json json = io::parsed(*text);
    if (json.is_discarded() || !json.is_object() || !json.value("scenarios", Json()).is_number_unsigned() ||
        !json.value("campaign", Json()).is_string())
      return refuse(path, "is no result of a campaign", remedy);
    const bool healthy = json["campaign"] == played.array.name + ": healthy";
    const std::optional<report::Trials>& here = healthy ? played.healthy : played.faults;
    if (!here) return refuse(path, "is of a campaign that could not be played here", "leave it out");
    const std::uint64_t scenarios = json["scenarios"];
    campaign::CampaignFile file = here->file;
    file.plan.scenarios = scenarios;
    const io::FileExpected<campaign::Progress> counted = campaign::read_result(path, file);
    if (!counted) return refuse(path, counted.error().what, remedy);
    if (counted->done < scenarios)
      return refuse(
          path, "is not complete: " + std::to_string(counted->done) + " of " + std::to_string(scenarios) + " scenarios",
          "go on with it: plumb campaign ... --out " + path + " --resume");
    Json rates = rates_of(counted->tally);
    const int blocks = blocks_of_each(*here);
    if (healthy && blocks > 0) {
      // A scenario without an alarm was at risk in all its blocks; one with an alarm in one at least.
      const std::uint64_t alarms = counted->tally.total(Count::false_alarm);
      const std::uint64_t at_risk = (scenarios - alarms) * static_cast<std::uint64_t>(blocks) + alarms;
      rates["false_alarm_per_block"] = report::rate_json(alarms, at_risk);
      rates["false_alarm_per_block"]["words"] = "false alarms, blocks up to the first";
    }
    section[healthy ? "healthy" : "faults"]["reused"] =
        io::object({{"file", std::filesystem::path(path).filename().string()},
                    {"plan_hash", json["plan_hash"]},
                    {"scenarios", scenarios},
                    {"rates", std::move(rates)}});
  }
  return {};
}

}  // namespace cli
}  // namespace PLUMB_ABI
}  // namespace plumb
