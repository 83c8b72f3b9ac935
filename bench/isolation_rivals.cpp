#include "isolation_rivals.hpp"

#include <cmath>

#include "plumb/detection/combination_mae.hpp"
#include "plumb/numeric/tails.hpp"

namespace plumb_bench {
namespace PLUMB_ABI {

using plumb::SensorSet;

namespace {

constexpr double kRate = 1e-6;

std::size_t at(int i) { return static_cast<std::size_t>(i); }

}  // namespace

Rivals::Rivals(const plumb::SensorArray& array, double g_mps2, int stations, int samples_per_station)
    : array_(array),
      gravity_{g_mps2, 0.0, plumb::GravityModel::value},
      limits_(plumb::TestLimits::from_rates(array.size(), kRate, kRate)),
      all_(plumb::least_squares(array, array.all())),
      mae_quantile_(plumb::half_normal_mean_quantile(stations * samples_per_station, kRate / array.triple_count())) {
  chi2_.push_back(0.0);
  for (int k = 1; k <= stations * (array.size() - 2); ++k) chi2_.push_back(plumb::chi2_tail_quantile(kRate, k));
  clear();
}

void Rivals::clear() {
  stations_ = samples_ = 0;
  parity_.assign(std::size_t{1} << static_cast<unsigned>(array_.size()), 0.0);
  norm_ = parity_;
  mae_sum_.assign(at(array_.triple_count()) + 1, 0.0);
  norm_variance_ = mae_sum_;
}

void Rivals::add(const StationSamples& station) {
  ++stations_;
  samples_ += static_cast<int>(station.sample.size());
  for (std::uint32_t bits = 0; bits < parity_.size(); ++bits) {
    const SensorSet set(bits);
    if (set.size() < 3) continue;
    const plumb::SetTest t = plumb::test_set(array_, gravity_, limits_, station.block, set);
    if (!t.tested) continue;
    parity_[bits] += t.parity * t.parity;
    norm_[bits] += t.norm * t.norm;
    if (set == array_.all()) norm_variance_.back() += t.norm_sigma_mps2 * t.norm_sigma_mps2;
  }
  for (int k = 0; k < array_.triple_count(); ++k) {
    const plumb::Triple& triple = array_.triple(k);
    const plumb::SetTest t = plumb::test_set(array_, gravity_, limits_, station.block, triple.set());
    norm_variance_[at(k)] += t.norm_sigma_mps2 * t.norm_sigma_mps2;
    for (const plumb::Readings& y : station.sample) {
      const double square =
          plumb::squared_length(array_.form(k), y[triple.sensors[0]], y[triple.sensors[1]], y[triple.sensors[2]]);
      mae_sum_[at(k)] += std::fabs(std::sqrt(std::fmax(square, 0.0)) - gravity_.g_mps2);
    }
  }
  for (const plumb::Readings& y : station.sample) {
    mae_sum_.back() += std::fabs(plumb::norm(all_.estimate(y)) - gravity_.g_mps2);
  }
}

SensorSet Rivals::answer(Rule rule) const {
  switch (rule) {
    case Rule::paper: return union_of_triples();
    case Rule::glt: return greedy();
    case Rule::leave_out: return leave_out();
    case Rule::best_fit: return best_fit();
    case Rule::strict: break;
  }
  return {};
}

/// The paper's steps 2 to 7: all sensors first; then whoever is in a triple that passes is correct. The limit is the
/// one that noise asks for, not the paper's 0.05 g0, which sees nothing of faults this small.
SensorSet Rivals::union_of_triples() const {
  const auto passes = [&](std::size_t k) {
    return mae_sum_[k] / samples_ < mae_quantile_ * std::sqrt(norm_variance_[k] / stations_);
  };
  if (passes(mae_sum_.size() - 1)) return {};
  SensorSet correct;
  for (int k = 0; k < array_.triple_count(); ++k) {
    if (passes(at(k))) correct = correct | array_.triple(k).set();
  }
  return correct.empty() ? SensorSet{} : array_.all() - correct;
}

/// The generalised likelihood test for one fault after the other; with equal noise it takes out whose leaving lowers
/// the parity residual most.
SensorSet Rivals::greedy() const {
  SensorSet rest = array_.all();
  while (parity_[rest.bits] > limit(stations_ * (rest.size() - 3))) {
    if (rest.size() - 1 < 4) return {};
    SensorSet best;
    for (int i = 0; i < array_.size(); ++i) {
      if (!rest.has(i)) continue;
      const SensorSet without = rest.without(i);
      if (best.empty() || parity_[without.bits] < parity_[best.bits]) best = without;
    }
    rest = best;
  }
  return array_.all() - rest;
}

/// The fewest sensors whose leaving lets parity pass; among as many, those that leave the least residual.
SensorSet Rivals::leave_out() const {
  for (int size = array_.size(); size >= 4; --size) {
    SensorSet best;
    for (SensorSet s = SensorSet::first(size); array_.all().contains(s); s = plumb::next_of_same_size(s)) {
      if (parity_[s.bits] > limit(stations_ * (size - 3))) continue;
      if (best.empty() || parity_[s.bits] < parity_[best.bits]) best = s;
    }
    if (!best.empty()) return array_.all() - best;
  }
  return {};
}

/// The same with the length of gravity as one more equation, down to three sensors.
SensorSet Rivals::best_fit() const {
  const auto misfit = [&](SensorSet s) { return parity_[s.bits] + norm_[s.bits]; };
  for (int size = array_.size(); size >= 3; --size) {
    SensorSet best;
    for (SensorSet s = SensorSet::first(size); array_.all().contains(s); s = plumb::next_of_same_size(s)) {
      if (misfit(s) > limit(stations_ * (size - 2))) continue;
      if (best.empty() || misfit(s) < misfit(best)) best = s;
    }
    if (!best.empty()) return array_.all() - best;
  }
  return {};
}

}  // namespace PLUMB_ABI
}  // namespace plumb_bench
