// plumb_isolation_rates WHAT [--scale X] [--seed S] [--from N] [--to N]: how often isolation is right, undecided,
// wrong, with 95 % Clopper-Pearson intervals, as Markdown. WHAT is soundness, beyond, confirmed, rivals, trouble,
// parity, assumed, or bound (what no rule can do better);
// --scale multiplies the numbers of trials, --from and --to bound the numbers of sensors of soundness.
// docs/isolation.md holds what it printed.
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include "isolation_runs.hpp"
#include "plumb/study/proportion.hpp"

namespace {

using namespace plumb_bench;

struct Settings {
  double scale = 1.0;
  std::uint64_t seed = 20180227;
  int from = 4, to = 16;  ///< sensors, of the soundness study
  std::uint64_t trials(double wanted) const { return static_cast<std::uint64_t>(wanted * scale) + 1; }
};

/// "99.87 [99.79, 99.92]", percent.
std::string share(std::uint64_t k, std::uint64_t n) {
  const plumb::study::Proportion p = plumb::study::proportion(k, n);
  return plumb::study::rounded_share(p, 4, 100.0) + " " + plumb::study::interval_text(p, 4, 100.0);
}

const char* name(Rule rule) {
  switch (rule) {
    case Rule::strict: return "plumb, confirmed";
    case Rule::paper: return "union of triples (paper)";
    case Rule::glt: return "GLT";
    case Rule::leave_out: return "leave m out";
    case Rule::best_fit: return "best fit";
  }
  return "?";
}

SoundCount soundness_of(const SoundnessJob& job) {
#ifdef PLUMB_BENCH_CAPACITY_16
  if (job.n > 8) return cap16::soundness(job);
#endif
  return job.n > 8 ? SoundCount{} : cap8::soundness(job);
}

void print(const SoundCount& c, const std::string& lead) {
  std::printf("| %s | %llu | %llu | %s | %s | %s of %llu | %s of %llu |\n", lead.c_str(),
              static_cast<unsigned long long>(c.trials), static_cast<unsigned long long>(c.votes),
              share(c.strict, c.trials).c_str(), share(c.strict_right, c.trials).c_str(),
              share(c.parity, c.parity_asked).c_str(), static_cast<unsigned long long>(c.parity_asked),
              share(c.asserted, c.asserted_asked).c_str(), static_cast<unsigned long long>(c.asserted_asked));
  std::fflush(stdout);
}

constexpr const char* kSoundHead =
    "| n | trials | blocks | confirmed wrong, % | confirmed right, % | provisional wrong, % | assumed wrong, % |\n"
    "|---|---|---|---|---|---|---|\n";

/// More trials where they are cheap: a vote among 16 takes a thousand times as long as one among 4.
struct Share {
  int n;
  double trials;
};
constexpr Share kShares[] = {{4, 5.2e6}, {5, 3.2e6}, {6, 1.2e6}, {7, 4e5},  {8, 1.5e5}, {9, 2e4}, {10, 1e4},
                             {11, 4e3},  {12, 3e3},  {13, 1e3},  {14, 6e2}, {15, 4e2},  {16, 4e2}};

void soundness(const Settings& s) {
  SoundCount sum;
  std::fputs(kSoundHead, stdout);
  for (const Share& part : kShares) {
    if (part.n < s.from || part.n > s.to) continue;
    for (const bool fitted : {false, true}) {
      SoundnessJob job;
      job.n = part.n;
      job.trials = s.trials(part.trials / 2);
      job.seed = s.seed + static_cast<std::uint64_t>(part.n) * 2 + (fitted ? 1 : 0);
      job.fitted = fitted;
      const SoundCount c = soundness_of(job);
      print(c, std::to_string(part.n) + (fitted ? ", fitted" : ", exact"));
      sum.trials += c.trials;
      sum.votes += c.votes;
      sum.strict += c.strict;
      sum.strict_right += c.strict_right;
      sum.parity += c.parity;
      sum.parity_asked += c.parity_asked;
      sum.asserted += c.asserted;
      sum.asserted_asked += c.asserted_asked;
    }
  }
  print(sum, "all");
}

/// Gravity further off than its sigma allows: no promise holds, and these are the rates.
void beyond(const Settings& s) {
  std::fputs(kSoundHead, stdout);
  for (int n = 4; n <= 8; ++n) {
    for (const double error : {4.0, 7.0, 20.0, 70.0}) {
      SoundnessJob job;
      job.healthy = n > 4 ? 4 : 3;  // with three, nothing but gravity itself can corroborate them
      job.stations = 8;
      job.n = n;
      job.trials = s.trials(n < 7 ? 1e5 : 2e4);
      job.seed = s.seed + static_cast<std::uint64_t>(100 * n + error);
      job.least_gravity = job.most_gravity = error;
      print(soundness_of(job), std::to_string(n) + ", " + std::to_string(static_cast<int>(error)) + " sigma");
    }
  }
}

void rates(const Settings& s, bool rivals) {
  std::printf(
      "| n | m | sigmas | rule | trials | correct, %% | undecided, %% | wrong, %% "
      "|\n|---|---|---|---|---|---|---|---|\n");
  for (int n = 4; n <= 8; ++n) {
    for (int m = 1; m <= n - 3; ++m) {
      for (const auto& [least, most] : {std::pair{3.0, 10.0}, std::pair{10.0, 30.0}, std::pair{30.0, 100.0}}) {
        const auto seed = s.seed + static_cast<std::uint64_t>(1000 * n + 100 * m + least);
        const RuleCounts counts = cap8::eight_attitudes({n, m, least, most, s.trials(1e4), seed});
        for (int r = 0; r < (rivals ? kRules : 1); ++r) {
          const Count& c = counts[static_cast<std::size_t>(r)];
          std::printf("| %d | %d | %.0f-%.0f | %s | %llu | %s | %s | %s |\n", n, m, least, most,
                      name(static_cast<Rule>(r)), static_cast<unsigned long long>(c.trials),
                      share(c.correct, c.trials).c_str(), share(c.undecided, c.trials).c_str(),
                      share(c.wrong, c.trials).c_str());
        }
        std::fflush(stdout);
      }
    }
  }
}

/// The same rules where the faults are in league, and where gravity is off by no more than its sigma allows.
void trouble(const Settings& s) {
  std::printf("| n | m | trouble | trials |");
  for (int r = 0; r < kRules; ++r) std::printf(" %s |", name(static_cast<Rule>(r)));
  std::printf("\n|---|---|---|---|---|---|---|---|---|\n");
  struct Trouble {
    const char* name;
    Lie lie;
    double gravity_error;
  };
  for (const Trouble& t : {Trouble{"gravity 2 sigma off", Lie::bias, 2.0}, Trouble{"colluding", Lie::colluding, 0.0},
                           Trouble{"mirrored", Lie::mirrored, 0.0}}) {
    for (int n = 4; n <= 8; ++n) {
      for (int m = 1; m <= n - 3; ++m) {
        const auto seed = s.seed + static_cast<std::uint64_t>(1000 * n + 100 * m) + static_cast<std::uint64_t>(t.lie);
        const std::uint64_t trials = s.trials(1e3);
        const RuleCounts counts = cap8::eight_attitudes({n, m, 30.0, 100.0, trials, seed, t.lie, t.gravity_error});
        std::printf("| %d | %d | %s | %llu |", n, m, t.name, static_cast<unsigned long long>(trials));
        for (const Count& c : counts) {
          const auto percent = [&c](std::uint64_t k) {
            return 100.0 * static_cast<double>(k) / static_cast<double>(c.trials);
          };
          std::printf(" %.1f / %.1f / %.1f |", percent(c.correct), percent(c.undecided), percent(c.wrong));
        }
        std::printf("\n");
        std::fflush(stdout);
      }
    }
  }
}

void parity(const Settings& s) {
  std::printf("| n | m | fault | trials | correct, %% | undecided, %% | wrong, %% |\n|---|---|---|---|---|---|---|\n");
  constexpr const char* kNames[] = {"bias 0.02-1 g0", "stuck", "colluding", "mirrored"};
  for (int n = 5; n <= 8; ++n) {
    for (int m = 1; m <= n - 4; ++m) {
      for (int f = 0; f < 4; ++f) {
        const auto seed = s.seed + static_cast<std::uint64_t>(1000 * n + 100 * m + f);
        const Count c = cap8::parity_at_one_station({n, m, 40.0, 2000.0, s.trials(2e4), seed, static_cast<Lie>(f)});
        std::printf("| %d | %d | %s | %llu | %s | %s | %s |\n", n, m, kNames[f],
                    static_cast<unsigned long long>(c.trials), share(c.correct, c.trials).c_str(),
                    share(c.undecided, c.trials).c_str(), share(c.wrong, c.trials).c_str());
      }
      std::fflush(stdout);
    }
  }
}

void asserted(const Settings& s) {
  std::printf("| fault | trials | correct, %% | undecided, %% | wrong, %% |\n|---|---|---|---|---|\n");
  for (const auto& [least, most] :
       {std::pair{0.06, 0.1}, std::pair{0.1, 0.3}, std::pair{0.3, 1.0}, std::pair{0.06, 1.0}}) {
    const Count c = cap8::asserted_at_one_block(
        {4, 1, least / 5e-4, most / 5e-4, s.trials(1e5), s.seed + static_cast<std::uint64_t>(1000 * (least + most))});
    std::printf("| %.2f-%.2f g0 | %llu | %s | %s | %s |\n", least, most, static_cast<unsigned long long>(c.trials),
                share(c.correct, c.trials).c_str(), share(c.undecided, c.trials).c_str(),
                share(c.wrong, c.trials).c_str());
  }
}

/// What no rule can do better.
void bound(const Settings& s) {
  std::printf(
      "| n | m | sigmas | level | trials | isolable, %% | isolable in a moving tool, %% | isolable by "
      "parity at one station, %% |\n|---|---|---|---|---|---|---|---|\n");
  for (int n = 4; n <= 8; ++n) {
    for (int m = 1; m <= n - 3; ++m) {
      for (const auto& [least, most] :
           {std::pair{3.0, 10.0}, std::pair{10.0, 30.0}, std::pair{30.0, 100.0}, std::pair{40.0, 2000.0}}) {
        for (const double rate : {1e-6, 1e-3}) {
          const auto seed = s.seed + static_cast<std::uint64_t>(1000 * n + 100 * m + least);
          const BoundCount c = cap8::best_possible({n, m, least, most, s.trials(1e4), seed}, rate);
          std::printf("| %d | %d | %.0f-%.0f | %.0e | %llu | %s | %s | %s |\n", n, m, least, most, rate,
                      static_cast<unsigned long long>(c.trials), share(c.told, c.trials).c_str(),
                      n > 4 ? share(c.told_moving, c.trials).c_str() : "-",
                      m <= n - 4 ? share(c.told_by_parity, c.trials).c_str() : "-");
        }
        std::fflush(stdout);
      }
    }
  }
}

int usage() {
  std::fputs(
      "usage: plumb_isolation_rates soundness|beyond|confirmed|rivals|trouble|parity|assumed|bound [--scale X] [--seed "
      "S] "
      "[--from N] [--to N]\n",
      stderr);
  return 2;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) return usage();
  Settings settings;
  for (int i = 2; i + 1 < argc; i += 2) {
    const std::string option = argv[i];
    if (option == "--scale") {
      settings.scale = std::strtod(argv[i + 1], nullptr);
    } else if (option == "--from") {
      settings.from = std::atoi(argv[i + 1]);
    } else if (option == "--to") {
      settings.to = std::atoi(argv[i + 1]);
    } else if (option == "--seed") {
      settings.seed = std::strtoull(argv[i + 1], nullptr, 10);
    } else {
      return usage();
    }
  }
  const std::string what = argv[1];
  if (what == "soundness") {
    soundness(settings);
  } else if (what == "beyond") {
    beyond(settings);
  } else if (what == "confirmed") {
    rates(settings, false);
  } else if (what == "rivals") {
    rates(settings, true);
  } else if (what == "trouble") {
    trouble(settings);
  } else if (what == "parity") {
    parity(settings);
  } else if (what == "assumed") {
    asserted(settings);
  } else if (what == "bound") {
    bound(settings);
  } else {
    return usage();
  }
  return 0;
}
