/// A simulated tool under a PaperMonitor: true sensors, calibrated from stations as `plumb calibrate` would.
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "paper/paper_support.hpp"
#include "plumb/paper/paper_monitor.hpp"

namespace paper_test {

using calibration_test::Noise;

inline constexpr double kSigma_mps2 = 2e-4 * plumb::kG0_mps2;

inline plumb::Datasheet sheet_of(int n) {
  if (n == 4) return calibration_test::paper_tool(kSigma_mps2);
  plumb::AxisList axes{};
  EXPECT_EQ(plumb::cone(axes, n), n);
  return calibration_test::datasheet_of(axes, n, kSigma_mps2);
}

/// Unit vector at inclination and toolface in deg.
inline plumb::Vec3 direction_at(double inclination_deg, double toolface_deg) {
  return plumb::scaled(calibration_test::rolled(inclination_deg, toolface_deg), 1.0 / plumb::kG0_mps2);
}

class PaperRig {
 public:
  /// What sensor i reads [m/s^2] instead of `reading_mps2`.
  using Distort = std::function<double(int sensor, double reading_mps2)>;

  explicit PaperRig(int n, int isolation_stations = 4, std::uint64_t seed = 1)
      : PaperRig(sheet_of(n), isolation_stations, seed) {}
  PaperRig(const plumb::Datasheet& datasheet, int isolation_stations, std::uint64_t seed)
      : setup(std::make_unique<plumb::PaperSetup>()),
        monitor(std::make_unique<plumb::PaperMonitor>()),
        sheet(datasheet),
        noise_(seed) {
    distort = [](int, double reading) { return reading; };
    truth_ = calibration_test::draw_truth(sheet, noise_);
    const auto stations = calibration_test::random_stations(sheet, truth_, 48, noise_, kSigma_mps2 / 10.0);
    const auto count = static_cast<int>(stations.size());
    const plumb::GravityReference gravity = calibration_test::standard_gravity();
    const auto fit = plumb::calibrate(sheet, gravity, stations.data(), count);
    EXPECT_TRUE(fit.has_value());
    EXPECT_TRUE(plumb::paper_calibrate_all(sheet, gravity, stations.data(), count, {}, setup->paper).has_value());
    if (fit) {
      setup->base.model = fit->model;
      setup->base.array = fit->array;
    }
    setup->base.gravity = gravity;
    setup->base.config.mode = plumb::MonitorMode::paper;
    setup->base.config.isolation_stations = isolation_stations;
    setup->datasheet = sheet;
    restart();
  }
  void restart() {
    const auto configured = monitor->configure(*setup);
    ASSERT_TRUE(configured.has_value()) << plumb::describe(configured.error().code);
  }

  plumb::Sample sample(const plumb::Vec3& direction) {
    plumb::Readings r{};
    for (int i = 0; i < sheet.size; ++i) {
      const double reading = plumb::dot(truth_.w[at(i)], plumb::scaled(direction, plumb::kG0_mps2)) + truth_.b[at(i)];
      r[at(i)] = distort(i, reading + kSigma_mps2 * noise_.normal());
    }
    plumb::Readings finite = r;
    for (double& v : finite) v = std::isfinite(v) ? v : 0.0;
    plumb::Sample s;
    s.raw = raw_of(sheet, finite);
    for (std::size_t i = 0; i < r.size(); ++i) s.raw[i] = std::isfinite(r[i]) ? s.raw[i] : r[i];
    s.time_s = time_s_ += 0.01;
    s.delivered = plumb::SensorSet::first(sheet.size);
    s.temperature_degc = 25.0;
    return s;
  }
  const plumb::Verdict& step(const plumb::Sample& s) {
    const plumb::Verdict& v = monitor->step(s);
    if (v.transition.sequence != 0) records.push_back(v.transition);
    ever_excluded = ever_excluded | v.excluded;
    return v;
  }
  const plumb::Verdict& stay(const plumb::Vec3& direction, int blocks = 1) {
    for (int k = 0; k < blocks * setup->base.config.window; ++k) step(sample(direction));
    return monitor->verdict();
  }
  /// One block at each of `count` attitudes far from each other.
  const plumb::Verdict& tour(int count) {
    for (int k = 0; k < count; ++k, ++toured_) stay(direction_at(25.0 + 37.0 * (toured_ % 4), 67.0 * toured_));
    return monitor->verdict();
  }
  const plumb::Verdict& prove() { return tour(4); }
  /// From now on the sensor's output stands at `volt`.
  void stick(int sensor, double reading_mps2) {
    distort = [sensor, reading_mps2, before = distort](int i, double reading) {
      return i == sensor ? reading_mps2 : before(i, reading);
    };
  }
  std::vector<plumb::HealthState> states() const {
    std::vector<plumb::HealthState> out;
    for (const plumb::TransitionRecord& r : records) out.push_back(r.to);
    return out;
  }

  std::unique_ptr<plumb::PaperSetup> setup;
  std::unique_ptr<plumb::PaperMonitor> monitor;
  plumb::Datasheet sheet;
  Distort distort;
  std::vector<plumb::TransitionRecord> records;
  plumb::SensorSet ever_excluded;

 private:
  Noise noise_;
  calibration_test::Truth truth_;
  double time_s_ = 0.0;
  int toured_ = 0;
};

}  // namespace paper_test
