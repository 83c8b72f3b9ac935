#include "pairs.hpp"

#include <sys/utsname.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <thread>

namespace plumb_bench {
namespace {

constexpr double kLeastRun_s = 0.01;
constexpr int kRounds = 21;

/// Processor time: others who use the machine do not count, but for the caches they take. On the wall they do.
double now_s(Clock clock) {
  timespec t{};
  clock_gettime(clock == Clock::thread    ? CLOCK_THREAD_CPUTIME_ID
                : clock == Clock::program ? CLOCK_PROCESS_CPUTIME_ID
                                          : CLOCK_MONOTONIC,
                &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

double seconds_of(const Runs& runs, std::size_t count, Clock clock) {
  const double begin = now_s(clock);
  runs(count);
  return now_s(clock) - begin;
}

/// So many times that a run is long beside the clock.
std::size_t enough(const Runs& runs, Clock clock) {
  std::size_t count = 1;
  while (seconds_of(runs, count, clock) < kLeastRun_s && count < std::size_t{1} << 30U) count *= 2;
  return count;
}

/// Least time of one, of many rounds in which the two take turns.
void compete(const Contest& contest, Clock clock, double& plumb_s, double& rival_s) {
  const std::size_t ours = enough(contest.plumb, clock);
  const std::size_t theirs = enough(contest.rival, clock);
  plumb_s = rival_s = 1e9;
  for (int k = 0; k < kRounds; ++k) {
    plumb_s = std::min(plumb_s, seconds_of(contest.plumb, ours, clock) / static_cast<double>(ours));
    rival_s = std::min(rival_s, seconds_of(contest.rival, theirs, clock) / static_cast<double>(theirs));
  }
  plumb_s /= contest.each;
  rival_s /= contest.each;
}

std::string time_text(double seconds) {
  char text[32];
  const bool small = seconds < 1e-6;
  std::snprintf(text, sizeof text, small ? "%.1f ns" : "%.2f us", seconds * (small ? 1e9 : 1e6));
  return text;
}

std::string processor() {
  std::ifstream in("/proc/cpuinfo");
  for (std::string line; std::getline(in, line);) {
    if (line.rfind("model name", 0) == 0) return line.substr(line.find(':') + 2);
  }
  return "an unnamed processor";
}

}  // namespace

std::vector<Pair>& pairs() {
  static std::vector<Pair> all;
  return all;
}
std::vector<Figures>& figures() {
  static std::vector<Figures> all;
  return all;
}

int print_table() {
  double load[1] = {0.0};
  (void)getloadavg(load, 1);
  std::printf("%s, %u cores, load %.1f; %s %s; processor time, least of %d rounds by turns\n\n", processor().c_str(),
              std::thread::hardware_concurrency(), load[0], PLUMB_BENCH_COMPILER, PLUMB_BENCH_FLAGS, kRounds);
  std::printf("| work | plumb | rival | time | rival / plumb | asked for |\n|---|---|---|---|---|---|\n");
  std::vector<Pair> all = pairs();
  std::sort(all.begin(), all.end(), [](const Pair& a, const Pair& b) { return a.work < b.work; });
  for (const Pair& pair : all) {
    const Contest contest = pair.make();
    if (!contest.plumb || !contest.rival) {
      std::printf("%s: cannot be set up\n", pair.work.c_str());
      return 1;
    }
    double ours = 0.0;
    double theirs = 0.0;
    compete(contest, pair.clock, ours, theirs);
    char bar[32] = "";
    if (pair.least > 0.0) std::snprintf(bar, sizeof bar, "%.3g", pair.least);
    std::printf("| %s | %s | %s | %s | %.2f | %s |\n", pair.work.c_str(), time_text(ours).c_str(), pair.rival.c_str(),
                time_text(theirs).c_str(), theirs / ours, bar);
    std::fflush(stdout);
  }
  std::printf("\n| figure | value | at most |\n|---|---|---|\n");
  for (const Figures& make : figures()) {
    for (const Figure& one : make()) {
      char bar[32] = "";
      if (one.most > 0.0) std::snprintf(bar, sizeof bar, "%.3g %s", one.most, one.unit.c_str());
      std::printf("| %s | %.3g %s | %s |\n", one.work.c_str(), one.value, one.unit.c_str(), bar);
    }
  }
  return 0;
}

}  // namespace plumb_bench
