#include "dispatch_rival.hpp"

// Boost 1.74 as Debian has it: vectors of more than 20 rows need these, and it remarks on its own use of Boost.Bind.
#define BOOST_BIND_GLOBAL_PLACEHOLDERS
#define BOOST_MPL_CFG_NO_PREPROCESSED_HEADERS
#define BOOST_MPL_LIMIT_LIST_SIZE 50
#define BOOST_MPL_LIMIT_VECTOR_SIZE 50
#include <boost/mpl/vector.hpp>
#include <boost/msm/back/state_machine.hpp>
#include <boost/msm/front/functor_row.hpp>
#include <boost/msm/front/state_machine_def.hpp>

namespace plumb_bench {
inline namespace PLUMB_ABI {
namespace {

namespace msm = boost::msm;
using msm::front::none;
using plumb::HealthEvent;
using plumb::Mode;

template <HealthEvent E>
struct On {};
template <Mode M>
struct In : msm::front::state<> {};

/// A row with its target from plumb's own table, so that the two machines cannot differ.
template <Mode From, HealthEvent E>
using Row = msm::front::Row<In<From>, On<E>,
                            In<plumb::resolve(From, plumb::cell_of(From, E).target, facts_at(From, E))>, none, none>;

struct Front : msm::front::state_machine_def<Front> {
  using initial_state = In<Mode::initial>;
  using M = Mode;
  using E = HealthEvent;
  // The cells that lead somewhere. The cells that stay are left out, which is what MSM does fastest.
  // clang-format off
  struct transition_table : boost::mpl::vector<
      Row<M::nominal, E::channel_lost>, Row<M::nominal, E::exclusion>, Row<M::nominal, E::provisional_exclusion>,
      Row<M::nominal, E::no_consistent_hypothesis>, Row<M::nominal, E::alarm>, Row<M::nominal, E::norm_mismatch>,
      Row<M::nominal, E::probation_passed>, Row<M::nominal, E::recalibrate>,
      Row<M::isolated, E::channel_lost>, Row<M::isolated, E::exclusion>, Row<M::isolated, E::provisional_exclusion>,
      Row<M::isolated, E::no_consistent_hypothesis>, Row<M::isolated, E::alarm>, Row<M::isolated, E::norm_mismatch>,
      Row<M::isolated, E::probation_passed>, Row<M::isolated, E::recalibrate>,
      Row<M::suspect, E::exclusion>, Row<M::suspect, E::isolation_timeout>, Row<M::suspect, E::recalibrate>,
      Row<M::suspect, E::passed_block>,
      Row<M::degraded, E::channel_lost>, Row<M::degraded, E::no_consistent_hypothesis>, Row<M::degraded, E::alarm>,
      Row<M::degraded, E::norm_mismatch>, Row<M::degraded, E::probation_passed>, Row<M::degraded, E::recalibrate>,
      Row<M::recalibrating, E::channel_lost>, Row<M::recalibrating, E::exclusion>, Row<M::recalibrating, E::provisional_exclusion>,
      Row<M::recalibrating, E::isolation_timeout>, Row<M::recalibrating, E::no_consistent_hypothesis>,
      Row<M::recalibrating, E::alarm>, Row<M::recalibrating, E::norm_mismatch>, Row<M::recalibrating, E::fit_accepted>,
      Row<M::recalibrating, E::fit_rejected>,
      Row<M::initial, E::fit_accepted>,
      Row<M::failed, E::reset>> {};
  // clang-format on
  template <class Fsm, class Event>
  void no_transition(const Event&, Fsm&, int) noexcept {}
};

using Machine = msm::back::state_machine<Front>;

/// MSM numbers its states as it finds them in the table.
template <Mode M>
bool is_in(const Machine& machine) {
  return machine.current_state()[0] == msm::back::get_state_id<Machine::stt, In<M>>::value;
}

template <HealthEvent E>
void process(Machine& machine) {
  machine.process_event(On<E>{});
}

void dispatch(Machine& machine, HealthEvent event) {
  using E = HealthEvent;
  switch (event) {
    case E::reset: return process<E::reset>(machine);
    case E::channel_lost: return process<E::channel_lost>(machine);
    case E::channel_back: return process<E::channel_back>(machine);
    case E::exclusion: return process<E::exclusion>(machine);
    case E::provisional_exclusion: return process<E::provisional_exclusion>(machine);
    case E::isolation_timeout: return process<E::isolation_timeout>(machine);
    case E::no_consistent_hypothesis: return process<E::no_consistent_hypothesis>(machine);
    case E::alarm: return process<E::alarm>(machine);
    case E::norm_mismatch: return process<E::norm_mismatch>(machine);
    case E::fit_accepted: return process<E::fit_accepted>(machine);
    case E::fit_rejected: return process<E::fit_rejected>(machine);
    case E::probation_passed: return process<E::probation_passed>(machine);
    case E::recalibrate: return process<E::recalibrate>(machine);
    case E::passed_block: return process<E::passed_block>(machine);
    case E::none: return process<E::none>(machine);
  }
}

}  // namespace

struct MsmMachine::Engine {
  Machine machine;
};

MsmMachine::MsmMachine() : engine_(new Engine) { engine_->machine.start(); }
MsmMachine::~MsmMachine() { delete engine_; }
std::size_t MsmMachine::size() noexcept { return sizeof(Machine); }

Mode MsmMachine::run(const HealthEvent* events, std::size_t count) {
  for (std::size_t k = 0; k < count; ++k) dispatch(engine_->machine, events[k]);
  const Machine& m = engine_->machine;
  if (is_in<Mode::nominal>(m)) return Mode::nominal;
  if (is_in<Mode::isolated>(m)) return Mode::isolated;
  if (is_in<Mode::suspect>(m)) return Mode::suspect;
  if (is_in<Mode::degraded>(m)) return Mode::degraded;
  if (is_in<Mode::recalibrating>(m)) return Mode::recalibrating;
  return is_in<Mode::initial>(m) ? Mode::initial : Mode::failed;
}

}  // namespace PLUMB_ABI
}  // namespace plumb_bench
