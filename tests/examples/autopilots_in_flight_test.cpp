// Ten flights of the simulated drone through the failure of the chip that is flown: the autopilots leave it within
// samples and never come back to it. From the program's own output, which has a line for every change.
#include <gtest/gtest.h>

#ifdef PLUMB_AUTOPILOTS_PATH

#include <algorithm>
#include <array>
#include <cstdio>
#include <sstream>
#include <string>
#include <vector>

namespace autopilots_in_flight_test {
namespace {

struct Row {
  double time_s = 0.0;
  std::string flown, healthy, lanes, mavlink;
};
struct Flight {
  std::string title;
  std::vector<Row> rows;
  int delta_velocities = 0;
};

std::vector<Flight> flights(int seed) {
  std::vector<Flight> out;
  FILE* pipe = popen((PLUMB_AUTOPILOTS_PATH " " + std::to_string(seed)).c_str(), "r");
  if (pipe == nullptr) return out;
  std::array<char, 256> line{};
  while (std::fgets(line.data(), static_cast<int>(line.size()), pipe) != nullptr) {
    const std::string text = line.data();
    if (text.rfind("chip 2", 0) == 0) out.push_back({text, {}, 0});
    if (out.empty()) continue;
    std::istringstream in(text);
    Row row;
    if (in >> row.time_s >> row.flown >> row.healthy >> row.lanes >> row.mavlink) out.back().rows.push_back(row);
    if (text.rfind("delta", 0) == 0) out.back().delta_velocities = std::stoi(text.substr(text.find(':') + 1));
  }
  return pclose(pipe) == 0 ? out : std::vector<Flight>{};
}

bool leaves_chip_2(const Row& row) {
  return row.flown != "2" && row.healthy.find('2') == std::string::npos && row.lanes.find('2') == std::string::npos;
}

TEST(AutopilotsInFlight, leaveTheChipThatFailedWithinSamplesAndNeverComeBack) {
  for (int seed = 1; seed <= 10; ++seed) {
    const auto both = flights(seed);
    ASSERT_EQ(both.size(), 2U) << seed;
    for (const Flight& flight : both) {
      const bool dead = flight.title.find("dead") != std::string::npos;
      const auto left = std::find_if(flight.rows.begin(), flight.rows.end(),
                                     [](const Row& r) { return r.time_s > 8.0 && leaves_chip_2(r); });
      ASSERT_NE(left, flight.rows.end()) << seed;
      EXPECT_LT(left->time_s, dead ? 8.010 : 8.100) << seed << flight.title;
      for (auto row = flight.rows.begin(); row != flight.rows.end(); ++row) {
        const std::string at = std::to_string(seed) + ", " + std::to_string(row->time_s);
        if (row < left) {
          EXPECT_TRUE(row->flown == "2" || row->time_s < 0.01) << at;
        } else {
          EXPECT_TRUE(leaves_chip_2(*row)) << at;
          EXPECT_NE(row->flown, "0") << at;
        }
      }
      EXPECT_EQ(flight.rows.back().time_s, 20.0) << seed;
      EXPECT_EQ(flight.rows.back().mavlink, "yes") << seed;
      EXPECT_GT(flight.delta_velocities, 19900) << seed;
      std::printf("[ measured ] flight %2d, %s: left after %.0f ms, %d delta velocities\n", seed,
                  dead ? "dead  " : "biased", 1e3 * (left->time_s - 8.0), flight.delta_velocities);
    }
  }
}

}  // namespace
}  // namespace autopilots_in_flight_test

#endif
