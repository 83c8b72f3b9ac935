#include "player.hpp"
#include "plumb/scenario/count_text.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace campaign_kernel {

using std::size_t;

namespace {

/// Events that speak against somebody or something.
bool accuses(HealthEvent event) noexcept {
  switch (event) {
    case HealthEvent::channel_lost:
    case HealthEvent::exclusion:
    case HealthEvent::provisional_exclusion:
    case HealthEvent::isolation_timeout:
    case HealthEvent::no_consistent_hypothesis:
    case HealthEvent::alarm:
    case HealthEvent::norm_mismatch: return true;
    default: return false;
  }
}

}  // namespace

void Judge::begin(const Plan& plan, const Spec& spec, campaign::Outcome& outcome) noexcept {
  out_ = &outcome;
  window_ = plan.window;
  block_end_ = plan.window - 1;
  outcome.blocks = 0;
  outcome.first_fault_block = outcome.alarm_block = outcome.isolated_block = -1;
  outcome.faulty = campaign::faulty_of(plan.tools[static_cast<size_t>(spec.tool)], spec);
  outcome.excluded = outcome.provisionally_excluded = outcome.ever_excluded = outcome.ever_provisionally_excluded = 0;
  outcome.failed = false;
  for (int k = 0; k < spec.faults; ++k) {
    const int station = static_cast<int>(spec.fault[static_cast<size_t>(k)].onset_station);
    if (station > spec.stations) continue;
    const int block = (station - 1) * plan.samples / plan.window;
    if (outcome.first_fault_block < 0 || block < outcome.first_fault_block) outcome.first_fault_block = block;
  }
}

void Judge::note(const Verdict& v, const Vec3& truth, bool ends) noexcept {
  campaign::Outcome& out = *out_;
  const bool against = v.transition.sequence != 0 && accuses(v.transition.event);
  // Within a block in suspect an alarm changes nothing and leaves no record: its figures tell.
  const bool over = ends && (v.margin < 0.0 || (v.qualifiers & Qualifier::moving) != 0 ||
                             !(v.noisy | v.stuck | v.contradicted_clip).empty());
  if (out.alarm_block < 0 && (against || over)) out.alarm_block = out.blocks;
  out.excluded = (v.excluded | v.absent).bits;
  out.provisionally_excluded = v.provisionally_excluded.bits;
  out.ever_excluded |= out.excluded;
  out.ever_provisionally_excluded |= out.provisionally_excluded;
  const bool exactly = out.faulty != 0 && out.excluded == out.faulty;
  if (!exactly) out.isolated_block = -1;
  if (exactly && out.isolated_block < 0) out.isolated_block = out.blocks;
  if (!ends) return;
  if (out.blocks < campaign::kMostBlocks) {
    campaign::BlockOutcome& block = out.block[static_cast<size_t>(out.blocks)];
    block.tilt_rad = angle_between_rad(v.gravity_mps2, truth);
    block.bounded = v.protection_available;
    block.protection_rad = v.protection_level_calibrated_axes_rad;
    block.usable = v.validity == Validity::valid || v.validity == Validity::degraded;
    block.alert = v.alert;
    block.alarmed = out.alarm_block >= 0;
    ++out.blocks;
  }
  block_end_ += window_;
}

void Judge::end(const Verdict& verdict) noexcept { out_->failed = verdict.state == HealthState::failed; }

void Player::run(const Spec& spec, double from_s, campaign::Outcome& outcome) noexcept {
  generator_.lay(spec, from_s);
  Judge judge;
  judge.begin(plan_, spec, outcome);
  Sample sample;
  int row = 0;
  for (int station = 0; station < spec.stations; ++station) {
    const Vec3& truth = generator_.truth(station);
    for (const int end = row + plan_.samples; row < end; ++row) {
      generator_.sample(row, sample);
      judge.look(monitor_.step(sample), row, truth);
    }
  }
  judge.end(monitor_.verdict());
}

void Player::play(const Spec& spec, campaign::Outcome& outcome) noexcept {
  monitor_ = start_[static_cast<size_t>(spec.tool)];
  run(spec, from_s_, outcome);
}

std::string Player::prepare() {
  auto outcome = std::make_unique<campaign::Outcome>();
  for (size_t tool = 0; tool < plan_.tools.size(); ++tool) {
    const std::string& name = plan_.tools[tool].name;
    if (plan_.tools[tool].sensors == 0) {  // another kernel's
      start_.emplace_back();
      continue;
    }
    const Expected<MonitorSetup> setup = setup_of(plan_, static_cast<int>(tool));
    const Expected<void> configured = setup ? monitor_.configure(*setup) : tl::unexpected<Error>(setup.error());
    if (!configured) {
      return "the monitor of tool " + name + " cannot be configured: " + describe(configured.error().code) +
             ". Remedy: " + remedy(configured.error().code);
    }
    if (plan_.start == campaign::Start::validated) {
      run(trust_spec(plan_, static_cast<int>(tool)), 0.0, *outcome);
      const HealthState state = monitor_.verdict().state;
      const bool three = state == HealthState::degraded_3_sensor && monitor_.array().size() == 3;
      if (state != HealthState::nominal && !three) {
        return "the monitor did not validate the healthy sensors of tool " + name + " within " +
               count_text(plan_.validation_stations, "station") + ": its state is " + to_string(state) +
               ". Remedy: raise [run] validation_stations, or use another seed";
      }
    }
    start_.push_back(monitor_);
  }
  return "";
}

std::unique_ptr<campaign::Kernel> make(const Plan& plan, std::string& refusal) {
  auto player = std::make_unique<Player>(plan);
  refusal = player->prepare();
  if (!refusal.empty()) return nullptr;
  return player;
}

}  // namespace campaign_kernel
}  // namespace PLUMB_ABI
}  // namespace plumb
