// The five z axes of mikoff5, a skewed array on real silicon: healthy figures, and 440 injected faults.
#include <gtest/gtest.h>

#include <cmath>
#include <iostream>
#include <memory>

#include "plumb/calibration/calibration.hpp"
#include "plumb/health/health_monitor.hpp"
#include "plumb/io/array_file.hpp"
#include "plumb/io/log_reader.hpp"
#include "support/recording.hpp"

namespace monitor_recordings_test {
namespace {

using namespace plumb;

struct Mikoff {
  io::ArrayFile file;
  std::vector<Sample> rows;
  Calibration calibration;
};

/// The recording through the tool's own reader and the example array file, calibrated on its 22 rows.
class MikoffZ : public testing::Test {
 protected:
  void SetUp() override {
    PLUMB_RECORDING(recording, "mikoff5_static_means.csv")
    auto file = io::read_array_file(std::string(PLUMB_SOURCE_DIR) + "/examples/mikoff5_z.toml");
    ASSERT_TRUE(file.has_value()) << file.error().text();
    data_ = std::make_unique<Mikoff>(Mikoff{*file, {}, {}});
    auto rows = io::read_log(recording.path, data_->file, io::BadRowPolicy::stop);
    ASSERT_TRUE(rows.has_value()) << rows.error().text();
    data_->rows = rows->samples;
    ASSERT_EQ(data_->rows.size(), 22U);
    std::vector<Station> stations;
    for (const Sample& s : data_->rows) {
      Station station;
      station.mean = s.raw;
      station.delivered = s.delivered;
      station.temperature_degc = s.temperature_degc;
      station.count = s.count;
      stations.push_back(station);
    }
    auto fit = std::make_unique<Expected<Calibration>>(
        calibrate(data_->file.datasheet, data_->file.gravity, stations.data(), static_cast<int>(stations.size())));
    ASSERT_TRUE(fit->has_value()) << describe(fit->error().code);
    data_->calibration = **fit;
  }
  std::unique_ptr<HealthMonitor> monitor() const {
    auto setup = std::make_unique<MonitorSetup>();
    setup->model = data_->calibration.model;
    setup->array = data_->calibration.array;
    setup->gravity = data_->file.gravity;
    setup->config = data_->file.monitor;
    auto out = std::make_unique<HealthMonitor>();
    EXPECT_TRUE(out->configure(*setup).has_value());
    return out;
  }
  std::unique_ptr<Mikoff> data_;
};

TEST_F(MikoffZ, TheNearlyCoplanarTriplesAreFoundAndTheConfirmedGradeIsOne) {
  const auto m = monitor();
  const SensorArray& array = m->array();
  EXPECT_EQ(coplanarity(array, array.all()), 3);
  SensorSet near_singular_triples;
  int count = 0;
  for (int k = 0; k < array.triple_count(); ++k) {
    if (array.triple(k).votes) continue;
    ++count;
    near_singular_triples = near_singular_triples | array.triple(k).set();
    EXPECT_TRUE(array.triple(k).set() == SensorSet(0b10101) || array.triple(k).set() == SensorSet(0b11010));
  }
  EXPECT_EQ(count, 2);
  EXPECT_EQ(near_singular_triples, array.all());
  EXPECT_EQ(m->step(data_->rows[0]).confirmed_grade, 1) << "published with every verdict";
}

TEST_F(MikoffZ, HealthyMaeOfThePyramidAndItsTriples) {
  // Window over all 22 station means: the four pyramid axes together, and each triple of them.
  const SensorArray& array = data_->calibration.array;
  auto mae = std::make_unique<CombinationMae>();
  mae->configure(array.triple_count(), 22);
  const SensorSet pyramid = SensorSet::first(4);
  const LeastSquares map = least_squares(array, pyramid);
  for (const Sample& s : data_->rows) {
    const Readings y = data_->calibration.model.apply(s.raw, s.temperature_degc, s.delivered);
    const Vec3 x = map.estimate(y);
    mae->add(array, y, array.all(), &x, data_->file.gravity.g_mps2);
  }
  const double four_g0 = g0_from_mps2(mae->all_mps2());
  double worst_g0 = 0.0;
  for (int k = 0; k < array.triple_count(); ++k) {
    if (pyramid.contains(array.triple(k).set())) worst_g0 = std::max(worst_g0, g0_from_mps2(mae->triple_mps2(k)));
  }
  std::cout << "mikoff5 z: healthy MAE of the four pyramid axes " << four_g0 << " g0, worst of their triples "
            << worst_g0 << " g0\n";
  EXPECT_LE(four_g0, 0.00025);
  EXPECT_LE(worst_g0, 0.0004);
}

TEST_F(MikoffZ, TheHealthyRecordingNeverAlarms) {
  const auto m = monitor();
  for (const Sample& s : data_->rows) {
    const Verdict& v = m->step(s);
    EXPECT_TRUE(v.cause == Cause::passed_block || v.cause == Cause::power_on)
        << to_string(v.cause) << " at " << v.time_s;
    EXPECT_TRUE((v.excluded | v.provisionally_excluded).empty());
  }
  EXPECT_EQ(m->verdict().state, HealthState::nominal);
}

TEST_F(MikoffZ, EveryStuckAndFrozenAxisIsExcludedWithinEightStationsAndNoHealthyOne) {
  int cases = 0, excluded = 0, wrong = 0, latest = 0;
  double used[4] = {0.0, kG0_mps2, -kG0_mps2, 0.0};
  for (int start = 0; start < 22; ++start) {
    for (int axis = 0; axis < 5; ++axis) {
      for (int kind = 0; kind < 4; ++kind) {
        const auto m = monitor();
        used[3] = data_->rows[static_cast<std::size_t>(start)].raw[static_cast<std::size_t>(axis)];  // frozen
        int when = 0;
        for (int k = 0; k < 8; ++k) {
          Sample s = data_->rows[static_cast<std::size_t>((start + k) % 22)];
          s.time_s = 10.0 * (k + 1);
          s.raw[static_cast<std::size_t>(axis)] = used[kind];
          const Verdict& v = m->step(s);
          const SensorSet blamed = v.excluded | v.provisionally_excluded | v.absent;
          if (!SensorSet::of(axis).contains(blamed)) ++wrong;
          if (when == 0 && v.excluded == SensorSet::of(axis)) when = k + 1;
        }
        ++cases;
        excluded += when > 0 ? 1 : 0;
        latest = std::max(latest, when);
        EXPECT_GT(when, 0) << "start " << start << " axis " << axis << " kind " << kind << " ends "
                           << to_string(m->verdict().state) << ", live " << m->verdict().consistent_hypotheses;
      }
    }
  }
  std::cout << "mikoff5 z: " << excluded << "/" << cases << " faults excluded, the latest at station " << latest
            << "; healthy axes blamed: " << wrong << "\n";
  EXPECT_EQ(cases, 440);
  EXPECT_EQ(excluded, 440);
  EXPECT_EQ(wrong, 0);
}

}  // namespace
}  // namespace monitor_recordings_test
