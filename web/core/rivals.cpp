#include "rivals.hpp"

#include "plumb/core/error.hpp"
#include "plumb/findings/best_turn.hpp"

namespace plumb_web {

using namespace plumb;

namespace {

std::vector<SensorSet> px4_units(const SensorArray& array) {
  std::vector<SensorSet> out;
  const SensorUnits& units = array.units();
  for (int u = 0; u < units.size() && units.grouped(); ++u) {
    const SensorSet sensors = units.sensors_of(SensorSet::of(u));
    if (sensors.size() >= 3 && spans_space(array, sensors)) out.push_back(sensors);
  }
  for (int i = 0; i + 3 <= array.size() && !units.grouped(); i += 3) {
    const SensorSet sensors = SensorSet(7U << static_cast<unsigned>(i));
    if (spans_space(array, sensors)) out.push_back(sensors);
  }
  if (out.size() > plumb_bench::kMostUnits) out.resize(plumb_bench::kMostUnits);
  return out;
}

}  // namespace

Px4Beside::Px4Beside(const SensorArray& array, double rate_hz) : units_(px4_units(array)), means_(rate_hz) {
  for (const SensorSet unit : units_) solve_.push_back(least_squares(array, unit));
  now_.count = units_.size();
}

SensorSet Px4Beside::sensors_of(std::uint32_t units) const {
  SensorSet out;
  for (std::size_t u = 0; u < units_.size(); ++u) {
    if ((units >> u & 1U) != 0) out = out | units_[u];
  }
  return out;
}

void Px4Beside::step(const Readings& y, SensorSet delivered) {
  now_.delivered = 0;
  for (std::size_t u = 0; u < units_.size(); ++u) {
    if (!delivered.contains(units_[u])) continue;  // its vector stays the last one
    now_.delivered |= 1U << u;
    now_.vector[u] = solve_[u].estimate(y);
  }
  if (!means_.add(now_)) return;
  selector_blames_ = selector_.step(means_.mean(), means_.period_s());
  voter_blames_ = voter_.step(means_.mean(), means_.period_s());
  const std::uint32_t blamed = selector_blames_ | voter_blames_;
  // It changes once the unit in use is blamed, to the first that is not, and does not return by itself.
  if ((blamed >> in_use_ & 1U) == 0) return;
  for (std::size_t u = 0; u < units_.size(); ++u) {
    if ((blamed >> u & 1U) != 0) continue;
    in_use_ = u;
    return;
  }
}

PaperBeside::PaperBeside(const Datasheet& datasheet, const MonitorSetup& plumb_setup,
                         const std::vector<Station>& stations) {
  if (datasheet.size > kPaperCapacity) {
    absent_ = "it is offered for at most " + std::to_string(kPaperCapacity) + " sensors";
    return;
  }
  const auto setup = std::make_unique<PaperSetup>();
  setup->base = plumb_setup;
  setup->base.config.mode = MonitorMode::paper;
  setup->datasheet = datasheet;
  const Expected<void> fitted = paper_calibrate_all(datasheet, plumb_setup.gravity, stations.data(),
                                                    static_cast<int>(stations.size()), PaperOptions{}, setup->paper);
  if (!fitted) absent_ = describe(fitted.error().code);
  if (!fitted) return;
  const Expected<void> configured = monitor_->configure(*setup);
  if (!configured) absent_ = describe(configured.error().code);
  if (configured) align(*setup, stations);
}

/// Gravity's length alone leaves the common turn of all axes to the datasheet; plumb's fit keeps it otherwise. The turn
/// between the two is no error of either.
void PaperBeside::align(const PaperSetup& setup, const std::vector<Station>& stations) {
  const Expected<SensorArray> nominal = setup.datasheet.array();
  const LeastSquares all = least_squares(setup.base.array, setup.base.array.all());
  if (!nominal) return;
  findings::BestTurn best;
  for (const Station& station : stations) {
    if (!setup.paper.all.used.empty() && station.delivered.contains(setup.paper.all.used)) {
      const Readings y = setup.base.model.apply(station.mean, station.temperature_degc, setup.base.array.all());
      best.add(all.estimate(y), paper_vector(*nominal, setup.paper.all, station.mean, station.temperature_degc));
    }
  }
  const findings::Turn turn = best.find(findings::Hand::kept);
  for (std::size_t r = 0; r < 3; ++r) {
    for (std::size_t c = 0; c < 3; ++c) turn_[3 * r + c] = turn[r][c];
  }
}

void PaperBeside::step(const Sample& sample) {
  if (absent_.empty()) monitor_->step(sample);
}

Vec3 PaperBeside::down() const { return times(turn_, monitor_->verdict().gravity_mps2); }

}  // namespace plumb_web
