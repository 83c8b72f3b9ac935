#include "plumb/findings/nothing_judged.hpp"

#include <algorithm>
#include <cmath>

namespace plumb {
inline namespace PLUMB_ABI {
namespace findings {
namespace {

/// A vector needs as many.
constexpr int kFewestSensors = 3;

}  // namespace

void NothingJudgedStudent::add(const Sample& sample, bool turning) {
  ++rows_;
  if (turning) ++turning_;
  SensorSet usable;
  for (int i = 0; i < array_->datasheet.size; ++i) {
    const auto a = static_cast<std::size_t>(i);
    const bool number = sample.delivered.has(i) && std::isfinite(sample.raw[a]);
    const double full_scale = array_->datasheet.sensor[a].full_scale_raw;
    if (!number) ++empty_[a];
    if (number) usable = usable.with(i);
    if (number && full_scale > 0.0 && std::fabs(sample.raw[a]) >= full_scale) ++clipped_[a];
  }
  rows_empty_ += usable.empty() ? 1U : 0U;
  rows_lacking_ += usable.size() < array_->datasheet.size ? 1U : 0U;
  run_ = usable.empty() ? 0 : run_ + 1;
  longest_run_ = std::max(longest_run_, run_);
  const SensorModel model = array_->datasheet.model();
  diagnosis_.add(sample, model.apply(sample.raw, sample.temperature_degc, usable), usable);
}

SensorSet NothingJudgedStudent::mostly(const std::array<std::uint64_t, kCapacity>& rows) const {
  SensorSet out;
  for (int i = 0; i < array_->datasheet.size; ++i) {
    if (2 * rows[static_cast<std::size_t>(i)] > rows_) out = out.with(i);
  }
  return out;
}

NothingJudgedStudy NothingJudgedStudent::study() const {
  NothingJudgedStudy out;
  out.rows = rows_;
  out.rows_empty = rows_empty_;
  out.longest_run = longest_run_;
  out.rows_lacking = rows_lacking_;
  const auto found = [&out](NothingJudged cause, SensorSet sensors = SensorSet()) {
    out.cause = cause;
    out.sensors = sensors;
    return out;
  };
  const int n = array_->datasheet.size;
  const SensorSet empty = mostly(empty_), clipped = mostly(clipped_);
  const auto window = static_cast<std::uint64_t>(array_->monitor.window);
  if (n - empty.size() < kFewestSensors) return found(NothingJudged::too_few_sensors, empty);
  if (array_->input.rows == io::RowKind::stations && window > 1) return found(NothingJudged::rows_are_stations);
  if (rows_ < window) return found(NothingJudged::too_short);
  // A row that lacks some sensor is left out of its block; a sensor that never speaks is not waited for.
  const bool all_speak = empty.empty() && rows_ - rows_lacking_ < window;
  if (longest_run_ < window || all_speak) return found(NothingJudged::rows_without_numbers);
  if (array_->lever_arm_m.empty() && 2 * turning_ > rows_) return found(NothingJudged::unknown_rotation);
  if (n - (empty | clipped).size() < kFewestSensors) return found(NothingJudged::full_scale, clipped);
  out.log = diagnosis_.findings();
  return out;
}

}  // namespace findings
}  // namespace PLUMB_ABI
}  // namespace plumb
