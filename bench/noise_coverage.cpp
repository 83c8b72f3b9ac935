// plumb_noise_coverage coverage [--runs N] [--case NAME] [--seed S] [--jobs J]: how often the 95 % intervals of the
// terms of noise hold the coefficients that simulated logs were made with, with Clopper-Pearson intervals, as Markdown.
// plumb_noise_coverage speed: processor time of the parts of a study against the length of the log.
// docs/noise.md holds what it printed.
#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "noise/simulated_noise.hpp"
#include "plumb/noise/axis_study.hpp"
#include "plumb/study/proportion.hpp"

namespace {

using namespace plumb;
using namespace plumb::noise;

constexpr double kPeriod_s = 0.01;

struct Case {
  const char* name;
  Coefficients truth;
  std::size_t readings;
};
constexpr Case kCases[] = {
    {"all", {2e-5, 1e-3, 2e-3, 2e-3, 1e-3}, 32768},     {"no-quantisation", {0.0, 1e-3, 1.2e-3, 6e-4, 0.0}, 32768},
    {"white-walk", {0.0, 1e-3, 0.0, 2e-3, 0.0}, 32768}, {"white-flicker", {0.0, 1e-3, 2e-3, 0.0, 0.0}, 32768},
    {"quantised", {3e-5, 1e-3, 0.0, 0.0, 0.0}, 32768},  {"drift", {0.0, 1e-3, 0.0, 0.0, 1e-5}, 32768},
    {"faint", {0.0, 1e-3, 3e-4, 1e-4, 1e-5}, 32768},    {"long", {2e-5, 1e-3, 3e-4, 3e-4, 1e-5}, 400000}};

struct Counts {
  std::array<std::uint64_t, kTerms> held{}, visible{};
};

Counts count(const Case& one, std::uint64_t seed, std::uint64_t runs, unsigned jobs) {
  Counts out;
  std::mutex guard;
  const auto work = [&](unsigned first) {
    simulated_noise::Source source(one.truth, one.readings, kPeriod_s);
    Counts mine;
    for (std::uint64_t k = first; k < runs; k += jobs) {
      const NoiseFit fit = fit_noise(source.draw(scenario::derive_seed(seed, k)), kPeriod_s, {});
      for (std::size_t t = 0; t < kTerms; ++t) {
        const TermEstimate& term = fit.terms[t];
        mine.held[t] += term.low <= one.truth[t] && one.truth[t] <= term.high ? 1U : 0U;
        mine.visible[t] += term.visible ? 1U : 0U;
      }
    }
    const std::lock_guard<std::mutex> lock(guard);
    for (std::size_t t = 0; t < kTerms; ++t) {
      out.held[t] += mine.held[t];
      out.visible[t] += mine.visible[t];
    }
  };
  std::vector<std::thread> threads;
  for (unsigned j = 1; j < jobs; ++j) threads.emplace_back(work, j);
  work(0);
  for (std::thread& thread : threads) thread.join();
  return out;
}

void print_case(const Case& one, const Counts& counts, std::uint64_t runs) {
  for (const Term term : kAllTerms) {
    const std::size_t t = index(term);
    const study::Proportion held = study::proportion(counts.held[t], runs);
    std::printf("| %s | %zu | %s | %g | %s %s | %.1f |\n", one.name, one.readings, symbol(term), one.truth[t],
                study::rounded_share(held, 4, 100.0).c_str(), study::interval_text(held, 4, 100.0).c_str(),
                100.0 * static_cast<double>(counts.visible[t]) / static_cast<double>(runs));
  }
  std::fflush(stdout);
}

double seconds_of(const std::vector<double>& readings, int part) {
  const std::clock_t begin = std::clock();
  if (part == 0) {
    (void)allan_deviation(prefix_sums(readings), kPeriod_s, 1);
  } else if (part == 1) {
    (void)fit_noise(readings, kPeriod_s, {});
  } else if (part == 2) {
    (void)power_spectrum(readings, kPeriod_s);
  } else {
    StillLog log;
    log.rate_hz = 1.0 / kPeriod_s;
    log.columns = {{"a", readings}};
    (void)study_axis(log, 0, {});
  }
  return static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
}

void print_speed() {
  std::puts(
      "| readings | one averaging time, ns a reading | fit, s | spectrum, s | whole study, s |\n|---|---|---|---|---|");
  for (std::size_t readings = 100000; readings <= 12800000; readings *= 2) {
    std::vector<double> log = simulated_noise::normals(1, 1, readings);
    double times[4];
    for (int part = 0; part < 4; ++part) {
      times[part] = seconds_of(log, part);
      for (int again = 0; again < 2; ++again) times[part] = std::min(times[part], seconds_of(log, part));
    }
    const double lengths = static_cast<double>(averaging_lengths(readings, 1).size());
    std::printf("| %zu | %.2f | %.3f | %.3f | %.3f |\n", readings,
                1e9 * times[0] / lengths / static_cast<double>(readings), times[1], times[2], times[3]);
    std::fflush(stdout);
  }
}

}  // namespace

int main(int argc, char** argv) {
  const std::string what = argc > 1 ? argv[1] : "";
  std::uint64_t runs = 10000, seed = 20180227, jobs = 1;
  std::string only;
  for (int k = 2; k + 1 < argc; k += 2) {
    const std::string option = argv[k];
    if (option == "--runs") runs = std::strtoull(argv[k + 1], nullptr, 10);
    if (option == "--seed") seed = std::strtoull(argv[k + 1], nullptr, 10);
    if (option == "--jobs") jobs = std::strtoull(argv[k + 1], nullptr, 10);
    if (option == "--case") only = argv[k + 1];
  }
  if (what == "speed") {
    print_speed();
    return 0;
  }
  if (what != "coverage" || runs == 0 || jobs == 0) {
    std::fputs("usage: plumb_noise_coverage coverage [--runs N] [--case NAME] [--seed S] [--jobs J] | speed\n", stderr);
    return 2;
  }
  std::puts("| case | readings | term | true | held, % [95 %] | visible, % |\n|---|---|---|---|---|---|");
  for (const Case& one : kCases) {
    if (only.empty() || only == one.name) print_case(one, count(one, seed, runs, static_cast<unsigned>(jobs)), runs);
  }
  return 0;
}
