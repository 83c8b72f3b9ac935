// The states of the lock-step model, counted a second time: model/check.sh holds spin's count against the same file.
#include <gtest/gtest.h>

#include <fstream>
#include <map>
#include <sstream>
#include <string>

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
    int sensors = 0;
    std::uint64_t states = 0;
    in >> sensors >> states;
    counts[sensors] = states;
  }
  return counts;
}

class BreadthFirst : public testing::TestWithParam<int> {};

TEST_P(BreadthFirst, ReachesAsManyStatesAsTheModelChecker) {
  const int sensors = GetParam();
  const plumb_model::Limits limits =
      sensors == 4 ? plumb_model::Limits{2, 3, 2, 2, 2} : plumb_model::Limits{1, 2, 1, 1, 1};
  plumb_model::Search search(sensors, limits);
  search.run();
  std::printf("%d sensors: %llu states, %llu steps\n", sensors, static_cast<unsigned long long>(search.states()),
              static_cast<unsigned long long>(search.steps()));
  const auto counts = pinned();
  ASSERT_EQ(counts.size(), 3U);
  EXPECT_EQ(search.states(), counts.at(sensors));
}

INSTANTIATE_TEST_SUITE_P(Model, BreadthFirst, testing::Values(4, 5, 6));

}  // namespace
}  // namespace breadth_first_test
