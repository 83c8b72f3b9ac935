// What one sample costs while the tool moves: the whole monitor of motion, and against it the rival in the same run:
// least squares of all sensors and of all without each one, solved anew per sample with Eigen, which is the plain form
// of solution separation.
#include <benchmark/benchmark.h>

#include <Eigen/Dense>
#include <memory>
#include <vector>

#include "bench_array.hpp"
#include "motion/rigid_motion.hpp"
#include "pairs.hpp"
#include "plumb/motion/motion_monitor.hpp"

namespace {

using namespace plumb;
using plumb_bench::array_of;

/// Built once for 4, once for 8 and once for 16 sensors; each measures the arrays that no smaller build takes.
void sizes_of_this_build(benchmark::internal::Benchmark* b) {
  for (const int n : {4, 6, 8, 12}) {
    if (n <= kCapacity && (n > kCapacity / 2 || kCapacity == 4)) b->Arg(n);
  }
}
constexpr int kMost = kCapacity < 12 ? kCapacity : 12;

/// A healthy flight of 16 s with two gyros, over and over, prepared before the clock starts.
class Flown {
 public:
  explicit Flown(int n) : array_(array_of(n)), setup_(plumb_test::motion_setup(n)) {
    setup_.gyros = 2;
    sound = monitor_.configure(array_, setup_).has_value();
    plumb_test::RigidMotion flight(array_, setup_, 1);
    for (std::uint64_t k = 0; k < (1U << 14); ++k) stream_.push_back(flight.sample(k));
  }
  const MotionVerdict& step() {
    const MotionSample& s = next();
    return monitor_.step(s);
  }
  /// The force by least squares of all, and how far those without one sensor are from it.
  double separation() {
    const MotionSample& s = next();
    const Eigen::Vector3d all = force_without(s, -1);
    double most = 0.0;
    for (int i = 0; i < array_.size(); ++i) most = std::max(most, (force_without(s, i) - all).norm());
    return most;
  }
  bool sound = false;

 private:
  const MotionSample& next() {
    MotionSample& s = stream_[k_];
    s.time_s = static_cast<double>(++count_) * setup_.sample_period_s;
    k_ = k_ + 1 == stream_.size() ? 0 : k_ + 1;
    return s;
  }
  Eigen::Vector3d force_without(const MotionSample& s, int left_out) const {
    Eigen::Matrix<double, Eigen::Dynamic, 3, 0, kMost, 3> h(array_.size() - (left_out < 0 ? 0 : 1), 3);
    Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMost, 1> y(h.rows());
    Eigen::Index row = 0;
    for (int i = 0; i < array_.size(); ++i) {
      if (i == left_out) continue;
      for (Eigen::Index c = 0; c < 3; ++c) h(row, c) = array_.axis(i)[static_cast<std::size_t>(c)];
      y(row++) = s.reading_mps2[static_cast<std::size_t>(i)];
    }
    return h.colPivHouseholderQr().solve(y);
  }

  SensorArray array_;
  MotionSetup setup_;
  MotionMonitor monitor_;
  std::vector<MotionSample> stream_;
  std::size_t k_ = 0;
  std::uint64_t count_ = 0;
};

void BM_MotionStep(benchmark::State& state) {
  const auto flown = std::make_unique<Flown>(static_cast<int>(state.range(0)));
  if (!flown->sound) state.SkipWithError("configuration refused");
  for (auto _ : state) benchmark::DoNotOptimize(flown->step());
  state.SetItemsProcessed(state.iterations());
}
BENCHMARK(BM_MotionStep)->Apply(sizes_of_this_build);

plumb_bench::Contest contest() {
  const auto flown = std::make_shared<Flown>(kMost), rival = std::make_shared<Flown>(kMost);
  if (!flown->sound) return {};
  return {[flown](std::size_t count) {
            for (std::size_t k = 0; k < count; ++k) benchmark::DoNotOptimize(flown->step());
          },
          [rival](std::size_t count) {
            for (std::size_t k = 0; k < count; ++k) benchmark::DoNotOptimize(rival->separation());
          }};
}
const plumb_bench::Enrolled kStep{
    {"step in motion,  " + std::string(kMost < 10 ? " " : "") + std::to_string(kMost) + " sensors",
     "separation by Eigen, anew", 0.0, contest}};

}  // namespace
