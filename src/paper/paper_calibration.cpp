/// The iteration of the paper's fit: minimum-norm steps of fixed rank, or the plain inverse.
#include "plumb/paper/paper_calibration.hpp"

#include <cmath>
#include <limits>

#include "paper_step.hpp"
#include "paper_three.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace {

using namespace paper;

/// Left side of the stop rule. A frozen parameter that stays where it is has not changed, whatever its size.
double change_between(const PaperParameters& now, const PaperParameters& before, const PaperParameters& prior,
                      int size) noexcept {
  double largest = 0.0;
  for (int k = 0; k < size; ++k) {
    const double moved = std::fabs(now[at(k)] - before[at(k)]);
    if (moved == 0.0) continue;
    const double mean = 0.5 * std::fabs(now[at(k)] + before[at(k)]);
    const double floor = std::fmax(std::fmax(mean, prior[at(k)]), std::numeric_limits<double>::min());
    largest = std::fmax(largest, moved / floor);
  }
  return largest;
}

void note(const PaperParameters& theta, double cost, double change, PaperTrace* trace) noexcept {
  if (trace == nullptr) return;
  PaperIteration& entry = trace->iteration[at(trace->size++)];
  entry.parameter = theta;
  entry.cost = cost;
  entry.change = change;
}

Error check_options(const PaperOptions& o) noexcept {
  if (!(o.damping > 0.0 && o.damping <= 1.0)) return Error{Errc::out_of_range, 0, o.damping, 1.0};
  if (!(o.stop > 0.0) || !std::isfinite(o.stop)) return Error{Errc::out_of_range, 1, o.stop, 0.0};
  if (o.max_iterations < 1 || o.max_iterations > kMaxPaperIterations) {
    return Error{Errc::out_of_range, 2, static_cast<double>(o.max_iterations), kMaxPaperIterations};
  }
  return Error{};
}

Error check_stations(const Problem& problem, bool sound) noexcept {
  int usable = 0;
  for (int s = 0; s < problem.count; ++s) {
    if (!problem.error.usable(problem.stations[s])) continue;
    ++usable;
    const double error = sound ? 0.0 : problem.error(problem.error.start(), problem.stations[s]);
    if (!std::isfinite(error)) return Error{Errc::not_finite, s, error, 0.0};
  }
  if (usable < kPaperRank) return Error{Errc::too_few_stations, -1, static_cast<double>(usable), kPaperRank};
  return Error{};
}

/// Standard deviation of a station mean relative to gravity, all sensors and usable stations together.
double relative_noise(const Datasheet& datasheet, const Problem& problem, double g_mps2) noexcept {
  double variance = 0.0, shares = 0.0;
  for (int i = 0; i < datasheet.size; ++i) {
    const double sigma = datasheet.sensor[at(i)].row.sigma_mps2;
    if (problem.error.used().has(i)) variance += sigma * sigma / problem.error.sensors();
  }
  int used = 0;
  for (int s = 0; s < problem.count; ++s) {
    if (!problem.error.usable(problem.stations[s])) continue;
    shares += 1.0 / problem.stations[s].count;
    ++used;
  }
  return std::sqrt(variance * shares / used) / g_mps2;
}

/// The storage of a fit, and the form that its steps take: that of three sensors where it holds, else the general one.
struct Way {
  Workspace general;
  ThreeSensorStep three;
  bool of_three = false;
};

/// The cost at theta, and what a step or the rank needs there.
double look(const Problem& problem, const PaperParameters& theta, Way& way) noexcept {
  return way.of_three ? way.three.look(problem, theta) : assemble(problem, theta, way.general);
}

/// From where `look` was last, theta.
bool step_from(const Problem& problem, const PaperParameters& theta, PaperStep step, Way& way) noexcept {
  if (step == PaperStep::plain_inverse) return plain_inverse_step(problem, theta, way.general);
  if (way.of_three) {
    if (way.three.step(problem, way.general.step)) return true;
    way.of_three = false;
    look(problem, theta, way);
  }
  return minimum_norm_step(problem, way.general);
}

/// Where `look` was last, theta.
int rank_at(const Problem& problem, const PaperParameters& theta, double noise, Way& way) noexcept {
  if (way.of_three) {
    if (way.three.shows_all(problem, rank_floor(noise))) return kPaperRank;
    way.of_three = false;
    look(problem, theta, way);
  }
  return rank_of(noise, way.general);
}

/// From the start, where `look` was and found `out.cost`, to the stop; fills what `out` says of the way and leaves
/// `theta` at the end, where `look` was last.
void iterate(const Problem& problem, const PaperOptions& options, Way& way, PaperParameters& theta, PaperFit& out,
             PaperTrace* trace) noexcept {
  const int size = problem.error.parameters();
  note(theta, out.cost, 0.0, trace);
  while (out.stop == StopReason::none) {
    const bool solved = step_from(problem, theta, options.step, way);
    PaperParameters next = theta;
    for (int k = 0; k < size; ++k) next[at(k)] += options.damping * way.general.step[at(k)];
    const double cost = solved ? look(problem, next, way) : 0.0;
    const double change = change_between(next, theta, problem.error.prior(), size);
    if (!solved || !std::isfinite(cost) || !std::isfinite(change)) {
      out.stop = StopReason::not_finite;
      look(problem, theta, way);
      break;
    }
    theta = next;
    out.cost = cost;
    ++out.iterations;
    note(theta, cost, change, trace);
    if (change < options.stop) {
      out.stop = StopReason::converged;
    } else if (out.iterations >= options.max_iterations) {
      out.stop = StopReason::iteration_limit;
    }
  }
  out.converged = out.stop == StopReason::converged;
}

}  // namespace

Expected<void> paper_calibrate(const Datasheet& datasheet, const GravityReference& gravity, const Station* stations,
                               int count, SensorSet used, const PaperOptions& options, PaperFit& out,
                               PaperTrace* trace) noexcept {
  const Error bad_option = check_options(options);
  if (bad_option.code != Errc::ok) return tl::unexpected<Error>(bad_option);
  const Expected<PaperError> error = PaperError::make(datasheet, gravity, used);
  if (!error) return tl::unexpected<Error>(error.error());
  const Problem problem = {*error, stations, stations == nullptr ? 0 : count};
  Way way;
  way.of_three = options.step == PaperStep::minimum_norm && way.three.begin(problem);
  PaperParameters theta = error->start();
  const double start_cost = look(problem, theta, way);
  const Error bad_station = check_stations(problem, std::isfinite(start_cost));
  if (bad_station.code != Errc::ok) return tl::unexpected<Error>(bad_station);
  out = PaperFit{};
  out.used = used;
  out.model = datasheet.model();
  out.start_cost = out.cost = start_cost;
  if (trace != nullptr) trace->size = 0;
  iterate(problem, options, way, theta, out, trace);
  out.rank = rank_at(problem, theta, relative_noise(datasheet, problem, gravity.g_mps2), way);
  error->store(theta, out.model);
  return {};
}

Expected<void> paper_calibrate_all(const Datasheet& datasheet, const GravityReference& gravity, const Station* stations,
                                   int count, const PaperOptions& options, PaperCalibration& out) noexcept {
  const int n = datasheet.size;
  if (n > kPaperCapacity) return fail(Errc::too_many_sensors, -1, static_cast<double>(n), kPaperCapacity);
  const Expected<void> all =
      paper_calibrate(datasheet, gravity, stations, count, SensorSet::first(n), options, out.all);
  if (!all) return all;
  out.triples = 0;
  for (int i = 0; i < n; ++i) {
    for (int j = i + 1; j < n; ++j) {
      for (int k = j + 1; k < n; ++k) {
        PaperFit& fit = out.triple[at(out.triples++)];
        const SensorSet used = SensorSet::of(i).with(j).with(k);
        if (paper_calibrate(datasheet, gravity, stations, count, used, options, fit)) continue;
        fit = PaperFit{};
        fit.used = used;
        fit.model = datasheet.model();
      }
    }
  }
  return {};
}

}  // namespace PLUMB_ABI
}  // namespace plumb
