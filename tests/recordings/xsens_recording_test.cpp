// The whole Xsens recording, motion included: plumb finds the static stretches itself and fits the triad.
#include <gtest/gtest.h>

#include <cmath>
#include <iostream>
#include <memory>

#include "plumb/calibration/calibration.hpp"
#include "plumb/detection/stationarity.hpp"
#include "plumb/io/array_file.hpp"
#include "plumb/io/log_reader.hpp"
#include "support/recording.hpp"

namespace xsens_recording_test {
namespace {

using namespace plumb;

std::vector<Station> stations_of(const io::ArrayFile& file, const std::vector<Sample>& samples) {
  StationFinder::Settings settings;
  settings.block = file.monitor.window;
  auto finder = std::make_unique<StationFinder>(file.array, file.gravity.g_mps2, settings);
  const SensorModel model = file.datasheet.model();
  std::vector<Station> out;
  Station station;
  for (const Sample& s : samples) {
    if (finder->add(s, model.apply(s.raw, s.temperature_degc, s.delivered), s.delivered, station))
      out.push_back(station);
  }
  if (finder->finish(station)) out.push_back(station);
  return out;
}

double norm_error_g0(const Calibration& calibration, const GravityReference& gravity, const Station& station) {
  return g0_from_mps2(station_residual(calibration, gravity, station).norm_error_mps2);
}

TEST(XsensRecording, StaticStretchesFoundByPlumbCalibrateTheTriad) {
  PLUMB_RECORDING(factory, "imutk_xsens_factory.csv")
  const auto file = io::read_array_file(std::string(PLUMB_SOURCE_DIR) + "/examples/xsens.toml");
  ASSERT_TRUE(file.has_value()) << file.error().text();
  const auto log = io::read_log(plumb_test::recording_path("imutk_xsens_full.csv"), *file, io::BadRowPolicy::stop);
  ASSERT_TRUE(log.has_value()) << log.error().text();
  const std::vector<Station> stations = stations_of(*file, log->samples);
  ASSERT_GE(stations.size(), 30U);

  const auto fit = calibrate(file->datasheet, file->gravity, stations.data(), static_cast<int>(stations.size()));
  ASSERT_TRUE(fit.has_value()) << describe(fit.error().code);
  double square = 0.0, left_out = 0.0;
  for (std::size_t k = 0; k < stations.size(); ++k) {
    const double e = norm_error_g0(*fit, file->gravity, stations[k]);
    square += e * e;
    std::vector<Station> others = stations;
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(k));
    const auto without = calibrate(file->datasheet, file->gravity, others.data(), static_cast<int>(others.size()));
    ASSERT_TRUE(without.has_value());
    const double h = norm_error_g0(*without, file->gravity, stations[k]);
    left_out += h * h;
  }
  const double n = static_cast<double>(stations.size());
  const double rms_g0 = std::sqrt(square / n), left_out_g0 = std::sqrt(left_out / n);
  std::cout << "[ measured ] " << stations.size() << " stations, rms " << rms_g0 << " g0, leave-one-out " << left_out_g0
            << " g0\n";
  EXPECT_LE(rms_g0, 0.11e-3);
  EXPECT_LE(left_out_g0, 0.16e-3);

  for (int i = 0; i < 3; ++i) {
    const char axis[] = {"xyz"[i], '\0'};
    const double scale = fit->model.sensor[static_cast<std::size_t>(i)].scale[0];          // counts per m/s^2
    const double offset = fit->model.sensor[static_cast<std::size_t>(i)].bias[0] * scale;  // counts
    const double certified_scale = factory.at(0, axis), certified_offset = factory.at(1, axis);
    std::cout << "[ measured ] " << axis << ": offset " << offset << " counts (certificate " << certified_offset
              << "), scale " << scale << " (certificate " << certified_scale << ")\n";
    EXPECT_NEAR(offset, certified_offset, 5.0);
    EXPECT_NEAR(scale / certified_scale, 1.0, 0.0025);
  }
}

}  // namespace
}  // namespace xsens_recording_test
