// plumb_replay: a corpus of cases as digests, so that two commits can be compared (scripts/replay). Each commit has a
// version of its own, which depends on the public interface alone.
#include <cinttypes>
#include <cstdio>
#include <memory>

#include "corpus.hpp"
#include "coverage.hpp"
#include "fixed_cases.hpp"
#include "options.hpp"
#include "player.hpp"
#include "trace.hpp"

namespace plumb_replay {
namespace {

/// The sample that --perturb takes: behind the first blocks, in every case.
constexpr std::uint64_t kPerturbedRow = 40;

std::vector<FixedCase> all_cases(const Options& options, std::vector<std::string>& skipped) {
  std::vector<FixedCase> out;
  for (FixedCase& one : drill_cases()) {
    const bool first_seed = one.name.find("seed1") != std::string::npos;
    if (!options.quick || first_seed) out.push_back(std::move(one));
  }
  if (!options.quick) {
    for (FixedCase& one : paper_cases()) out.push_back(std::move(one));
  }
  if (options.data.empty()) {
    skipped.emplace_back("recordings: no --data");
  } else if (!options.quick) {
    for (FixedCase& one : recording_cases(options.data, options.examples, skipped)) out.push_back(std::move(one));
  }
  for (int k = 0; k < options.scenarios; ++k) {
    const CaseNumber number{options.seed, k};
    out.push_back({number.name(), [number](const Stage& stage) {
                     stage.coverage.met("capacity", std::to_string(number.capacity()));
                     const std::string sensors = std::to_string(number.sensors());
                     stage.coverage.met("sensors", sensors.size() < 2 ? " " + sensors : sensors);
                     return number.capacity() == 8 ? play_generated_8(number, stage) : play_generated_24(number, stage);
                   }});
  }
  return out;
}

bool begins(const std::string& name, const std::string& with) { return name.compare(0, with.size(), with) == 0; }

void play(const FixedCase& one, const Options& options, const Words& words, Coverage& coverage) {
  const bool tells = !options.trace.empty();
  const auto trace = std::make_unique<Trace>(words, tells ? stdout : nullptr);
  Stage stage{*trace, coverage, tells};
  if (!options.perturb.empty() && begins(one.name, options.perturb)) stage.perturbed_row = kPerturbedRow;
  one.play(stage);
  coverage.end_case();
  if (tells) return;
  std::printf("%s", one.name.c_str());
  for (int k = 0; k < kParts; ++k) std::printf(" %016" PRIx64, trace->digest(static_cast<Part>(k)));
  std::printf("\n");
}

int run(const Options& options) {
  const FieldCount count = count_verdict_fields();
  if (count.there != count.told) {
    std::fprintf(stderr,
                 "plumb_replay: the verdict has %" PRIu64 " figures and %" PRIu64
                 " are compared: add the field to bench/replay/tell.cpp\n",
                 count.there, count.told);
    return 2;
  }
  Words words;
  if (!options.words.empty() && !words.read(options.words)) {
    std::fprintf(stderr, "plumb_replay: cannot read %s\n", options.words.c_str());
    return 2;
  }
  std::vector<std::string> skipped;
  Coverage coverage;
  want_all(coverage);
  std::printf("# corpus %d snapshot format %d seed %" PRIu64 " scenarios %d\n", kCorpusVersion, plumb::kSnapshotFormat,
              options.seed, options.scenarios);
  const std::string chosen = options.trace.empty() ? options.only : options.trace;
  int played = 0;
  for (const FixedCase& one : all_cases(options, skipped)) {
    if (!begins(one.name, chosen) || (!options.trace.empty() && played == 1)) continue;
    play(one, options, words, coverage);
    ++played;
  }
  if (!options.trace.empty()) return played == 1 ? 0 : 2;
  coverage.print(stdout);
  for (const std::string& what : skipped) std::printf("# skipped: %s\n", what.c_str());
  std::printf("# cases %d\n", played);
  return played > 0 ? 0 : 2;
}

}  // namespace
}  // namespace plumb_replay

int main(int argc, char** argv) {
  plumb_replay::Options options;
  if (!plumb_replay::parse(argc, argv, options)) return 2;
  if (options.help) {
    std::printf("%s", plumb_replay::usage());
    return 0;
  }
  return plumb_replay::run(options);
}
