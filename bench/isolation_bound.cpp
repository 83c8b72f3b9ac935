// What any rule could do that blames nobody: how often the readings tell every wrong explanation from the truth.
#include <cmath>
#include <vector>

#include "isolation_runs.hpp"
#include "plumb/array/geometry.hpp"
#include "plumb/array/mirror.hpp"
#include "plumb/numeric/tails.hpp"
#include "support/isolation_trials.hpp"

namespace plumb_bench {
namespace PLUMB_ABI {

using namespace plumb_test;
using plumb::Readings;
using plumb::SensorSet;
using plumb::Vec3;

namespace {

/// Block means at one station, and what they would be without noise.
struct Seen {
  Readings mean{}, exact{};
};

/// The best test of a wrong explanation knows what the faulty sensors read: the likelihood ratio, normal with the
/// mean `separation` (noise of 1) where the explanation is wrong, and with 0 where it holds.
class BestTest {
 public:
  void add(double exact, double seen, double sigma) {
    square_ += exact * exact / (sigma * sigma);
    along_ += exact * seen / (sigma * sigma);
  }
  bool rejects(double limit) const { return square_ > 0.0 && along_ > limit * std::sqrt(square_); }

 private:
  double square_ = 0.0, along_ = 0.0;
};

std::vector<Seen> stations_of(const TrialTool& tool, TrialEpisode& episode, int count, TrialNoise& noise) {
  std::vector<Seen> out(static_cast<std::size_t>(count));
  for (Seen& s : out) {
    s.exact = episode.readings(plumb::scaled(noise.direction(), tool.gravity.g_mps2), noise);
    s.mean = s.exact;
    for (int i = 0; i < tool.array.size(); ++i)
      s.mean[slot(i)] += tool.array.sigma_mps2(i) / std::sqrt(kTrialSamples) * noise.normal();
  }
  return out;
}

/// All but three may be faulty in any way, gravity is as stated within three sigmas, the same at all stations:
/// the length that the three show is all that speaks.
bool triple_rejected(const TrialTool& tool, int triple, const std::vector<Seen>& seen, double limit) {
  const plumb::Mat3 map = plumb::triple_map(tool.array, triple);
  const auto& members = tool.array.triple(triple).sensors;
  const auto vector_of = [&](const Readings& y) {
    return plumb::times(map, {y[members[0]], y[members[1]], y[members[2]]});
  };
  struct Length {
    double exact, seen, sigma;
  };
  std::vector<Length> off;
  double weight = 0.0, sum = 0.0;
  for (const Seen& s : seen) {
    const Vec3 x = vector_of(s.exact);
    const double length = plumb::norm(x);
    double variance = 0.0;
    for (std::size_t m = 0; m < 3; ++m) {
      const Vec3 column = {map[m], map[3 + m], map[6 + m]};
      const double along = plumb::dot(column, x) / length * tool.array.sigma_mps2(members[m]);
      variance += along * along / kTrialSamples;
    }
    const double g = tool.gravity.g_mps2;
    off.push_back({length - g, plumb::norm(vector_of(s.mean)) - g, std::sqrt(variance)});
    weight += 1.0 / variance;
    sum += off.back().exact / variance;
  }
  // The error of gravity that makes the explanation look best.
  const double most = 3.0 * tool.gravity.sigma_mps2;
  const double error = std::fmin(std::fmax(sum / weight, -most), most);
  BestTest test;
  for (const Length& l : off) test.add(l.exact - error, l.seen - error, l.sigma);
  return test.rejects(limit);
}

/// The same where the tool may be accelerated, anew at every station: only what the sensors of the set say about one
/// another speaks.
bool parity_rejected(const TrialTool& tool, SensorSet set, const std::vector<Seen>& seen, double limit) {
  const plumb::LeastSquares ls = plumb::least_squares(tool.array, set);
  BestTest test;
  for (const Seen& s : seen) {
    const Vec3 exact = ls.estimate(s.exact), mean = ls.estimate(s.mean);
    for (int i = 0; i < tool.array.size(); ++i) {
      if (!set.has(i)) continue;
      const Vec3& h = tool.array.axis(i);
      test.add(s.exact[slot(i)] - plumb::dot(h, exact), s.mean[slot(i)] - plumb::dot(h, mean),
               tool.array.sigma_mps2(i) / std::sqrt(kTrialSamples));
    }
  }
  return test.rejects(limit);
}

/// True where every set of `size` sensors with a faulty one among them is rejected by parity.
bool all_rejected_by_parity(const TrialTool& tool, SensorSet faulty, int size, const std::vector<Seen>& seen,
                            double limit) {
  const SensorSet all = tool.array.all();
  for (SensorSet s = SensorSet::first(size); all.contains(s); s = plumb::next_of_same_size(s)) {
    if (!(s & faulty).empty() && !parity_rejected(tool, s, seen, limit)) return false;
  }
  return true;
}

}  // namespace

BoundCount best_possible(const RatesJob& job, double rate) {
  constexpr int kStations = 8;
  const double limit = plumb::normal_tail_quantile(rate);
  TrialNoise noise(job.seed);
  const TrialTool tool = exact_tool(job.n);
  BoundCount out;
  for (std::uint64_t t = 0; t < job.trials; ++t) {
    TrialEpisode episode(tool, job.faults, FaultLaw::bias, job.least * kTrialSigma_mps2, job.most * kTrialSigma_mps2,
                         noise);
    const std::vector<Seen> seen = stations_of(tool, episode, kStations, noise);
    const SensorSet faulty = episode.faulty();
    bool told = true;
    for (int k = 0; k < tool.array.triple_count() && told; ++k) {
      const bool wrong = !(tool.array.triple(k).set() & faulty).empty();
      told = !wrong || triple_rejected(tool, k, seen, limit);
    }
    ++out.trials;
    if (told) ++out.told;
    if (told && all_rejected_by_parity(tool, faulty, job.n - 1, seen, limit)) ++out.told_moving;
    const std::vector<Seen> first(seen.begin(), seen.begin() + 1);
    if (job.n > 4 && all_rejected_by_parity(tool, faulty, 4, first, limit)) ++out.told_by_parity;
  }
  return out;
}

}  // namespace PLUMB_ABI
}  // namespace plumb_bench
