#include "plumb/review/log_digest.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace plumb {
inline namespace PLUMB_ABI {
namespace review {
namespace {

constexpr std::size_t kMostParameters = 1024;
constexpr std::size_t kMostNotes = 256;
constexpr std::size_t kMostStatuses = 64;
/// A change of velocity over a time, in 32-bit numbers each, comes back to a few parts in ten million.
constexpr double kSameReading = 1.0e-6;
/// A block index beyond this is no time of a log: it would not fit into a double without loss.
constexpr double kFurthestBlock = 4.0e15;

bool finite(const Axes& axes) noexcept {
  return std::all_of(axes.begin(), axes.end(), [](double x) { return std::isfinite(x); });
}

bool starts_with(const std::string& text, const char* beginning) { return text.rfind(beginning, 0) == 0; }

/// One record as a block of its own.
SourceBlock block_of(const logs::ImuRecord& record) noexcept {
  SourceBlock out;
  out.records = 1;
  const bool spread = record.count > 1 && finite(record.variance_m2ps4);
  out.weight = spread ? static_cast<double>(record.count) : 1.0;
  out.mean_mps2 = out.least_mps2 = out.most_mps2 = record.specific_force_mps2;
  for (std::size_t k = 0; k < 3; ++k) {
    if (spread) out.squares_m2ps4[k] = std::max(record.variance_m2ps4[k], 0.0) * (out.weight - 1.0);
    out.clipped[k] = record.clipped[k];
  }
  if (finite(record.rate_radps)) {
    out.rates = 1;
    out.rate_radps = record.rate_radps;
    for (const double w : record.rate_radps) out.rate_squares += w * w;
  }
  if (std::isfinite(record.temperature_degc)) {
    out.temperatures = 1;
    out.temperature_degc = record.temperature_degc;
  }
  return out;
}

}  // namespace

double SourceBlock::deviation_mps2(std::size_t axis) const noexcept {
  return weight > 1.0 ? std::sqrt(squares_m2ps4[axis] / (weight - 1.0)) : 0.0;
}

// Means and squares are joined as by Chan, Golub and LeVeque (1979).
void SourceBlock::add(const SourceBlock& other) noexcept {
  if (other.records == 0) return;
  if (records == 0) {
    const std::int64_t kept = index;
    *this = other;
    index = kept;
    return;
  }
  const double sum = weight + other.weight;
  for (std::size_t k = 0; k < 3; ++k) {
    const double step = other.mean_mps2[k] - mean_mps2[k];
    mean_mps2[k] += step * (other.weight / sum);
    squares_m2ps4[k] += other.squares_m2ps4[k] + step * step * (weight * other.weight / sum);
    least_mps2[k] = std::min(least_mps2[k], other.least_mps2[k]);
    most_mps2[k] = std::max(most_mps2[k], other.most_mps2[k]);
    clipped[k] += other.clipped[k];
  }
  weight = sum;
  records += other.records;
  rates += other.rates;
  if (other.rates > 0) {
    const double share = static_cast<double>(other.rates) / rates;
    for (std::size_t k = 0; k < 3; ++k) rate_radps[k] += share * (other.rate_radps[k] - rate_radps[k]);
    rate_squares += share * (other.rate_squares - rate_squares);
  }
  temperatures += other.temperatures;
  if (other.temperatures > 0)
    temperature_degc += (other.temperature_degc - temperature_degc) * other.temperatures / temperatures;
}

void Intervals::add(double interval_s) noexcept {
  if (!(interval_s > 0.0)) return;
  const double place = (std::log2(interval_s) - kLeast) * kPerOctave;
  const double last = static_cast<double>(bins_.size() - 1);
  Bin& bin = bins_[static_cast<std::size_t>(std::clamp(place, 0.0, last))];
  ++bin.count;
  bin.sum_s += interval_s;
  ++count_;
}

double Intervals::usual_s() const noexcept {
  std::uint64_t below = 0;
  for (const Bin& bin : bins_) {
    below += bin.count;
    if (2 * below > count_) return bin.sum_s / static_cast<double>(bin.count);
  }
  return logs::kAbsent;
}

Intervals::Gaps Intervals::gaps(double times) const noexcept {
  Gaps out;
  const double usual = usual_s();
  for (const Bin& bin : bins_) {
    if (bin.count == 0 || !(bin.sum_s > times * usual * static_cast<double>(bin.count))) continue;
    out.count += bin.count;
    out.lost_s += bin.sum_s - usual * static_cast<double>(bin.count);
  }
  return out;
}

void LogDigester::source(std::size_t number, const logs::ImuSource& source) {
  if (number >= digest_.sources.size()) {
    digest_.sources.resize(number + 1);
    readings_.resize(number + 1);
  }
  digest_.sources[number].source = source;
}

void LogDigester::double_blocks() {
  digest_.block_s *= 2.0;
  for (Reading& reading : readings_) {
    std::map<std::int64_t, SourceBlock> out;
    for (const auto& [index, block] : reading.blocks) {
      const std::int64_t wider = index >= 0 ? index / 2 : (index - 1) / 2;
      SourceBlock& into = out.try_emplace(out.end(), wider)->second;
      into.index = wider;
      into.add(block);
    }
    reading.blocks = std::move(out);
  }
  for (StatusDigest& status : digest_.statuses) {
    std::map<std::int64_t, double> out;
    for (const auto& [index, apart] : status.apart_mps2) {
      const auto into = out.try_emplace(index >= 0 ? index / 2 : (index - 1) / 2, apart).first;
      into->second = std::min(into->second, apart);
    }
    status.apart_mps2 = std::move(out);
  }
}

void LogDigester::follow_still(const logs::ImuRecord& record, Reading& reading, SourceDigest& digest) {
  const Axes& f = record.specific_force_mps2;
  std::array<bool, 4> same{};
  for (std::size_t k = 0; k < 3; ++k)
    same[k] = std::abs(f[k] - reading.still_at_mps2[k]) <= kSameReading * std::max(1.0, std::abs(f[k]));
  same[3] = same[0] && same[1] && same[2];
  for (std::size_t k = 0; k < 4; ++k) {
    StillRun& run = reading.still[k];
    if (!same[k]) run = {0, record.time_s, record.time_s, f[k % 3]};
    ++run.records;
    run.to_s = record.time_s;
    if (run.records > digest.longest_still[k].records) digest.longest_still[k] = run;
  }
  for (std::size_t k = 0; k < 3; ++k) {
    if (!same[k]) reading.still_at_mps2[k] = f[k];
  }
}

void LogDigester::record(std::size_t number, const logs::ImuRecord& record) {
  if (number >= digest_.sources.size()) return;
  SourceDigest& digest = digest_.sources[number];
  const bool timed = std::abs(record.time_s) < kFurthestBlock * digest_.block_s;  // false for NaN
  if (!timed || !finite(record.specific_force_mps2)) {
    ++digest.unreadable;
    return;
  }
  Reading& reading = readings_[number];
  const double interval_s = record.time_s - reading.last_s;
  if (interval_s < 0.0) ++digest.backwards;
  digest.intervals.add(interval_s);
  if (interval_s > digest.longest_gap_s) {
    digest.longest_gap_s = interval_s;
    digest.longest_gap_at_s = reading.last_s;
  }
  reading.last_s = record.time_s;
  follow_still(record, reading, digest);
  digest.first_s = std::fmin(digest.first_s, record.time_s);
  digest.last_s = std::fmax(digest.last_s, record.time_s);
  ++digest.records;
  const auto index = static_cast<std::int64_t>(std::floor(record.time_s / digest_.block_s));
  SourceBlock& block = reading.blocks.try_emplace(reading.blocks.end(), index)->second;
  block.index = index;
  block.add(block_of(record));
  while (reading.blocks.size() > most_blocks_) double_blocks();
}

/// One report alone is a touchdown: the least of three in a row counts.
void LogDigester::follow_vibration(const logs::ChipStatus& status, Saying& now, StatusDigest& digest) {
  const Axes& here = status.vibration_mps2;
  if (!finite(here)) return;
  for (std::size_t k = 0; k < 3; ++k) {
    const double lasting = std::min({here[k], now.last_vibration_mps2[0][k], now.last_vibration_mps2[1][k]});
    if (!(lasting > digest.vibration_mps2)) continue;
    digest.vibration_mps2 = lasting;
    digest.vibration_at_s = status.time_s;
    digest.vibration_axis = static_cast<int>(k);
  }
  now.last_vibration_mps2 = {here, now.last_vibration_mps2[0]};
}

void LogDigester::status(const logs::ChipStatus& status) {
  if (!(std::abs(status.time_s) < kFurthestBlock * digest_.block_s)) return;
  auto found = std::find_if(digest_.statuses.begin(), digest_.statuses.end(), [&](const StatusDigest& one) {
    return one.device_id == status.device_id && (one.device_id != 0 || one.instance == status.instance);
  });
  if (found == digest_.statuses.end()) {
    if (digest_.statuses.size() == kMostStatuses) return;
    found = digest_.statuses.insert(digest_.statuses.end(), StatusDigest{});
    found->device_id = status.device_id;
    found->instance = status.instance;
    sayings_.emplace_back();
  }
  Saying& now = sayings_[static_cast<std::size_t>(found - digest_.statuses.begin())];
  follow_vibration(status, now, *found);
  if (status.health == logs::ChipStatus::Health::failed) {
    if (now.failed.records == 0) now.failed.from_s = status.time_s;
    ++now.failed.records;
    now.failed.to_s = status.time_s;
    if (now.failed.records > found->failed.records) found->failed = now.failed;
  } else if (status.health == logs::ChipStatus::Health::sound) {
    now.failed.records = 0;
  }
  if (!std::isfinite(status.inconsistency_mps2)) return;
  const auto index = static_cast<std::int64_t>(std::floor(status.time_s / digest_.block_s));
  const auto apart = found->apart_mps2.try_emplace(index, status.inconsistency_mps2).first;
  apart->second = std::min(apart->second, status.inconsistency_mps2);
  while (found->apart_mps2.size() > most_blocks_) double_blocks();
}

void LogDigester::parameter(const std::string& name, double value) {
  const bool wanted = starts_with(name, "CAL_ACC") || starts_with(name, "INS_ACC") || starts_with(name, "INS_USE") ||
                      starts_with(name, "TC_A");
  if (!wanted) return;
  if (!std::isfinite(value)) {
    note(0, "the parameter " + name + " is no number and is left out");
    return;
  }
  const auto found = digest_.parameters.find(name);
  if (found == digest_.parameters.end()) {
    if (digest_.parameters.size() < kMostParameters) digest_.parameters[name] = value;
  } else if (std::abs(found->second - value) > 0.0) {
    note(0, "the parameter " + name + " changes within the log; its first value counts");
  }
}

void LogDigester::note(std::uint64_t offset, const std::string& what) {
  if (digest_.notes.size() < kMostNotes) digest_.notes.push_back({offset, what});
}

LogDigest LogDigester::take(std::string name, const logs::LogExtent& extent) {
  digest_.name = std::move(name);
  digest_.extent = extent;
  for (std::size_t k = 0; k < readings_.size(); ++k) {
    digest_.sources[k].blocks.reserve(readings_[k].blocks.size());
    for (const auto& [index, block] : readings_[k].blocks) digest_.sources[k].blocks.push_back(block);
  }
  return std::move(digest_);
}

}  // namespace review
}  // namespace PLUMB_ABI
}  // namespace plumb
