/// Many flights side by side, and shares of them.
#pragma once

#include <atomic>
#include <cstdint>
#include <string>
#include <thread>
#include <vector>

#include "plumb/study/proportion.hpp"

namespace plumb_bench {

/// "84.6 [82.6, 86.4]": k of n in per cent, with its interval.
inline std::string share(std::uint64_t k, std::uint64_t n) {
  const plumb::study::Proportion p = plumb::study::proportion(k, n);
  return plumb::study::rounded_share(p, 3, 100.0) + " " + plumb::study::interval_text(p, 3, 100.0);
}

/// What `run` answers for `first`, `first + 1`, ...: one number per flight, from which it draws all that happens. The
/// order of the answers is that of the numbers, whatever ended first.
template <class Run>
auto run_all(std::uint64_t flights, unsigned jobs, std::uint64_t first, Run run) {
  std::vector<decltype(run(first))> out(flights);
  std::atomic<std::uint64_t> next{0};
  std::vector<std::thread> threads;
  for (unsigned j = 0; j < jobs; ++j) {
    threads.emplace_back([&] {
      for (std::uint64_t k = next++; k < flights; k = next++) out[k] = run(first + k);
    });
  }
  for (std::thread& t : threads) t.join();
  return out;
}

}  // namespace plumb_bench
