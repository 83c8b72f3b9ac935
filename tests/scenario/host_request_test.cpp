#include "plumb/scenario/host_request.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "plumb/array/named.hpp"
#include "plumb/health/health_monitor.hpp"

namespace plumb {
namespace scenario {
namespace host_request_test {
namespace {

SensorArray tetrahedron() {
  AxisList axes{};
  const int n = paper_tetrahedron(axes);
  std::array<SensorRow, kCapacity> rows{};
  for (std::size_t i = 0; i < static_cast<std::size_t>(n); ++i) {
    rows[i] = {make_id(("a" + std::to_string(i + 1)).c_str()), axes[i], 0.002};
  }
  return *SensorArray::make(rows.data(), n);
}

TEST(HostRequest, ReadsAReset) {
  const auto request = parse_host_request("  1min  reset a2,a4 key 0x706c756d62 ", tetrahedron());
  ASSERT_TRUE(request) << request.error();
  EXPECT_EQ(request->time_s, 60.0);
  EXPECT_EQ(request->sensors, SensorSet::of(1).with(3));
  EXPECT_EQ(request->key, 0x706c756d62ULL);
  EXPECT_EQ(parse_host_request("60s reset a1 key 17", tetrahedron())->key, 17U);
  EXPECT_EQ(describe(*request, tetrahedron()), "a reset that returns a2, a4 to service");
}

TEST(HostRequest, ReadsARecalibration) {
  const auto request = parse_host_request("36.5s recalibrate", tetrahedron());
  ASSERT_TRUE(request) << request.error();
  EXPECT_EQ(request->kind, HostRequest::Kind::recalibrate);
  EXPECT_EQ(request->time_s, 36.5);
  EXPECT_EQ(to_text(*request, tetrahedron()), "36.5s recalibrate");
  EXPECT_EQ(describe(*request, tetrahedron()), "a recalibration");
}

TEST(HostRequest, RefusalsSayWhatAndHow) {
  const SensorArray array = tetrahedron();
  const std::pair<const char*, const char*> bad[] = {
      {"", "does not begin with a number"},
      {"reset a2 key 1", "does not begin with a number"},
      {"60 reset a2 key 1", "has no unit"},
      {"60s", "unknown request ''"},
      {"60s explode", "unknown request 'explode'"},
      {"60s reset", "no sensor ''"},
      {"60s reset a9 key 1", "no sensor 'a9'"},
      {"60s reset a1,,a2 key 1", "no sensor ''"},
      {"60s reset a2", "a reset needs a key. Remedy: end with `key` and the"},
      {"60s reset a2 key", "'' is not a key"},
      {"60s reset a2 key -1", "'-1' is not a key"},
      {"60s reset a2 key 0x", "'0x' is not a key"},
      {"60s reset a2 key 18446744073709551616", "is not a key. Remedy:"},
      {"60s reset a2 key 1 2", "'2' is not expected here"},
      {"60s recalibrate a2", "'a2' is not expected here"}};
  for (const auto& [text, what] : bad) {
    const auto request = parse_host_request(text, array);
    ASSERT_FALSE(request) << text;
    EXPECT_NE(request.error().find(what), std::string::npos) << request.error();
    EXPECT_NE(request.error().find("Remedy:"), std::string::npos) << request.error();
  }
}

RC_GTEST_PROP(HostRequestLaw, TextReadsBackAsTheSameRequest, ()) {
  const SensorArray array = tetrahedron();
  HostRequest request;
  request.time_s = *rc::gen::inRange(0, 1000000) / 1000.0;
  request.sensors = SensorSet(*rc::gen::inRange<std::uint32_t>(1, 16));
  request.key = *rc::gen::arbitrary<std::uint64_t>();
  const auto back = parse_host_request(to_text(request, array), array);
  RC_ASSERT(back.has_value());
  RC_ASSERT(back->time_s == request.time_s);
  RC_ASSERT(back->sensors == request.sensors);
  RC_ASSERT(back->key == request.key);
}

TEST(Host, AsksInOrderOfTimeAndKeepsTheAnswers) {
  auto setup = std::make_unique<MonitorSetup>();
  setup->array = tetrahedron();
  setup->model.size = 4;
  setup->gravity.g_mps2 = kG0_mps2;
  auto monitor = std::make_unique<HealthMonitor>();
  ASSERT_TRUE(monitor->configure(*setup));
  const std::uint64_t key = MonitorConfig().reset_key;
  const auto reset = HostRequest::Kind::reset;
  const auto recalibrate = HostRequest::Kind::recalibrate;
  Host host({{2.0, reset, SensorSet::of(0), key},
             {1.0, reset, SensorSet::of(1), key + 1},
             {9.0, reset, {}, key},
             {2.5, recalibrate, {}, 0}});
  host.before(0.5, *monitor);
  EXPECT_TRUE(host.answers().empty());
  host.before(2.5, *monitor);
  ASSERT_EQ(host.answers().size(), 3U);
  EXPECT_EQ(host.answers()[0].request.time_s, 1.0);
  EXPECT_EQ(host.answers()[0].refusal, Errc::wrong_key);
  EXPECT_EQ(host.answers()[1].refusal, Errc::wrong_state) << "a reset is for failed only";
  EXPECT_EQ(host.answers()[1].time_s, 2.5);
  EXPECT_EQ(host.answers()[2].refusal, Errc::wrong_state)
      << "an not yet validated monitor has nothing to recalibrate from";
  EXPECT_EQ(host.waiting(), 1U);
}

}  // namespace
}  // namespace host_request_test
}  // namespace scenario
}  // namespace plumb
