// What a target answered against what the host answered, and what its steps cost:
//   metal_judge HOST_EXACT TARGET_EXACT HOST_FIGURES TARGET_FIGURES COSTS [MEDIAN_LIMIT]
// One line per class of steps. Non-zero where a bit of the exact answers differs, a figure by more than kUnits units in
// the last place, or where the median step in `nominal` (of a flight: in motion) takes more instructions than the
// limit.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iterator>
#include <map>
#include <string>
#include <vector>

namespace {

using Words = std::vector<std::uint64_t>;

/// For limits, which come out of the C library's functions (erfc, exp, log).
constexpr std::int64_t kUnits = 2;

bool read(const char* path, Words& words) {
  std::ifstream in(path, std::ios::binary);
  const std::vector<char> bytes((std::istreambuf_iterator<char>(in)), std::istreambuf_iterator<char>());
  words.resize(bytes.size() / 8);
  if (words.empty()) return false;
  std::memcpy(words.data(), bytes.data(), words.size() * 8);
  return true;
}

/// A double's place among all doubles, so that neighbours are one apart.
std::int64_t place_of(std::uint64_t bits) {
  const auto magnitude = static_cast<std::int64_t>(bits & 0x7FFF'FFFF'FFFF'FFFFULL);
  return (bits >> 63U) != 0 ? -magnitude : magnitude;
}

/// False where more than `units` lie between the same words of both; names the first few.
bool compare(const char* what, const Words& host, const Words& target, std::int64_t units) {
  std::size_t bad = host.size() == target.size() ? 0 : 1, off = 0;
  std::int64_t most = 0;
  for (std::size_t k = 0; k < std::min(host.size(), target.size()); ++k) {
    if (host[k] == target[k]) continue;
    ++off;
    const std::int64_t apart = units > 0 ? std::llabs(place_of(host[k]) - place_of(target[k])) : 1;
    most = std::max(most, apart);
    if (apart > units && bad++ < 5) {
      std::printf("  %s, word %zu: host %016llx, target %016llx\n", what, k, static_cast<unsigned long long>(host[k]),
                  static_cast<unsigned long long>(target[k]));
    }
  }
  std::printf("  %s: %zu words on the host, %zu on the target; %zu differ", what, host.size(), target.size(), off);
  std::printf(units > 0 && off > 0 ? ", by at most %lld units in the last place\n" : "\n",
              static_cast<long long>(most));
  return bad == 0;
}

constexpr double kTicksPerInstruction = 25.6;  // 1024 ns at 25 MHz
constexpr std::uint64_t kAll = 99;             // behind every kind of step
constexpr std::uint64_t kInMotion = 6;
const char* const kStates[] = {"nominal", "suspect", "isolated", "degraded", "recalibrating", "failed", "in_motion"};
const char* const kWorks[] = {"sample", "block", "event", "fit iteration", "judgement", "block of 4", "block of 256"};

/// Returns the median of all steps in `nominal`, or in motion; 0 where there were none.
double tell_costs(const Words& costs) {
  std::map<std::pair<std::uint64_t, std::uint64_t>, std::vector<double>> classes;
  for (std::size_t k = 0; k + 5 <= costs.size(); k += 3) {
    const double ticks = static_cast<double>(costs[k + 1]) - static_cast<double>(costs[k + 2]);
    const double instructions = std::round(ticks / kTicksPerInstruction);
    classes[{costs[k] >> 8U, costs[k] & 0xFFU}].push_back(instructions);
    classes[{costs[k] >> 8U, kAll}].push_back(instructions);
  }
  std::printf("  %-14s %-14s %8s %9s %9s\n", "state before", "step", "steps", "median", "worst");
  for (auto& [key, values] : classes) {
    std::sort(values.begin(), values.end());
    const char* const state = key.first < std::size(kStates) ? kStates[key.first] : "?";
    const char* const work = key.second < std::size(kWorks) ? kWorks[key.second] : "all";
    std::printf("  %-14s %-14s %8zu %9.0f %9.0f\n", state, work, values.size(), values[values.size() / 2],
                values.back());
  }
  std::printf("  monitor object %llu B, stack touched by the whole run %llu B\n",
              static_cast<unsigned long long>(costs[costs.size() - 2]),
              static_cast<unsigned long long>(costs[costs.size() - 1]));
  auto counted = classes.find({0, kAll});
  if (counted == classes.end()) counted = classes.find({kInMotion, kAll});
  return counted == classes.end() ? 0.0 : counted->second[counted->second.size() / 2];
}

}  // namespace

int main(int argc, char** argv) {
  Words host, target, host_figures, target_figures, costs;
  if (argc < 6 || !read(argv[1], host) || !read(argv[2], target) || !read(argv[3], host_figures) ||
      !read(argv[4], target_figures) || !read(argv[5], costs)) {
    std::fputs("usage: metal_judge HOST_EXACT TARGET_EXACT HOST_FIGURES TARGET_FIGURES COSTS [MEDIAN_LIMIT]\n", stderr);
    return 2;
  }
  bool good = compare("exact", host, target, 0);
  good = compare("figures", host_figures, target_figures, kUnits) && good;
  const double median = tell_costs(costs);
  const double limit = argc > 6 ? std::atof(argv[6]) : 0.0;
  if (limit > 0.0 && !(median > 0.0 && median <= limit)) {
    std::printf("  the median step takes %.0f instructions, more than %.0f\n", median, limit);
    good = false;
  }
  return good ? 0 : 1;
}
