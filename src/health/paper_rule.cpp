#include "plumb/health/paper_rule.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

using std::size_t;

namespace {

/// Vector of some of the sensors by the fit of all: eq (3) over everything, eq (5) over those in use.
Vec3 vector_of_some(const SensorArray& nominal, const PaperFit& all, const std::array<double, kCapacity>& raw,
                    double temperature_degc, SensorSet in_use) noexcept {
  const Readings y = all.model.apply(raw, temperature_degc, nominal.all());
  return least_squares(nominal, in_use).estimate(y);
}

}  // namespace

void PaperRule::clear() noexcept {
  all_sum_ = 0;
  triple_sum_.fill(0);
  samples_ = 0;
}

void PaperRule::add(const std::array<double, kCapacity>& raw, double temperature_degc, SensorSet in_use) noexcept {
  double all_error = 0.0;
  bool have_all = false;
  for (int k = 0; k < calibration_->triples; ++k) {
    const PaperFit& fit = calibration_->triple[static_cast<size_t>(k)];
    const double error = norm(paper_vector(*nominal_, fit, raw, temperature_degc)) - g_mps2_;
    triple_sum_[static_cast<size_t>(k)] += to_mae_units(error);
    if (fit.used == in_use) {
      all_error = error;
      have_all = true;
    }
  }
  if (in_use == nominal_->all()) {
    all_error = norm(paper_vector(*nominal_, calibration_->all, raw, temperature_degc)) - g_mps2_;
  } else if (!have_all) {
    all_error = norm(vector_of_some(*nominal_, calibration_->all, raw, temperature_degc, in_use)) - g_mps2_;
  }
  all_sum_ += to_mae_units(all_error);
  ++samples_;
}

PaperFinding PaperRule::finding(SensorSet in_use) const noexcept {
  PaperFinding out;
  out.triples = calibration_->triples;
  if (samples_ == 0) return out;
  const auto mean = [this](std::int64_t sum) { return static_cast<double>(sum) / samples_ * kMaeUnit_mps2; };
  out.mae_all_mps2 = mean(all_sum_);
  out.detected = !(out.mae_all_mps2 < delta_f_mps2_);
  for (int k = 0; k < out.triples; ++k) {
    const auto t = static_cast<size_t>(k);
    out.mae_triple_mps2[t] = mean(triple_sum_[t]);
    const SensorSet members = calibration_->triple[t].used;
    if (!in_use.contains(members) || !(out.mae_triple_mps2[t] < delta_f_mps2_)) continue;
    ++out.passing;
    out.correct = out.correct | members;
  }
  if (out.detected && out.passing > 0) out.isolated = in_use - out.correct;
  return out;
}

}  // namespace PLUMB_ABI
}  // namespace plumb
