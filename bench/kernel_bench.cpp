// The kernel: the length of gravity from every triple, and its exact window, for one sample; against the systems solved
// anew per triple and sample with Eigen, by LU and by the inverse.
#include <benchmark/benchmark.h>

#include <Eigen/Dense>
#include <cmath>
#include <memory>
#include <random>
#include <vector>

#include "bench_array.hpp"
#include "pairs.hpp"
#include "plumb/detection/combination_mae.hpp"
#ifdef PLUMB_BENCH_HIGHWAY
#include "lanes_highway.hpp"
#endif

namespace {

using namespace plumb;

constexpr std::size_t kSamples = 1 << 10;  // a power of two: finding one costs nothing

std::vector<Readings> stream_of(const SensorArray& array) {
  std::mt19937_64 engine(1);
  std::normal_distribution<double> noise;
  std::vector<Readings> out(kSamples);
  for (Readings& y : out) {
    for (int i = 0; i < array.size(); ++i)
      y[static_cast<std::size_t>(i)] = array.axis(i)[2] * kG0_mps2 + array.sigma_mps2(i) * noise(engine);
  }
  return out;
}

/// The kernel with its array, its window and readings.
struct Kernel {
  SensorArray array = plumb_bench::array_of(kCapacity);
  std::vector<Readings> stream = stream_of(array);
  CombinationMae mae;
  Kernel() { mae.configure(array.triple_count(), 32); }
  void add(std::size_t k) { mae.add(array, stream[k % kSamples], array.all(), nullptr, kG0_mps2); }
  /// What every processor can, though this one may do more at a time.
  void add_portable(std::size_t k) {
    mae.add(array, stream[k % kSamples], array.all(), nullptr, kG0_mps2, kPortableLanes);
  }
};

void BM_Kernel(benchmark::State& state) {
  const auto kernel = std::make_unique<Kernel>();
  std::size_t k = 0;
  for (auto _ : state) {
    kernel->add(k++);
    benchmark::ClobberMemory();
  }
  state.counters["ns_per_triple"] =
      benchmark::Counter(static_cast<double>(kernel->array.triple_count()) * 1e-9,
                         benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}
BENCHMARK(BM_Kernel)->Arg(kCapacity);

template <class Solve>
double by_eigen(const SensorArray& array, const Readings& readings, Solve solve) {
  double sum = 0.0;
  for (int t = 0; t < array.triple_count(); ++t) {
    Eigen::Matrix3d h;
    Eigen::Vector3d y;
    for (int r = 0; r < 3; ++r) {
      const int i = array.triple(t).sensors[static_cast<std::size_t>(r)];
      for (int c = 0; c < 3; ++c) h(r, c) = array.axis(i)[static_cast<std::size_t>(c)];
      y(r) = readings[static_cast<std::size_t>(i)];
    }
    sum += std::fabs(solve(h, y).norm() - kG0_mps2);
  }
  return sum;
}

template <class Solve>
void per_triple(benchmark::State& state, Solve solve) {
  const auto kernel = std::make_unique<Kernel>();
  std::size_t k = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(by_eigen(kernel->array, kernel->stream[k], solve));
    k = (k + 1) % kSamples;
  }
}

Eigen::Vector3d by_lu(const Eigen::Matrix3d& h, const Eigen::Vector3d& y) {
  return Eigen::PartialPivLU<Eigen::Matrix3d>(h).solve(y);
}
Eigen::Vector3d by_inverse(const Eigen::Matrix3d& h, const Eigen::Vector3d& y) { return h.inverse() * y; }

void BM_KernelByEigenLU(benchmark::State& state) {
  per_triple(state, [](const Eigen::Matrix3d& h, const Eigen::Vector3d& y) { return by_lu(h, y); });
}
BENCHMARK(BM_KernelByEigenLU)->Arg(kCapacity);

void BM_KernelByEigenInverse(benchmark::State& state) {
  per_triple(state, [](const Eigen::Matrix3d& h, const Eigen::Vector3d& y) { return by_inverse(h, y); });
}
BENCHMARK(BM_KernelByEigenInverse)->Arg(kCapacity);

template <auto Add, class Solve>
plumb_bench::Contest contest(Solve solve) {
  const auto kernel = std::make_shared<Kernel>();
  return {[kernel](std::size_t count) {
            for (std::size_t k = 0; k < count; ++k) {
              (kernel.get()->*Add)(k);
              benchmark::ClobberMemory();
            }
          },
          [kernel, solve](std::size_t count) {
            for (std::size_t k = 0; k < count; ++k)
              benchmark::DoNotOptimize(by_eigen(kernel->array, kernel->stream[k % kSamples], solve));
          }};
}

std::string work(const char* lanes) {
  return "kernel: all triples and window, " + std::string(kCapacity < 10 ? " " : "") + std::to_string(kCapacity) +
         " sensors, " + lanes;
}
constexpr double bar(double of_4, double of_8, double of_16) {
  return kCapacity == 4 ? of_4 : kCapacity == 8 ? of_8 : of_16;
}
const char* widest() {
  return most_lanes() == Lanes::eight ? "AVX-512" : most_lanes() == Lanes::four ? "AVX2" : "no vectors beyond portable";
}
const plumb_bench::Enrolled kLu{
    {work(widest()), "Eigen LU of every triple", bar(40.0, 140.0, 130.0), [] { return contest<&Kernel::add>(by_lu); }}};
const plumb_bench::Enrolled kLuPortable{{work("portable"), "Eigen LU of every triple", bar(18.0, 50.0, 60.0),
                                         [] { return contest<&Kernel::add_portable>(by_lu); }}};
const plumb_bench::Enrolled kInverse{{work("portable"), "Eigen inverse of every triple", 2.5,
                                      [] { return contest<&Kernel::add_portable>(by_inverse); }}};

#ifdef PLUMB_BENCH_HIGHWAY
/// The kernel's lanes alone: a ring of rows, and readings of which some are no numbers on request.
class Rows {
 public:
  explicit Rows(bool odd = false)
      : stream_(stream_of(array_)),
        triples_(static_cast<std::size_t>(array_.triple_count())),
        ring_(kRows * triples_, 7),
        sums_(triples_, 7 * kRows) {
    const double strange[] = {std::nan(""), HUGE_VAL, -HUGE_VAL, 1e300, 5e-324, -0.0, 1e3};
    for (std::size_t k = 0; odd && k < kSamples; k += 3) stream_[k][k % kCapacity] = strange[k % 7];
  }
  template <class Replace>
  void add(Replace replace, std::size_t k) {
    const TripleRange all = {0, array_.triple_count()};
    replace(array_, stream_[k % kSamples].data(), kG0_mps2, &ring_[k % kRows * triples_], sums_.data(), all);
    benchmark::ClobberMemory();
  }
  bool same_as(const Rows& other) const { return ring_ == other.ring_ && sums_ == other.sums_; }

 private:
  static constexpr std::size_t kRows = 32;
  SensorArray array_ = plumb_bench::array_of(kCapacity);
  std::vector<Readings> stream_;
  std::size_t triples_;
  std::vector<std::int32_t> ring_;
  std::vector<std::int64_t> sums_;
};

int by_lanes(const SensorArray& array, const double* y_mps2, double g_mps2, std::int32_t* slots, std::int64_t* sums,
             TripleRange range) {
  return replace_side_by_side(array, y_mps2, g_mps2, slots, sums, range, most_lanes());
}

/// Empty, and the table is not printed, where the two do not give the same bits.
plumb_bench::Contest against_highway() {
  Rows ours(true), theirs(true);
  for (std::size_t k = 0; k < 2 * kSamples; ++k) {
    ours.add(by_lanes, k);
    theirs.add(plumb_bench::replace_by_highway, k);
  }
  if (!ours.same_as(theirs)) return {};
  const auto rows = std::make_shared<Rows>();
  return {[rows](std::size_t count) {
            for (std::size_t k = 0; k < count; ++k) rows->add(by_lanes, k);
          },
          [rows](std::size_t count) {
            for (std::size_t k = 0; k < count; ++k) rows->add(plumb_bench::replace_by_highway, k);
          }};
}
const plumb_bench::Enrolled kHighway{
    {work(widest()) + ", lanes alone", "Highway, dynamic dispatch", 0.0, against_highway}};
#endif

}  // namespace
