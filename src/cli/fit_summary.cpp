#include "fit_summary.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "plumb/core/units.hpp"
#include "plumb/navigation/tilt.hpp"
#include "plumb/report/words.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace cli {
namespace {

constexpr double kMilliG0_mps2 = 1e-3 * kG0_mps2;
/// Parameters with at least this part of the largest share in a null direction are named.
constexpr double kNamedShare = 0.3;
/// No more than this many parameters in one sentence.
constexpr std::size_t kNamedParameters = 6;
/// Directions tried when looking for the attitude that is farthest from all recorded ones.
constexpr int kCandidates = 400;

std::string id_of(const io::ArrayFile& array, int i) { return array.array.row(i).id.data(); }

struct NamedShare {
  double share;
  std::string name;
};

/// What a null direction does to each sensor: bias, scale (along the axis), axis (across it).
std::vector<NamedShare> shares_of(const NullDirection& direction, const io::ArrayFile& array) {
  std::vector<NamedShare> out;
  for (int i = 0; i < array.array.size(); ++i) {
    const std::size_t at = 4 * static_cast<std::size_t>(i);
    const Vec3 w{direction.component[at], direction.component[at + 1], direction.component[at + 2]};
    const Vec3& h = array.array.axis(i);
    const double along = dot(w, h);
    out.push_back({std::fabs(direction.component[at + 3]), "bias of " + id_of(array, i)});
    out.push_back({std::fabs(along), "scale of " + id_of(array, i)});
    out.push_back({norm(minus(w, scaled(h, along))), "axis of " + id_of(array, i)});
  }
  std::stable_sort(out.begin(), out.end(), [](const NamedShare& a, const NamedShare& b) { return a.share > b.share; });
  return out;
}

/// Rounded to what a hand can set, as a driller says it and as a vector.
std::string in_words(const Vec3& down) {
  const Tilt tilt = tilt_of(down, Mat3{});
  const auto to_five = [](double rad) { return 5.0 * std::round(deg_from_rad(rad) / 5.0); };
  std::string out = fmt::format("inclination {:.0f} deg", to_five(tilt.inclination_rad));
  if (tilt.toolface_valid) out += fmt::format(", toolface {:.0f} deg", to_five(tilt.toolface_rad));
  return out + fmt::format(" (down along {:.1f}, {:.1f}, {:.1f})", down[0], down[1], down[2]);
}

/// Evenly spread over the sphere (golden-angle spiral).
Vec3 candidate(int k) {
  const double z = 1.0 - (2.0 * k + 1.0) / kCandidates;
  const double r = std::sqrt(1.0 - z * z);
  const double angle = k * kPi * (3.0 - std::sqrt(5.0));
  return {r * std::cos(angle), r * std::sin(angle), z};
}

std::string worst_sensor(const FitReport& report, const io::ArrayFile& array) {
  int worst = 0;
  for (int i = 1; i < array.array.size(); ++i) {
    if (report.residual_rms_mps2[static_cast<std::size_t>(i)] >
        report.residual_rms_mps2[static_cast<std::size_t>(worst)])
      worst = i;
  }
  return id_of(array, worst);
}

std::string joined(const std::vector<std::string>& parts, const char* between) {
  std::string out;
  for (const std::string& part : parts) out += (out.empty() ? "" : between) + part;
  return out;
}

}  // namespace

std::vector<SensorFigures> sensor_figures(const CalibrationRun& run, const io::ArrayFile& array) {
  std::vector<SensorFigures> out;
  for (int i = 0; i < array.array.size(); ++i) {
    const auto a = static_cast<std::size_t>(i);
    SensorFigures f;
    f.id = id_of(array, i);
    f.bias_sigma_mg = run.report.sigma[4 * a + 3] / kMilliG0_mps2;
    f.e_cal_mg = run.report.e_cal_mps2[a] / kMilliG0_mps2;
    f.residual_rms_mg = run.report.residual_rms_mps2[a] / kMilliG0_mps2;
    const double* share = run.report.data_share.data() + 4 * a;
    f.data_share = *std::min_element(share, share + 4);
    if (run.accepted) {
      const SensorCoefficients& fitted = run.accepted->model.sensor[a];
      f.bias_mg = fitted.bias[0] / kMilliG0_mps2;
      f.scale = fitted.scale[0] * kG0_mps2;
      f.scale_change = fitted.scale[0] / array.datasheet.sensor[a].coefficients.scale[0] - 1.0;
      f.axis_shift_deg = deg_from_rad(angle_between_rad(run.accepted->array.axis(i), array.array.axis(i)));
    }
    out.push_back(std::move(f));
  }
  return out;
}

std::vector<std::string> unobservable(const FitReport& report, const io::ArrayFile& array) {
  std::vector<std::string> out;
  const int kept = std::min(report.null_directions, kMaxNullDirections);
  for (int k = 0; k < kept; ++k) {
    const std::vector<NamedShare> shares = shares_of(report.null_direction[static_cast<std::size_t>(k)], array);
    std::vector<std::string> names;
    std::size_t left_out = 0;
    for (const NamedShare& s : shares) {
      if (!(s.share > kNamedShare * shares.front().share)) continue;
      if (names.size() < kNamedParameters) {
        names.push_back(s.name);
      } else {
        ++left_out;
      }
    }
    out.push_back((names.size() > 1 ? "a common change of: " : "") + joined(names, ", ") +
                  (left_out > 0 ? fmt::format(", and {} more", left_out) : ""));
  }
  if (report.null_directions > kept)
    out.push_back(fmt::format("and {} more directions", report.null_directions - kept));
  return out;
}

std::vector<std::string> attitudes_to_record(const CalibrationRun& run, const io::ArrayFile& array, int count) {
  const SensorModel model = array.datasheet.model();
  std::vector<Vec3> seen;
  for (const Station& station : run.stations) {
    const LeastSquares map = least_squares(array.array, station.delivered);
    if (!map.valid) continue;
    const Vec3 x = map.estimate(model.apply(station.mean, station.temperature_degc, station.delivered));
    if (norm(x) > 0.0) seen.push_back(scaled(x, 1.0 / norm(x)));
  }
  std::vector<std::string> out;
  while (static_cast<int>(out.size()) < count) {
    Vec3 best = candidate(0);
    double farthest_rad = -1.0;
    for (int k = 0; k < kCandidates; ++k) {
      double nearest_rad = kPi;
      for (const Vec3& s : seen) nearest_rad = std::min(nearest_rad, angle_between_rad(candidate(k), s));
      if (nearest_rad > farthest_rad) {
        farthest_rad = nearest_rad;
        best = candidate(k);
      }
    }
    out.push_back(in_words(best));
    seen.push_back(best);
  }
  return out;
}

Refusal refusal_of(const CalibrationRun& run, const io::ArrayFile& array) {
  const Error& e = run.refusal;
  const std::string sensor = e.index >= 0 && e.index < array.array.size() ? id_of(array, e.index) : "";
  const auto more = [&run, &array](int count) {
    return "hold the tool still at attitudes it has not had yet, for example: " +
           joined(attitudes_to_record(run, array, count), "; ");
  };
  switch (e.code) {
    case Errc::too_few_stations:
      return {fmt::format("{} stations were found, {} are needed", run.stations.size(), e.limit), more(4)};
    case Errc::unobservable:
      return {fmt::format(
                  "the stations determine {} of the {} parameters that they must (the report names what is missing)",
                  e.value, e.limit),
              more(4)};
    case Errc::implausible:
      return {
          fmt::format("a parameter of {} is physically implausible ({:.4g}, bound {:.4g})", sensor, e.value, e.limit),
          "check the channel, the sign of its axis and its scale in the array file; if all is right, the sensor is "
          "faulty: leave it out"};
    case Errc::poor_fit:
      return {fmt::format("the residual is too large ({:.4g} m/s^2, allowed {:.4g})", e.value, e.limit),
              "look at " + worst_sensor(run.report, array) +
                  ", whose residual is the largest; make sure that the tool was still at every "
                  "station and that [gravity] is right, then record again"};
    case Errc::diverged:
      return {"the fit did not settle",
              "check axes, scales and `reads` in the array file against the log; then " + more(4)};
    default: {
      const io::FileError words = io::from_error(e);
      return {words.what + (sensor.empty() ? "" : " (sensor " + sensor + ")"), words.remedy};
    }
  }
}

Refusal paper_refusal_of(const CalibrationRun& run, const io::ArrayFile& array) {
  const Error& e = run.paper_refusal;
  const std::string rotate = "hold the tool still at attitudes it has not had yet, for example: " +
                             joined(attitudes_to_record(run, array, 4), "; ");
  const std::string without = ", or calibrate without --paper and mode = \"paper\"";
  switch (e.code) {
    case Errc::diverged: return {"it did not converge", "check axes and scales in the array file" + without};
    case Errc::unobservable:
      return {fmt::format("the stations show {} of the {} directions that the length of gravity can show", e.value,
                          e.limit),
              rotate + without};
    case Errc::too_few_stations:
      return {fmt::format("{} stations have all sensors, {} are needed", e.value, e.limit), rotate + without};
    default: {
      const io::FileError words = io::from_error(e);
      return {words.what, words.remedy + without};
    }
  }
}

std::vector<PaperFigures> paper_figures(const PaperCalibration& paper, const io::ArrayFile& array) {
  const auto figures_of = [&array](const PaperFit& fit) {
    PaperFigures f;
    f.sensors = fit.used == array.array.all() ? "all" : report::sensor_names(fit.used, array.array);
    f.sound = fit.sound();
    f.outcome = fit.stop == StopReason::none ? "not possible" : to_string(fit.stop);
    f.iterations = fit.iterations;
    f.rank = fit.rank;
    f.start_cost = fit.start_cost;
    f.cost = fit.cost;
    f.length_error_mg = std::sqrt(fit.cost) / (2.0 * array.gravity.g_mps2) / kMilliG0_mps2;
    return f;
  };
  std::vector<PaperFigures> out = {figures_of(paper.all)};
  const int triples = array.array.size() > 3 ? paper.triples : 0;  // of three sensors the triple is all
  for (int k = 0; k < triples; ++k) out.push_back(figures_of(paper.triple[static_cast<std::size_t>(k)]));
  return out;
}

}  // namespace cli
}  // namespace PLUMB_ABI
}  // namespace plumb
