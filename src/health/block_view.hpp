/// What the evidence of one block said: shared by the files that judge it and that keep it on record.
#pragma once

#include "plumb/health/health_monitor.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

/// What a quiet block said about the sensors in service.
struct HealthMonitor::BlockView {
  enum class Kind : std::uint8_t { none, clean, soft, alarm, reference };
  SetTest used;
  Kind kind = Kind::none;
  Cause cause = Cause::none;
  Cause decided_by = Cause::none;
  double parity_ratio = 0.0, norm_ratio = 0.0, mae_ratio = 0.0;
  double mae_worst_mps2 = 0.0, mae_limit_mps2 = 0.0;
  TripleSet triples_tested, triples_passed;
  bool mae_clean = true;  ///< all voting triples below clear_fraction of their noise limit, systematic part on top
  double statistic = 0.0, limit = 0.0;

  /// An alarm, or in suspect a block that is not clean enough to end it.
  bool doubtful(Mode mode) const noexcept {
    return kind == Kind::alarm || (kind == Kind::soft && mode == Mode::suspect);
  }
};

}  // namespace PLUMB_ABI
}  // namespace plumb
