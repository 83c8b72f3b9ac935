#include "plumb/scenario/injector.hpp"

#include <cmath>
#include <utility>

namespace plumb {
inline namespace PLUMB_ABI {
namespace scenario {

tl::expected<Injector, std::string> Injector::make(const Datasheet& datasheet, const SensorModel& model,
                                                   std::vector<Fault> faults, std::uint64_t seed,
                                                   const NoiseLaw& converter) {
  for (std::size_t k = 0; k < faults.size(); ++k) {
    const auto checked = check(faults[k], datasheet.size);
    if (!checked) return tl::unexpected<std::string>("fault " + std::to_string(k + 1) + ": " + checked.error());
  }
  return Injector(datasheet, model, std::move(faults), seed, converter);
}

Injector::Injector(const Datasheet& datasheet, const SensorModel& model, std::vector<Fault> faults, std::uint64_t seed,
                   const NoiseLaw& converter)
    : datasheet_(datasheet),
      model_(model),
      faults_(std::move(faults)),
      memory_(faults_.size()),
      seed_(seed),
      converter_(converter) {}

SensorSet Injector::apply(Sample& sample) noexcept {
  now_.time_s = sample.time_s;
  if (sample.station != 0 && sample.station != tag_) ++now_.station;
  if (sample.station != 0) tag_ = sample.station;
  for (std::size_t k = 0; k < faults_.size(); ++k) {
    FaultMemory& memory = memory_[k];
    if (!has_begun(faults_[k], now_)) continue;
    if (!memory.begun) {
      const bool exact = faults_[k].clock == Clock::time && now_.row > 0;
      memory.begun_s = exact ? faults_[k].onset : sample.time_s;
      memory.begun = true;
    }
    const auto s = static_cast<std::size_t>(faults_[k].sensor);
    if (!memory.has_last && sample.delivered.has(faults_[k].sensor) && std::isfinite(sample.raw[s])) {
      memory.last_raw = sample.raw[s];
      memory.has_last = true;
    }
  }
  const SensorSet faulty = inject(sample, now_);
  for (std::size_t k = 0; k < faults_.size(); ++k) {
    const auto s = static_cast<std::size_t>(faults_[k].sensor);
    if (in_effect(faults_[k], now_) && sample.delivered.has(faults_[k].sensor)) memory_[k].effective = true;
    if (memory_[k].begun || !sample.delivered.has(faults_[k].sensor) || !std::isfinite(sample.raw[s])) continue;
    memory_[k].last_raw = sample.raw[s];
    memory_[k].has_last = true;
  }
  ++now_.row;
  return faulty;
}

std::vector<int> Injector::without_effect() const {
  std::vector<int> waiting;
  for (std::size_t k = 0; k < faults_.size(); ++k) {
    if (!memory_[k].effective) waiting.push_back(static_cast<int>(k));
  }
  return waiting;
}

SensorSet Injector::inject(Sample& sample, const Moment& now) const noexcept {
  SensorSet faulty;
  for (std::size_t k = 0; k < faults_.size(); ++k) {
    const Fault& fault = faults_[k];
    if (!in_effect(fault, now)) continue;
    faulty = faulty.with(fault.sensor);
    if (!sample.delivered.has(fault.sensor)) continue;
    const auto s = static_cast<std::size_t>(fault.sensor);
    const double scale = model_.scale_at(fault.sensor, sample.temperature_degc);
    const ChannelLaw law = {scale, scale * model_.bias_at(fault.sensor, sample.temperature_degc)};
    const Stream stream(seed_, Purpose::fault, static_cast<std::uint32_t>(k));
    sample.raw[s] = scenario::apply(fault, memory_[k], now, sample.raw[s], law, stream);
  }
  for (int i = 0; i < datasheet_.size; ++i) {
    if (!faulty.has(i) || !sample.delivered.has(i)) continue;
    const auto s = static_cast<std::size_t>(i);
    NoiseLaw converter = converter_;
    if (sample.count > 1) converter.quantise = false;
    sample.raw[s] = digitised(sample.raw[s], datasheet_.sensor[s], converter);
  }
  return faulty;
}

void Injector::remember(int fault, const FaultMemory& memory) noexcept {
  if (fault >= 0 && static_cast<std::size_t>(fault) < memory_.size()) memory_[static_cast<std::size_t>(fault)] = memory;
}

}  // namespace scenario
}  // namespace PLUMB_ABI
}  // namespace plumb
