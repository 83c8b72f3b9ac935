#include "plumb/campaign/result_file.hpp"
#include "plumb/io/json_fields.hpp"

#include <fmt/format.h>

#include "plumb/core/units.hpp"
#include "plumb/io/hash.hpp"
#include "plumb/io/output_file.hpp"
#include "plumb/scenario/count_text.hpp"
#include "plumb/study/proportion.hpp"

namespace plumb {
namespace campaign {
namespace {

using Json = nlohmann::ordered_json;
using std::size_t;

constexpr int kFormat = 1;
constexpr double kDegPerNrad = 1e-9 * 180.0 / kPi;

std::string hex(std::uint64_t value) { return fmt::format("{:016x}", value); }

/// The scenarios that a count is a share of.
std::uint64_t trials_of(const Progress& progress) { return progress.tally.total(Count::scenarios); }

Json rate_of(std::uint64_t count, std::uint64_t trials) {
  const study::Proportion p = study::proportion(count, trials);
  return io::object({{"count", count}, {"of", trials}, {"rate", p.share()}, {"low", p.low}, {"high", p.high}});
}

Json rates_of(const Progress& progress) {
  Json out = Json::object();
  for (int k = 1; k < kCounts; ++k) {
    const auto count = static_cast<Count>(k);
    out[to_string(count)] = rate_of(progress.tally.total(count), trials_of(progress));
  }
  return out;
}

Json times_of(const std::array<std::uint64_t, kMostBlocks>& histogram, const Plan& plan) {
  const double block_s = plan.window / plan.rate_hz;
  size_t last = 0;
  for (size_t k = 0; k < histogram.size(); ++k) {
    if (histogram[k] != 0) last = k + 1;
  }
  Json counts = Json::array();
  for (size_t k = 0; k < last; ++k) counts.push_back(histogram[k]);
  Json quantiles = Json::object();
  for (const double share : {0.5, 0.9, 0.95, 0.99, 1.0}) {
    quantiles[fmt::format("{}", share)] = quantile_blocks(histogram, share);
  }
  return io::object({{"block_s", block_s}, {"blocks", counts}, {"quantiles_blocks", quantiles}});
}

Json stanford_of(const Tally& tally) {
  Json regions = Json::object();
  for (int k = 0; k < kRegions; ++k) regions[to_string(static_cast<Region>(k))] = tally.region(static_cast<Region>(k));
  Json rows = Json::array();
  for (int level = 0; level <= kOctaves; ++level) {
    Json row = Json::array();
    for (int error = 0; error < kOctaves; ++error) row.push_back(tally.stanford(error, level));
    rows.push_back(row);
  }
  return io::object({{"blocks", regions},
                     {"first_octave_ends_at_deg", 0.001},
                     {"rows", "protection level by octave, the last row: none"},
                     {"columns", "error by octave"},
                     {"counts", rows}});
}

Json cells_of(const Plan& plan, const Tally& tally) {
  Json out = Json::array();
  for (int k = 0; k < tally.cells(); ++k) {
    const Cell& cell = plan.cells[static_cast<size_t>(k)];
    Json row = io::object({{"tool", plan.tools[static_cast<size_t>(cell.tool)].name},
                           {"attitude", plan.attitudes[static_cast<size_t>(cell.attitude)].name},
                           {"fault", plan.faults[static_cast<size_t>(cell.fault)].name},
                           {"faulty", cell.faulty},
                           {"gravity_sigmas", cell.gravity_sigmas}});
    for (int c = 0; c < kCounts; ++c) {
      const std::uint64_t count = tally.count(k, static_cast<Count>(c));
      if (c == 0 || count != 0) row[to_string(static_cast<Count>(c))] = count;
    }
    row["largest_undetected_nrad"] = tally.largest_undetected_nrad(k);
    out.push_back(row);
  }
  return out;
}

Json firsts_of(const FirstNumbers& numbers) {
  Json out = Json::array();
  for (const std::uint64_t number : numbers) {
    if (number != kNoNumber) out.push_back(number);
  }
  return out;
}

io::FileError unusable(const std::string& path, const std::string& what, const std::string& remedy) {
  return io::FileError{path, 0, "", what, remedy};
}

}  // namespace

std::string result_text(const CampaignFile& file, const Progress& progress) {
  const Plan& plan = file.plan;
  const Tally& tally = progress.tally;
  const Tally::Numbers numbers = tally.numbers();
  Json out;
  out["format"] = kFormat;
  out["campaign"] = plan.name;
  out["plan_hash"] = hex(hash_of(plan));
  out["seed"] = plan.seed;
  out["scenarios"] = plan.scenarios;
  out["done"] = progress.done;
  out["complete"] = progress.done == plan.scenarios;
  out["confidence"] = 0.95;
  out["rates"] = rates_of(progress);
  out["largest_undetected_deg"] = static_cast<double>(tally.largest_undetected_nrad()) * kDegPerNrad;
  out["time_to_detect"] = times_of(tally.blocks_to_detect(), plan);
  out["time_to_isolate"] = times_of(tally.blocks_to_isolate(), plan);
  out["stanford"] = stanford_of(tally);
  out["first_wrong_exclusions"] = firsts_of(tally.first_wrong());
  out["first_misleading"] = firsts_of(tally.first_misleading());
  out["cells"] = cells_of(plan, tally);
  out["state"] = io::object({{"sums", numbers.sums}, {"maxima", numbers.maxima}, {"firsts", numbers.firsts}});
  // Lists of numbers on one line each: a result of a thousand cells stays a file that one can look into.
  std::string text = "{\n";
  for (auto item = out.begin(); item != out.end(); ++item) {
    const bool rows = item.key() == "cells" || item.key() == "rates";
    text += "  \"" + item.key() + "\": ";
    if (!rows) {
      text += item.value().dump();
    } else {
      const bool list = item.value().is_array();
      text += list ? "[" : "{";
      bool first = true;
      for (auto row = item.value().begin(); row != item.value().end(); ++row) {
        text += first ? "\n    " : ",\n    ";
        text += (list ? "" : "\"" + row.key() + "\": ") + row.value().dump();
        first = false;
      }
      text += list ? "\n  ]" : "\n  }";
    }
    text += ",\n";
  }
  return text + "  \"hash\": \"" + hex(io::fnv1a(text.data(), text.size())) + "\"\n}\n";
}

io::FileExpected<Progress> read_result(const std::string& path, const CampaignFile& file) {
  const auto refuse = [&path](const std::string& what, const std::string& remedy) {
    return tl::unexpected<io::FileError>(unusable(path, what, remedy));
  };
  const io::FileExpected<std::string> text = io::read_file(path);
  if (!text) return tl::unexpected<io::FileError>(text.error());
  const std::string again = "run without --resume to start again, or name the result file of this campaign";
  const Json json = io::parsed(*text);
  if (json.is_discarded() || !json.is_object()) return refuse("is not valid JSON, so it is not a result file", again);
  const size_t last = text->rfind("  \"hash\"");
  const std::string hash = json.value("hash", "");
  if (last == std::string::npos || hash != hex(io::fnv1a(text->data(), last))) {
    return refuse("is damaged: its hash does not match its contents", again);
  }
  if (json.value("format", 0) != kFormat) return refuse("has a format that this version of plumb cannot read", again);
  if (json.value("plan_hash", "") != hex(hash_of(file.plan))) {
    return refuse("is the result of another campaign: the file, the seed or the number of scenarios differs", again);
  }
  Progress progress;
  progress.done = json.value("done", std::uint64_t{0});
  progress.tally = Tally(file.plan);
  Tally::Numbers numbers;
  const Json& state = json["state"];
  numbers.sums = state.value("sums", std::vector<std::uint64_t>());
  numbers.maxima = state.value("maxima", std::vector<std::uint64_t>());
  numbers.firsts = state.value("firsts", std::vector<std::uint64_t>());
  if (!progress.tally.take(numbers) || progress.done > file.plan.scenarios || progress.done != trials_of(progress)) {
    return refuse("holds counts that do not match this campaign", again);
  }
  return progress;
}

std::string summary_text(const CampaignFile& file, const Progress& progress) {
  const Tally& tally = progress.tally;
  const std::uint64_t trials = trials_of(progress);
  std::string out = fmt::format("{}: {} of {}, {}, seed {}\n", file.plan.name, progress.done,
                                count_text(file.plan.scenarios, "scenario"),
                                count_text(file.plan.cells.size(), "combination"), file.plan.seed);
  out += fmt::format("{:<28}{:>10}  {:<12}{:<26}{}\n", "", "count", "rate", "Clopper-Pearson*", "");
  for (int k = 1; k < kCounts; ++k) {
    const auto count = static_cast<Count>(k);
    const study::Proportion p = study::proportion(tally.total(count), trials);
    out += fmt::format("{:<28}{:>10}  {:<12}{:<26}{}\n", to_string(count), p.count, study::rounded_share(p),
                       study::interval_text(p), words_of(count));
  }
  out += fmt::format("* {}\n", study::kIntervalNote);
  const double block_s = file.plan.window / file.plan.rate_hz;
  const auto times = [&out, block_s](const char* what, const std::array<std::uint64_t, kMostBlocks>& histogram) {
    out += fmt::format("{}: median {}, 95 % {}, 99 % {} blocks of {:.3g} s\n", what, quantile_blocks(histogram, 0.5),
                       quantile_blocks(histogram, 0.95), quantile_blocks(histogram, 0.99), block_s);
  };
  times("time to detect", tally.blocks_to_detect());
  times("time to isolate", tally.blocks_to_isolate());
  out +=
      fmt::format("largest {} before any alarm: {:.4g} deg\n", file.plan.magnetic ? "error of the direction" : "tilt",
                  static_cast<double>(tally.largest_undetected_nrad()) * kDegPerNrad);
  return out;
}

std::string broken_expectations(const CampaignFile& file, const Progress& progress) {
  std::string out;
  for (const Expectation& expected : file.expect) {
    const std::uint64_t count = progress.tally.total(expected.count);
    if (count <= expected.at_most) continue;
    out += fmt::format("{} in {}, at most {} expected: {}\n", to_string(expected.count), count_text(count, "scenario"),
                       expected.at_most, words_of(expected.count));
  }
  return out;
}

}  // namespace campaign
}  // namespace plumb
