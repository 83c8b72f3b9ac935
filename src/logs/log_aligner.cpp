#include "plumb/logs/log_aligner.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace plumb {
inline namespace PLUMB_ABI {
namespace logs {
namespace {

double mixed(double a, double b, double share) noexcept { return a + share * (b - a); }

Axes mixed(const Axes& a, const Axes& b, double share) noexcept {
  return {mixed(a[0], b[0], share), mixed(a[1], b[1], share), mixed(a[2], b[2], share)};
}

}  // namespace

LogAligner::LogAligner(std::vector<AlignedSource> sources, std::size_t reference, Alignment how,
                       std::function<bool(const AlignedRow&)> take)
    : reference_(reference), how_(how), take_(std::move(take)) {
  for (const AlignedSource& source : sources) waiting_.push_back({source, {}, 0.0, 0});
}

void LogAligner::record(std::size_t number, const ImuRecord& record) {
  const auto found = std::find_if(waiting_.begin(), waiting_.end(),
                                  [&](const Waiting& waiting) { return waiting.source.number == number; });
  if (stopped_ || found == waiting_.end()) return;
  std::deque<ImuRecord>& records = found->records;
  // A record that jumped ahead, and after which the log goes on where it was, has a wrong time.
  const std::size_t size = records.size();
  if (size > 1 && record.time_s > records[size - 2].time_s && record.time_s <= records.back().time_s &&
      records.back().time_s - records[size - 2].time_s > found->source.longest_gap_s) {
    records.pop_back();
    ++left_out_;
  }
  if (!std::isfinite(record.time_s) || (!records.empty() && !(record.time_s > records.back().time_s))) {
    ++left_out_;
    return;
  }
  records.push_back(record);
  std::deque<ImuRecord>& instants = waiting_[reference_].records;
  while (!stopped_ && !instants.empty() && (ready(instants.front().time_s) || instants.size() > kMostWaiting)) give();
  // What is older than any instant to come: one record is kept to interpolate from.
  if (records.size() > kMostWaiting && found != waiting_.begin() + static_cast<std::ptrdiff_t>(reference_))
    records.pop_front();
}

bool LogAligner::ready(double time_s) const noexcept {
  return std::all_of(waiting_.begin(), waiting_.end(), [time_s](const Waiting& waiting) {
    return !waiting.records.empty() && waiting.records.back().time_s >= time_s;
  });
}

ImuRecord LogAligner::reading_at(Waiting& waiting, double time_s) {
  std::deque<ImuRecord>& records = waiting.records;
  while (records.size() > 1 && records[1].time_s <= time_s) records.pop_front();
  ImuRecord none;
  none.time_s = time_s;
  if (records.empty() || records.front().time_s > time_s) return none;
  const ImuRecord before = records.front();
  if (!(before.time_s < time_s)) {
    ++waiting.distances;
    return before;
  }
  if (records.size() < 2 || records[1].time_s - before.time_s > waiting.source.longest_gap_s) return none;
  const ImuRecord& after = records[1];
  const double share = (time_s - before.time_s) / (after.time_s - before.time_s);
  waiting.distances_s += std::min(time_s - before.time_s, after.time_s - time_s);
  ++waiting.distances;
  ImuRecord out = share < 0.5 ? before : after;
  out.time_s = time_s;
  if (how_ == Alignment::nearest) return out;
  out.specific_force_mps2 = mixed(before.specific_force_mps2, after.specific_force_mps2, share);
  out.rate_radps = mixed(before.rate_radps, after.rate_radps, share);
  out.temperature_degc = mixed(before.temperature_degc, after.temperature_degc, share);
  return out;
}

void LogAligner::give() {
  AlignedRow row;
  const ImuRecord instant = waiting_[reference_].records.front();
  row.time_s = instant.time_s;
  for (std::size_t i = 0; i < waiting_.size(); ++i)
    row.readings.push_back(i == reference_ ? instant : reading_at(waiting_[i], row.time_s));
  waiting_[reference_].records.pop_front();
  ++rows_;
  stopped_ = !take_(row);
}

void LogAligner::finish() {
  while (!stopped_ && !waiting_[reference_].records.empty()) give();
}

double LogAligner::mean_distance_s(std::size_t source) const noexcept {
  const Waiting& waiting = waiting_[source];
  return waiting.distances > 0 ? waiting.distances_s / static_cast<double>(waiting.distances) : 0.0;
}

}  // namespace logs
}  // namespace PLUMB_ABI
}  // namespace plumb
