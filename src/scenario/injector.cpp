#include "plumb/scenario/injector.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "plumb/scenario/attitude.hpp"
#include "plumb/scenario/portable_math.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace scenario {
namespace {

bool speaks_of_gravity(FaultKind kind) noexcept {
  return kind == FaultKind::turned || kind == FaultKind::ghost || kind == FaultKind::mirror ||
         kind == FaultKind::gravity;
}

/// Least squares of the readings over the channels that are there and finite; zero where those have no rank of 3.
Vec3 least_squares(const Datasheet& datasheet, const Readings& y, SensorSet usable) noexcept {
  Mat3 a{};
  Vec3 b{};
  for (int i = 0; i < datasheet.size; ++i) {
    const auto s = static_cast<std::size_t>(i);
    if (!usable.has(i)) continue;
    const Vec3& h = datasheet.sensor[s].row.axis;
    for (std::size_t r = 0; r < 3; ++r) {
      b[r] += h[r] * y[s];
      for (std::size_t c = 0; c < 3; ++c) a[3 * r + c] += h[r] * h[c];
    }
  }
  const Vec3 first = {a[0], a[1], a[2]};
  const Vec3 second = {a[3], a[4], a[5]};
  const Vec3 third = {a[6], a[7], a[8]};
  const double det = dot(first, cross(second, third));
  if (!(det > 1e-9)) return {};
  // Cramer, with the rows of a symmetric matrix.
  return {dot(b, cross(second, third)) / det, dot(first, cross(b, third)) / det, dot(first, cross(second, b)) / det};
}

/// The axis turned by an angle, the direction of the turn counted about the axis itself.
Vec3 turned_axis(const Vec3& axis, double angle_rad, double direction_rad) noexcept {
  const Vec3 one = perpendicular_to(axis);
  const Vec3 two = cross(axis, one);
  const SinCos way = portable_sincos(direction_rad);
  const SinCos turn = portable_sincos(angle_rad);
  const Vec3 across = plus(scaled(one, way.cos), scaled(two, way.sin));
  return plus(scaled(axis, turn.cos), scaled(across, turn.sin));
}

Vec3 mirrored(const Vec3& vector, const Vec3& a, const Vec3& b) noexcept {
  const Vec3 across = cross(a, b);
  const double square = dot(across, across);
  return square > 1e-12 ? minus(vector, scaled(across, 2.0 * dot(vector, across) / square)) : vector;
}

}  // namespace

/// What several faults of one row ask for; gravity is worked out only where one of them does.
struct Injector::Scene {
  std::array<double, kCapacity> raw{};
  Readings mps2{};  ///< gravity sense
  Vec3 gravity_mps2{};
};

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
      converter_(converter) {
  for (const Fault& fault : faults_) {
    const bool channel = fault.sensor != kWholeLog;
    looks_back_ = looks_back_ || (channel && (fault.kind == FaultKind::late || fault.kind == FaultKind::slow));
  }
}

void Injector::Ring::keep(const Sample& sample, std::uint64_t row) {
  constexpr std::size_t kRows = kMostRowsLate + 1;
  if (rows_.size() < kRows) {
    rows_.push_back(sample.raw);
  } else {
    rows_[static_cast<std::size_t>(row % kRows)] = sample.raw;
  }
  next_ = row + 1;
}

double Injector::Ring::raw(int sensor, std::uint64_t row) const noexcept {
  // Before the log nothing was delivered: the oldest row stands in.
  const std::uint64_t oldest = next_ > rows_.size() ? next_ - rows_.size() : 0;
  return rows_[static_cast<std::size_t>(std::max(row, oldest) % rows_.size())][static_cast<std::size_t>(sensor)];
}

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
    if (faults_[k].sensor == kWholeLog) continue;
    const auto s = static_cast<std::size_t>(faults_[k].sensor);
    if (!memory.has_last && sample.delivered.has(faults_[k].sensor) && std::isfinite(sample.raw[s])) {
      memory.last_raw = sample.raw[s];
      memory.has_last = true;
    }
  }
  last_ = now_;
  if (looks_back_) ring_.keep(sample, now_.row);
  const SensorSet came = sample.delivered;
  const SensorSet faulty = inject(sample, now_, ring_);
  for (std::size_t k = 0; k < faults_.size(); ++k) {
    const int sensor = faults_[k].sensor;
    if (in_effect(faults_[k], now_) && (sensor == kWholeLog || came.has(sensor))) memory_[k].effective = true;
    if (sensor == kWholeLog || memory_[k].begun || !sample.delivered.has(sensor)) continue;
    if (!std::isfinite(sample.raw[static_cast<std::size_t>(sensor)])) continue;
    memory_[k].last_raw = sample.raw[static_cast<std::size_t>(sensor)];
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

/// Faults of the whole log that change what every channel or the thermometer says.
void Injector::disturb(Sample& sample, const Fault& fault, const Moment& now, const Stream& stream) const noexcept {
  if (fault.kind == FaultKind::temperature) sample.temperature_degc += fault.magnitude;
  if (fault.kind != FaultKind::shake && fault.kind != FaultKind::gravity) return;
  Vec3 extra = vibration(stream, now.row, fault.magnitude);
  if (fault.kind == FaultKind::gravity) {
    const Readings y = model_.apply(sample.raw, sample.temperature_degc, sample.delivered);
    const Vec3 down = least_squares(datasheet_, y, sample.delivered);
    const double length = norm(down);
    extra = length > 0.0 ? scaled(down, fault.magnitude / length) : Vec3{};
  }
  for (int i = 0; i < datasheet_.size; ++i) {
    const auto s = static_cast<std::size_t>(i);
    if (!sample.delivered.has(i)) continue;
    const double felt = dot(datasheet_.sensor[s].row.axis, extra) * static_cast<double>(model_.reads);
    sample.raw[s] += model_.scale_at(i, sample.temperature_degc) * felt;
  }
}

double Injector::faulty_value(std::size_t k, const Sample& sample, const Moment& now, const Scene& scene,
                              const Past& past, const Stream& stream) const noexcept {
  const Fault& fault = faults_[k];
  const auto s = static_cast<std::size_t>(fault.sensor);
  const auto axis = [this](std::size_t i) -> const Vec3& { return datasheet_.sensor[i].row.axis; };
  const double scale = model_.scale_at(fault.sensor, sample.temperature_degc);
  const double sense = scale * static_cast<double>(model_.reads);
  const double raw = sample.raw[s];
  const auto other = static_cast<std::size_t>(std::max(0.0, fault.magnitude));
  switch (fault.kind) {
    case FaultKind::late: {
      const auto rows = static_cast<std::uint64_t>(fault.magnitude);
      return past.raw(fault.sensor, now.row > rows ? now.row - rows : 0);
    }
    case FaultKind::slow: {
      const auto rows = static_cast<std::uint64_t>(fault.magnitude);
      return past.raw(fault.sensor, now.row - now.row % rows);
    }
    case FaultKind::exchange: return scene.raw[other];
    case FaultKind::cross_talk: return raw + sense * (fault.upper * scene.mps2[other]);
    case FaultKind::turned: {
      const Vec3 bent = turned_axis(axis(s), fault.magnitude, fault.upper);
      return raw + sense * dot(minus(bent, axis(s)), scene.gravity_mps2);
    }
    case FaultKind::ghost: {
      const SinCos way = portable_sincos(fault.upper);
      const Vec3 shown = seen_from_turned(scene.gravity_mps2, {way.cos, way.sin, 0.0}, fault.magnitude);
      return raw + sense * dot(axis(s), minus(shown, scene.gravity_mps2));
    }
    case FaultKind::mirror: {
      const Vec3 shown = mirrored(scene.gravity_mps2, axis(other), axis(static_cast<std::size_t>(fault.upper)));
      return raw + sense * dot(axis(s), minus(shown, scene.gravity_mps2));
    }
    default: break;
  }
  const ChannelLaw law = {scale, scale * model_.bias_at(fault.sensor, sample.temperature_degc),
                          datasheet_.sensor[s].resolution_raw};
  return scenario::apply(fault, memory_[k], now, raw, law, stream);
}

SensorSet Injector::inject(Sample& sample, const Moment& now, const Past& past) const noexcept {
  Scene scene;
  bool gravity_asked = false;
  for (const Fault& fault : faults_) gravity_asked = gravity_asked || speaks_of_gravity(fault.kind);
  scene.raw = sample.raw;
  if (!faults_.empty()) scene.mps2 = model_.apply(sample.raw, sample.temperature_degc, sample.delivered);
  if (gravity_asked) scene.gravity_mps2 = least_squares(datasheet_, scene.mps2, sample.delivered);

  SensorSet faulty, changed;
  for (std::size_t k = 0; k < faults_.size(); ++k) {
    const Fault& fault = faults_[k];
    if (!in_effect(fault, now) || is_delivery(fault.kind, fault.sensor)) continue;
    const Stream stream(seed_, Purpose::fault, static_cast<std::uint32_t>(k));
    if (fault.sensor == kWholeLog) {
      if (fault.kind != FaultKind::temperature) changed = changed | SensorSet::first(datasheet_.size);
      disturb(sample, fault, now, stream);
      continue;
    }
    faulty = faulty.with(fault.sensor);
    if (fault.kind == FaultKind::missing && stream.uniform(now.row) < fault.magnitude) {
      sample.delivered = sample.delivered.without(fault.sensor);
      sample.raw[static_cast<std::size_t>(fault.sensor)] = 0.0;
    }
    if (!sample.delivered.has(fault.sensor) || fault.kind == FaultKind::missing) continue;
    sample.raw[static_cast<std::size_t>(fault.sensor)] = faulty_value(k, sample, now, scene, past, stream);
    if (fault.kind == FaultKind::exchange) {
      const auto other = static_cast<std::size_t>(fault.magnitude);
      sample.raw[other] = scene.raw[static_cast<std::size_t>(fault.sensor)];
      faulty = faulty.with(static_cast<int>(other));
    }
    changed = changed.with(fault.sensor);
    // What is no reading does not come from the converter.
    if (fault.kind == FaultKind::pattern) changed = changed.without(fault.sensor);
  }
  for (int i = 0; i < datasheet_.size; ++i) {
    if (!changed.has(i) || !sample.delivered.has(i)) continue;
    const auto s = static_cast<std::size_t>(i);
    NoiseLaw converter = converter_;
    if (sample.count > 1) converter.quantise = false;
    sample.raw[s] = digitised(sample.raw[s], datasheet_.sensor[s], converter);
  }
  return faulty;
}

void Injector::reserve(std::size_t faults) {
  faults_.reserve(faults);
  memory_.reserve(faults);
}

void Injector::pose(const Datasheet& datasheet, const SensorModel& model, const Fault* faults, int count,
                    std::uint64_t seed) noexcept {
  datasheet_ = datasheet;
  model_ = model;
  faults_.assign(faults, faults + count);
  memory_.assign(static_cast<std::size_t>(count), FaultMemory{});
  seed_ = seed;
}

void Injector::remember(int fault, const FaultMemory& memory) noexcept {
  if (fault >= 0 && static_cast<std::size_t>(fault) < memory_.size()) memory_[static_cast<std::size_t>(fault)] = memory;
}

}  // namespace scenario
}  // namespace PLUMB_ABI
}  // namespace plumb
