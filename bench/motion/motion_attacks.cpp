// plumb_motion_attacks [--flights N] [--seed S] [--jobs J] [--more-units U]: an adversary in command of as many faulty
// units as the monitor of motion is promised for, counted, as Markdown with 95 % Clopper-Pearson intervals. With
// --kind K --number M it plays that one flight and says what was wrong in it; with --more-units U so many units more
// lie than are promised for. Exit code 1 where a healthy sensor was blamed or a promised bound was passed.
// docs/motion.md holds what it printed.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "flight_runs.hpp"
#include "motion_attack.hpp"

namespace {

using namespace plumb_bench;

struct Settings {
  std::uint64_t flights = 200;
  std::uint64_t seed = 1;
  std::uint64_t number = 0;
  unsigned jobs = 2;
  int more_units = 0;
  int kind = -1;
};

bool read(int argc, char** argv, Settings* out) {
  for (int k = 1; k + 1 < argc; k += 2) {
    const std::string key = argv[k];
    char* end = nullptr;
    const auto value = static_cast<std::uint64_t>(std::strtoull(argv[k + 1], &end, 10));
    if (*end != '\0') return false;
    if (key == "--flights" && value > 0)
      out->flights = value;
    else if (key == "--seed")
      out->seed = value;
    else if (key == "--jobs" && value > 0)
      out->jobs = static_cast<unsigned>(value);
    else if (key == "--kind" && value < static_cast<std::uint64_t>(kAttackKinds))
      out->kind = static_cast<int>(value);
    else if (key == "--more-units" && value < 8)
      out->more_units = static_cast<int>(value);
    else if (key == "--number")
      out->number = value;
    else
      return false;
  }
  return argc % 2 == 1;
}

unsigned long long printable(std::uint64_t value) { return static_cast<unsigned long long>(value); }

bool is_wrong(const AttackOutcome& one) {
  return one.blamed || one.false_alarm || one.sample.violations > 0 || one.block.violations > 0;
}

void print_wrong(int kind, std::uint64_t number, const AttackOutcome& one) {
  std::printf("--kind %d --number %llu: %s:", kind, printable(number), one.scene.c_str());
  if (one.false_alarm) std::printf(" a false alarm;");
  if (one.blamed) std::printf(" a healthy sensor blamed at %.3f s;", one.blamed_at_s);
  if (one.passed_at_s >= 0.0) {
    std::printf(" bound passed, first at %.3f s, by %llu of %llu samples and %llu of %llu blocks;", one.passed_at_s,
                printable(one.sample.violations), printable(one.sample.checks), printable(one.block.violations),
                printable(one.block.checks));
  }
  std::printf("\n");
}

/// True where nothing was wrong.
bool row(const Settings& s, int kind) {
  const std::uint64_t first = s.seed * 1000003;
  const auto all = run_all(s.flights, s.jobs, first, [&](std::uint64_t number) {
    return attack(static_cast<AttackKind>(kind), number, s.more_units);
  });
  const auto count = [&](auto test) { return static_cast<std::uint64_t>(std::count_if(all.begin(), all.end(), test)); };
  const auto lying = count([](const AttackOutcome& o) { return o.units_lying > 0; });
  BoundTally sample, block;
  for (const AttackOutcome& one : all) {
    sample.checks += one.sample.checks, sample.violations += one.sample.violations;
    block.checks += one.block.checks, block.violations += one.block.violations;
  }
  std::printf("| %s | %llu | %s | %llu of %llu | %s | %llu of %llu | %llu of %llu |\n",
              to_string(static_cast<AttackKind>(kind)), printable(s.flights),
              share(count([](const AttackOutcome& o) { return o.alarm; }), s.flights).c_str(),
              printable(count([](const AttackOutcome& o) { return o.isolated; })), printable(lying),
              share(count([](const AttackOutcome& o) { return o.blamed; }), s.flights).c_str(),
              printable(sample.violations), printable(sample.checks), printable(block.violations),
              printable(block.checks));
  std::fflush(stdout);
  bool right = true;
  for (std::size_t k = 0; k < all.size(); ++k) {
    if (!is_wrong(all[k])) continue;
    right = false;
    print_wrong(kind, first + k, all[k]);
  }
  return right;
}

}  // namespace

int main(int argc, char** argv) {
  Settings s;
  if (!read(argc, argv, &s)) {
    std::fprintf(
        stderr,
        "usage: plumb_motion_attacks [--flights N] [--seed S] [--jobs J] [--more-units U] | --kind 0..%d --number M\n",
        kAttackKinds - 1);
    return 2;
  }
  if (s.kind >= 0) {
    const AttackOutcome one = attack(static_cast<AttackKind>(s.kind), s.number, s.more_units);
    if (is_wrong(one)) print_wrong(s.kind, s.number, one);
    return is_wrong(one) ? 1 : 0;
  }
  std::printf(
      "| adversary | flights | alarm, %% | a liar isolated | healthy sensor blamed, %% | sample: bound passed | block: "
      "bound passed |\n|---|---|---|---|---|---|---|\n");
  bool right = true;
  for (int kind = 0; kind < kAttackKinds; ++kind) right = row(s, kind) && right;
  return right ? 0 : 1;
}
