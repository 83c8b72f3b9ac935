// The tools of the generated cases: what the sensors are, and what the monitor knows of them.
#include <cmath>
#include <memory>

#include "plan.hpp"
#include "plumb/array/named.hpp"
#include "plumb/scenario/library.hpp"

namespace plumb_replay {
inline namespace PLUMB_ABI {

using namespace plumb;

namespace {

std::size_t slot(int i) { return static_cast<std::size_t>(i); }

/// n axes anywhere, no two of them within 15 deg of a line and the first three far from one plane.
int scattered(AxisList& axes, int n, Draws& draws) {
  constexpr double kMostCosine = 0.966, kLeastDet = 0.15;
  int made = 0;
  while (made < n) {
    const Vec3 axis = draws.direction();
    bool apart = true;
    for (int i = 0; i < made; ++i) apart = apart && std::fabs(dot(axis, axes[slot(i)])) < kMostCosine;
    if (made == 2) apart = apart && std::fabs(det3(axes[0], axes[1], axis)) > kLeastDet;
    if (apart) axes[slot(made++)] = axis;
  }
  return made;
}

int draw_axes(AxisList& axes, int n, Draws& draws) {
  int made = 0;
  switch (draws.below(4)) {
    case 0: made = n == 4 ? paper_tetrahedron(axes) : platonic(axes, n); break;
    case 1: made = cone_with_axis(axes, n); break;
    case 2: made = cone(axes, n); break;
    default: break;
  }
  return made == n ? made : scattered(axes, n, draws);
}

}  // namespace

Datasheet draw_datasheet(int n, Draws& draws) {
  AxisList axes{};
  draw_axes(axes, n, draws);
  Datasheet out;
  out.size = n;
  out.reads = draws.one_in(4) ? Reads::specific_force : Reads::gravity;
  const bool volts = !draws.one_in(4);  // else the log is in m/s^2, range and codes unknown
  const bool warm = draws.one_in(3);
  for (int i = 0; i < n; ++i) {
    DatasheetSensor& sensor = out.sensor[slot(i)];
    sensor.row.id = make_id(("a" + std::to_string(i + 1)).c_str());
    sensor.row.axis = axes[slot(i)];
    sensor.row.sigma_mps2 = scenario::kPaperNoise_mps2 * (draws.one_in(6) ? 2.0 : 1.0);
    if (volts) {
      sensor.coefficients.scale[0] = scenario::kPaperScale_VpMps2;
      sensor.full_scale_raw = scenario::kPaperFullScale_V;
      sensor.resolution_raw = scenario::kPaperResolution_V;
    }
    if (warm) {
      sensor.coefficients.scale[1] = 1e-5 * draws.normal() * sensor.coefficients.scale[0];
      sensor.coefficients.bias[1] = 1e-4 * draws.normal();
    }
  }
  return out;
}

std::vector<Station> draw_stations(const scenario::Tool& tool, int stations, std::uint64_t seed) {
  scenario::Scenario stand = scenario::calibration_run(tool, seed, stations);
  stand.dwell_s = 16.0 / stand.rate_hz;
  auto simulator = scenario::Simulator::make(stand);
  std::vector<Station> out;
  if (!simulator) return out;
  for (Sample sample; simulator->next(sample);) {
    if (out.empty() || out.back().tag != sample.station) {
      out.emplace_back();
      out.back().tag = sample.station;
      out.back().begin_s = sample.time_s;
      out.back().delivered = sample.delivered;
      out.back().temperature_degc = sample.temperature_degc;
    }
    Station& station = out.back();
    for (std::size_t i = 0; i < sample.raw.size(); ++i) station.mean[i] += sample.raw[i];
    ++station.count;
    station.end_s = sample.time_s;
  }
  for (Station& station : out) {
    for (double& mean : station.mean) mean /= station.count;
  }
  return out;
}

}  // namespace PLUMB_ABI
}  // namespace plumb_replay
