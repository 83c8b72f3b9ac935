// The real decision layer behind model/shim.h. With PLUMB_MODEL_DEFECT one cell of the table is wrong, with
// PLUMB_MODEL_FORGETS_CHIPS every sensor is a unit whatever the array says: the lock-step must notice.
#include "shim.h"

#include "plumb/health/detail/decision.hpp"

namespace {

using namespace plumb;

static_assert(sizeof(plumb_model_state) == 11, "no padding: the model checker compares bytes");
static_assert(static_cast<int>(Mode::nominal) == 0 && static_cast<int>(Mode::isolated) == 1 &&
              static_cast<int>(Mode::suspect) == 2 && static_cast<int>(Mode::degraded) == 3 &&
              static_cast<int>(Mode::recalibrating) == 4 && static_cast<int>(Mode::initial) == 5 &&
              static_cast<int>(Mode::failed) == 6 && kModeCount == 7);
static_assert(static_cast<int>(HealthEvent::reset) == 0 && static_cast<int>(HealthEvent::channel_lost) == 1 &&
              static_cast<int>(HealthEvent::channel_back) == 2 && static_cast<int>(HealthEvent::exclusion) == 3 &&
              static_cast<int>(HealthEvent::provisional_exclusion) == 4 &&
              static_cast<int>(HealthEvent::isolation_timeout) == 5 &&
              static_cast<int>(HealthEvent::no_consistent_hypothesis) == 6 &&
              static_cast<int>(HealthEvent::alarm) == 7 && static_cast<int>(HealthEvent::norm_mismatch) == 8 &&
              static_cast<int>(HealthEvent::fit_accepted) == 9 && static_cast<int>(HealthEvent::fit_rejected) == 10 &&
              static_cast<int>(HealthEvent::probation_passed) == 11 &&
              static_cast<int>(HealthEvent::recalibrate) == 12 && static_cast<int>(HealthEvent::passed_block) == 13 &&
              static_cast<int>(HealthEvent::none) == 14);

#ifdef PLUMB_MODEL_DEFECT
TransitionTable table_with_a_defect() {
  TransitionTable table = kTransitionTable;
  table[static_cast<std::size_t>(Mode::recalibrating)][static_cast<std::size_t>(HealthEvent::fit_rejected)].target =
      Target::by_size;
  return table;
}
const TransitionTable kTable = table_with_a_defect();
#else
constexpr const TransitionTable& kTable = kTransitionTable;
#endif

SensorUnits units_of([[maybe_unused]] const plumb_model_input& input) {
#ifdef PLUMB_MODEL_FORGETS_CHIPS
  return SensorUnits{};
#else
  return SensorUnits::of_chips(input.sensors, [&input](int i) {
    const SensorSet unit(input.unit[i]);
    return unit.size() > 1 ? unit.lowest() + 1 : 0;
  });
#endif
}

unsigned char byte_of(SensorSet set) { return static_cast<unsigned char>(set.bits); }

}  // namespace

plumb_model_answer plumb_model_step(plumb_model_state* state, const plumb_model_input* input) {
  DecisionState s;
  s.mode = static_cast<Mode>(state->mode);
  s.base = static_cast<Mode>(state->base);
  s.sensors = {SensorSet(state->in_service), SensorSet(state->provisionally_excluded), SensorSet(state->excluded),
               SensorSet(state->absent), SensorSet(state->readmitted)};
  s.not_yet_validated = state->not_yet_validated != 0;
  s.timed_out = state->timed_out != 0;
  s.clean_run = state->clean_run;

  DecisionInput in;
  in.raised = input->raised;
  in.from_motion = input->from_motion;
  in.named = {SensorSet(input->isolated), SensorSet(input->suspected), SensorSet(input->lost), SensorSet(input->back),
              SensorSet(input->proven),   SensorSet(input->reset),     units_of(*input)};
  in.protection_within = input->protection_within != 0;
  in.calibrated = state->calibrated != 0;
  in.passed_blocks = input->passed_blocks;
  const int n = input->sensors;
  const Decision decision = decide(kTable, s, in, [n](SensorSet set) {
    if (set.size() < 3) return SizeClass::rank_lost;
    if (set.size() == 3) return SizeClass::critical;
    return set.size() == n ? SizeClass::all_configured : SizeClass::reduced;
  });

  const bool adopted = (decision.actions & Action::adopt_fit) != 0;
  state->mode = static_cast<unsigned char>(s.mode);
  state->base = static_cast<unsigned char>(s.base);
  state->in_service = byte_of(s.sensors.in_service);
  state->provisionally_excluded = byte_of(s.sensors.provisionally_excluded);
  state->excluded = byte_of(s.sensors.excluded);
  state->absent = byte_of(s.sensors.absent);
  state->readmitted = byte_of(s.sensors.readmitted);
  state->not_yet_validated = s.not_yet_validated ? 1 : 0;
  state->timed_out = s.timed_out ? 1 : 0;
  state->clean_run = static_cast<unsigned char>(s.clean_run);
  if (adopted) state->calibrated = 1;
  return {static_cast<unsigned char>(decision.event), byte_of(decision.sensors),
          static_cast<unsigned char>(decision.changed ? 1 : 0), static_cast<unsigned char>(adopted ? 1 : 0),
          static_cast<unsigned char>(decision.from_motion ? 1 : 0)};
}

const char* plumb_model_mode_name(unsigned char mode) { return to_string(static_cast<Mode>(mode)); }
const char* plumb_model_event_name(unsigned char event) { return to_string(static_cast<HealthEvent>(event)); }
