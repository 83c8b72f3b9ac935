/// A breadth-first search over the same closed loop as model/lockstep.pml: the compiled decision layer behind
/// model/shim.h, in an environment written a second time, in C++ and without the model's shortcuts (every subset of
/// sensors is tried, not one of each kind). It counts what the model checker must have stored.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <deque>
#include <functional>
#include <map>
#include <string>
#include <unordered_set>
#include <utility>
#include <vector>

#include "model/units.hpp"
#include "shim.h"

namespace plumb_model {

enum Mode : std::uint8_t { nominal, isolated, suspect, degraded, recalibrating, initial, failed };
enum Event : std::uint8_t {
  reset,
  channel_lost,
  channel_back,
  exclusion,
  provisional_exclusion,
  isolation_timeout,
  no_consistent_hypothesis,
  alarm,
  norm_mismatch,
  fit_accepted,
  fit_rejected,
  probation_passed,
  recalibrate,
  passed_block,
  none
};
enum class Block : std::uint8_t { sample, no_evidence, clean, soft, alarming, off_gravity };
enum Doubt : std::uint8_t { other, of_gravity, none_alive };

inline unsigned bit(Event e) { return 1U << e; }

struct Limits {
  int stations, isolation_timeout, probation, forget, passed_blocks;
};

/// All that is kept from step to step: the machine in the library's hands, and the evidence on record.
struct World {
  plumb_model_state machine{};
  Set ever = 0, suspected = 0, probation = 0;
  std::uint8_t open = 0, standing = 0, agree = 0, doubt = 0, most = 0, clean_stations = 0, probation_stations = 0;
  std::uint8_t pending = 0, suspicion = other, fit = 0, alarmed = 0;
};
static_assert(sizeof(World) == sizeof(plumb_model_state) + 14, "no padding: states are compared by their bytes");

class Search {
 public:
  Search(Units units, Limits limits)
      : units_(std::move(units)),
        n_(units_.sensors()),
        all_(static_cast<Set>((1U << n_) - 1U)),
        limits_(limits),
        all_of_it_(!units_.chips()) {
    for (int i = 0; i < n_; ++i) unit_of_[static_cast<std::size_t>(i)] = units_.unit_of(i);
  }

  std::uint64_t states() const { return seen_.size(); }
  std::uint64_t steps() const { return steps_; }

  void run() {
    for (const bool calibrated : {true, false}) {
      if (!calibrated && !all_of_it_) continue;
      World w;
      w.machine.mode = calibrated ? suspect : initial;
      w.machine.base = suspect;
      w.machine.in_service = all_;
      w.machine.not_yet_validated = 1;
      w.machine.calibrated = calibrated ? 1 : 0;
      meet(w);
    }
    while (!frontier_.empty()) {
      const World w = frontier_.front();
      frontier_.pop_front();
      between_blocks(w);
      for (const Block kind : {Block::no_evidence, Block::clean, Block::soft, Block::alarming, Block::off_gravity})
        end_of_block(w, kind);
    }
  }

 private:
  /// A step under construction: the world as the records have it, and what the machine will be told.
  struct Step {
    World w;
    plumb_model_input in{};
    Block kind = Block::sample;
  };

  // --- words of the specification ------------------------------------------------------------------------------
  static Set monitored(const World& w) { return w.machine.in_service | w.machine.provisionally_excluded; }
  static bool publishes(int mode) { return mode == nominal || mode == isolated || mode == degraded; }
  static bool collects(const World& w) { return w.machine.mode == recalibrating || w.machine.mode == initial; }
  static bool records(const World& w) { return w.machine.mode != failed && w.machine.mode != initial; }
  static bool accuses(const World& w) { return w.machine.mode <= suspect || w.machine.mode == recalibrating; }
  int healthy_throughout(const World& w) const { return units_.of(monitored(w) & ~w.ever); }
  int flat(const World& w) const { return units_.flat(monitored(w)); }
  static bool expected(const World& w, Doubt what) {
    return w.machine.mode == recalibrating && w.machine.base == suspect && w.suspicion == what;
  }
  static Set touched(const World& w) { return w.ever | w.machine.excluded | w.machine.absent | w.machine.readmitted; }
  int most_faults() const { return units_.of(all_) - 1 - units_.flat(all_); }
  bool bearable(const World& w, Set silent) const {
    const int in_all = units_.of(touched(w) | silent);
    return n_ == 6 || units_.chips() ? count(w.machine.absent | silent) <= 1 && in_all <= most_faults()
                                     : in_all <= most_faults() + 1;
  }
  bool answerable(const World& w) const {
    return w.suspected != 0 && units_.of(monitored(w)) >= flat(w) + 2 &&
           units_.of(monitored(w) & ~w.suspected) >= flat(w) + 1;
  }
  int needed(const World& w) const {
    return count(monitored(w) & ~w.suspected) <= 3 ? std::max(2, limits_.stations) : limits_.stations;
  }
  bool may_recalibrate(const World& w) const {
    const plumb_model_state& m = w.machine;
    if (!all_of_it_ || m.provisionally_excluded != 0) return false;
    if (publishes(m.mode)) return !w.open && !m.not_yet_validated;
    return m.mode == suspect && count(m.in_service) > 3 &&
           (w.suspicion == none_alive || (w.suspicion == of_gravity && !w.open));
  }

  template <class Use>
  static void subsets(Set of, Use&& use) {
    for (unsigned s = of;; s = (s - 1) & of) {
      use(static_cast<Set>(s));
      if (s == 0) return;
    }
  }
  /// The same, of every unit all that is in `of` or nothing.
  template <class Use>
  void whole_subsets(Set of, Use&& use) const {
    if (!units_.chips()) return subsets(of, use);
    const std::vector<Set> parts = units_.parts(of);
    for (unsigned chosen = 0; chosen < 1U << parts.size(); ++chosen) {
      unsigned set = 0;
      for (std::size_t k = 0; k < parts.size(); ++k) set |= ((chosen >> k) & 1U) != 0 ? parts[k] : 0U;
      use(static_cast<Set>(set));
    }
  }
  /// Runs `next` as it stands, and again with the change, where that is possible.
  template <class Next>
  static void with_and_without(Step s, bool possible, const std::function<void(Step&)>& change, Next&& next) {
    next(s);
    if (!possible) return;
    change(s);
    next(s);
  }

  // --- between blocks ------------------------------------------------------------------------------------------
  void between_blocks(const World& w) {
    Step s;
    s.w = w;
    const auto raise = [&](Event e) {
      Step t = s;
      t.in.raised = bit(e);
      return t;
    };
    take(s);
    subsets(all_ & ~w.machine.absent, [&](Set lost) {
      if (lost == 0 || !bearable(w, lost)) return;
      Step t = raise(channel_lost);
      t.in.lost = lost;
      take(t);
    });
    subsets(w.machine.absent, [&](Set back) {
      if (back == 0) return;
      Step t = raise(channel_back);
      t.in.back = back;
      take(t);
    });
    subsets(all_, [&](Set named) {
      if (w.machine.mode != failed && named != all_) return;
      Step t = raise(reset);
      t.in.reset = named;
      take(t);
    });
    if (w.open && records(w)) onset(s, [&](const Step& t) { take(t); });
    if (may_recalibrate(w)) take(raise(recalibrate));
    if (collects(w)) {
      if (w.fit) take(raise(fit_accepted));
      take(raise(fit_rejected));
    }
  }

  template <class Next>
  void onset(const Step& s, Next&& next) {
    whole_subsets(monitored(s.w) & ~s.w.ever, [&](Set wrong) {
      Step t = s;
      const bool bounded = healthy_throughout(s.w) - units_.of(wrong) >= flat(s.w) + 1 &&
                           units_.of(touched(s.w) | wrong) <= most_faults();
      if (bounded) t.w.ever |= wrong;
      next(t);
    });
  }

  // --- a block -------------------------------------------------------------------------------------------------
  void end_of_block(const World& w, Block kind) {
    Step s;
    s.w = w;
    s.kind = kind;
    if (kind == Block::no_evidence) return motion(s);
    attitude(s);
    if (!all_of_it_) return;
    for (int i = 0; i < n_; ++i) {
      const Set one = static_cast<Set>(1U << i);
      if ((w.machine.absent & one) != 0 || !bearable(w, one)) continue;
      Step t = s;
      t.in.lost = one;
      t.in.raised = bit(channel_lost);
      evidence(t, false);
    }
    if (w.machine.absent != 0) {
      Step t = s;
      t.in.back = w.machine.absent;
      t.in.raised = bit(channel_back);
      evidence(t, false);
    }
  }
  /// A block in motion: nothing, or whatever a monitor in motion may say, of whomever.
  void motion(const Step& s) {
    take(s);
    whole_subsets(s.w.machine.in_service, [&](Set away) {
      Step t = s;
      t.in.from_motion = (1U << none) - 1U;
      if (away == 0) t.in.from_motion &= ~bit(provisional_exclusion);
      t.in.suspected = away;
      t.in.isolated = s.w.machine.in_service;
      take(t);
    });
  }
  void attitude(const Step& s) {
    evidence(s, true);
    evidence(s, false);
  }

  void evidence(const Step& s, bool excited) {
    const bool may_open = records(s.w) && !s.w.open;
    const bool agree = s.kind == Block::clean || s.kind == Block::soft;
    if (may_open && (s.kind == Block::alarming || (agree && s.w.machine.provisionally_excluded != 0))) {
      Step t = s;
      t.w.open = 1;
      onset(t, [&](const Step& u) { prove(u, excited); });
    }
    if (!may_open || s.kind != Block::alarming) prove(s, excited);
  }
  void prove(const Step& s, bool excited) {
    const bool may = s.kind == Block::clean && s.w.machine.not_yet_validated && excited &&
                     s.w.machine.clean_run + 1 >= limits_.passed_blocks;
    ballot(s, excited, false);
    if (may) ballot(s, excited, true);
  }

  void ballot(const Step& s, bool excited, bool proves) {
    const bool channel = (s.in.lost | s.in.back) != 0;
    if (!(s.w.open && records(s.w)) || s.kind == Block::off_gravity || channel) return contradict(s, excited, proves);
    const bool sound = units_.of(monitored(s.w)) >= flat(s.w) + 2 && healthy_throughout(s.w) >= flat(s.w) + 1;
    const Set accusable = sound ? static_cast<Set>(monitored(s.w) & s.w.ever & ~s.w.suspected) : Set{0};
    whole_subsets(accusable, [&](Set grown) {
      Step t = s;
      if (grown != 0 && units_.of(monitored(s.w) & ~(s.w.suspected | grown)) >= flat(s.w) + 1) {
        t.w.suspected |= grown;
        t.w.standing = t.w.agree = 0;
      }
      for (const bool stands : {false, true}) {
        Step u = t;
        if (!answerable(u.w) && stands) continue;
        if (!stands || !u.w.standing) u.w.agree = 0;
        u.w.standing = stands ? 1 : 0;
        contradict(u, excited, proves);
        if (stands && u.w.agree < needed(u.w)) {
          ++u.w.agree;
          contradict(u, excited, proves);
        }
      }
    });
  }

  void contradict(const Step& s, bool excited, bool proves) {
    count_blocks(s, excited, proves, false);
    if (s.kind == Block::alarming && units_.of(monitored(s.w)) >= flat(s.w) + 2 && !s.w.standing)
      count_blocks(s, excited, proves, true);
  }

  void count_blocks(const Step& s, bool excited, bool proves, bool nothing_alive) {
    Step t = s;
    World& w = t.w;
    plumb_model_state& m = w.machine;
    const int suspected = units_.of((w.standing ? w.suspected : 0U) | m.provisionally_excluded);
    if (records(w) && suspected > w.most) {
      w.most = static_cast<std::uint8_t>(suspected);
      w.doubt = 0;
    }
    const bool in_doubt = (t.kind == Block::alarming && !(nothing_alive && expected(w, none_alive))) ||
                          (t.kind == Block::soft && m.mode == suspect);
    if (records(w) && in_doubt && excited && w.doubt < limits_.isolation_timeout) ++w.doubt;
    if (t.kind != Block::clean) {
      m.clean_run = 0;
      if (t.kind != Block::soft || m.mode == suspect) w.clean_stations = 0;
      if (t.kind != Block::soft) w.probation = w.probation_stations = 0;
      return raise(t, nothing_alive);
    }
    if (m.clean_run < limits_.passed_blocks) ++m.clean_run;
    if (proves) m.not_yet_validated = 0;
    const bool on_record = w.open || w.doubt > 0;
    if (on_record && excited) {
      if (m.provisionally_excluded != 0) probe(t, excited);  // those set aside do not agree
      if (++w.clean_stations == limits_.forget) {
        w.open = w.suspected = w.standing = w.agree = w.doubt = w.most = w.clean_stations = w.ever = 0;
        m.timed_out = 0;
      }
    }
    probe(t, excited);
  }

  void probe(const Step& s, bool excited) {
    const plumb_model_state& m = s.w.machine;
    if (s.w.open || m.not_yet_validated || !records(s.w) || m.mode == suspect || (n_ == 6 && all_of_it_))
      return raise(s, false);
    // A unit is asked with all that is out of it, unless some of that has returned once.
    unsigned asked = 0;
    for (const Set part : units_.parts((m.excluded | m.provisionally_excluded) & ~m.absent)) {
      if ((part & m.readmitted) == 0) asked |= part;
    }
    whole_subsets(static_cast<Set>(asked), [&](Set fine) {
      Step t = s;
      World& w = t.w;
      if ((w.probation & fine) != 0) {
        w.probation &= fine;
      } else {
        w.probation = fine;
        w.probation_stations = 0;
      }
      if (w.probation != 0 && excited && w.probation_stations < limits_.probation) ++w.probation_stations;
      raise(t, false);
    });
  }

  void raise(const Step& s, bool nothing_alive) {
    Step t = s;
    World& w = t.w;
    if (accuses(w) && w.open && w.standing && w.agree >= needed(w)) {
      t.in.isolated = w.suspected;
      t.in.raised |= bit(exclusion);
    }
    if (t.kind == Block::alarming) {
      if (!nothing_alive) t.in.raised |= bit(alarm);
      if (nothing_alive && !expected(w, none_alive)) t.in.raised |= bit(no_consistent_hypothesis);
    }
    if (t.kind == Block::off_gravity && !expected(w, of_gravity)) t.in.raised |= bit(norm_mismatch);
    if (t.kind == Block::clean) {
      t.in.raised |= bit(passed_block);
      if (collects(w)) w.fit = 1;
    }
    if (w.probation != 0 && w.probation_stations == limits_.probation) {
      t.in.proven = w.probation;
      t.in.raised |= bit(probation_passed);
    }
    if (limits_.probation == 1) w.probation = w.probation_stations = 0;
    accuse_by_parity(t, nothing_alive);
  }

  void accuse_by_parity(const Step& s, bool nothing_alive) {
    const plumb_model_state& m = s.w.machine;
    const bool channel = (s.in.lost | s.in.back) != 0;
    count_isolation_timeout(s);
    if (!(accuses(s.w) && s.w.open && s.kind == Block::alarming && units_.of(monitored(s.w)) >= flat(s.w) + 3) ||
        nothing_alive || channel)
      return;
    const bool sound = healthy_throughout(s.w) >= flat(s.w) + 2;
    const Set accusable = sound ? static_cast<Set>(m.in_service & s.w.ever) : Set{m.in_service};
    whole_subsets(accusable, [&](Set aside) {
      if (aside == 0 || count(m.in_service & ~aside) < 3) return;
      Step t = s;
      t.in.suspected = aside;
      t.in.raised |= bit(provisional_exclusion);
      count_isolation_timeout(t);
    });
  }

  void count_isolation_timeout(const Step& s) {
    const int mode = s.w.machine.mode;
    if (s.kind == Block::off_gravity || s.w.doubt < limits_.isolation_timeout ||
        !(mode == suspect || mode == recalibrating))
      return conclude(s);
    for (const bool within : {false, true}) {
      Step t = s;
      t.in.protection_within = within ? 1 : 0;
      if (!s.w.machine.timed_out || !within) t.in.raised |= bit(isolation_timeout);
      conclude(t);
    }
  }

  /// Outcome of a fit, request and freeze.
  void conclude(const Step& s) {
    const auto freeze = [&](const Step& t) {
      take(t);
      if (!all_of_it_) return;
      Step u = t;
      u.in.raised &=
          ~(bit(exclusion) | bit(provisional_exclusion) | bit(probation_passed) | bit(recalibrate) | bit(fit_accepted));
      if (u.in.raised != t.in.raised) take(u);
    };
    const auto ask = [&](const Step& t) {
      freeze(t);
      if (!may_recalibrate(t.w) || t.kind != Block::clean) return;
      Step u = t;
      u.in.raised |= bit(recalibrate);
      freeze(u);
    };
    ask(s);
    if (!collects(s.w)) return;
    for (const Event outcome : {fit_accepted, fit_rejected}) {
      if (outcome == fit_accepted && !s.w.fit) continue;
      Step t = s;
      t.in.raised |= bit(outcome);
      ask(t);
    }
  }

  // --- the step itself, by the library -------------------------------------------------------------------------
  void take(Step s) {
    ++steps_;
    World& w = s.w;
    const plumb_model_state before = w.machine;
    const Set posed_before = monitored(w);
    s.in.raised |= static_cast<unsigned>(w.pending) << no_consistent_hypothesis;
    s.in.passed_blocks = static_cast<unsigned char>(limits_.passed_blocks);
    s.in.sensors = static_cast<unsigned char>(n_);
    std::memcpy(s.in.unit, unit_of_.data(), unit_of_.size());
    constexpr unsigned kKept = 1U << no_consistent_hypothesis | 1U << alarm | 1U << norm_mismatch;
    if (before.mode == recalibrating && (s.in.raised & kKept) != 0) s.in.raised &= ~bit(isolation_timeout);
    if ((s.in.raised & kKept) != 0) w.alarmed = collects(w) ? 1 : 0;
    const plumb_model_answer answer = plumb_model_step(&w.machine, &s.in);
    const int event = answer.event;
    const bool taken = event != none;
    const bool forgets = taken && (event == exclusion || event == reset || answer.adopted) &&
                         (event != exclusion || before.mode != failed);
    const Set now_posed = monitored(w);
    if (forgets) {
      w.open = w.suspected = w.standing = w.agree = w.doubt = w.most = w.clean_stations = 0;
    } else if (now_posed != posed_before) {
      w.standing = w.agree = 0;
      w.suspected = (now_posed & ~posed_before) != 0 ? Set{0} : static_cast<Set>(w.suspected & now_posed);
    }
    if (event == probation_passed || answer.adopted) w.probation = w.probation_stations = 0;
    if (event == channel_lost) {
      w.probation &= static_cast<Set>(~answer.moved);
      if (w.probation == 0) w.probation_stations = 0;
    }
    const bool collected = before.mode == recalibrating || before.mode == initial;
    const bool still = collects(w) && collected;
    const bool spoken_against = event == channel_lost || event == exclusion || event == provisional_exclusion ||
                                event == isolation_timeout || event == no_consistent_hypothesis || event == alarm ||
                                event == norm_mismatch;
    const bool ended = (collected && spoken_against) || !still;
    if (ended || before.in_service != w.machine.in_service) w.fit = 0;
    if (ended) w.alarmed = 0;
    switch (answer.from_motion != 0 ? int{none} : event) {
      case norm_mismatch: w.suspicion = of_gravity; break;
      case no_consistent_hypothesis: w.suspicion = none_alive; break;
      case alarm:
      case provisional_exclusion:
      case channel_lost:
      case fit_accepted:
      case exclusion: w.suspicion = other; break;
      default: break;
    }
    const int mode = w.machine.mode;
    if (!all_of_it_ || (mode != suspect && mode != recalibrating)) {
      w.suspicion = other;
    }
    if (mode != recalibrating) w.machine.base = suspect;
    w.pending =
        event <= channel_back ? static_cast<std::uint8_t>((s.in.raised & kKept) >> no_consistent_hypothesis) : 0;
    w.ever = w.open ? static_cast<Set>(w.ever & now_posed) : Set{0};
    meet(w);
  }

  // --- states seen: sensors in a standard order -----------------------------------------------------------------
  void meet(World w) {
    plumb_model_state& m = w.machine;
    const std::array<unsigned char*, 8> sets = {
        &m.in_service, &m.provisionally_excluded, &m.excluded, &m.absent, &m.readmitted, &w.ever, &w.suspected,
        &w.probation};
    std::array<unsigned, 8> columns{};
    for (int i = 0; i < n_; ++i) {
      for (std::size_t k = 0; k < sets.size(); ++k) columns[static_cast<std::size_t>(i)] |= ((*sets[k] >> i) & 1U) << k;
    }
    in_order(columns);
    for (std::size_t k = 0; k < sets.size(); ++k) {
      unsigned set = 0;
      for (int i = 0; i < n_; ++i) set |= ((columns[static_cast<std::size_t>(i)] >> k) & 1U) << i;
      *sets[k] = static_cast<unsigned char>(set);
    }
    std::string bytes(sizeof w, '\0');
    std::memcpy(&bytes[0], &w, sizeof w);
    if (seen_.insert(bytes).second) frontier_.push_back(w);
  }

  /// The axes of a chip in order, then the units of each size.
  void in_order(std::array<unsigned, 8>& columns) const {
    if (!units_.chips()) {
      std::sort(columns.begin(), columns.begin() + n_);
      return;
    }
    std::map<int, std::vector<std::vector<unsigned>>> by_size;
    auto at = columns.begin();
    for (const int size : units_.sizes()) {
      std::vector<unsigned> unit(at, at + size);
      std::sort(unit.begin(), unit.end());
      by_size[size].push_back(unit);
      at += size;
    }
    std::map<int, std::size_t> used;
    for (auto& of_a_size : by_size) std::sort(of_a_size.second.begin(), of_a_size.second.end());
    at = columns.begin();
    for (const int size : units_.sizes()) {
      const std::vector<unsigned>& unit = by_size[size][used[size]++];
      at = std::copy(unit.begin(), unit.end(), at);
    }
  }

  Units units_;
  std::array<unsigned char, 8> unit_of_{};
  int n_;
  Set all_;
  Limits limits_;
  bool all_of_it_;  ///< fits, freezes, two events at a time: in arrays without chips
  std::unordered_set<std::string> seen_;
  std::deque<World> frontier_;
  std::uint64_t steps_ = 0;
};

}  // namespace plumb_model
