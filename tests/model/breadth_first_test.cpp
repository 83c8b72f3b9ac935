// The states of the lock-step model, counted a second time: model/check.sh holds spin's count against the same file.
#include <gtest/gtest.h>

#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "breadth_first.hpp"

namespace breadth_first_test {
namespace {

std::map<int, std::uint64_t> pinned() {
  std::map<int, std::uint64_t> counts;
  std::ifstream file(std::string(PLUMB_SOURCE_DIR) + "/model/states.txt");
  std::string line;
  while (std::getline(file, line)) {
    if (line.empty() || line[0] == '#') continue;
    std::istringstream in(line);
    int array = 0;
    std::uint64_t states = 0;
    in >> array >> states;
    counts[array] = states;
  }
  return counts;
}

/// The sizes of the units: 2111 is a chip of two axes and three single sensors, 4 to 6 are single sensors alone.
std::vector<int> sizes_of(int array) {
  if (array <= 6) return std::vector<int>(static_cast<std::size_t>(array), 1);
  std::vector<int> out;
  for (const char digit : std::to_string(array)) out.push_back(digit - '0');
  return out;
}

class BreadthFirst : public testing::TestWithParam<int> {};

TEST_P(BreadthFirst, ReachesAsManyStatesAsTheModelChecker) {
  const int array = GetParam();
  const plumb_model::Limits limits =
      array == 4 ? plumb_model::Limits{2, 3, 2, 2, 2} : plumb_model::Limits{1, 2, 1, 1, 1};
  plumb_model::Search search(plumb_model::Units(sizes_of(array)), limits);
  search.run();
  std::printf("%d: %llu states, %llu steps\n", array, static_cast<unsigned long long>(search.states()),
              static_cast<unsigned long long>(search.steps()));
  const auto counts = pinned();
  ASSERT_EQ(counts.size(), 5U);
  EXPECT_EQ(search.states(), counts.at(array));
}

INSTANTIATE_TEST_SUITE_P(Model, BreadthFirst, testing::Values(4, 5, 6, 222, 2111));

}  // namespace
}  // namespace breadth_first_test
