// What one sample costs: the whole monitor, and against it the rival in the same run: the inverse of
// every triple recomputed per sample with Eigen, which is what a straightforward reading of the paper does.
#include <benchmark/benchmark.h>

#include <Eigen/Dense>
#include <memory>
#include <random>
#include <vector>

#include "bench_array.hpp"
#include "pairs.hpp"
#include "plumb/health/health_monitor.hpp"
#include "px4_voter.hpp"

namespace {

using namespace plumb;
using plumb_bench::array_of;

/// Built once for 4, once for 8 and once for 16 sensors; each measures the arrays that no smaller build takes.
void sizes_of_this_build(benchmark::internal::Benchmark* b) {
  for (const int n : {4, 6, 8, 16}) {
    if (n <= kCapacity && (n > kCapacity / 2 || kCapacity == 4)) b->Arg(n);
  }
}

/// A quiet tool that changes attitude every 32 samples, prepared before the clock starts.
std::vector<Sample> quiet_stream(const SensorArray& array, int samples) {
  std::mt19937_64 engine(1);
  std::normal_distribution<double> noise;
  std::vector<Sample> out(static_cast<std::size_t>(samples));
  for (int k = 0; k < samples; ++k) {
    const double a = 0.7 * (k / 32), b = 0.3 * (k / 32);
    const Vec3 g = {std::sin(a) * std::cos(b) * kG0_mps2, std::sin(a) * std::sin(b) * kG0_mps2, std::cos(a) * kG0_mps2};
    Sample& s = out[static_cast<std::size_t>(k)];
    s.time_s = 0.01 * (k + 1);
    s.delivered = array.all();
    for (int i = 0; i < array.size(); ++i) {
      s.raw[static_cast<std::size_t>(i)] = dot(array.axis(i), g) + array.sigma_mps2(i) * noise(engine);
    }
  }
  return out;
}

/// A monitor and the stream that it watches, over and over.
class Watched {
 public:
  explicit Watched(int n) {
    MonitorSetup setup;
    setup.array = array_of(n);
    setup.model.size = n;
    setup.gravity = {kG0_mps2, 1e-3, GravityModel::value};
    sound = monitor_.configure(setup).has_value();
    stream_ = quiet_stream(setup.array, 1 << 14);
  }
  void step() {
    Sample s = stream_[k_];
    s.time_s += offset_s_;
    benchmark::DoNotOptimize(monitor_.step(s));
    if (++k_ < stream_.size()) return;
    k_ = 0;
    offset_s_ += 0.01 * static_cast<double>(stream_.size());
  }
  bool sound = false;

 private:
  HealthMonitor monitor_;
  std::vector<Sample> stream_;
  std::size_t k_ = 0;
  double offset_s_ = 0.0;
};

void BM_MonitorStep(benchmark::State& state) {
  const auto watched = std::make_unique<Watched>(static_cast<int>(state.range(0)));
  if (!watched->sound) state.SkipWithError("configuration refused");
  for (auto _ : state) watched->step();
  state.SetItemsProcessed(state.iterations());
}
BENCHMARK(BM_MonitorStep)->Apply(sizes_of_this_build);

double by_eigen(const SensorArray& array, const Sample& s) {
  double sum = 0.0;
  for (int t = 0; t < array.triple_count(); ++t) {
    Eigen::Matrix3d h;
    Eigen::Vector3d y;
    for (int r = 0; r < 3; ++r) {
      const int i = array.triple(t).sensors[static_cast<std::size_t>(r)];
      for (int c = 0; c < 3; ++c) h(r, c) = array.axis(i)[static_cast<std::size_t>(c)];
      y(r) = s.raw[static_cast<std::size_t>(i)];
    }
    sum += std::fabs((h.inverse() * y).norm() - kG0_mps2);
  }
  return sum;
}

void BM_EigenInversePerTriple(benchmark::State& state) {
  const SensorArray array = array_of(static_cast<int>(state.range(0)));
  const std::vector<Sample> stream = quiet_stream(array, 1 << 12);
  std::size_t k = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(by_eigen(array, stream[k]));
    k = k + 1 == stream.size() ? 0 : k + 1;
  }
  state.SetItemsProcessed(state.iterations());
}
BENCHMARK(BM_EigenInversePerTriple)->Apply(sizes_of_this_build);

plumb_bench::Contest contest() {
  const auto watched = std::make_shared<Watched>(kCapacity);
  if (!watched->sound) return {};
  const auto array = std::make_shared<SensorArray>(array_of(kCapacity));
  const auto stream = std::make_shared<std::vector<Sample>>(quiet_stream(*array, 1 << 12));
  return {[watched](std::size_t count) {
            for (std::size_t k = 0; k < count; ++k) watched->step();
          },
          [array, stream](std::size_t count) {
            for (std::size_t k = 0; k < count; ++k)
              benchmark::DoNotOptimize(by_eigen(*array, (*stream)[k % stream->size()]));
          }};
}
const plumb_bench::Enrolled kStep{
    {"step in nominal, " + std::string(kCapacity < 10 ? " " : "") + std::to_string(kCapacity) + " sensors",
     "Eigen inverse of every triple",
     kCapacity == 4   ? 1.0 / 2.0
     : kCapacity == 8 ? 1.0 / 0.6
                      : 0.0,
     contest}};

/// One of so many sensors as one unit of three axes: what both are asked in a sample, and what each says, differs.
plumb_bench::Contest contest_with_px4() {
  const auto watched = std::make_shared<Watched>(kCapacity);
  if (!watched->sound) return {};
  const std::vector<Sample> stream = quiet_stream(array_of(kCapacity), 1 << 12);
  const auto readings = std::make_shared<std::vector<plumb_bench::Px4Reading>>();
  for (const Sample& s : stream) {
    for (std::size_t i = 0; i < static_cast<std::size_t>(kCapacity); ++i) {
      const auto y = static_cast<float>(s.raw[i]);
      readings->push_back({{y, 0.5F * y, 0.25F * y}, 0});
    }
  }
  const auto units = std::make_shared<plumb_bench::Px4Units>(static_cast<std::size_t>(kCapacity));
  const auto time_us = std::make_shared<std::uint64_t>(0);
  return {[watched](std::size_t count) {
            for (std::size_t k = 0; k < count; ++k) watched->step();
          },
          [readings, units, time_us](std::size_t count) {
            const std::size_t rows = readings->size() / static_cast<std::size_t>(kCapacity);
            for (std::size_t k = 0; k < count; ++k) {
              *time_us += 1000;
              const auto* const row = readings->data() + (k % rows) * static_cast<std::size_t>(kCapacity);
              benchmark::DoNotOptimize(units->step(*time_us, row));
            }
          }};
}
const plumb_bench::Enrolled kStepBesidePx4{
    {"step in nominal, " + std::string(kCapacity < 10 ? " " : "") + std::to_string(kCapacity) + " sensors",
     "PX4's voter, " + std::to_string(kCapacity) + " units of three axes", 0.0, contest_with_px4}};

}  // namespace
