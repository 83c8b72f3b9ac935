/// What a block says about the sensors in service: by parity, by the length, by the combination MAE of every triple.
#pragma once

#include "plumb/detection/combination_mae.hpp"
#include "plumb/detection/detail/block_tests.hpp"
#include "plumb/detection/detail/triple_set.hpp"
#include "plumb/health/detail/in_force.hpp"
#include "plumb/health/detail/settings.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

struct BlockReport {
  enum class Kind : std::uint8_t { none, clean, soft, alarm, reference };
  SetTest used;
  Kind kind = Kind::none;
  Cause cause = Cause::none;
  Cause decided_by = Cause::none;
  double parity_ratio = 0.0, norm_ratio = 0.0, mae_ratio = 0.0;
  double mae_worst_mps2 = 0.0, mae_limit_mps2 = 0.0;
  TripleSet triples_tested, triples_passed;
  bool mae_clean = true;  ///< all monitored triples below clear_fraction of their noise limit, systematic part on top
  double statistic = 0.0, limit = 0.0;

  /// An alarm, or in suspect a block that is not clean enough to end it.
  bool doubtful(Mode mode) const noexcept {
    return kind == Kind::alarm || (kind == Kind::soft && mode == Mode::suspect);
  }
};
using BlockKind = BlockReport::Kind;

/// What a block is judged by.
struct JudgeTerms {
  const Settings& settings;
  const InForce& in_force;
  const CombinationMae& mae;
  SensorSet in_service;
  bool suspect = false;  ///< then clean is a part of the limit
  bool partial = false;  ///< a sensor in service was silent or doubted: the block is not clean
};

BlockReport judge(const BlockTests& tests, const JudgeTerms& terms) noexcept;

}  // namespace PLUMB_ABI
}  // namespace plumb
