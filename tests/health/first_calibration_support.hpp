/// A tool that nobody has calibrated: what its datasheet says, and what it is.
#pragma once

#include <algorithm>
#include <memory>
#include <vector>

#include "plumb/calibration/datasheet.hpp"
#include "support/simulated_tool.hpp"

namespace plumb_test {

/// How far the truth lies from the datasheet, of every kind, in prior sigmas: drawn, cut at two.
class UncalibratedTool {
 public:
  using Distort = std::function<double(int sensor, double reading_mps2, int sample)>;

  explicit UncalibratedTool(const plumb::SensorArray& nominal, std::uint64_t seed = 1, double share = 1.0,
                            plumb::MonitorConfig config = {})
      : noise(seed), nominal_(nominal) {
    sheet.size = nominal.size();
    for (int i = 0; i < sheet.size; ++i) {
      plumb::DatasheetSensor& s = sheet.sensor[static_cast<std::size_t>(i)];
      s.row = nominal.row(i);
      s.coefficients.scale[0] = 0.3;  // raw unit per m/s^2
      truth_.push_back(draw(s, share));
    }
    setup.gravity = {plumb::kG0_mps2, 1e-4 * plumb::kG0_mps2, plumb::GravityModel::value};
    setup.config = config;
    EXPECT_TRUE(plumb::set_datasheet(sheet, setup).has_value());
  }
  explicit UncalibratedTool(int n, std::uint64_t seed = 1, double share = 1.0, plumb::MonitorConfig config = {})
      : UncalibratedTool(n == 3   ? orthogonal()
                         : n == 4 ? tetrahedron()
                                  : cone_array(n),
                         seed, share, config) {}
  void start() { ASSERT_TRUE(monitor.configure(setup).has_value()); }

  plumb::Sample sample(const plumb::Vec3& direction) {
    plumb::Sample s;
    s.time_s = time_s += 0.01;
    s.delivered = nominal_.all() - silent;
    s.temperature_degc = temperature_degc;
    for (int i = 0; i < sheet.size; ++i) {
      const Truth& t = truth_[static_cast<std::size_t>(i)];
      const double felt = plumb::dot(t.w, direction) * g_mps2 + t.bias_mps2 + nominal_.sigma_mps2(i) * noise.normal();
      s.raw[static_cast<std::size_t>(i)] = 0.3 * distort(i, felt, samples);
    }
    ++samples;
    return s;
  }
  const plumb::Verdict& step(const plumb::Sample& s) {
    const plumb::Verdict& v = monitor.step(s);
    if (v.transition.sequence != 0) records.push_back(v.transition);
    usable_too_early = usable_too_early || (monitor.calibrated().empty() && shows_output(v));
    return v;
  }
  const plumb::Verdict& stay(const plumb::Vec3& direction, int blocks = 1) {
    for (int k = 0; k < blocks * setup.config.window; ++k) step(sample(direction));
    return monitor.verdict();
  }
  /// Goes where the monitor asks to be taken, until it has a calibration; how many stations that took.
  int follow(int most) {
    int stations = 0;
    for (; stations < most && !calibrated(); ++stations) {
      const plumb::Vec3 wanted = monitor.verdict().recalibration.wanted_direction;
      stay(plumb::norm(wanted) > 0.5 ? wanted : random_direction(noise));
    }
    return stations;
  }
  int roam(int most) {
    int stations = 0;
    for (; stations < most && !calibrated(); ++stations) stay(random_direction(noise));
    return stations;
  }
  /// Two blocks at each: the adoption of a fit began a block in the middle of one, so that one lies across two
  /// attitudes.
  void wander(int stations) {
    for (int k = 0; k < stations; ++k) stay(random_direction(noise), 2);
  }
  bool calibrated() const { return !monitor.calibrated().empty(); }
  plumb::HealthState state() const { return monitor.verdict().state; }
  int count(plumb::HealthEvent event) const {
    return static_cast<int>(std::count_if(records.begin(), records.end(),
                                          [event](const plumb::TransitionRecord& r) { return r.event == event; }));
  }
  static bool shows_output(const plumb::Verdict& v) {
    const bool usable = (v.usable & (plumb::Usable::vector | plumb::Usable::inclination | plumb::Usable::toolface |
                                     plumb::Usable::protection_level | plumb::Usable::calibration)) != 0;
    return v.validity != plumb::Validity::invalid || usable || v.protection_available || !v.alert;
  }

  /// Gravity turned into the frame of the calibrated axes, which is the best fit of all true axes to them: how that
  /// frame sits in the housing no attitude shows.
  plumb::Vec3 in_calibrated_frame(const plumb::Vec3& u) const {
    plumb::Mat3 turn{1, 0, 0, 0, 1, 0, 0, 0, 1};
    for (int round = 0; round < 20; ++round) {  // small turns, each the least squares of what is left
      plumb::Mat3 m{};
      plumb::Vec3 r{};
      for (int i = 0; i < sheet.size; ++i) {
        if (!monitor.calibrated().has(i)) continue;
        const plumb::Vec3 h = monitor.array().axis(i);
        const plumb::Vec3& w = truth_[static_cast<std::size_t>(i)].w;
        const plumb::Vec3 t = plumb::times(turn, plumb::scaled(w, 1.0 / plumb::norm(w)));
        r = plumb::plus(r, plumb::cross(t, h));
        for (std::size_t p = 0; p < 3; ++p) {
          for (std::size_t q = 0; q < 3; ++q) m[3 * p + q] += (p == q ? 1.0 : 0.0) - t[p] * t[q];
        }
      }
      turn = product(small_turn(solve3(m, r)), turn);
    }
    return plumb::times(turn, u);
  }

  struct Truth {
    plumb::Vec3 w{};
    double bias_mps2 = 0.0;
  };
  const Truth& truth(int i) const { return truth_[static_cast<std::size_t>(i)]; }
  Truth& truth(int i) { return truth_[static_cast<std::size_t>(i)]; }

  Noise noise;
  plumb::Datasheet sheet;
  plumb::MonitorSetup setup;
  plumb::HealthMonitor monitor;
  Distort distort = [](int, double reading, int) { return reading; };
  plumb::SensorSet silent;
  double g_mps2 = plumb::kG0_mps2;
  double temperature_degc = 25.0;
  double time_s = 0.0;
  int samples = 0;
  bool usable_too_early = false;
  std::vector<plumb::TransitionRecord> records;

 private:
  static plumb::SensorArray orthogonal() {
    plumb::AxisList axes{};
    return make_array(axes, plumb::orthogonal_triad(axes), 2e-4 * plumb::kG0_mps2);
  }
  double cut_normal() { return std::fmax(-2.0, std::fmin(2.0, noise.normal())); }
  Truth draw(const plumb::DatasheetSensor& s, double share) {
    const plumb::Vec3& h = s.row.axis;
    const plumb::Vec3 across = plumb::cross(h, random_direction(noise));
    const double angle = share * s.prior.axis_rad * cut_normal();
    const plumb::Vec3 axis =
        plumb::plus(plumb::scaled(h, std::cos(angle)), plumb::scaled(across, std::sin(angle) / plumb::norm(across)));
    return {plumb::scaled(axis, 1.0 + share * s.prior.scale * cut_normal()), share * s.prior.bias_mps2 * cut_normal()};
  }
  static plumb::Mat3 product(const plumb::Mat3& a, const plumb::Mat3& b) {
    plumb::Mat3 out{};
    for (std::size_t p = 0; p < 9; ++p) {
      for (std::size_t k = 0; k < 3; ++k) out[p] += a[p / 3 * 3 + k] * b[3 * k + p % 3];
    }
    return out;
  }
  static plumb::Mat3 small_turn(const plumb::Vec3& r) {
    const double angle = plumb::norm(r);
    if (!(angle > 0.0)) return {1, 0, 0, 0, 1, 0, 0, 0, 1};
    const plumb::Vec3 k = plumb::scaled(r, 1.0 / angle);
    const double c = std::cos(angle), s = std::sin(angle);
    return {c + k[0] * k[0] * (1 - c),        k[0] * k[1] * (1 - c) - k[2] * s, k[0] * k[2] * (1 - c) + k[1] * s,
            k[1] * k[0] * (1 - c) + k[2] * s, c + k[1] * k[1] * (1 - c),        k[1] * k[2] * (1 - c) - k[0] * s,
            k[2] * k[0] * (1 - c) - k[1] * s, k[2] * k[1] * (1 - c) + k[0] * s, c + k[2] * k[2] * (1 - c)};
  }
  static plumb::Vec3 solve3(const plumb::Mat3& m, const plumb::Vec3& r) {
    const plumb::Vec3 a = {m[0], m[3], m[6]}, b = {m[1], m[4], m[7]}, c = {m[2], m[5], m[8]};
    const double det = plumb::dot(a, plumb::cross(b, c));
    return {plumb::dot(r, plumb::cross(b, c)) / det, plumb::dot(a, plumb::cross(r, c)) / det,
            plumb::dot(a, plumb::cross(b, r)) / det};
  }

  plumb::SensorArray nominal_;
  std::vector<Truth> truth_;
};

}  // namespace plumb_test
