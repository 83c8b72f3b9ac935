#include "plumb/health/paper_rule.hpp"

#include <cmath>

namespace plumb {
inline namespace PLUMB_ABI {

using std::size_t;

void PaperMae::add(double error_mps2) noexcept {
  sum += to_mae_units(error_mps2);
  ++samples;
}

double PaperMae::mps2() const noexcept {
  return samples > 0 ? static_cast<double>(sum) / samples * kMaeUnit_mps2 : 0.0;
}

const PaperFit* PaperFits::own(SensorSet in_use) const noexcept {
  if (in_use == calibration.all.used && calibration.all.sound()) return &calibration.all;
  if (in_use == rest.used && rest.sound()) return &rest;
  if (in_use.size() != 3) return nullptr;
  for (int k = 0; k < calibration.triples; ++k) {
    const PaperFit& fit = calibration.triple[static_cast<size_t>(k)];
    if (fit.used == in_use) return fit.sound() ? &fit : nullptr;
  }
  return nullptr;
}

Vec3 paper_vector_in_use(const PaperFits& fits, const std::array<double, kCapacity>& raw, double temperature_degc,
                         SensorSet in_use) noexcept {
  const PaperFit* own = fits.own(in_use);
  const PaperFit& fit = own != nullptr ? *own : fits.calibration.all;
  return paper_vector(fits.nominal, fit, raw, temperature_degc, in_use);
}

void PaperRule::add(const PaperFits& fits, double g_mps2, const std::array<double, kCapacity>& raw,
                    double temperature_degc, SensorSet in_use) noexcept {
  all_.add(norm(paper_vector_in_use(fits, raw, temperature_degc, in_use)) - g_mps2);
  for (int k = 0; k < fits.calibration.triples; ++k) {
    const PaperFit& fit = fits.calibration.triple[static_cast<size_t>(k)];
    if (!in_use.contains(fit.used) || !fit.sound()) continue;
    triple_[static_cast<size_t>(k)].add(norm(paper_vector(fits.nominal, fit, raw, temperature_degc)) - g_mps2);
  }
}

PaperFinding PaperRule::finding(const PaperFits& fits, double delta_f_mps2, SensorSet in_use) const noexcept {
  PaperFinding out;
  if (samples() == 0) return out;
  out.mae_all_mps2 = all_.mps2();
  out.detected = !(out.mae_all_mps2 < delta_f_mps2);
  for (int k = 0; k < fits.calibration.triples; ++k) {
    const auto t = static_cast<size_t>(k);
    const PaperFit& fit = fits.calibration.triple[t];
    if (!in_use.contains(fit.used) || triple_[t].samples == 0) continue;
    ++out.triples;
    const double mae = out.mae_triple_mps2[t] = triple_[t].mps2();
    out.worst_mps2 = std::fmax(out.worst_mps2, mae);
    if (!(mae < delta_f_mps2)) continue;
    ++out.passing;
    out.correct = out.correct | fit.used;
  }
  if (out.detected && out.passing > 0) out.isolated = in_use - out.correct;
  return out;
}

}  // namespace PLUMB_ABI
}  // namespace plumb
