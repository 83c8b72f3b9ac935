// plumb_monitor_attacks: attacks on the whole monitor by named families of episodes, an adversary that copies the
// monitor among them, in one table with 95 % Clopper-Pearson intervals (docs/attacks.md).
//
//   --episodes N        in all, shared out among the families    --adaptive-share X  of these, to the adaptive ones
//   --family NAME       this one alone, or all that begin so     --seed S            another run
//   --quick             a short run of every family              --by-n              a row for each number of sensors
//   --state FILE        go on where FILE left off, and save there after every chunk
//   --json FILE         the table as JSON too                    --before FILE       beside such a table of another
//   build
//   --episode K         one episode of one family, every change of state told; without --family numbered as in
//                       docs/isolation.md                        --first K           begin with this number
//   --list              the families and what they play
//
// Exit 1 where something happened that plumb promises not to do, 2 for a wrong option, 3 for a file that is of no use.
#include <cstdio>

#include "options.hpp"
#include "plumb/io/output_file.hpp"
#include "table.hpp"

namespace {

using namespace plumb_bench;

constexpr int kUnreadable = 3;

int complain(const plumb::io::FileError& error) {
  std::fprintf(stderr, "plumb_monitor_attacks: %s\n", error.text().c_str());
  return kUnreadable;
}

int list() {
  for (const Family& family : families()) {
    std::printf("%-20s n = %d..%d  %-9s%s %s\n", family.name, family.least_n, family.most_n, to_string(family.safety),
                family.adaptive ? " adaptive;" : "", family.what);
  }
  return 0;
}

void tell_findings(const Progress& progress) {
  for (const Finding& f : progress.findings) {
    std::printf("--seed %llu --family %s --episode %llu: %s\n", static_cast<unsigned long long>(progress.seed),
                families()[static_cast<std::size_t>(f.family)].name, static_cast<unsigned long long>(f.episode),
                f.text.c_str());
  }
}

int replay(const Options& options) {
  const int family = options.chosen.front();
  std::vector<Finding> findings;
  const Tally tally = play_episode(
      {family, options.seed, options.first, stream_of_episode(options.seed, family, options.first), true}, findings);
  for (const Finding& finding : findings) std::printf("FOUND %s\n", finding.text.c_str());
  return tally.unsafe() == 0 ? 0 : 1;
}

/// Prints, and writes what was asked for.
int report(const Options& options, const Progress& progress) {
  tell_findings(progress);
  std::printf("\nseed %llu\n\n%s", static_cast<unsigned long long>(progress.seed),
              table_text(progress, options.every_n).c_str());
  if (!options.before.empty()) {
    const auto compared = comparison_text(options.before, progress);
    if (!compared) return complain(compared.error());
    std::printf("\n%s", compared->c_str());
  }
  if (!options.json.empty()) {
    const auto written = plumb::io::write_file(options.json, table_json(progress));
    if (!written) return complain(written.error());
  }
  const std::string broken = broken_promises(progress);
  std::printf("\n%s", broken.empty() ? "every promise holds\n" : broken.c_str());
  return broken.empty() ? 0 : 1;
}

bool exists(const std::string& path) {
  std::FILE* file = std::fopen(path.c_str(), "rb");
  if (file != nullptr) std::fclose(file);
  return file != nullptr;
}

int run(const Options& options) {
  Progress progress(options.seed, options.first);
  if (!options.state.empty() && exists(options.state)) {
    auto state = read_state(options.state, options.seed);
    if (!state) return complain(state.error());
    progress = *state;
  }
  RunPlan plan;
  plan.seed = options.seed;
  plan.first = options.first;
  plan.episodes = shared_out(options.episodes, options.adaptive_share, options.chosen);
  std::string trouble;
  play(plan, progress, [&](const Progress& so_far) {
    if (options.state.empty()) return true;
    const auto written = plumb::io::write_file(options.state, state_text(so_far));
    if (!written) trouble = written.error().text();
    return written.has_value();
  });
  if (!trouble.empty()) {
    std::fprintf(stderr, "plumb_monitor_attacks: %s\n", trouble.c_str());
    return kUnreadable;
  }
  return report(options, progress);
}

}  // namespace

int main(int argc, char** argv) {
  const auto options = options_of(argc, argv);
  if (!options) {
    std::fprintf(stderr, "plumb_monitor_attacks: %s\n%s", options.error().c_str(), usage());
    return 2;
  }
  if (options->list) return list();
  return options->one ? replay(*options) : run(*options);
}
