#include <cmath>

#include "plumb/detection/stationarity.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

using std::size_t;

StationFinder::StationFinder(const SensorArray& array, double g_mps2, const Settings& settings) noexcept
    : array_(array),
      settings_(settings),
      g_mps2_(g_mps2),
      factor_(scatter_factor(array.size(), settings.block, settings.restless_rate)) {}

void StationFinder::merge(const Block& block) noexcept {
  if (!station_.present) {
    station_ = block;
    blocks_ = 1;
    return;
  }
  const auto old_weight = static_cast<double>(station_.count);
  const auto weight = static_cast<double>(block.count);
  const double total = old_weight + weight;
  for (int i = 0; i < array_.size(); ++i) {
    const auto a = static_cast<size_t>(i);
    station_.mean[a] = (station_.mean[a] * old_weight + block.mean[a] * weight) / total;
    station_.variance[a] = (station_.variance[a] * old_weight + block.variance[a] * weight) / total;
  }
  station_.temperature_degc = (station_.temperature_degc * old_weight + block.temperature_degc * weight) / total;
  station_.usable = station_.usable & block.usable;
  station_.count += block.count;
  station_.end_s = block.end_s;
  ++blocks_;
}

bool StationFinder::close(Station& finished) noexcept {
  const bool enough = station_.present && blocks_ >= settings_.min_blocks;
  if (enough) {
    finished = Station{};
    finished.delivered = station_.usable;
    for (int i = 0; i < array_.size(); ++i) {
      const auto a = static_cast<size_t>(i);
      if (!station_.usable.has(i)) continue;
      finished.mean[a] = station_.mean[a];
      finished.scatter[a] = std::sqrt(station_.variance[a] > 0.0 ? station_.variance[a] : 0.0);
    }
    finished.temperature_degc = station_.temperature_degc;
    finished.count = station_.count;
    finished.tag = station_.tag;
    finished.roll_group = station_.roll_group;
    finished.begin_s = station_.begin_s;
    finished.end_s = station_.end_s;
  }
  station_ = Block{};
  waiting_ = Block{};
  blocks_ = 0;
  settling_ = true;
  return enough;
}

bool StationFinder::block_done(Station& finished) noexcept {
  const BlockJudgement judged = judge_block(array_, readings_, array_.all(), factor_, g_mps2_);
  readings_.clear();
  Block block = current_;
  current_ = Block{};
  if (!judged.quiet) return close(finished);
  const LeastSquares ls = least_squares(array_, judged.evidence.usable);
  block.direction = ls.estimate(judged.evidence.mean_mps2);
  block.usable = judged.evidence.usable;
  const auto n = static_cast<double>(block.count);
  for (int i = 0; i < array_.size(); ++i) {
    const auto a = static_cast<size_t>(i);
    const double sum = block.mean[a];
    block.variance[a] = n > 1.0 ? (block.variance[a] - sum * sum / n) / (n - 1.0) : 0.0;
    block.mean[a] = block.origin[a] + sum / n;
  }
  // Against the first block of the station, so that a slow creep cannot carry it along.
  const Block& reference = station_.present ? station_ : waiting_;
  const bool same =
      !reference.present || angle_between_rad(reference.direction, block.direction) <= settings_.station_angle_rad;
  bool written = false;
  if (!same) written = close(finished);
  if (settling_) {
    settling_ = false;
    if (block.tag == 0) return written;  // a tag says where the station begins; without one the first block settles
  }
  if (waiting_.present) merge(waiting_);
  block.present = true;
  waiting_ = block;
  return written;
}

bool StationFinder::add(const Sample& sample, const Readings& y_mps2, SensorSet usable, Station& finished) noexcept {
  bool written = false;
  const bool gap = started_ && (!(sample.time_s > last_s_) || sample.time_s - last_s_ > settings_.max_gap_s);
  const auto other = [&sample](const Block& block) {
    return sample.station != block.tag || sample.roll_group != block.roll_group;
  };
  const bool other_tag = started_ && current_.count > 0 && other(current_);
  const bool other_station = started_ && station_.present && other(station_);
  if (gap || other_tag || other_station) {
    readings_.clear();
    current_ = Block{};
    written = finish(finished);
  }
  if (current_.count == 0) {
    current_.begin_s = sample.time_s;
    current_.tag = sample.station;
    current_.roll_group = sample.roll_group;
    current_.origin = sample.raw;
  }
  readings_.add(y_mps2, usable, sample.count);
  ++current_.count;
  for (int i = 0; i < array_.size(); ++i) {
    const auto a = static_cast<size_t>(i);
    if (!usable.has(i)) continue;
    const double d = sample.raw[a] - current_.origin[a];
    current_.mean[a] += d;
    current_.variance[a] += d * d;
  }
  current_.temperature_degc +=
      (sample.temperature_degc - current_.temperature_degc) / static_cast<double>(current_.count);
  current_.end_s = sample.time_s;
  last_s_ = sample.time_s;
  started_ = true;
  if (readings_.size() < settings_.block) return written;
  // A station that ended by tag and one that ends by motion cannot coincide: the block is fresh then.
  return block_done(finished) || written;
}

bool StationFinder::finish(Station& finished) noexcept {
  // The stream ended or jumped while still at rest: no onset of motion can hide in the last block.
  if (waiting_.present) {
    const Block last = waiting_;
    waiting_ = Block{};
    merge(last);
  }
  return close(finished);
}

}  // namespace PLUMB_ABI
}  // namespace plumb
