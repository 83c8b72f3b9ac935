// A simulated flight whose chips sample by clocks of their own, as a log.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "clocked_support.hpp"
#include "plumb/io/hash.hpp"
#include "plumb/io/log_reader.hpp"
#include "plumb/io/output_file.hpp"
#include "plumb/session/flight_play.hpp"

namespace clocked_flight_test {
namespace {

using namespace plumb;
using namespace motion_support;
using namespace clocked_support;
using plumb_test::Directory;
using plumb_test::with;

struct Logged {
  Sample sample;
  std::vector<double> clock_s;
  Rotation rotation, second;
};

std::string flown(const Directory& where, const io::ArrayFile& array, double duration_s, std::uint64_t seed = 1) {
  session::FlightRequest request;
  request.duration_s = duration_s;
  request.seed = seed;
  auto play = session::FlightPlay::make(array, request);
  EXPECT_TRUE(play.has_value()) << play.error().text();
  const std::string path = (where / "flight.csv").string();
  EXPECT_TRUE((*play)->run(path, "").has_value());
  return path;
}

std::vector<Logged> read(const std::string& path, const io::ArrayFile& array) {
  auto reader = io::LogReader::open(path, array, io::BadRowPolicy::stop);
  EXPECT_TRUE(reader.has_value()) << reader.error().text();
  std::vector<Logged> out;
  Sample sample;
  while (reader->next(sample) == io::LogReader::Next::row)
    out.push_back({sample, reader->clock_s(), reader->rotation(), reader->second_rotation()});
  return out;
}

TEST(ClockedFlight, WithoutClocksALogIsAsItWasBitForBit) {
  const Directory where;
  const io::ArrayFile array = array_of(drone_text());
  session::FlightRequest request;
  request.duration_s = 2.0;
  auto play = session::FlightPlay::make(array, request);
  ASSERT_TRUE(play.has_value());
  ASSERT_TRUE((*play)->run((where / "flight.csv").string(), "").has_value());
  const std::string log = *io::read_file((where / "flight.csv").string());
  EXPECT_EQ(io::fnv1a(log.data(), log.size()), 0xbf73c8d37cc5216aULL) << "as plumb wrote it before chips had clocks";
}

// Verifies: REQ-207
TEST(ClockedFlight, EveryChipSamplesByItsClockWithinTheStatedBounds) {
  const Directory where;
  const io::ArrayFile array = array_of(clocked_text());
  for (std::uint64_t seed = 1; seed < 6; ++seed) {
    const std::vector<Logged> rows = read(flown(where, array, 1.0, seed), array);
    for (std::size_t c = 0; c < 3; ++c) {
      const MotionClock& stated = array.motion.clocks[c].clock;
      const double period_s = *array.motion.clocks[c].sample_period_s;
      double last_s = std::nan("");
      int samples = 0;
      for (const Logged& row : rows) {
        const double stamp_s = row.clock_s[c];
        if (!std::isfinite(stamp_s) || stamp_s == last_s) continue;
        if (samples++ > 0) {
          EXPECT_NEAR(stamp_s - last_s, period_s, 1e-9) << "none is lost, however rows and samples lie";
        }
        last_s = stamp_s;
        // By the stated clock, and so at most by the bounds after its row.
        const double common_s = stamp_s - stated.offset_s - stated.rate * (stamp_s - stated.since_s);
        const double bound_s = stated.offset_bound_s + stated.rate_bound * stated.valid_s;
        EXPECT_LE(common_s - row.sample.time_s, bound_s);
        EXPECT_GE(common_s - row.sample.time_s, -0.001 - bound_s);
      }
      EXPECT_NEAR(samples, 0.999 / period_s, 2.0);
    }
  }
}

// Verifies: REQ-207
TEST(ClockedFlight, AClockIsOffByWhatIsDrawnWithinItsBounds) {
  const Directory where;
  const std::string exact = with(with(clocked_text(), "offset_bound_s = 20e-6", "offset_bound_s = 0"),
                                 "rate_bound = 0.5e-6", "rate_bound = 0");
  const auto first_stamp_s = [&where](const io::ArrayFile& array, std::uint64_t seed) {
    for (const Logged& row : read(flown(where, array, 0.05, seed), array)) {
      if (std::isfinite(row.clock_s[1])) return row.clock_s[1];
    }
    return std::nan("");
  };
  for (std::uint64_t seed = 1; seed < 6; ++seed) {
    const double off_s = first_stamp_s(array_of(clocked_text()), seed) - first_stamp_s(array_of(exact), seed);
    EXPECT_NE(off_s, 0.0) << seed;
    EXPECT_LE(std::fabs(off_s), 20e-6 + 60 * 0.5e-6);
  }
}

// Verifies: REQ-207
TEST(ClockedFlight, ARowHoldsTheNewestReadingOfEachChip) {
  const Directory where;
  const io::ArrayFile array = array_of(clocked_text());
  const std::vector<Logged> rows = read(flown(where, array, 1.0), array);
  EXPECT_GT(rows.size(), 2400U) << "a chip that is faster than the log asks for more rows";
  for (std::size_t k = 8; k < rows.size(); ++k) {
    const Logged &before = rows[k - 1], &now = rows[k];
    EXPECT_EQ(now.sample.delivered, array.array.all());
    for (std::size_t c = 0; c < 3; ++c) {
      const bool stands = now.clock_s[c] == before.clock_s[c];
      EXPECT_EQ(now.sample.raw[3 * c] == before.sample.raw[3 * c], stands) << k;
    }
    EXPECT_EQ(now.rotation.rate_radps == before.rotation.rate_radps, now.clock_s[0] == before.clock_s[0]);
    EXPECT_EQ(now.second.rate_radps == before.second.rate_radps, now.clock_s[1] == before.clock_s[1]);
  }
}

// Verifies: REQ-207
TEST(ClockedFlight, WhatIsOnTheTimeOfTheLogIsEmptyInRowsBetween) {
  const Directory where;
  std::string text = clocked_text();
  const std::size_t first = text.find("[[clock]]");
  text.erase(first, text.find("[[clock]]", first + 1) - first);
  const io::ArrayFile array = array_of(text);
  const std::vector<Logged> rows = read(flown(where, array, 1.0), array);
  std::size_t on_time = 0;
  for (std::size_t k = 8; k < rows.size(); ++k) {
    const Logged& now = rows[k];
    const double periods = now.sample.time_s / 0.001;
    const bool whole = std::fabs(periods - std::round(periods)) < 1e-9;
    on_time += whole ? 1 : 0;
    EXPECT_EQ(now.sample.delivered.has(0), whole);
    EXPECT_EQ(now.rotation.rate_known, whole);
    EXPECT_TRUE(now.sample.delivered.has(6));
  }
  EXPECT_GT(on_time, 990U);
}

}  // namespace
}  // namespace clocked_flight_test
