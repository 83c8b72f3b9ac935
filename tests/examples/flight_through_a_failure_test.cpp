// The navigator in flight of examples/navigation: the figures that docs/navigation.md states, from the program's own
// output over several flights; and its strapdown.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <sstream>
#include <string>
#include <vector>

#include "navigation/strapdown.hpp"

namespace flight_through_a_failure_test {
namespace {

TEST(Strapdown, carriesTheForceRound) {
  Strapdown navigator;  // half a circle at 2 rad/s: a force ahead makes the velocity of a quarter circle, twice
  const int steps = 10000;
  const double half_circle_s = plumb::kPi / 2.0;
  for (int k = 0; k < steps; ++k) navigator.step({0.0, 0.0, 2.0}, {3.0, 0.0, 0.0}, half_circle_s / steps);
  EXPECT_NEAR(navigator.velocity_mps()[0], 0.0, 1e-6);
  EXPECT_NEAR(navigator.velocity_mps()[1], 3.0, 1e-6);  // 2 f / w
  EXPECT_NEAR(navigator.velocity_mps()[2], 0.0, 1e-6);
  EXPECT_NEAR(std::fabs(navigator.attitude().z()), 1.0, 1e-9);
}

TEST(Recent, isTheMeanOfTwoSamplesInTheirMiddle) {
  Recent recent;
  for (int k = 0; k < 4; ++k) recent.add(0.001 * k, {1.0 * k * k, 0.0, -1.0 * k});
  EXPECT_NEAR(recent.at(0.0015)[0], 2.5, 1e-9);  // of 1 and 4
  EXPECT_NEAR(recent.at(0.0025)[0], 6.5, 1e-9);  // of 4 and 9
  EXPECT_NEAR(recent.at(0.0025)[2], -2.5, 1e-9);
  EXPECT_NEAR(recent.at(0.002)[0], 4.0, 1e-9);
}

#ifdef PLUMB_FLIGHT_PATH

struct Row {
  double time_s = 0.0, with_mps = 0.0, allowed_mps = 0.0, without_mps = 0.0;
  std::string isolated, excluded;
};

/// The table of each of the two failures: "biased", then "dead".
std::vector<std::vector<Row>> tables(int seed) {
  std::vector<std::vector<Row>> out;
  FILE* pipe = popen((PLUMB_FLIGHT_PATH " " + std::to_string(seed)).c_str(), "r");
  if (pipe == nullptr) return out;
  std::array<char, 256> line{};
  while (std::fgets(line.data(), static_cast<int>(line.size()), pipe) != nullptr) {
    std::string text = line.data();
    if (text.rfind("chip 2", 0) == 0) out.emplace_back();
    std::replace_if(
        text.begin(), text.end(), [](char c) { return c == '(' || c == ')'; }, ' ');
    std::istringstream in(text);
    Row row;
    in >> row.time_s >> row.with_mps >> row.allowed_mps >> row.without_mps >> row.isolated >> row.excluded;
    if (in && !out.empty()) out.back().push_back(row);
  }
  pclose(pipe);
  return out;
}

// The errors of healthy sensors and gyros do not all point one way: 1 mg of a whole axis, which each of its sensors may
// be off by, is 0.2 m/s in 20 s; 0.15 m/s at most was measured over ten flights. A dead chip is out of the force within
// milliseconds, and adds nothing to speak of.
constexpr double kMost_mps = 0.2;

TEST(FlightThroughAFailure, plumbCarriesTheNavigatorThroughAndTheAverageDoesNot) {
  for (int seed = 1; seed <= 10; ++seed) {
    const auto runs = tables(seed);
    ASSERT_EQ(runs.size(), 2U) << seed;
    for (const auto& rows : runs) {
      const Row& last = rows.back();
      EXPECT_EQ(last.time_s, 20.0);
      EXPECT_LT(last.with_mps, kMost_mps) << seed;
      EXPECT_GT(last.without_mps, 5.0 * last.with_mps) << seed;
      EXPECT_EQ(last.isolated + last.excluded, "-2") << seed;
      const auto out = std::find_if(rows.begin(), rows.end(), [](const Row& row) { return row.excluded == "2"; });
      ASSERT_NE(out, rows.end()) << seed;
      EXPECT_GT(out->time_s, 8.0) << seed;
      EXPECT_LT(out->time_s, 8.1) << seed;
      for (const Row& row : rows) {  // one for each that is isolated or excluded for the first time, too
        EXPECT_LT(row.with_mps, row.allowed_mps) << seed << ", " << row.time_s;
        EXPECT_EQ(row.isolated, row.time_s > 8.0 && row.time_s < out->time_s ? "2" : "-") << seed << ", " << row.time_s;
        EXPECT_EQ(row.excluded, row.time_s < out->time_s ? "-" : "2") << seed << ", " << row.time_s;
      }
      std::printf("[ measured ] flight %2d, %s: with %.3f, bound %.2f, without %.3f m/s; out at %.3f s\n", seed,
                  &rows == &runs.back() ? "dead  " : "biased", last.with_mps, last.allowed_mps, last.without_mps,
                  out->time_s);
    }
  }
}

#endif

}  // namespace
}  // namespace flight_through_a_failure_test
