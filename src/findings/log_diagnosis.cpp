#include "plumb/findings/log_diagnosis.hpp"

#include <algorithm>
#include <cmath>

#include "plumb/array/geometry.hpp"
#include "plumb/findings/unit_guess.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace findings {
namespace {

constexpr int kBlock = 32;
constexpr std::size_t kMostBlocks = 4096;
/// The tenth with least scatter of the blocks is taken for the tool at rest.
constexpr double kQuietest = 0.1;
/// Scatter within this factor of the declared noise is as declared; the search for stations allows about twice.
constexpr double kNoiseFactor = 1.5;
constexpr double kLengthFactor = 1.2;

constexpr std::size_t at(int i) noexcept { return static_cast<std::size_t>(i); }

double quantile(std::vector<double> values, double share) {
  if (values.empty()) return 0.0;
  const auto k = static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), values.begin() + k, values.end());
  return values[static_cast<std::size_t>(k)];
}

}  // namespace

void LogDiagnosis::add(const Sample& sample, const Readings& y_mps2, SensorSet usable) {
  ++rows_;
  if (length_mps2_.size() >= kMostBlocks) return;
  if (in_block_ == 0) {
    begin_s_ = sample.time_s;
    usable_ = usable;
    origin_ = y_mps2;
    sum_ = {};
    square_ = {};
  }
  usable_ = usable_ & usable;
  for (int i = 0; i < array_->array.size(); ++i) {
    if (!usable_.has(i)) continue;
    const double d = y_mps2[at(i)] - origin_[at(i)];
    sum_[at(i)] += d;
    square_[at(i)] += d * d;
  }
  last_s_ = sample.time_s;
  if (++in_block_ == kBlock) end_block();
}

void LogDiagnosis::end_block() {
  Readings mean{};
  for (int i = 0; i < array_->array.size(); ++i) {
    if (!usable_.has(i)) continue;
    mean[at(i)] = origin_[at(i)] + sum_[at(i)] / kBlock;
    const double variance = (square_[at(i)] - sum_[at(i)] * sum_[at(i)] / kBlock) / (kBlock - 1);
    scatter_mps2_[at(i)].push_back(std::sqrt(std::fmax(variance, 0.0)));
  }
  const LeastSquares map = least_squares(array_->array, usable_);
  if (map.valid) length_mps2_.push_back(norm(map.estimate(mean)));
  step_s_.push_back((last_s_ - begin_s_) / (kBlock - 1));
  in_block_ = 0;
}

void LogDiagnosis::judge_noise(std::vector<Finding>& out) const {
  int worst = -1;
  double most = kNoiseFactor, quietest_mps2 = 0.0;
  int loud = 0;
  for (int i = 0; i < array_->array.size(); ++i) {
    const double quiet_mps2 = quantile(scatter_mps2_[at(i)], kQuietest);
    const double factor = quiet_mps2 / array_->array.sigma_mps2(i);
    if (factor > kNoiseFactor) ++loud;
    if (!(factor > most)) continue;
    most = factor;
    worst = i;
    quietest_mps2 = quiet_mps2;
  }
  if (worst < 0) return;
  out.push_back({FindingCode::noise_at_rest, worst, quietest_mps2, array_->array.sigma_mps2(worst), loud});
}

bool LogDiagnosis::judge_length(std::vector<Finding>& out) const {
  const double factor = quantile(length_mps2_, 0.5) / array_->gravity.g_mps2;
  if (length_mps2_.empty() || (factor > 1.0 / kLengthFactor && factor < kLengthFactor)) return false;
  out.push_back({FindingCode::vector_length_wrong, -1, factor, kLengthFactor});
  return likely_unit(*array_, factor).kind != UnitGuess::Kind::none;
}

void LogDiagnosis::judge_time(std::vector<Finding>& out) const {
  const double step_s = quantile(step_s_, 0.5);
  if (step_s_.empty() || !(step_s > array_->monitor.max_gap_s)) return;
  out.push_back({FindingCode::row_step_beyond_gap, -1, step_s, array_->monitor.max_gap_s});
}

std::vector<Finding> LogDiagnosis::findings() const {
  std::vector<Finding> out;
  if (rows_ < 4 * kBlock) out.push_back({FindingCode::log_too_short, -1, static_cast<double>(rows_), 4 * kBlock});
  const bool other_unit = judge_length(out);
  judge_time(out);
  // In another unit the noise is off by the same factor, and to declare it so would be wrong.
  if (!other_unit) judge_noise(out);
  if (out.empty()) out.push_back({FindingCode::tool_not_at_rest});
  return out;
}

}  // namespace findings
}  // namespace PLUMB_ABI
}  // namespace plumb
