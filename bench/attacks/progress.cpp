#include "progress.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "plumb/core/version.hpp"
#include "plumb/io/hash.hpp"
#include "plumb/io/json_fields.hpp"
#include "plumb/io/output_file.hpp"
#include "plumb/scenario/random.hpp"

namespace plumb_bench {
namespace {

using plumb::io::FileError;
using plumb::io::FileExpected;
using plumb::io::Json;

constexpr int kFormat = 1;
constexpr std::size_t kFindingsPerFamily = 5;
constexpr const char* kHashLine = "  \"hash\"";

std::size_t at(int k) { return static_cast<std::size_t>(k); }

std::string hex(std::uint64_t value) { return fmt::format("{:016x}", value); }

/// One tally as two lists: the counts, and pairs of (blocks to nominal, episodes).
Json json_of(const Tally& tally) {
  Json counts = Json::array(), times = Json::array();
  for (const std::uint64_t k : tally.count) counts.push_back(k);
  for (std::size_t k = 0; k < tally.to_nominal.size(); ++k) {
    if (tally.to_nominal[k] != 0) times.push_back(Json::array({k, tally.to_nominal[k]}));
  }
  return plumb::io::object({{"counts", counts}, {"to_nominal", times}});
}

bool take(const Json& json, Tally& tally) {
  if (!json.is_object() || !json.contains("counts") || !json.contains("to_nominal")) return false;
  const Json& counts = json["counts"];
  const Json& times = json["to_nominal"];
  if (!counts.is_array() || counts.size() != tally.count.size() || !times.is_array()) return false;
  for (std::size_t k = 0; k < tally.count.size(); ++k) {
    if (!counts[k].is_number_unsigned()) return false;
    tally.count[k] = counts[k].get<std::uint64_t>();
  }
  for (const Json& pair : times) {
    if (!pair.is_array() || pair.size() != 2 || !pair[0].is_number_unsigned() || !pair[1].is_number_unsigned()) {
      return false;
    }
    const auto bin = pair[0].get<std::size_t>();
    if (bin >= tally.to_nominal.size()) return false;
    tally.to_nominal[bin] = pair[1].get<std::uint64_t>();
  }
  return true;
}

bool take_family(const Json& json, int family, Progress& progress) {
  if (!json.is_object() || json.value("family", "") != families()[at(family)].name) return false;
  if (!json.contains("tallies") || !json["tallies"].is_array() || json["tallies"].size() != kSensorCounts) return false;
  progress.next[at(family)] = json.value("next", std::uint64_t{0});
  for (std::size_t n = 0; n < kSensorCounts; ++n) {
    if (!take(json["tallies"][n], progress.tally[at(family)][n])) return false;
  }
  for (const Json& finding : json.value("findings", Json::array())) {
    progress.findings.push_back({family, finding.value("episode", std::uint64_t{0}), finding.value("text", "")});
  }
  return true;
}

void keep(const Finding& finding, Progress& progress) {
  std::size_t kept = 0;
  for (const Finding& f : progress.findings) kept += f.family == finding.family ? 1 : 0;
  if (kept < kFindingsPerFamily) progress.findings.push_back(finding);
}

void play_chunk(const RunPlan& plan, int family, Progress& progress) {
  const std::uint64_t end = plan.first + plan.episodes[at(family)];
  std::uint64_t& next = progress.next[at(family)];
  const std::uint64_t stop = std::min(end, next + plan.chunk);
  for (; next < stop; ++next) {
    const EpisodeRequest request{family, plan.seed, next, stream_of_episode(plan.seed, family, next), false};
    std::vector<Finding> findings;
    const auto n = at(sensors_of(families()[at(family)], next) - kLeastSensors);
    progress.tally[at(family)][n].add(play_episode(request, findings));
    for (const Finding& finding : findings) keep(finding, progress);
  }
}

/// What a few episodes come to in this build, as one number: a monitor that decides otherwise has another.
std::uint64_t behaviour() {
  static const std::uint64_t value = [] {
    std::uint64_t hash = plumb::io::kFnvStart;
    for (int family = 0; family < static_cast<int>(families().size()); ++family) {
      for (const std::uint64_t episode : {0U, 1U}) {
        std::vector<Finding> findings;
        const Tally t = play_episode({family, 0, episode, stream_of_episode(0, family, episode), false}, findings);
        hash = plumb::io::fnv1a(t.count.data(), sizeof t.count, hash);
        hash = plumb::io::fnv1a(t.to_nominal.data(), sizeof t.to_nominal, hash);
      }
    }
    return hash;
  }();
  return value;
}

}  // namespace

Progress::Progress(std::uint64_t seed_, std::uint64_t first)
    : seed(seed_), next(families().size(), first), tally(families().size()) {}

Tally Progress::total(int family) const {
  Tally sum;
  for (const Tally& one : tally[at(family)]) sum.add(one);
  return sum;
}

std::uint64_t stream_of_episode(std::uint64_t seed, int family, std::uint64_t episode) {
  const std::string name = families()[at(family)].name;
  const std::uint64_t key = plumb::io::fnv1a(name.data(), name.size());
  return plumb::scenario::derive_seed(plumb::scenario::derive_seed(seed, key), episode);
}

std::vector<std::uint64_t> shared_out(std::uint64_t episodes, double adaptive_share, const std::vector<int>& chosen) {
  double weight[2] = {0.0, 0.0};
  for (const int k : chosen) weight[families()[at(k)].adaptive ? 1 : 0] += families()[at(k)].weight;
  if (weight[0] == 0.0) adaptive_share = 1.0;
  if (weight[1] == 0.0) adaptive_share = 0.0;
  std::vector<std::uint64_t> out(families().size(), 0);
  for (const int k : chosen) {
    const Family& family = families()[at(k)];
    const double share = family.adaptive ? adaptive_share : 1.0 - adaptive_share;
    const double part = std::ceil(static_cast<double>(episodes) * share * family.weight / weight[family.adaptive]);
    const auto least = static_cast<std::uint64_t>(family.most_n - family.least_n + 1);
    out[at(k)] = std::max(least, static_cast<std::uint64_t>(part));
  }
  return out;
}

void play(const RunPlan& plan, Progress& progress, const std::function<bool(const Progress&)>& after_chunk) {
  for (bool left = true; left;) {
    left = false;
    for (int family = 0; family < static_cast<int>(families().size()); ++family) {
      if (progress.next[at(family)] >= plan.first + plan.episodes[at(family)]) continue;
      play_chunk(plan, family, progress);
      left = true;
      if (!after_chunk(progress)) return;
    }
  }
}

std::string state_text(const Progress& progress) {
  std::string out = fmt::format(
      "{{\n  \"plumb_monitor_attacks\": {},\n  \"harness\": {},\n  \"library\": {},\n"
      "  \"behaviour\": \"{}\",\n  \"seed\": {},\n  \"families\": [",
      kFormat, kHarnessVersion, plumb::kLibraryVersion, hex(behaviour()), progress.seed);
  for (int family = 0; family < static_cast<int>(families().size()); ++family) {
    Json tallies = Json::array(), findings = Json::array();
    for (const Tally& tally : progress.tally[at(family)]) tallies.push_back(json_of(tally));
    for (const Finding& f : progress.findings) {
      if (f.family == family) findings.push_back(plumb::io::object({{"episode", f.episode}, {"text", f.text}}));
    }
    out += family == 0 ? "\n    " : ",\n    ";
    out += plumb::io::object({{"family", families()[at(family)].name},
                              {"next", progress.next[at(family)]},
                              {"tallies", tallies},
                              {"findings", findings}})
               .dump();
  }
  return with_hash(out + "\n  ],\n");
}

std::string with_hash(const std::string& members) {
  return members + kHashLine + ": \"" + hex(plumb::io::fnv1a(members.data(), members.size())) + "\"\n}\n";
}

FileExpected<Progress> read_state(const std::string& path, std::uint64_t seed) {
  const auto refuse = [&path](const std::string& what) {
    return tl::unexpected<FileError>(
        FileError{path, 0, "", what, "name another file for --state, or remove this one to start anew"});
  };
  const FileExpected<std::string> text = plumb::io::read_file(path);
  if (!text) return tl::unexpected<FileError>(text.error());
  const Json json = plumb::io::parsed(*text);
  if (json.is_discarded() || !json.is_object() || !json.contains("plumb_monitor_attacks")) {
    return refuse("is no state of plumb_monitor_attacks");
  }
  const std::size_t end = text->rfind(kHashLine);
  if (end == std::string::npos || json.value("hash", "") != hex(plumb::io::fnv1a(text->data(), end))) {
    return refuse("is damaged: its hash does not match its contents");
  }
  if (json.value("plumb_monitor_attacks", 0) != kFormat || json.value("harness", 0) != kHarnessVersion ||
      json.value("library", 0U) != plumb::kLibraryVersion) {
    return refuse("was written by another version of the harness or of plumb: its counts do not add up with these");
  }
  if (json.value("behaviour", "") != hex(behaviour())) {
    return refuse("was written by a build whose monitor decides otherwise: its counts do not add up with these");
  }
  if (json.value("seed", std::uint64_t{0}) != seed) {
    return refuse(
        fmt::format("is the state of seed {}, and this run has seed {}", json.value("seed", std::uint64_t{0}), seed));
  }
  Progress progress(seed);
  const Json list = json.value("families", Json::array());
  if (list.size() != families().size()) return refuse("lists other families than this version");
  for (std::size_t k = 0; k < list.size(); ++k) {
    if (!take_family(list[k], static_cast<int>(k), progress)) return refuse("lists other families than this version");
  }
  return progress;
}

}  // namespace plumb_bench
