#include "generator.hpp"

#include <algorithm>
#include <cmath>

namespace plumb {
inline namespace PLUMB_ABI {
namespace campaign_kernel {

using std::size_t;

namespace {

/// As the simulator's thermometer says without a [temperature] table.
constexpr double kTemperature_degc = 25.0;

scenario::Injector empty_injector() {
  Datasheet nothing;
  return *scenario::Injector::make(nothing, nothing.model(), {}, 0);
}

/// Kinds that `scenario::apply` acts out: what a channel reads is then a function of what it would have read.
bool of_one_channel(const scenario::Fault& fault) noexcept {
  using scenario::FaultKind;
  return fault.sensor != scenario::kWholeLog && fault.kind <= FaultKind::pattern;
}

}  // namespace

Generator::Generator(const Plan& plan) : plan_(plan), injector_(empty_injector()) {
  const int stations = std::max(plan.stations, plan.validation_stations);
  const auto rows = static_cast<size_t>(stations) * static_cast<size_t>(plan.samples);
  healthy_.resize(rows);
  noise_.resize(rows);
  clock_.resize(rows);
  lay_clock();
  for (const ToolPlan& tool : plan.tools) datasheets_.push_back(datasheet_of(tool));
  injector_.reserve(campaign::kMostFaults);
}

/// When each row comes is the same in every scenario, and three divisions a sample are as dear as its noise.
void Generator::lay_clock() {
  const auto dwell = static_cast<std::uint64_t>(plan_.samples);
  const auto period = dwell + static_cast<std::uint64_t>(std::llround(plan_.move_s * plan_.rate_hz));
  for (size_t row = 0; row < clock_.size(); ++row) {
    const std::uint64_t station = row / dwell;
    clock_[row] = {static_cast<double>(station * period + row % dwell) / plan_.rate_hz, station + 1};
  }
}

scenario::Moment Generator::moment_of(int row) const noexcept {
  const Tick& tick = clock_[static_cast<size_t>(row)];
  scenario::Moment now;
  now.row = static_cast<std::uint64_t>(row);
  now.station = tick.station;
  now.time_s = from_s_ + tick.offset_s;
  return now;
}

double Generator::raw(int sensor, std::uint64_t row) const noexcept {
  return healthy_[static_cast<size_t>(row)][static_cast<size_t>(sensor)];
}

void Generator::lay(const Spec& spec, double from_s) noexcept {
  from_s_ = from_s;
  rows_ = spec.stations * plan_.samples;
  datasheet_ = &datasheets_[static_cast<size_t>(spec.tool)];
  all_ = SensorSet::first(datasheet_->size);
  const scenario::Tool tool = tool_of(plan_, spec, *datasheet_);
  lay_readings(spec, tool);
  lay_faults(spec, tool);
}

void Generator::lay_readings(const Spec& spec, const scenario::Tool& tool) noexcept {
  const scenario::Stream attitudes(spec.seed, scenario::Purpose::attitude);
  const AttitudePlan anywhere;
  const AttitudePlan& attitude = spec.attitude < 0 ? anywhere : plan_.attitudes[static_cast<size_t>(spec.attitude)];
  const double gravity_mps2 = true_gravity_mps2(plan_, spec);
  const Vec3 turn_rad = spec.calibration_mps2 > 0.0 ? common_turn_rad(tool) : Vec3{};
  std::array<Vec3, campaign::kMostStations> felt{};
  for (int k = 0; k < spec.stations; ++k) {
    const auto a = static_cast<size_t>(k);
    felt[a] = scaled(direction_at(attitude, k, plan_.stations, attitudes), gravity_mps2);
    truth_[a] = minus(felt[a], cross(turn_rad, felt[a]));
  }
  const scenario::NoiseLaw converter;
  for (int i = 0; i < tool.datasheet.size; ++i) {
    const auto s = static_cast<size_t>(i);
    const DatasheetSensor& sensor = tool.datasheet.sensor[s];
    scenario::Stream(spec.seed, scenario::Purpose::noise, static_cast<std::uint32_t>(i))
        .normals(0, rows_, noise_.data());
    const double scale = tool.model.scale_at(i, kTemperature_degc), bias = tool.model.bias_at(i, kTemperature_degc);
    const double sigma_mps2 = sensor.row.sigma_mps2;
    const bool rounds = sensor.resolution_raw > 0.0 || sensor.full_scale_raw > 0.0;
    for (int k = 0, row = 0; k < spec.stations; ++k) {
      const double shows_mps2 = dot(tool.axes[s], felt[static_cast<size_t>(k)]);
      for (const int end = row + plan_.samples; row < end; ++row) {
        const auto r = static_cast<size_t>(row);
        const double raw = scale * (shows_mps2 + sigma_mps2 * noise_[r] + bias);
        healthy_[r][s] = rounds ? scenario::digitised(raw, sensor, converter) : raw;
      }
    }
  }
}

void Generator::lay_faults(const Spec& spec, const scenario::Tool& tool) noexcept {
  faults_ = spec.faults;
  first_fault_row_ = rows_;
  alone_ = true;
  std::array<scenario::Fault, campaign::kMostFaults> monitored{};
  for (int k = 0; k < faults_; ++k) {
    const auto a = static_cast<size_t>(k);
    Channel& c = channel_[a];
    monitored[a] = c.fault = fault_of(spec.fault[a]);
    alone_ = alone_ && of_one_channel(c.fault);
    c.stream = scenario::Stream(spec.seed, scenario::Purpose::fault, static_cast<std::uint32_t>(k));
    c.memory = scenario::FaultMemory{};
    const double first = (c.fault.onset - 1.0) * plan_.samples;
    c.first_row = static_cast<int>(std::min(first, static_cast<double>(rows_)));
    c.end_row = static_cast<int>(std::min(first + c.fault.duration * plan_.samples, static_cast<double>(rows_)));
    first_fault_row_ = std::min(first_fault_row_, c.first_row);
    if (c.fault.sensor == scenario::kWholeLog) continue;
    const auto s = static_cast<size_t>(c.fault.sensor);
    const double scale = tool.model.scale_at(c.fault.sensor, kTemperature_degc);
    c.law = {scale, scale * tool.model.bias_at(c.fault.sensor, kTemperature_degc),
             tool.datasheet.sensor[s].resolution_raw};
  }
  if (!alone_) {
    Datasheet real = tool.datasheet;  // faults of direction mean the true axes, as in the simulator
    for (int i = 0; i < real.size; ++i)
      real.sensor[static_cast<size_t>(i)].row.axis = tool.axes[static_cast<size_t>(i)];
    injector_.pose(real, tool.model, monitored.data(), faults_, spec.seed);
  }
  // In order of onset: a sensor that stands at its last value may have been at fault before.
  for (int station = 1; station <= spec.stations; ++station) {
    for (int k = 0; k < faults_; ++k) {
      Channel& c = channel_[static_cast<size_t>(k)];
      const int row = (station - 1) * plan_.samples;
      if (c.first_row != row) continue;
      c.memory.begun = true;
      c.memory.begun_s = moment_of(row).time_s;
      c.memory.has_last = c.fault.sensor != scenario::kWholeLog;
      if (c.memory.has_last) {
        Sample last;
        sample(row > 0 ? row - 1 : row, last);
        const auto s = static_cast<size_t>(c.fault.sensor);
        c.memory.last_raw = row > 0 ? last.raw[s] : healthy_[0][s];
      }
      if (!alone_) injector_.remember(k, c.memory);
    }
  }
}

void Generator::disturb(Sample& out, const scenario::Moment& now) const noexcept {
  const int row = static_cast<int>(now.row);
  const scenario::NoiseLaw converter;
  for (int k = 0; k < faults_; ++k) {
    const Channel& c = channel_[static_cast<size_t>(k)];
    if (row < c.first_row || row >= c.end_row) continue;
    const auto s = static_cast<size_t>(c.fault.sensor);
    const double raw = scenario::apply(c.fault, c.memory, now, out.raw[s], c.law, c.stream);
    const bool reading = c.fault.kind != scenario::FaultKind::pattern;
    out.raw[s] = reading ? scenario::digitised(raw, datasheet_->sensor[s], converter) : raw;
  }
}

void Generator::sample(int row, Sample& out) const noexcept {
  const scenario::Moment now = moment_of(row);
  out.time_s = now.time_s;
  out.raw = healthy_[static_cast<size_t>(row)];
  out.delivered = all_;
  out.temperature_degc = kTemperature_degc;
  out.station = static_cast<std::uint32_t>(now.station);
  if (row < first_fault_row_) return;
  if (alone_) {
    disturb(out, now);
  } else {
    injector_.inject(out, now, *this);
  }
}

}  // namespace campaign_kernel
}  // namespace PLUMB_ABI
}  // namespace plumb
