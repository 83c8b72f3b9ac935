// The tables for cFS's Limit Checker, evaluated as LC evaluates them: bytes of the packet at an offset, an operator,
// then the actionpoint's expression in reverse Polish notation.
#include <gtest/gtest.h>

#include <cstring>
#include <limits>
#include <memory>
#include <vector>

extern "C" {
#include "navigation/cfs_lc.h"
}
#include "verdicts.hpp"

namespace cfs_test {
namespace {

plumb_verdict usable_verdict() {
  plumb_verdict v{};
  plumb_verdict_defaults(&v);
  v.state = PLUMB_NOMINAL;
  v.validity = PLUMB_VALID;
  v.in_service = 0xF;
  v.age_s = 0.32;
  return v;
}

NAV_PlumbHk_t packet_of(const plumb_verdict& v) {
  NAV_PlumbHk_t packet{};
  NAV_FillPlumbHk(&packet, &v);
  return packet;
}

bool watch(const LC_WDTEntry_t& point, const NAV_PlumbHk_t& packet) {
  const auto* bytes = reinterpret_cast<const unsigned char*>(&packet) + point.WatchpointOffset;
  const auto byte = [bytes](int k) { return std::uint32_t{bytes[k]}; };
  std::uint32_t value = byte(0);
  if (point.DataType == LC_DATA_WATCH_UDWORD_LE) {
    value = byte(0) | byte(1) << 8U | byte(2) << 16U | byte(3) << 24U;
  } else if (point.DataType == LC_DATA_WATCH_UDWORD_BE) {
    value = byte(0) << 24U | byte(1) << 16U | byte(2) << 8U | byte(3);
  } else {
    EXPECT_EQ(point.DataType, LC_DATA_WATCH_UBYTE);
  }
  value &= point.BitMask;
  const std::uint32_t limit = point.ComparisonValue.Unsigned32;
  switch (point.OperatorID) {
    case LC_OPER_LT: return value < limit;
    case LC_OPER_LE: return value <= limit;
    case LC_OPER_NE: return value != limit;
    case LC_OPER_EQ: return value == limit;
    case LC_OPER_GE: return value >= limit;
    default: EXPECT_EQ(point.OperatorID, LC_OPER_GT); return value > limit;
  }
}

bool fires(int action, const NAV_PlumbHk_t& packet) {
  std::vector<bool> stack;
  const auto pop = [&stack] {
    const bool top = !stack.empty() && stack.back();
    EXPECT_FALSE(stack.empty());
    stack.pop_back();
    return top;
  };
  for (const std::uint16_t word : NAV_PlumbADT[action].RPNEquation) {
    if (word == LC_RPN_EQUAL) break;
    if (word == LC_RPN_NOT) {
      stack.push_back(!pop());
    } else if (word >= LC_RPN_AND) {
      const bool second = pop();
      const bool first = pop();
      stack.push_back(word == LC_RPN_AND ? first && second : word == LC_RPN_OR ? first || second : first != second);
    } else {
      EXPECT_LT(word, NAV_WATCHPOINTS);
      stack.push_back(watch(NAV_PlumbWDT[word], packet));
    }
  }
  EXPECT_EQ(stack.size(), 1U);  // else LC refuses the table
  return stack.back();
}

TEST(CfsLimitChecker, nothingFiresOnAUsableVector) {
  const NAV_PlumbHk_t packet = packet_of(usable_verdict());
  EXPECT_FALSE(fires(NAV_AP_LOST, packet));
  EXPECT_FALSE(fires(NAV_AP_COASTING, packet));
}

TEST(CfsLimitChecker, onlyFailedLosesTheAttitude) {
  for (int state = PLUMB_NOMINAL; state <= PLUMB_FAILED; ++state) {
    plumb_verdict v = usable_verdict();
    v.state = static_cast<std::uint8_t>(state);
    EXPECT_EQ(fires(NAV_AP_LOST, packet_of(v)), state == PLUMB_FAILED);
  }
}

TEST(CfsLimitChecker, coastingFiresOnAnOldVectorThatIsNotUsableAndOnNoVectorAtAll) {
  for (int validity = PLUMB_INVALID; validity <= PLUMB_VALID; ++validity) {
    for (const double age_s : {0.0, 59.9, 60.1, 1e9}) {
      plumb_verdict v = usable_verdict();
      v.validity = static_cast<std::uint8_t>(validity);
      v.age_s = age_s;
      const bool expected = validity == PLUMB_INVALID || (validity < PLUMB_DEGRADED && age_s > 60.0);
      EXPECT_EQ(fires(NAV_AP_COASTING, packet_of(v)), expected) << validity << " " << age_s;
    }
  }
}

TEST(CfsLimitChecker, anAgeThatIsNoNumberCountsAsTooOld) {
  for (const double age_s : {std::numeric_limits<double>::quiet_NaN(), -1.0, std::numeric_limits<double>::infinity()}) {
    plumb_verdict v = usable_verdict();
    v.age_s = age_s;
    EXPECT_EQ(packet_of(v).AgeMs, 0xFFFFFFFFU);
    v.validity = PLUMB_HELD;
    EXPECT_TRUE(fires(NAV_AP_COASTING, packet_of(v)));
  }
}

TEST(CfsLimitChecker, thePacketCarriesTheMasks) {
  plumb_verdict v = usable_verdict();
  v.in_service = 0b1101;
  v.excluded = 0b0010;
  v.alert = 1;
  const NAV_PlumbHk_t packet = packet_of(v);
  EXPECT_EQ(packet.InService, 3);
  EXPECT_EQ(packet.Excluded, 2U);
  EXPECT_EQ(packet.Alert, 1);
  EXPECT_EQ(packet.AgeMs, 320U);
}

TEST(CfsLimitChecker, theRowsAreSuchAsLcTakes) {
  for (const LC_WDTEntry_t& row : NAV_PlumbWDT) {
    EXPECT_EQ(row.MessageID, static_cast<CFE_SB_MsgId_t>(NAV_PLUMB_HK_MID));
    EXPECT_LE(row.WatchpointOffset + 4, sizeof(NAV_PlumbHk_t));
    EXPECT_GT(row.ResultAgeWhenStale, 0U);  // 0 would keep the last result of a program that died
  }
  for (const LC_ADTEntry_t& row : NAV_PlumbADT) {
    EXPECT_EQ(row.MaxFailsBeforeRTS, 1);  // LC refuses 0, and counts anew after every stale sample
    EXPECT_NE(row.RTSId, 0);
    EXPECT_EQ(row.EventText[LC_MAX_ACTION_TEXT - 1], '\0');
  }
}

}  // namespace
}  // namespace cfs_test
