#include "plumb/paper/paper_rule.hpp"

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

bool may_replace(const PaperFit& fit, const Datasheet& datasheet, double g_mps2, double delta_f_mps2) noexcept {
  const FitOptions bounds;
  if (!fit.sound()) return false;
  for (int i = 0; i < datasheet.size; ++i) {
    if (!fit.used.has(i)) continue;
    const auto a = static_cast<size_t>(i);
    const DatasheetSensor& sheet = datasheet.sensor[a];
    const double scale = fit.model.sensor[a].scale[0] / sheet.coefficients.scale[0];
    const double bias_mps2 = fit.model.sensor[a].bias[0] - sheet.coefficients.bias[0];
    if (!(scale > 0.0) || !(std::fmax(scale, 1.0 / scale) - 1.0 <= bounds.max_scale_change)) return false;
    if (!(std::fabs(bias_mps2) <= bounds.max_bias_sigmas * sheet.prior.bias_mps2)) return false;
  }
  // e_g of eq (7) is 2 G times the error of the length: the root of E_g says what eq (15) would.
  return std::sqrt(fit.cost) / (2.0 * g_mps2) < delta_f_mps2;
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
