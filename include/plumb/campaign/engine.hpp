/// Runs a campaign in batches over threads, and over ranks where there are several.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <tl/expected.hpp>

#include "plumb/campaign/tally.hpp"

namespace plumb {
namespace campaign {

/// How ranks agree. Of a single process there is nothing to agree on.
class Ranks {
 public:
  Ranks() = default;
  Ranks(const Ranks&) = delete;
  Ranks& operator=(const Ranks&) = delete;
  virtual ~Ranks() = default;
  virtual int rank() const noexcept { return 0; }
  virtual int size() const noexcept { return 1; }
  /// Every rank gets the numbers of all: sums added, maxima and smallest taken.
  virtual void unite(Tally::Numbers&) {}
  /// True on every rank where it was on any.
  virtual bool any(bool mine) { return mine; }
};

struct RunOptions {
  int threads = 1;
  int least_capacity = 0;           ///< of the monitors; 0 = the smallest that fit
  std::uint64_t batch = 1U << 15U;  ///< scenarios between two looks at `stop`; does not show in the result
};

/// How far a campaign is. Scenarios 0 .. done - 1 are counted.
struct Progress {
  std::uint64_t done = 0;
  Tally tally;
};

/// Plays on from `progress` to the end of the plan, or until `stop` says so; after every batch `report` sees how far it
/// is (on rank 0 alone) and may refuse to go on with a text. Errors: those of `make_kernel`, and that of `report`.
tl::expected<void, std::string> run(const Plan& plan, const RunOptions& options, Ranks& ranks, Progress& progress,
                                    const std::function<bool()>& stop,
                                    const std::function<std::string(const Progress&)>& report);

}  // namespace campaign
}  // namespace plumb
