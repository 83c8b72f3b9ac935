// The forward fit and the paper's, against Ceres on the same cost in the same run. Built for 8 sensors, as an
// instrument would. The rivals are there where PLUMB_BENCH_CERES is on; every pair is checked to reach the same cost.
#include "calibration_bench.hpp"

#include <benchmark/benchmark.h>

#include <memory>

#include "plumb/paper/paper_calibration.hpp"
#ifdef PLUMB_BENCH_CERES
#include "ceres_rivals.hpp"
#endif

namespace {

using namespace plumb;
using plumb_bench::at;
using plumb_bench::Problem;

constexpr int kProblems = 16;

const std::vector<Problem>& problems() {
  static const std::vector<Problem> all = [] {
    std::vector<Problem> out;
    for (int k = 0; k < kProblems; ++k) out.push_back(plumb_bench::problem_of(4, 48, 100U + static_cast<unsigned>(k)));
    return out;
  }();
  return all;
}

/// The cost alone: known noise, so that both sides minimise one and the same function.
FitOptions known_noise(FitStart start) {
  FitOptions o;
  o.estimate_misfit = false;
  o.start = start;
  return o;
}

double fitted_cost(const Problem& p, FitStart start) {
  Calibrator calibrator(p.sheet, plumb_bench::gravity(), known_noise(start));
  while (!calibrator.done()) calibrator.iterate(p.stations.data(), static_cast<int>(p.stations.size()));
  return calibrator.cost();
}

void fit_only(benchmark::State& state, FitStart start) {
  std::size_t k = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(fitted_cost(problems()[k], start));
    k = (k + 1) % problems().size();
  }
}

void with_report(benchmark::State& state, const FitOptions& options) {
  std::size_t k = 0;
  for (auto _ : state) {
    const Problem& p = problems()[k];
    benchmark::DoNotOptimize(calibrate(p.sheet, plumb_bench::gravity(), p.stations.data(), 48, options));
    k = (k + 1) % problems().size();
  }
}

void BM_ForwardFit(benchmark::State& state) { fit_only(state, FitStart::automatic); }
BENCHMARK(BM_ForwardFit);
void BM_ForwardFitFromDatasheet(benchmark::State& state) { fit_only(state, FitStart::datasheet); }
BENCHMARK(BM_ForwardFitFromDatasheet);
void BM_ForwardFitWithReport(benchmark::State& state) { with_report(state, known_noise(FitStart::automatic)); }
BENCHMARK(BM_ForwardFitWithReport);
void BM_Calibrate(benchmark::State& state) { with_report(state, {}); }
BENCHMARK(BM_Calibrate);

template <int n>
double paper_cost(const Problem& p) {
  PaperFit fit;
  const auto done =
      paper_calibrate(p.sheet, plumb_bench::gravity(), p.stations.data(), 48, SensorSet::first(n), {}, fit);
  return done ? fit.cost : -1.0;
}

template <int n>
void BM_PaperFit(benchmark::State& state) {
  std::size_t k = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(paper_cost<n>(problems()[k]));
    k = (k + 1) % problems().size();
  }
}
BENCHMARK(BM_PaperFit<4>)->Name("BM_PaperFit");
BENCHMARK(BM_PaperFit<3>)->Name("BM_PaperFitOfATriple");

#ifdef PLUMB_BENCH_CERES

/// Runs a rival; fails the benchmark where it does not reach the cost that plumb reached.
template <class Rival>
void against(benchmark::State& state, double (*own)(const Problem&), double tolerance, Rival rival) {
  double worst = 0.0;
  for (const Problem& p : problems()) {
    const double mine = own(p), theirs = rival(p);
    worst = std::fmax(worst, std::fabs(theirs - mine) / mine);
  }
  if (!(worst <= tolerance)) {
    state.SkipWithError(("costs differ by " + std::to_string(worst)).c_str());
    return;
  }
  std::size_t k = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(rival(problems()[k]));
    k = (k + 1) % problems().size();
  }
  state.counters["cost_difference"] = worst;
}

double own_forward(const Problem& p) { return fitted_cost(p, FitStart::automatic); }

void BM_CeresForwardFit(benchmark::State& state) { against(state, own_forward, 1e-6, plumb_bench::ceres_forward); }
BENCHMARK(BM_CeresForwardFit);

void BM_CeresForwardFitEliminated(benchmark::State& state) {
  against(state, own_forward, 1e-6, plumb_bench::ceres_eliminated);
}
BENCHMARK(BM_CeresForwardFitEliminated);

// Three sensors have nine directions, all of them seen: one minimum, and both sides are in it.
void BM_CeresPaperFitOfATriple(benchmark::State& state) {
  against(state, paper_cost<3>, 1e-6, plumb_bench::ceres_paper_triple);
}
BENCHMARK(BM_CeresPaperFitOfATriple);
void BM_TinySolverPaperFitOfATriple(benchmark::State& state) {
  against(state, paper_cost<3>, 1e-6, plumb_bench::tiny_paper_triple);
}
BENCHMARK(BM_TinySolverPaperFitOfATriple);

// With four, three more directions show noise alone; plumb leaves them, a damped method crawls down them, and 3 of the
// 39 degrees of freedom of the residuals go that way, more or less.
constexpr double kNoiseOnly = 0.5;
void BM_CeresPaperFit(benchmark::State& state) { against(state, paper_cost<4>, kNoiseOnly, plumb_bench::ceres_paper); }
BENCHMARK(BM_CeresPaperFit);
void BM_TinySolverPaperFit(benchmark::State& state) {
  against(state, paper_cost<4>, kNoiseOnly, plumb_bench::tiny_paper);
}
BENCHMARK(BM_TinySolverPaperFit);

#endif

}  // namespace
