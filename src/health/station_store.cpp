#include "plumb/health/detail/station_store.hpp"

#include <cmath>
#include <type_traits>

#include "plumb/core/detail/archive.hpp"
#include "plumb/core/detail/numbers.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

using numbers::at;

static_assert(std::is_trivially_copyable<StationStore>::value, "a copy is an assignment");

namespace {

using archive_detail::bits_of;

}  // namespace

void RawBlock::add(const std::array<double, kCapacity>& raw, SensorSet usable, double temperature_degc) noexcept {
  check_ -= complete_.bits;
  complete_ = size_ == 0 ? usable : complete_ & usable;
  check_ += complete_.bits;
  std::uint32_t left = complete_.bits;
  for (std::size_t a = 0; left != 0 && a < raw.size(); ++a, left >>= 1U) {
    if ((left & 1U) == 0) continue;
    check_ -= bits_of(sum_[a]);
    sum_[a] += raw[a];
    check_ += bits_of(sum_[a]);
  }
  check_ -= bits_of(temperature_sum_);
  temperature_sum_ += temperature_degc;
  check_ += bits_of(temperature_sum_) + 1;
  ++size_;
}

std::uint64_t RawBlock::check() const noexcept {
  std::uint64_t out = complete_.bits + bits_of(temperature_sum_) + static_cast<std::uint64_t>(size_);
  for (const double sum : sum_) out += bits_of(sum);
  return out;
}

StationMean RawBlock::mean(SensorSet of, const Vec3& direction, double samples) const noexcept {
  StationMean out;
  if (size_ == 0) return out;
  for (int i = 0; i < kCapacity; ++i) {
    if ((of & complete_).has(i)) out.raw[at(i)] = sum_[at(i)] / size_;
  }
  out.direction = scaled(direction, 1.0 / norm(direction));
  out.temperature_degc = temperature_sum_ / size_;
  out.samples = samples;
  return out;
}

void StationStore::add_block(const StationMean& block) noexcept {
  const bool same = current_.samples > 0.0 && angle_between_rad(current_.direction, block.direction) <= kPoolAngle_rad;
  if (!same) {
    current_ = block;
    return;
  }
  const double total = current_.samples + block.samples;
  const double share = block.samples / total;
  for (int i = 0; i < kCapacity; ++i) current_.raw[at(i)] += share * (block.raw[at(i)] - current_.raw[at(i)]);
  current_.temperature_degc += share * (block.temperature_degc - current_.temperature_degc);
  current_.samples = total;  // the direction stays that of the first block, else the station could creep
}

void StationStore::end_station() noexcept {
  if (!(current_.samples > 0.0)) return;
  if (waiting_.samples > 0.0) enter(waiting_);
  waiting_ = current_;
  current_.samples = 0.0;
}

void StationStore::drop_last() noexcept { current_.samples = waiting_.samples = 0.0; }

void StationStore::clear() noexcept {
  drop_last();
  size_ = 0;
}

double StationStore::nearest_cosine(const Vec3& direction) const noexcept {
  double nearest = -1.0;
  for (int k = 0; k < size_; ++k) nearest = std::fmax(nearest, dot(direction, station_[at(k)].direction));
  if (current_.samples > 0.0) nearest = std::fmax(nearest, dot(direction, current_.direction));
  if (waiting_.samples > 0.0) nearest = std::fmax(nearest, dot(direction, waiting_.direction));
  return nearest;
}

/// Of one station more than there is room for, the two nearest in direction are one too many. The newcomer stays: it
/// takes the place of its nearest neighbour, or of one of a pair that lies closer together than it does to anyone.
int StationStore::crowded_slot(int nearest, double nearest_cosine) const noexcept {
  int slot = nearest;
  double closest = nearest_cosine;
  for (int i = 0; i < size_; ++i) {
    for (int k = i + 1; k < size_; ++k) {
      const double cosine = dot(station_[at(i)].direction, station_[at(k)].direction);
      if (cosine > closest) {
        closest = cosine;
        slot = i;
      }
    }
  }
  return slot;
}

void StationStore::enter(const StationMean& mean) noexcept {
  int nearest = 0;
  double cosine = -2.0;
  for (int k = 0; k < size_; ++k) {
    const double c = dot(station_[at(k)].direction, mean.direction);
    if (c > cosine) {
      cosine = c;
      nearest = k;
    }
  }
  int slot = nearest;
  const bool known = size_ > 0 && angle_between_rad(station_[at(nearest)].direction, mean.direction) <= same_rad_;
  if (!known) slot = size_ == kMax ? crowded_slot(nearest, cosine) : size_++;
  station_[at(slot)] = mean;
  ++entries_;
}

}  // namespace PLUMB_ABI
}  // namespace plumb
