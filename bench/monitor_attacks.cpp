// plumb_monitor_attacks [--episodes N] [--first K] [--seed S] [--situation NAME] [--episode K]: attacks on the whole
// monitor, counted by number of sensors, by situation and by lie, with 95 % Clopper-Pearson intervals, as Markdown.
// `--situation` plays only the episodes of one situation among them; `--episode` replays one and tells every change of
// state. Exit 1 where something happened that plumb promises not to do.
// docs/isolation.md holds what it printed.
#include <cstdio>
#include <cstdlib>
#include <string>

#include "attack_runs.hpp"
#include "plumb/study/proportion.hpp"

namespace {

using namespace plumb_bench;

constexpr std::uint64_t kChunk = 20000;
constexpr std::size_t kMostTold = 400;

struct Settings {
  std::uint64_t seed = 20180227, first = 0, episodes = 20000;
  bool one = false;
  int only = -1;
};

std::string bound(std::uint64_t k, std::uint64_t n) {
  const plumb::study::Proportion p = plumb::study::proportion(k, n);
  char text[96];
  if (k == 0) {
    std::snprintf(text, sizeof text, "0 (< %.2g)", p.high);
  } else {
    std::snprintf(text, sizeof text, "%llu ([%.2g, %.2g])", static_cast<unsigned long long>(k), p.low, p.high);
  }
  return text;
}

void head(const char* first) {
  std::printf(
      "\n| %s | episodes | blocks | usable | healthy out | healthy aside | beyond level | beyond alert limit | failed, "
      "nobody lied | broken | several liars: beyond level | hidden motion: any of these | failed | all liars out |\n"
      "|---|---|---|---|---|---|---|---|---|---|---|---|---|---|\n",
      first);
}

void line(const std::string& lead, const AttackCount& c) {
  const auto percent = [](std::uint64_t k, std::uint64_t n) {
    return n > 0 ? 100.0 * static_cast<double>(k) / static_cast<double>(n) : 0.0;
  };
  std::printf("| %s | %llu | %llu | %.1f %% | %s | %s | %s | %s | %s | %s | %s | %s | %.1f %% | %.1f %% |\n",
              lead.c_str(), static_cast<unsigned long long>(c.episodes), static_cast<unsigned long long>(c.ticks),
              percent(c.usable_ticks, c.ticks), bound(c.excluded_healthy, c.episodes).c_str(),
              bound(c.set_aside_healthy, c.episodes).c_str(), bound(c.beyond_level, c.episodes).c_str(),
              bound(c.beyond_alert, c.episodes).c_str(), bound(c.failed_healthy, c.episodes - c.liars).c_str(),
              bound(c.broken, c.episodes).c_str(), bound(c.crowd_beyond_level, c.episodes).c_str(),
              bound(c.beyond_bounds, c.episodes).c_str(), percent(c.failed, c.episodes), percent(c.all_out, c.liars));
}

void report(const AttackSum& sum) {
  AttackCount all;
  std::array<AttackCount, 5> by_n{};
  std::array<AttackCount, kSituations> by_situation{};
  std::array<AttackCount, kAttackLies> by_lie{};
  for (std::size_t n = 0; n < by_n.size(); ++n) {
    for (std::size_t s = 0; s < by_situation.size(); ++s) {
      for (std::size_t l = 0; l < by_lie.size(); ++l) {
        const AttackCount& c = sum.count[n][s][l];
        by_n[n].add(c);
        by_situation[s].add(c);
        by_lie[l].add(c);
        all.add(c);
      }
    }
  }
  head("n");
  for (std::size_t n = 0; n < by_n.size(); ++n) line(std::to_string(n + 4), by_n[n]);
  line("all", all);
  head("situation");
  for (std::size_t s = 0; s < by_situation.size(); ++s) line(name(static_cast<Situation>(s)), by_situation[s]);
  head("lie");
  for (std::size_t l = 0; l < by_lie.size(); ++l) line(name_of_lie(static_cast<int>(l)), by_lie[l]);
  std::fflush(stdout);
}

int run(const Settings& settings) {
  AttackSum sum;
  std::uint64_t unsound = 0;
  const std::uint64_t end = settings.first + settings.episodes;
  for (std::uint64_t from = settings.first; from < end; from += kChunk) {
    const AttackSum part =
        attack({settings.seed, from, from + kChunk < end ? kChunk : end - from, settings.one, settings.only});
    for (std::size_t n = 0; n < part.count.size(); ++n) {
      for (std::size_t s = 0; s < kSituations; ++s) {
        for (std::size_t l = 0; l < kAttackLies; ++l) {
          sum.count[n][s][l].add(part.count[n][s][l]);
          unsound += part.count[n][s][l].unsound();
        }
      }
    }
    for (const std::string& find : part.finds) {
      if (sum.finds.size() < kMostTold)
        std::printf("seed %llu, %s\n", static_cast<unsigned long long>(settings.seed), find.c_str());
      sum.finds.push_back(find);
    }
    std::fprintf(stderr, "%llu episodes, %llu unsound\n",
                 static_cast<unsigned long long>(from + kChunk - settings.first),
                 static_cast<unsigned long long>(unsound));
    std::fflush(stdout);
  }
  std::printf("seed %llu, episodes %llu to %llu\n", static_cast<unsigned long long>(settings.seed),
              static_cast<unsigned long long>(settings.first), static_cast<unsigned long long>(end - 1));
  report(sum);
  return unsound == 0 ? 0 : 1;
}

/// -1 where there is none of that name.
int situation_named(const std::string& text) {
  for (int s = kSituations - 1; s >= 0; --s) {
    if (text == name(static_cast<Situation>(s))) return s;
  }
  return -1;
}

int usage() {
  std::fputs("usage: plumb_monitor_attacks [--episodes N] [--first K] [--seed S] [--situation NAME] [--episode K]\n",
             stderr);
  return 2;
}

}  // namespace

int main(int argc, char** argv) {
  Settings settings;
  if (argc % 2 == 0) return usage();
  for (int i = 1; i + 1 < argc; i += 2) {
    const std::string option = argv[i];
    const std::uint64_t value = std::strtoull(argv[i + 1], nullptr, 10);
    if (option == "--episodes") {
      settings.episodes = value;
    } else if (option == "--first") {
      settings.first = value;
    } else if (option == "--seed") {
      settings.seed = value;
    } else if (option == "--episode") {
      settings.first = value;
      settings.episodes = 1;
      settings.one = true;
    } else if (option == "--situation" && situation_named(argv[i + 1]) >= 0) {
      settings.only = situation_named(argv[i + 1]);
    } else {
      return usage();
    }
  }
  return run(settings);
}
