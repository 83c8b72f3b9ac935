// Redundant magnetometers through calibration and monitor, as accelerometers go: in fields of every length on Earth.
#include <gtest/gtest.h>

#include <rapidcheck/gtest.h>

#include <cmath>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "plumb/array/geometry.hpp"
#include "plumb/calibration/calibration.hpp"
#include "plumb/session/monitor_pipeline.hpp"

namespace magnetic_group_test {
namespace {

using namespace plumb;

/// Four to six magnetometers, hard and soft iron, in a field of `total_ut`.
struct Tool {
  io::ArrayFile array;
  double total_ut = 50.0;
  std::array<double, 9> iron{};  ///< what soft iron makes of the field, row-major
  Vec3 hard_ut{};
  Vec3 disturbance_ut{};  ///< of a drill string, say: turns with the tool
  std::vector<double> bias_ut, scale;
  std::mt19937_64 random;

  double noise(double sigma) { return std::normal_distribution<double>(0.0, sigma)(random); }
  Vec3 direction() {
    const Vec3 v{noise(1.0), noise(1.0), noise(1.0)};
    return scaled(v, 1.0 / norm(v));
  }
  /// In the unit of the log, nT.
  std::array<double, kCapacity> readings(const Vec3& direction_of_field) {
    Vec3 at{};
    for (std::size_t r = 0; r < 3; ++r) {
      at[r] = hard_ut[r] + disturbance_ut[r];
      for (std::size_t c = 0; c < 3; ++c) at[r] += iron[3 * r + c] * total_ut * direction_of_field[c];
    }
    std::array<double, kCapacity> out{};
    for (int i = 0; i < array.array.size(); ++i) {
      const auto a = static_cast<std::size_t>(i);
      out[a] = 1e3 * scale[a] * (dot(array.array.axis(i), at) + bias_ut[a]) + noise(20.0);
    }
    return out;
  }
};

std::string text_of(int sensors, double total_ut) {
  static const char* const kAxes[] = {"[1, 0, 0]",
                                      "[0, 1, 0]",
                                      "[0, 0, 1]",
                                      "[0.577350269189626, 0.577350269189626, 0.577350269189626]",
                                      "[-0.577350269189626, 0.577350269189626, 0.577350269189626]",
                                      "[0.577350269189626, -0.577350269189626, 0.577350269189626]"};
  std::string out =
      "[input]\nreads = \"gravity\"\nunit = \"m/s^2\"\nrate = \"50 Hz\"\n[[group]]\nname = \"mag\"\n"
      "field = \"magnetic\"\nunit = \"nT\"\n[group.reference]\nvalue = \"" +
      std::to_string(total_ut) +
      " uT\"\nsigma = \"100 nT\"\n[group.monitor]\nwindow = 8\nalignment_bound = \"0.1 deg\"\n"
      "alert_limit = \"5 deg\"\n";
  for (int i = 0; i < sensors; ++i)
    out += "[[group.sensor]]\nid = \"m" + std::to_string(i + 1) + "\"\naxis = " + kAxes[i] +
           "\nnoise = \"20 nT\"\nstability = \"20 nT\"\nprior = {bias = \"3 uT\", scale = \"3 %\", axis = \"3 deg\"}\n";
  return out;
}

Tool tool_of(int sensors, double total_ut, std::uint64_t seed) {
  Tool out;
  const auto read = io::parse_array_text(text_of(sensors, total_ut), "tool.toml", {}, "mag");
  EXPECT_TRUE(read.has_value()) << read.error().text();
  out.array = *read;
  out.total_ut = total_ut;
  out.random.seed(seed);
  for (std::size_t r = 0; r < 3; ++r) {
    out.hard_ut[r] = 0.02 * total_ut * out.noise(1.0);
    for (std::size_t c = 0; c <= r; ++c) {
      const double part = 0.01 * out.noise(1.0);
      out.iron[3 * r + c] = out.iron[3 * c + r] = part + (r == c ? 1.0 : 0.0);
    }
  }
  for (int i = 0; i < sensors; ++i) {
    out.bias_ut.push_back(0.3 * out.noise(1.0));
    out.scale.push_back(1.0 + 0.005 * out.noise(1.0));
  }
  return out;
}

std::vector<Station> stations_of(Tool& tool, int count) {
  std::vector<Station> out;
  for (int k = 0; k < count; ++k) {
    const Vec3 field = tool.direction();
    Station station;
    station.count = 100;
    station.temperature_degc = 25.0;
    station.delivered = tool.array.array.all();
    for (int j = 0; j < 100; ++j) {
      const auto one = tool.readings(field);
      for (std::size_t i = 0; i < one.size(); ++i) station.mean[i] += one[i] / 100.0;
    }
    out.push_back(station);
  }
  return out;
}

/// The directions in the frame of the fit, which may be turned as a whole: angles between two of them count.
double angle_rad(const Vec3& a, const Vec3& b) { return std::atan2(norm(cross(a, b)), dot(a, b)); }

// Verifies: REQ-240
// The length of the field is all that is needed: hard iron, soft iron and cross-axis come out as biases, scales and
// axes do.
RC_GTEST_PROP(MagneticGroup, HardAndSoftIronAreCalibratedAway, ()) {
  const double total_ut = *rc::gen::inRange(22, 68);
  Tool tool = tool_of(*rc::gen::inRange(3, 7), total_ut, static_cast<std::uint64_t>(*rc::gen::inRange(1, 1000000)));
  const std::vector<Station> stations = stations_of(tool, 36);
  const auto made =
      calibrate(tool.array.datasheet, tool.array.gravity, stations.data(), static_cast<int>(stations.size()));
  RC_ASSERT(made.has_value());
  const auto* calibration = &*made;
  const LeastSquares map = least_squares(calibration->array, calibration->array.all());
  const Vec3 a = tool.direction(), b = tool.direction();
  const auto measured = [&](const Vec3& field) {
    std::array<double, kCapacity> mean{};
    for (int j = 0; j < 400; ++j) {
      const auto one = tool.readings(field);
      for (std::size_t i = 0; i < one.size(); ++i) mean[i] += one[i] / 400.0;
    }
    return map.estimate(calibration->model.apply(mean, 25.0, calibration->array.all()));
  };
  const Vec3 at_a = measured(a), at_b = measured(b);
  // 20 nT over the root of 400 beside what the fit left: some nT of 22 uT and more.
  RC_ASSERT(std::fabs(norm(at_a) / (io::kInside_per_ut * total_ut) - 1.0) < 1e-3);
  RC_ASSERT(std::fabs(angle_rad(at_a, at_b) - angle_rad(a, b)) < 2e-3);
}

struct Answer {
  HealthState state = HealthState::suspect;
  SensorSet excluded;
  int claims = 0, wrong = 0;  ///< directions that may be used, and those of them off by more than their bound
};

/// A perfectly known tool held still in one attitude after the other; from the fifth on one sensor reads `fault_nt`
/// more, or stands still.
Answer watched(Tool& tool, int sensor, double fault_nt, bool stuck) {
  tool.hard_ut = {};
  tool.iron = {1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0};
  for (double& bias : tool.bias_ut) bias = 0.0;
  for (double& scale : tool.scale) scale = 1.0;
  auto setup = std::make_unique<MonitorSetup>();
  setup->gravity = tool.array.gravity;
  setup->config = tool.array.monitor;
  setup->model = tool.array.datasheet.model();
  setup->array = tool.array.array;
  for (std::size_t i = 0; i < 6; ++i) setup->stability[i] = tool.array.stability[i];
  auto monitor = std::make_unique<HealthMonitor>();
  const Expected<void> made = monitor->configure(*setup);
  EXPECT_TRUE(made.has_value());
  Answer out;
  double time_s = 0.0, held = 0.0;
  for (int station = 0; station < 16; ++station) {
    const Vec3 field = tool.direction();
    for (int k = 0; k < 32; ++k) {
      Sample sample;
      sample.time_s = time_s += 0.02;
      sample.temperature_degc = 25.0;
      sample.delivered = tool.array.array.all();
      sample.station = static_cast<std::uint32_t>(station + 1);
      sample.raw = tool.readings(field);
      const auto a = static_cast<std::size_t>(sensor);
      if (station == 3) held = sample.raw[a];
      if (station >= 4) sample.raw[a] = stuck ? held : sample.raw[a] + fault_nt;
      const Verdict& v = monitor->step(sample);
      if (v.validity < Validity::degraded || !v.protection_available || v.alert) continue;
      ++out.claims;
      out.wrong += angle_rad(v.gravity_mps2, field) > v.protection_level_housing_rad ? 1 : 0;
    }
  }
  out.state = monitor->verdict().state;
  out.excluded = monitor->verdict().excluded;
  return out;
}

// A disturbance within what the array file states stays within the bounds, wherever it points and however strong.
RC_GTEST_PROP(MagneticGroup, AStatedDisturbanceStaysWithinTheBound, ()) {
  const double bound_ut = 0.1 * *rc::gen::inRange(1, 30);
  Tool tool = tool_of(*rc::gen::inRange(4, 7), *rc::gen::inRange(22, 68),
                      static_cast<std::uint64_t>(*rc::gen::inRange(1, 1000000)));
  tool.array.monitor.acceleration_bound_mps2 = io::kInside_per_ut * bound_ut;
  tool.disturbance_ut = scaled(tool.direction(), bound_ut * 0.01 * *rc::gen::inRange(0, 101));
  const Answer answer = watched(tool, 0, 0.0, false);
  RC_ASSERT(answer.excluded.empty());
  RC_ASSERT(answer.wrong == 0);
  if (bound_ut < 0.05 * tool.total_ut) RC_ASSERT(answer.claims > 0);
}

// Four magnetometers in any field: a shifted or stuck one is found and named, nobody else is, and no bound is passed.
RC_GTEST_PROP(MagneticGroup, AFaultyOneOfFourIsFoundAndNamed, ()) {
  const int sensor = *rc::gen::inRange(0, 4);
  const bool stuck = *rc::gen::arbitrary<bool>();
  const double fault_nt = (*rc::gen::arbitrary<bool>() ? 1.0 : -1.0) * *rc::gen::inRange(1500, 20000);
  Tool tool = tool_of(4, *rc::gen::inRange(22, 68), static_cast<std::uint64_t>(*rc::gen::inRange(1, 1000000)));
  const Answer answer = watched(tool, sensor, fault_nt, stuck);
  RC_ASSERT((answer.excluded - SensorSet::of(sensor)).empty());
  RC_ASSERT(answer.excluded.has(sensor));
  RC_ASSERT(answer.state == HealthState::degraded_3_sensor);
  RC_ASSERT(answer.claims > 0);
  RC_ASSERT(answer.wrong == 0);
}

}  // namespace
}  // namespace magnetic_group_test
