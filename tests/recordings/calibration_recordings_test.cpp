/// The fit on public recordings: what it must reach on real silicon, and what it did reach.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <string>
#include <vector>

#include "plumb/calibration/calibration.hpp"
#include "plumb/core/units.hpp"
#include "support/recording.hpp"

namespace calibration_recordings_test {
namespace {

using plumb::Vec3;
using plumb_test::Recording;

std::size_t at(int i) { return static_cast<std::size_t>(i); }

void tell(const std::string& name, double value) {
  testing::Test::RecordProperty(name, std::to_string(value));
  std::cout << "[ measured ] " << name << " = " << value << '\n';
}

double root_mean_square(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double v : values) sum += v * v;
  return std::sqrt(sum / static_cast<double>(values.size()));
}

plumb::GravityReference gravity_of(double g_mps2) { return {g_mps2, 0.0, plumb::GravityModel::value}; }

struct Channel {
  std::string column;
  Vec3 axis;
};

plumb::Datasheet datasheet_of(const std::vector<Channel>& channels, double scale, double bias_mps2, double sigma_mps2,
                              const plumb::Prior& prior) {
  plumb::Datasheet d;
  d.size = static_cast<int>(channels.size());
  d.reads = plumb::Reads::specific_force;
  for (std::size_t i = 0; i < channels.size(); ++i) {
    plumb::DatasheetSensor& s = d.sensor[i];
    s.row.id = plumb::make_id(channels[i].column.c_str());
    s.row.axis = plumb::scaled(channels[i].axis, 1.0 / plumb::norm(channels[i].axis));
    s.row.sigma_mps2 = sigma_mps2;
    s.coefficients.scale[0] = scale;
    s.coefficients.bias[0] = bias_mps2;
    s.prior = prior;
  }
  return d;
}

plumb::Station station_of(const Recording& recording, std::size_t row, const std::vector<Channel>& channels,
                          double count) {
  plumb::Station s;
  for (std::size_t i = 0; i < channels.size(); ++i) s.mean[i] = recording.at(row, channels[i].column);
  s.delivered = plumb::SensorSet::first(static_cast<int>(channels.size()));
  s.temperature_degc = 25.0;
  s.count = static_cast<std::uint32_t>(count);
  return s;
}

plumb::Expected<plumb::Calibration> fit(const plumb::Datasheet& d, double g_mps2,
                                        const std::vector<plumb::Station>& stations,
                                        plumb::FitReport* report = nullptr) {
  return plumb::calibrate(d, gravity_of(g_mps2), stations.data(), static_cast<int>(stations.size()), {}, report);
}

// ------------------------------------------------------------------------------------------ mikoff5

constexpr double kMikoffG = 9.81;

/// Nominal axes: the best rotation between the raw triads, in the frame of triad 4, three decimals.
const std::vector<Channel>& mikoff_channels() {
  static const std::vector<Channel> channels = {
      {"a0x_mps2", {-0.017, -0.509, -0.860}}, {"a0y_mps2", {1.000, -0.005, -0.017}},
      {"a0z_mps2", {0.004, -0.861, 0.509}},   {"a1x_mps2", {0.510, 0.006, 0.860}},
      {"a1y_mps2", {0.009, 1.000, -0.012}},   {"a1z_mps2", {-0.860, 0.014, 0.510}},
      {"a2x_mps2", {-0.014, 0.485, -0.874}},  {"a2y_mps2", {-1.000, 0.007, 0.020}},
      {"a2z_mps2", {0.015, 0.874, 0.485}},    {"a3x_mps2", {-0.483, -0.009, 0.875}},
      {"a3y_mps2", {0.010, -1.000, -0.004}},  {"a3z_mps2", {0.875, 0.006, 0.483}},
      {"a4x_mps2", {1.0, 0.0, 0.0}},          {"a4y_mps2", {0.0, 1.0, 0.0}},
      {"a4z_mps2", {0.0, 0.0, 1.0}}};
  return channels;
}

const plumb::Prior kMikoffPrior = {0.2, 0.01, plumb::rad_from_deg(1.0)};
constexpr double kMikoffNoise = 0.065;

std::vector<plumb::Station> mikoff_stations(const Recording& means, const std::vector<Channel>& channels) {
  std::vector<plumb::Station> out;
  for (std::size_t k = 0; k < means.rows.size(); ++k) out.push_back(station_of(means, k, channels, means.at(k, "n")));
  return out;
}

/// a = M u + b of one triad with M upper triangular, in the units of the published table.
struct TriadForm {
  Vec3 scale_pct{};
  double yz_deg = 0.0, xy_deg = 0.0, xz_deg = 0.0;
  Vec3 bias_mps2{};
};

/// The rows W of a triad are M R with R a rotation: M by orthogonalising from the last row up.
TriadForm triad_form(const plumb::Calibration& c, int first) {
  std::array<Vec3, 3> w{};
  TriadForm out;
  for (int p = 0; p < 3; ++p) {
    const plumb::SensorCoefficients& s = c.model.sensor[at(first + p)];
    w[at(p)] = plumb::scaled(c.array.axis(first + p), s.scale[0]);  // the nominal scale is 1
    out.bias_mps2[at(p)] = s.scale[0] * s.bias[0];
  }
  const double zz = plumb::norm(w[2]);
  const Vec3 z = plumb::scaled(w[2], 1.0 / zz);
  const double yz = plumb::dot(w[1], z);
  const Vec3 y_rest = plumb::minus(w[1], plumb::scaled(z, yz));
  const double yy = plumb::norm(y_rest);
  const Vec3 y = plumb::scaled(y_rest, 1.0 / yy);
  const double xz = plumb::dot(w[0], z), xy = plumb::dot(w[0], y);
  const double xx = plumb::norm(plumb::minus(w[0], plumb::plus(plumb::scaled(z, xz), plumb::scaled(y, xy))));
  out.scale_pct = {100.0 * (xx - 1.0), 100.0 * (yy - 1.0), 100.0 * (zz - 1.0)};
  out.yz_deg = plumb::deg_from_rad(yz);
  out.xy_deg = plumb::deg_from_rad(xy);
  out.xz_deg = plumb::deg_from_rad(xz);
  return out;
}

struct WorstDifference {
  double scale_pct = 0.0;
  double angle_deg = 0.0;
  double bias_mps2 = 0.0;

  void take(const TriadForm& form, const Recording& published, std::size_t triad) {
    const auto differs = [&](double& worst, double value, const char* column) {
      worst = std::fmax(worst, std::fabs(value - published.at(triad, column)));
    };
    differs(scale_pct, form.scale_pct[0], "sx_pct");
    differs(scale_pct, form.scale_pct[1], "sy_pct");
    differs(scale_pct, form.scale_pct[2], "sz_pct");
    differs(angle_deg, form.yz_deg, "m_yz_deg");
    differs(angle_deg, form.xy_deg, "m_xy_deg");
    differs(angle_deg, form.xz_deg, "m_xz_deg");
    differs(bias_mps2, form.bias_mps2[0], "bx_mps2");
    differs(bias_mps2, form.bias_mps2[1], "by_mps2");
    differs(bias_mps2, form.bias_mps2[2], "bz_mps2");
  }
};

TEST(MikoffRecording, JointFitOfFifteenAxesAgreesWithThePublishedTable) {
  PLUMB_RECORDING(means, "mikoff5_static_means.csv");
  PLUMB_RECORDING(published, "mikoff5_published.csv");
  const plumb::Datasheet d = datasheet_of(mikoff_channels(), 1.0, 0.0, kMikoffNoise, kMikoffPrior);
  plumb::FitReport report;
  const auto c = fit(d, kMikoffG, mikoff_stations(means, mikoff_channels()), &report);
  ASSERT_TRUE(c.has_value()) << plumb::describe(c.error().code) << " " << c.error().value;
  EXPECT_EQ(report.rank, 57);
  EXPECT_EQ(report.gauge, 3);
  EXPECT_EQ(report.stations, 22);
  WorstDifference worst;
  for (int triad = 0; triad < 5; ++triad) worst.take(triad_form(*c, 3 * triad), published, at(triad));
  EXPECT_LE(worst.scale_pct, 0.02);
  EXPECT_LE(worst.angle_deg, 0.03);
  EXPECT_LE(worst.bias_mps2, 3e-3);
  tell("joint_scale_difference_pct", worst.scale_pct);
  tell("joint_angle_difference_deg", worst.angle_deg);
  tell("joint_bias_difference_mps2", worst.bias_mps2);
  std::vector<double> rms(report.residual_rms_mps2.begin(), report.residual_rms_mps2.begin() + 15);
  tell("joint_residual_rms_mps2", root_mean_square(rms));
  tell("joint_norm_rms_mps2", report.norm_rms_mps2);
  tell("joint_parity_rms_mps2", report.parity_rms_mps2);
  tell("joint_misfit_mps2", report.misfit_mps2);
  tell("joint_condition", report.condition);
  tell("joint_iterations", report.iterations);
}

TEST(MikoffRecording, NormOnlyFitOfEveryTriadAgreesWithThePublishedTable) {
  PLUMB_RECORDING(means, "mikoff5_static_means.csv");
  PLUMB_RECORDING(published, "mikoff5_published.csv");
  WorstDifference worst;
  std::vector<double> norms;
  for (int triad = 0; triad < 5; ++triad) {
    std::vector<Channel> channels(mikoff_channels().begin() + 3 * triad, mikoff_channels().begin() + 3 * triad + 3);
    const Vec3 unit[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    for (int p = 0; p < 3; ++p) channels[at(p)].axis = unit[p];
    plumb::FitReport report;
    const auto c = fit(datasheet_of(channels, 1.0, 0.0, kMikoffNoise, kMikoffPrior), kMikoffG,
                       mikoff_stations(means, channels), &report);
    ASSERT_TRUE(c.has_value()) << triad << ": " << plumb::describe(c.error().code);
    EXPECT_EQ(report.rank, 9);
    worst.take(triad_form(*c, 0), published, at(triad));
    norms.push_back(report.norm_rms_mps2);
  }
  EXPECT_LE(worst.angle_deg, 0.02);
  EXPECT_LE(worst.scale_pct, 0.02);
  EXPECT_LE(worst.bias_mps2, 3e-3);
  tell("triad_scale_difference_pct", worst.scale_pct);
  tell("triad_angle_difference_deg", worst.angle_deg);
  tell("triad_bias_difference_mps2", worst.bias_mps2);
  tell("triad_norm_rms_mps2", root_mean_square(norms));
}

TEST(MikoffRecording, FiveSkewedZAxesCalibrateAlone) {
  PLUMB_RECORDING(means, "mikoff5_static_means.csv");
  std::vector<Channel> z;
  for (std::size_t triad = 0; triad < 5; ++triad) z.push_back(mikoff_channels()[3 * triad + 2]);
  plumb::FitReport report;
  const auto c =
      fit(datasheet_of(z, 1.0, 0.0, kMikoffNoise, kMikoffPrior), kMikoffG, mikoff_stations(means, z), &report);
  ASSERT_TRUE(c.has_value()) << plumb::describe(c.error().code);
  EXPECT_EQ(report.rank, 17);
  EXPECT_LE(report.norm_rms_mps2, 0.006);
  tell("z_norm_rms_mps2", report.norm_rms_mps2);
  tell("z_parity_rms_mps2", report.parity_rms_mps2);
  tell("z_misfit_mps2", report.misfit_mps2);
  tell("z_e_cal_mps2", *std::max_element(report.e_cal_mps2.begin(), report.e_cal_mps2.end()));
}

// ------------------------------------------------------------------------------------------ Xsens

constexpr double kXsensG = 9.81744;

const std::vector<Channel>& xsens_channels() {
  static const std::vector<Channel> channels = {{"ax_cnt", {1, 0, 0}}, {"ay_cnt", {0, 1, 0}}, {"az_cnt", {0, 0, 1}}};
  return channels;
}

/// Nominal 415 counts per m/s^2 about 32768; one code short of a percent in scale, 150 mg in offset.
plumb::Datasheet xsens_datasheet() {
  return datasheet_of(xsens_channels(), 415.0, 32768.0 / 415.0, 0.008, {1.5, 0.01, plumb::rad_from_deg(1.5)});
}

TEST(XsensRecording, NormOnlyFitReachesTheNoiseAndTheFactoryCertificate) {
  PLUMB_RECORDING(means, "imutk_xsens_static_means.csv");
  PLUMB_RECORDING(factory, "imutk_xsens_factory.csv");
  std::vector<plumb::Station> stations;
  for (std::size_t k = 0; k < means.rows.size(); ++k) {
    stations.push_back(station_of(means, k, xsens_channels(), means.at(k, "i1") - means.at(k, "i0")));
  }
  const plumb::Datasheet d = xsens_datasheet();
  plumb::FitReport report;
  const auto c = fit(d, kXsensG, stations, &report);
  ASSERT_TRUE(c.has_value()) << plumb::describe(c.error().code) << " " << c.error().value;
  const double rms_mg = 1e3 * plumb::g0_from_mps2(report.norm_rms_mps2);
  EXPECT_LE(rms_mg, 0.11);
  std::vector<double> left_out;
  for (std::size_t k = 0; k < stations.size(); ++k) {
    std::vector<plumb::Station> others = stations;
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(k));
    const auto without = fit(d, kXsensG, others);
    ASSERT_TRUE(without.has_value());
    left_out.push_back(plumb::station_residual(*without, gravity_of(kXsensG), stations[k]).norm_error_mps2);
  }
  const double left_out_mg = 1e3 * plumb::g0_from_mps2(root_mean_square(left_out));
  EXPECT_LE(left_out_mg, 0.16);
  double offset_counts = 0.0, scale_pct = 0.0;
  const std::string axes = "xyz";
  for (int i = 0; i < 3; ++i) {
    const plumb::SensorCoefficients& s = c->model.sensor[at(i)];
    const std::string axis(1, axes[at(i)]);
    tell("offset_" + axis + "_counts", s.scale[0] * s.bias[0]);
    tell("scale_" + axis + "_counts_per_mps2", s.scale[0]);
    offset_counts = std::fmax(offset_counts, std::fabs(s.scale[0] * s.bias[0] - factory.at(1, axis)));
    scale_pct = std::fmax(scale_pct, 100.0 * std::fabs(s.scale[0] / factory.at(0, axis) - 1.0));
  }
  EXPECT_LE(offset_counts, 5.0);
  EXPECT_LE(scale_pct, 0.25);
  tell("norm_rms_mg", rms_mg);
  tell("leave_one_out_mg", left_out_mg);
  tell("factory_offset_difference_counts", offset_counts);
  tell("factory_scale_difference_pct", scale_pct);
  tell("misfit_mg", 1e3 * plumb::g0_from_mps2(report.misfit_mps2));
}

// ------------------------------------------------------------------------------------------ carlsson

std::vector<Channel> carlsson_channels() {
  std::vector<Channel> out;
  for (int triad = 0; triad < 8; ++triad) {
    const bool back = triad % 2 == 1;
    const std::string name = "a" + std::to_string(triad);
    out.push_back({name + "x_cnt", back ? Vec3{0, -1, 0} : Vec3{1, 0, 0}});
    out.push_back({name + "y_cnt", back ? Vec3{-1, 0, 0} : Vec3{0, 1, 0}});
    out.push_back({name + "z_cnt", back ? Vec3{0, 0, -1} : Vec3{0, 0, 1}});
  }
  return out;
}

std::vector<plumb::Station> carlsson_stations(const Recording& means, int run) {
  std::vector<plumb::Station> out;
  for (std::size_t k = 0; k < means.rows.size(); ++k) {
    if (static_cast<int>(means.at(k, "exp")) == run)
      out.push_back(station_of(means, k, carlsson_channels(), means.at(k, "n")));
  }
  return out;
}

plumb::Datasheet carlsson_datasheet() {
  return datasheet_of(carlsson_channels(), 2048.0 / plumb::kG0_mps2, 0.0, 0.04, {0.3, 0.02, plumb::rad_from_deg(1.0)});
}

TEST(CarlssonRecording, TwentyFourAxesFitJointlyInRunsTwoToFour) {
  PLUMB_RECORDING(means, "carlsson_static_means.csv");
  std::vector<double> all;
  for (int run = 2; run <= 4; ++run) {
    plumb::FitReport report;
    const auto c = fit(carlsson_datasheet(), plumb::kG0_mps2, carlsson_stations(means, run), &report);
    ASSERT_TRUE(c.has_value()) << "run " << run << ": " << plumb::describe(c.error().code) << " " << c.error().value;
    EXPECT_EQ(report.rank, 93);
    EXPECT_EQ(report.stations, 20);
    const std::vector<double> rms(report.residual_rms_mps2.begin(), report.residual_rms_mps2.begin() + 24);
    tell("run" + std::to_string(run) + "_residual_rms_mps2", root_mean_square(rms));
    tell("run" + std::to_string(run) + "_worst_axis_rms_mps2", *std::max_element(rms.begin(), rms.end()));
    tell("run" + std::to_string(run) + "_misfit_mps2", report.misfit_mps2);
    all.insert(all.end(), rms.begin(), rms.end());
  }
  EXPECT_LE(root_mean_square(all), 1.5e-3);
  tell("runs2to4_residual_rms_mps2", root_mean_square(all));
}

TEST(CarlssonRecording, TheWanderingAxisOfRunOneIsRefusedByNameAndStandsOut) {
  PLUMB_RECORDING(means, "carlsson_static_means.csv");
  constexpr int kWandering = 3 * 3 + 2;
  const std::vector<plumb::Station> stations = carlsson_stations(means, 1);
  const auto refused = fit(carlsson_datasheet(), plumb::kG0_mps2, stations);
  ASSERT_FALSE(refused.has_value());
  EXPECT_EQ(refused.error(), (plumb::Error{plumb::Errc::poor_fit, kWandering, 0.0, 0.0}));
  EXPECT_GE(refused.error().value, 4.0);
  plumb::FitOptions lenient;
  lenient.max_sensor_excess = 10.0;
  plumb::FitReport report;
  const auto c = plumb::calibrate(carlsson_datasheet(), gravity_of(plumb::kG0_mps2), stations.data(),
                                  static_cast<int>(stations.size()), lenient, &report);
  ASSERT_TRUE(c.has_value()) << plumb::describe(c.error().code) << " " << c.error().value;
  double others = 0.0;
  for (int i = 0; i < 24; ++i) {
    if (i != kWandering) others = std::fmax(others, report.residual_rms_mps2[at(i)]);
  }
  EXPECT_GE(report.residual_rms_mps2[at(kWandering)], 2.0 * others);
  tell("run1_a3z_rms_mps2", report.residual_rms_mps2[at(kWandering)]);
  tell("run1_next_axis_rms_mps2", others);
  tell("run1_ratio", report.residual_rms_mps2[at(kWandering)] / others);
}

}  // namespace
}  // namespace calibration_recordings_test
