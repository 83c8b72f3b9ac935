#include "plumb/campaign/engine.hpp"

#include <algorithm>
#include <atomic>
#include <memory>
#include <thread>
#include <vector>

#include "plumb/campaign/kernel.hpp"

namespace plumb {
namespace campaign {
namespace {

/// Scenarios that a thread takes at once: few enough that all end together, many enough that taking costs nothing.
constexpr std::uint64_t kSlice = 64;

/// A thread's own monitors and its own counts.
struct Worker {
  std::unique_ptr<Kernel> kernel;
  Tally tally;
};

void play_slices(const Plan& plan, Worker& worker, std::atomic<std::uint64_t>& next, std::uint64_t end) {
  auto outcome = std::make_unique<Outcome>();
  for (;;) {
    const std::uint64_t first = next.fetch_add(kSlice);
    if (first >= end) return;
    for (std::uint64_t number = first; number < std::min(first + kSlice, end); ++number) {
      const Spec spec = spec_of(plan, number);
      worker.kernel->play(spec, *outcome);
      worker.tally.add(plan, spec, *outcome);
    }
  }
}

void play_batch(const Plan& plan, std::vector<Worker>& workers, std::uint64_t first, std::uint64_t end) {
  std::atomic<std::uint64_t> next{first};
  std::vector<std::thread> others;
  for (std::size_t k = 1; k < workers.size(); ++k) {
    others.emplace_back([&plan, &workers, &next, end, k] { play_slices(plan, workers[k], next, end); });
  }
  play_slices(plan, workers.front(), next, end);
  for (std::thread& other : others) other.join();
}

}  // namespace

tl::expected<void, std::string> run(const Plan& plan, const RunOptions& options, Ranks& ranks, Progress& progress,
                                    const std::function<bool()>& stop,
                                    const std::function<std::string(const Progress&)>& report) {
  std::vector<Worker> workers;
  for (int k = 0; k < std::max(options.threads, 1); ++k) {
    auto kernel = make_kernel(plan, options.least_capacity);
    if (!kernel) return tl::unexpected<std::string>(kernel.error());
    workers.push_back({std::move(*kernel), Tally(plan)});
  }
  const auto size = static_cast<std::uint64_t>(ranks.size()), rank = static_cast<std::uint64_t>(ranks.rank());
  while (progress.done < plan.scenarios && !ranks.any(stop())) {
    const std::uint64_t batch = std::min(std::max<std::uint64_t>(options.batch, 1), plan.scenarios - progress.done);
    const std::uint64_t begin = progress.done;
    play_batch(plan, workers, begin + batch * rank / size, begin + batch * (rank + 1) / size);
    Tally mine(plan);
    for (Worker& worker : workers) {
      mine.merge(worker.tally);
      worker.tally = Tally(plan);
    }
    Tally::Numbers numbers = mine.numbers();
    ranks.unite(numbers);
    Tally all(plan);
    if (!all.take(numbers))
      return tl::unexpected<std::string>(
          "the ranks run different campaigns. Remedy: start every rank with the same file and the same plumb");
    progress.tally.merge(all);
    progress.done += batch;
    std::string refusal = rank == 0 ? report(progress) : std::string();
    if (ranks.any(!refusal.empty())) {
      return tl::unexpected<std::string>(
          refusal.empty() ? "the first rank could not write the result; its message says why" : refusal);
    }
  }
  return {};
}

}  // namespace campaign
}  // namespace plumb
