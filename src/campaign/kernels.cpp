// The kernels that this program has, one per capacity.
#include "plumb/campaign/kernel.hpp"
#include "plumb/scenario/count_text.hpp"

#include <algorithm>

#include "../session/builds.hpp"

#define PLUMB_DECLARE_KERNEL(ABI, CAPACITY, WINDOW)                                         \
  namespace plumb {                                                                         \
  namespace ABI {                                                                           \
  namespace campaign_kernel {                                                               \
  std::unique_ptr<campaign::Kernel> make(const campaign::Plan& plan, std::string& refusal); \
  }                                                                                         \
  }                                                                                         \
  }
PLUMB_FOR_EACH_BUILD(PLUMB_DECLARE_KERNEL)
#undef PLUMB_DECLARE_KERNEL

namespace plumb {
namespace campaign {
namespace {

using Make = std::unique_ptr<Kernel> (*)(const Plan& plan, std::string& refusal);
using Build = stepping::Build<Make>;

const std::vector<Build>& builds() {
#define PLUMB_KERNEL(ABI, CAPACITY, WINDOW) {CAPACITY, WINDOW, ABI::campaign_kernel::make},
  static const std::vector<Build> all = {PLUMB_FOR_EACH_BUILD(PLUMB_KERNEL)};
#undef PLUMB_KERNEL
  return all;
}

/// Every tool with the smallest monitor that holds it.
class Choice final : public Kernel {
 public:
  explicit Choice(std::size_t tools) : of_tool_(tools, nullptr) {}

  Kernel* with(std::unique_ptr<Kernel> kernel) {
    kernels_.push_back(std::move(kernel));
    return kernels_.back().get();
  }
  void assign(std::size_t tool, Kernel* kernel) { of_tool_[tool] = kernel; }

  void play(const Spec& spec, Outcome& outcome) noexcept override {
    of_tool_[static_cast<std::size_t>(spec.tool)]->play(spec, outcome);
  }
  int capacity() const noexcept override {
    int most = 0;
    for (const auto& kernel : kernels_) most = std::max(most, kernel->capacity());
    return most;
  }

 private:
  std::vector<std::unique_ptr<Kernel>> kernels_;
  std::vector<Kernel*> of_tool_;
};

}  // namespace

const std::vector<int>& kernel_capacities() {
  static const std::vector<int> all = stepping::capacities_of(builds());
  return all;
}

tl::expected<std::unique_ptr<Kernel>, std::string> make_kernel(const Plan& plan, int least_capacity) {
  auto choice = std::make_unique<Choice>(plan.tools.size());
  std::vector<bool> served(plan.tools.size(), false);
  for (const Build& build : builds()) {
    if (!build.holds(least_capacity, plan.window)) continue;
    // A kernel knows its own tools only; the others are taken out of its plan by emptying them.
    Plan part = plan;
    std::vector<std::size_t> mine;
    for (std::size_t t = 0; t < plan.tools.size(); ++t) {
      part.tools[t].sensors = 0;
      if (served[t] || plan.tools[t].sensors > build.capacity) continue;
      part.tools[t] = plan.tools[t];
      served[t] = true;
      mine.push_back(t);
    }
    if (mine.empty()) continue;
    std::string refusal;
    std::unique_ptr<Kernel> made = build.make(part, refusal);
    if (!made) return tl::unexpected<std::string>(refusal);
    Kernel* kernel = choice->with(std::move(made));
    for (const std::size_t t : mine) choice->assign(t, kernel);
  }
  for (std::size_t t = 0; t < plan.tools.size(); ++t) {
    if (!served[t]) {
      return tl::unexpected<std::string>("no monitor of this program is large enough for tool " + plan.tools[t].name +
                                         " with a window of " + count_text(plan.window, "sample") +
                                         ". Remedy: use at most 24 sensors and a window of at most 256 samples");
    }
  }
  return choice;
}

}  // namespace campaign
}  // namespace plumb
