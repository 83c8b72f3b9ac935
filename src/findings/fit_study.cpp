#include "plumb/findings/fit_study.hpp"

#include <algorithm>
#include <cmath>

#include "plumb/array/geometry.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace findings {
namespace {

/// Below so many stations every one is held out alone: a quarter would be missed too much.
constexpr int kFewStations = 16;
constexpr int kDefaultFolds = 4;
/// Samples behind a proposed station where none is recorded yet: 10 s at 100 Hz.
constexpr double kDefaultSamples = 1000.0;
constexpr int kMostIterations = 10000;

HoldOutPlan plan_of(const HoldOutChoice& choice, int stations) {
  HoldOutPlan plan;
  plan.folds = choice.folds > 0 ? choice.folds : kDefaultFolds;
  if (choice.all || (choice.folds == 0 && stations < kFewStations)) plan.folds = std::max(stations, 2);
  plan.folds = std::min(plan.folds, std::max(stations, 2));
  plan.rounds = choice.once ? 1 : plan.folds;
  return plan;
}

/// Directions by the fit where there is one, else by the datasheet.
void find_attitudes(const io::ArrayFile& array, const std::vector<Station>& stations, FitStudy& out) {
  const SensorModel nominal = array.datasheet.model();
  for (Station station : stations) {
    for (int i = 0; i < array.array.size(); ++i) {
      // A reading at full scale is none, as in the fit.
      const auto a = static_cast<std::size_t>(i);
      const double full_scale = array.datasheet.sensor[a].full_scale_raw;
      if (full_scale > 0.0 && std::fabs(station.mean[a]) >= full_scale)
        station.delivered = station.delivered.without(i);
    }
    SeenAttitude seen{Vec3{}, station.delivered & array.array.all(), static_cast<double>(station.count)};
    Vec3 x{};
    if (out.shown) {
      out.residuals.push_back(station_residual(*out.shown, array.gravity, station));
      x = out.residuals.back().gravity_mps2;
    } else {
      const LeastSquares map = least_squares(array.array, seen.delivered);
      if (map.valid) x = map.estimate(nominal.apply(station.mean, station.temperature_degc, seen.delivered));
    }
    const double length = norm(x);
    if (length > 0.0 && std::isfinite(length)) seen.direction = scaled(x, 1.0 / length);
    out.attitudes.push_back(seen);
  }
}

void plan_next(const io::ArrayFile& array, FitStudy& out) {
  auto planner = std::make_unique<StationPlanner>(array.datasheet, array.gravity.g_mps2);
  double samples = 0.0;
  int usable = 0;
  for (const SeenAttitude& seen : out.attitudes) {
    if (!planner->add(seen)) continue;
    samples += seen.samples;
    ++usable;
  }
  out.next.resize(kPlanned);
  const int planned = planner->plan(usable > 0 ? samples / usable : kDefaultSamples, kPlanned, out.next.data());
  out.next.resize(static_cast<std::size_t>(planned));
}

/// What was refused is shown too: the figures are why. Of an order that the temperatures do not support, the highest
/// that they do.
std::unique_ptr<Calibration> refused_fit(const io::ArrayFile& array, const std::vector<Station>& stations,
                                         TemperatureOptions options) {
  const auto work = std::make_unique<TemperatureWork>();
  std::vector<Station> scratch(stations.size());
  options.fit = without_limits(options.fit);
  options.max_order = options.order;
  options.order = options.order > 0 ? kAutomaticOrder : 0;
  const Expected<Calibration> refused =
      calibrate_over_temperature(array.datasheet, array.gravity, stations.data(), static_cast<int>(stations.size()),
                                 options, scratch.data(), *work);
  return refused ? std::make_unique<Calibration>(*refused) : nullptr;
}

/// The fit once more, step by step: `calibrate` keeps neither its history nor more than a few outliers.
void look_again(const io::ArrayFile& array, const std::vector<Station>& stations, bool accepted,
                const FitOptions& options, FitStudy& out) {
  auto calibrator = std::make_unique<Calibrator>(array.datasheet, array.gravity, options);
  for (int k = 0; k < kMostIterations && !calibrator->done(); ++k) {
    calibrator->iterate(stations.data(), static_cast<int>(stations.size()));
    const bool started = calibrator->iterations() > 0;  // the first call may only find where to start
    if (started && std::isfinite(calibrator->cost())) out.cost.push_back(calibrator->cost());
  }
  for (int k = 0; k < static_cast<int>(stations.size()); ++k) {
    const bool aside = accepted && calibrator->sets_aside(stations[static_cast<std::size_t>(k)]);
    (aside ? out.set_aside : out.kept).push_back(k);
  }
}

/// What an accepted fit has rejected is neither predicted nor held against a sensor.
void cross_check(const io::ArrayFile& array, const Datasheet& nominal, const std::vector<Station>& all,
                 const Expected<Calibration>& fit, const FitReport& report, const TemperatureOptions& over,
                 const HoldOutChoice& choice, FitStudy& out) {
  const FitOptions& options = over.fit;
  const std::vector<Station> stations = chosen(all, out.kept);
  std::vector<Station> scratch(stations.size());
  const int count = static_cast<int>(stations.size());
  out.plan = plan_of(choice, count);
  if (!choice.none && out.shown) {
    std::vector<StationPrediction> predicted(stations.size());
    if (over.order > 0) {
      std::vector<Station> more(stations.size());
      const auto work = std::make_unique<TemperatureWork>();
      out.held_out = hold_out_over_temperature(nominal, array.gravity, stations.data(), count, out.plan, over,
                                               scratch.data(), more.data(), *work, predicted.data());
    } else {
      out.held_out = hold_out(array.datasheet, array.gravity, stations.data(), count, out.plan, options, scratch.data(),
                              predicted.data());
    }
    if (out.held_out.judged > 0) {
      out.held_out.worst = out.kept[static_cast<std::size_t>(out.held_out.worst)];
      out.predicted.resize(all.size());
      for (std::size_t k = 0; k < predicted.size(); ++k)
        out.predicted[static_cast<std::size_t>(out.kept[k])] = predicted[k];
    }
  }
  const bool unsettled = !out.shown && report.stop != StopReason::none && report.stop != StopReason::converged;
  const bool poor = !fit && fit.error().code == Errc::poor_fit;
  out.odd_sought = unsettled || poor || (out.shown && report.degrees_of_freedom > 0 && report.p_value < kNoNoise);
  if (out.odd_sought)
    out.odd = odd_sensor(array.datasheet, array.gravity, stations.data(), count, options, scratch.data());
}

}  // namespace

std::vector<Station> chosen(const std::vector<Station>& stations, const std::vector<int>& which) {
  std::vector<Station> out;
  for (const int k : which) out.push_back(stations[static_cast<std::size_t>(k)]);
  return out;
}

FitStudy study_fit(const io::ArrayFile& array, const std::vector<Station>& stations, const Expected<Calibration>& fit,
                   const FitReport& report, const TemperatureOptions& options, const HoldOutChoice& choice) {
  FitStudy out;
  const int count = static_cast<int>(stations.size());
  if (fit) {
    out.shown = std::make_unique<Calibration>(*fit);
  } else if (fit.error().code != Errc::diverged) {
    out.shown = refused_fit(array, stations, options);
  }
  io::ArrayFile drifting = array;
  if (options.order > 0 && out.shown) drifting.datasheet = with_temperature_of(array.datasheet, *out.shown);
  find_attitudes(array, stations, out);
  out.coverage = coverage_of(array.datasheet, out.attitudes.data(), count);
  plan_next(array, out);
  out.null_count = null_combinations(array.datasheet, out.shown ? out.shown->report : report, *out.nulls);
  look_again(drifting, stations, fit.has_value(), options.fit, out);
  cross_check(drifting, array.datasheet, stations, fit, report, options, choice, out);
  out.judgement = judge_gravity(array.gravity);
  if (!out.shown) {
    if (out.judgement.error.code == Errc::ok) out.judgement = judge_odd_sensor(array.datasheet, out.odd);
    return out;
  }
  out.paper = paper_form(array.array, out.shown->array, out.shown->model);
  out.judgement = judge(array.datasheet, array.gravity, *out.shown, out.held_out, out.odd);
  return out;
}

}  // namespace findings
}  // namespace PLUMB_ABI
}  // namespace plumb
