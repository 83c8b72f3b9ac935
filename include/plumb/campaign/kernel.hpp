/// The inner loop of a campaign: generates a scenario, steps a monitor through it and judges what it published, in one
/// pass and without allocation. Built once per capacity; `make_kernel` takes the smallest that fits.
#pragma once

#include <memory>
#include <string>
#include <tl/expected.hpp>

#include "plumb/campaign/outcome.hpp"
#include "plumb/campaign/plan.hpp"

namespace plumb {
namespace campaign {

class Kernel {
 public:
  Kernel() = default;
  Kernel(const Kernel&) = delete;
  Kernel& operator=(const Kernel&) = delete;
  virtual ~Kernel() = default;

  /// The same spec gives the same outcome, whatever was played before.
  virtual void play(const Spec& spec, Outcome& outcome) noexcept = 0;
  virtual int capacity() const noexcept = 0;
};

/// Refuses, with a remedy, a plan whose monitors cannot be configured or do not validate healthy sensors.
/// `least_capacity` asks for a larger build than needed: what is played must not depend on it.
tl::expected<std::unique_ptr<Kernel>, std::string> make_kernel(const Plan& plan, int least_capacity = 0);

/// Capacities that this program was built with, in rising order.
const std::vector<int>& kernel_capacities();

}  // namespace campaign
}  // namespace plumb
