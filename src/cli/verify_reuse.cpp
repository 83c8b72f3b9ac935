#include "verify_reuse.hpp"

#include <filesystem>

#include "plumb/campaign/result_file.hpp"
#include "plumb/io/json_fields.hpp"
#include "plumb/io/output_file.hpp"
#include "plumb/render/trials_json.hpp"
#include "plumb/scenario/count_text.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace cli {
namespace {

tl::unexpected<io::FileError> refuse(const std::string& path, const std::string& what, const std::string& remedy) {
  return tl::unexpected<io::FileError>(io::FileError{path, 0, "--reuse", what, remedy});
}

}  // namespace

io::FileExpected<void> take_reused(const std::vector<std::string>& paths, Verification& out, Json& section) {
  for (const std::string& path : paths) {
    const std::string remedy =
        "run faults.toml or healthy.toml of this report: plumb campaign faults.toml --scenarios N --out faults.json";
    const io::FileExpected<std::string> text = io::read_file(path);
    if (!text) return tl::unexpected<io::FileError>(text.error());
    const Json json = io::parsed(*text);
    if (json.is_discarded() || !json.is_object() || !json.value("scenarios", Json()).is_number_unsigned() ||
        !json.value("campaign", Json()).is_string())
      return refuse(path, "is not the result of a campaign", remedy);
    const bool healthy = json["campaign"] == out.array.name + ": healthy";
    const std::optional<verification::Trials>& here = healthy ? out.healthy : out.faults;
    if (!here) return refuse(path, "is the result of a campaign that this machine cannot run", "leave out this option");
    const std::uint64_t scenarios = json["scenarios"];
    campaign::CampaignFile file = here->file;
    file.plan.scenarios = scenarios;
    const io::FileExpected<campaign::Progress> counted = campaign::read_result(path, file);
    if (!counted) return refuse(path, counted.error().what, remedy);
    if (counted->done < scenarios)
      return refuse(path,
                    "is not complete: " + std::to_string(counted->done) + " of " + count_text(scenarios, "scenario"),
                    "continue it: plumb campaign ... --out " + path + " --resume");
    Json rates = render::rates_json(counted->tally);
    if (healthy) {
      take_longer(*here, counted->tally, out.facts.healthy);
      if (blocks_at_risk(*here, counted->tally) > 0) {
        rates["false_alarm_per_block"] = render::rate_json(out.facts.healthy.false_alarm_per_block);
        rates["false_alarm_per_block"]["words"] = "false alarms, blocks up to the first";
      }
    } else {
      take_longer(counted->tally, out.facts.faults);
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
