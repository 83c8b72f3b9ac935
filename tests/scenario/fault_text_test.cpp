#include "plumb/scenario/fault_text.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <limits>

#include "plumb/scenario/library.hpp"

namespace plumb {
namespace scenario {
namespace fault_text_test {
namespace {

FaultContext volts() {
  FaultContext context;
  context.datasheet = paper_datasheet();
  return context;
}

FaultContext counts() {
  FaultContext context;
  context.datasheet = paper_datasheet();
  context.raw = FaultContext::Raw::count;
  context.raw_unit = "count";
  for (DatasheetSensor& sensor : context.datasheet.sensor) {
    sensor.coefficients.scale[0] = 415.0;
    sensor.coefficients.bias[0] = 33123.0 / 415.0;
    sensor.full_scale_raw = 65535.0;
    sensor.resolution_raw = 1.0;
  }
  return context;
}

FaultContext accelerations() {
  FaultContext context;
  context.datasheet = paper_datasheet();
  context.raw = FaultContext::Raw::acceleration;
  context.raw_unit = "m/s^2";
  return context;
}

Fault parsed(const char* text, const FaultContext& context) {
  const auto fault = parse_fault(text, context);
  EXPECT_TRUE(fault) << (fault ? "" : fault.error());
  return fault ? *fault : Fault{};
}

TEST(FaultText, ReadsTheExamplesOfTheHelp) {
  const Fault stuck = parsed("a2:stuck=0V@12s", volts());
  EXPECT_EQ(stuck.kind, FaultKind::stuck_level);
  EXPECT_EQ(stuck.sensor, 1);
  EXPECT_EQ(stuck.onset, 12.0);
  EXPECT_EQ(stuck.magnitude, 0.0);
  EXPECT_TRUE(std::isinf(stuck.duration));

  const Fault bias = parsed("2:bias=50mg0@30s+10s", volts());
  EXPECT_EQ(bias.kind, FaultKind::bias_step);
  EXPECT_EQ(bias.sensor, 1) << "number 2 counted from 1";
  EXPECT_DOUBLE_EQ(bias.magnitude, 0.05 * kG0_mps2);
  EXPECT_EQ(bias.duration, 10.0);

  const Fault random = parsed("a1:random=-3V..3V@20s", volts());
  EXPECT_EQ(random.kind, FaultKind::random_range);
  EXPECT_EQ(random.magnitude, -3.0);
  EXPECT_EQ(random.upper, 3.0);
  EXPECT_EQ(random, parsed("a1:random=-3..3V@20s", volts()));

  EXPECT_EQ(parsed("a3:last@5s", volts()).kind, FaultKind::stuck_last);
  EXPECT_DOUBLE_EQ(parsed("a3:last=0.5LSB@5s", volts()).magnitude, 0.5 * kPaperResolution_V);
  EXPECT_EQ(parsed("a3:held=-3V..3V@5s", volts()).kind, FaultKind::random_level);
  EXPECT_DOUBLE_EQ(parsed("a1:drift=1mg0/s@10s", volts()).magnitude, 1e-3 * kG0_mps2);
  EXPECT_DOUBLE_EQ(parsed("a1:drift=3.6mg/h@10s", volts()).magnitude, 1e-6 * kG0_mps2);
  EXPECT_DOUBLE_EQ(parsed("a1:drift=2m/s^2/min@10s", volts()).magnitude, 2.0 / 60.0);
  EXPECT_EQ(parsed("a4:scale=1.1@10s", volts()).magnitude, 1.1);
}

TEST(FaultText, ReadsLevelsInEveryUnit) {
  EXPECT_EQ(parsed("a1:stuck=FS@1s", volts()).magnitude, 5.0);
  EXPECT_EQ(parsed("a1:stuck=-FS@1s", volts()).magnitude, -5.0);
  EXPECT_EQ(parsed("a1:stuck=+3V@1s", volts()).magnitude, 3.0);
  EXPECT_DOUBLE_EQ(parsed("a1:stuck=250mV@1s", volts()).magnitude, 0.25);
  EXPECT_DOUBLE_EQ(parsed("a1:stuck=-1g0@1s", volts()).magnitude, -3.0) << "what the datasheet makes of -1 g0";
  EXPECT_EQ(parsed("a1:stuck=36000count@1s", counts()).magnitude, 36000.0);
  EXPECT_DOUBLE_EQ(parsed("a1:stuck=0m/s^2@1s", counts()).magnitude, 33123.0) << "mid scale is zero acceleration";
  EXPECT_DOUBLE_EQ(parsed("a1:stuck=1g0@1s", accelerations()).magnitude, kG0_mps2);
  FaultContext millivolts = volts();
  millivolts.raw_unit = "mV";
  millivolts.base_per_raw = 1e-3;
  EXPECT_DOUBLE_EQ(parsed("a1:stuck=3V@1s", millivolts).magnitude, 3000.0);
  EXPECT_EQ(parsed("a1:stuck=3mV@1s", millivolts).magnitude, 3.0);
}

TEST(FaultText, ReadsTimesRowsAndStations) {
  EXPECT_DOUBLE_EQ(parsed("a1:last@2min+500ms", volts()).onset, 120.0);
  EXPECT_DOUBLE_EQ(parsed("a1:last@2min+500ms", volts()).duration, 0.5);
  EXPECT_EQ(parsed("a1:last@1e+02s+1e+01s", volts()).onset, 100.0);
  EXPECT_EQ(parsed("a1:last@-3s", volts()).onset, -3.0);
  const Fault row = parsed("a1:last@#5+#10", volts());
  EXPECT_EQ(row.clock, Clock::row);
  EXPECT_EQ(row.onset, 5.0);
  EXPECT_EQ(row.duration, 10.0);
  const Fault station = parsed("a1:last@station6", volts());
  EXPECT_EQ(station.clock, Clock::station);
  EXPECT_EQ(station.onset, 6.0);
  EXPECT_EQ(parsed(" a1 : stuck = 0 V @ 12 s + 3 s ", volts()), parsed("a1:stuck=0V@12s+3s", volts()));
}

TEST(FaultText, AnIdGoesBeforeANumberAndMayHoldAnything) {
  FaultContext context = volts();
  context.datasheet.sensor[0].row.id = make_id("2");
  context.datasheet.sensor[3].row.id = make_id("x:1@7");
  EXPECT_EQ(parsed("2:last@1s", context).sensor, 0);
  EXPECT_EQ(parsed("3:last@1s", context).sensor, 2);
  EXPECT_EQ(parsed("x:1@7:last@1s", context).sensor, 3);
  EXPECT_EQ(parsed(to_text(parsed("x:1@7:last@1s", context), context).c_str(), context).sensor, 3);
}

TEST(FaultText, BadStringsAreRefusedWithARemedy) {
  struct Bad {
    const char* text;
    const char* says;
  };
  const Bad bad[] = {{"", "the onset is missing. Remedy: give the begin of the fault,"},
                     {"a2:stuck=0V", "the onset is missing. Remedy: give the begin of the fault,"},
                     {"stuck=0V@12s", "the sensor is missing"},
                     {"b2:stuck=0V@12s", "name one of a1, a2, a3, a4"},
                     {"0:stuck=0V@12s", "no sensor '0'"},
                     {"5:stuck=0V@12s", "no sensor '5'"},
                     {"a2:broken=0V@12s", "write one of stuck, last, random, held, bias, drift, scale"},
                     {"a2:stuck@12s", "needs a size"},
                     {"a2:stuck=@12s", "needs a size"},
                     {"a2:last=@12s", "needs a size"},
                     {"a2:stuck=0@12s", "has no unit. Remedy: write the level in one of V, mV, uV, LSB, as FS"},
                     {"a2:stuck=1g@12s", "'g' is ambiguous"},
                     {"a2:stuck=3apples@12s", "unknown unit 'apples'"},
                     {"a2:stuck=xV@12s", "does not begin with a number"},
                     {"a2:stuck=nanV@12s", "does not begin with a number"},
                     {"a2:stuck=infV@12s", "does not begin with a number"},
                     {"a2:stuck=1e999V@12s", "too large"},
                     {"a2:bias=50@12s", "no unit"},
                     {"a2:bias=0.05g@12s", "'g' is ambiguous"},
                     {"a2:drift=0.05g/s@12s", "'g' is ambiguous"},
                     {"a2:drift=1mg0@12s", "unknown unit"},
                     {"a2:drift=1mg0/day@12s", "unknown unit"},
                     {"a2:drift=1e308mg0/s@12s", "size of the fault is beyond 1e12"},
                     {"a2:stuck=1e308g0@12s", "size of the fault is not a finite number"},
                     {"a2:stuck=-1e13V@12s", "size of the fault is beyond 1e12"},
                     {"a2:random=-3V..1e308V@12s", "size of the fault is beyond 1e12"},
                     {"a2:scale=1e308@12s", "size of the fault is beyond 1e12"},
                     {"a2:random=3V@12s", "not a range"},
                     {"a2:random=3V..-3V@12s", "range of the random value is empty"},
                     {"a2:random=..3V@12s", "does not begin with a number"},
                     {"a2:scale=1.1V@12s", "not a plain factor"},
                     {"a2:scale=1@12s", "changes nothing"},
                     {"a2:stuck=0V@", "onset"},
                     {"a2:stuck=0V@12", "no unit"},
                     {"a2:stuck=0V@12V", "unknown unit"},
                     {"a2:stuck=0V@#0", "the first is 1"},
                     {"a2:stuck=0V@#1.5", "whole number"},
                     {"a2:stuck=0V@#x", "write #5 or station6"},
                     {"a2:stuck=0V@station", "write #5 or station6"},
                     {"a2:stuck=0V@12s+", "duration"},
                     {"a2:stuck=0V@12s+0s", "duration is not positive"},
                     {"a2:stuck=0V@12s+-1s", "duration is not positive"},
                     {"a2:stuck=0V@12s+#4", "counted differently"}};
  for (const Bad& b : bad) {
    const auto fault = parse_fault(b.text, volts());
    ASSERT_FALSE(fault) << b.text;
    EXPECT_NE(fault.error().find(b.says), std::string::npos) << b.text << " -> " << fault.error();
    EXPECT_NE(fault.error().find("Remedy: "), std::string::npos) << b.text << " -> " << fault.error();
    EXPECT_EQ(fault.error().rfind("fault '" + std::string(b.text) + "': ", 0), 0U) << fault.error();
  }
  FaultContext unknown = volts();
  unknown.datasheet.sensor[1].full_scale_raw = 0.0;
  EXPECT_FALSE(parse_fault("a2:stuck=FS@12s", unknown));
}

TEST(FaultText, DescribesInSentences) {
  const auto said = [](const char* text) { return describe(parsed(text, volts()), volts()); };
  EXPECT_EQ(said("a2:stuck=0V@12s"), "a2 is stuck at 0 V from t = 12 s on");
  EXPECT_EQ(said("a3:last@#5"), "a3 is stuck at its last value from row 5 on");
  EXPECT_EQ(said("a2:bias=50mg0@30s+10s"), "a2 reads 50 mg0 too high from t = 30 s on, for 10 s");
  EXPECT_EQ(said("a1:random=-3V..3V@station2+station3"),
            "a1 delivers random values from -3 V to 3 V, new in every row from station 2 on, for 3 stations");
  EXPECT_EQ(said("a1:held=-3V..3V@1s"), "a1 is stuck at a random value from -3 V to 3 V from t = 1 s on");
  EXPECT_EQ(said("a1:drift=1mg0/s@10s"), "a1 drifts by 1 mg0/s from t = 10 s on");
  EXPECT_EQ(said("a4:scale=1.1@10s"), "a4 has its scale factor multiplied by 1.1 from t = 10 s on");
}

TEST(FaultText, ShortTextsComeBackAsWritten) {
  for (const char* text :
       {"a2:stuck=0V@12s", "a3:last@5s", "a1:random=-3V..3V@20s", "a1:held=-3V..3V@20s", "a2:bias=50mg0@30s+10s",
        "a1:drift=1mg0/s@10s", "a4:scale=1.1@10s", "a1:stuck=5V@#5+#3", "a1:stuck=-3V@station6"}) {
    EXPECT_EQ(to_text(parsed(text, volts()), volts()), text);
  }
}

/// Any double of a size that a fault may have, from its bits, so that round trips meet the awkward ones.
rc::Gen<double> any_size() {
  return rc::gen::map(rc::gen::arbitrary<std::uint64_t>(), [](std::uint64_t bits) {
    const double mantissa = 1.0 + std::ldexp(static_cast<double>(bits >> 12U), -52);
    const int exponent = static_cast<int>(bits % 98U) - 60;
    return (bits & 0x800U) != 0 ? -std::ldexp(mantissa, exponent) : std::ldexp(mantissa, exponent);
  });
}

/// Numbers that a kind can have; others stay as they were drawn.
void fit(Fault& fault, double second) {
  const int other = (fault.sensor + 1) % 4;
  switch (fault.kind) {
    case FaultKind::noise:
    case FaultKind::shake:
    case FaultKind::coarse:
    case FaultKind::stuck_last: fault.magnitude = std::abs(fault.magnitude); break;
    case FaultKind::scale_change: fault.magnitude = fault.magnitude == 1.0 ? 2.0 : fault.magnitude; break;
    case FaultKind::random_range:
    case FaultKind::random_level:
    case FaultKind::clip: fault.upper = fault.magnitude + 2.0 * std::abs(fault.magnitude); break;
    case FaultKind::spikes: fault.upper = 1.0 / (1.0 + std::abs(second)); break;
    case FaultKind::chatter:
    case FaultKind::warm_up: fault.upper = std::abs(second); break;
    case FaultKind::missing:
    case FaultKind::drop: fault.magnitude = 1.0 / (1.0 + std::abs(second)); break;
    case FaultKind::late:
    case FaultKind::slow: fault.magnitude = 1 + static_cast<int>(std::fmod(std::abs(second), 100.0)); break;
    case FaultKind::bit_flip: fault.magnitude = static_cast<int>(std::fmod(std::abs(second), 41.0)); break;
    case FaultKind::pattern: fault.magnitude = static_cast<int>(std::fmod(std::abs(second), kBitPatterns)); break;
    case FaultKind::exchange: fault.magnitude = other; break;
    case FaultKind::mirror: fault.upper = (other + 1) % 4; [[fallthrough]];
    case FaultKind::cross_talk:
      fault.magnitude = other;
      if (fault.kind == FaultKind::cross_talk) fault.upper = second;
      break;
    case FaultKind::turned:
    case FaultKind::ghost: fault.upper = second; break;
    case FaultKind::repeat:
    case FaultKind::swap: fault.magnitude = 0.0; break;
    default: break;
  }
}

rc::Gen<Fault> any_fault() {
  return rc::gen::exec([] {
    Fault fault;
    fault.kind = static_cast<FaultKind>(*rc::gen::inRange(0, kFaultKinds));
    fault.sensor = *rc::gen::inRange(0, 4);
    if (needs_whole_log(fault.kind)) fault.sensor = kWholeLog;
    fault.clock = static_cast<Clock>(*rc::gen::inRange(0, 3));
    const bool counted = fault.clock != Clock::time;
    fault.onset = counted ? *rc::gen::inRange(1, 1000000) : *any_size();
    if (*rc::gen::arbitrary<bool>()) {
      fault.duration = counted ? *rc::gen::inRange(1, 1000000) : std::abs(*any_size());
    }
    fault.magnitude = *any_size();
    fit(fault, *any_size());
    return fault;
  });
}

RC_GTEST_PROP(FaultTextLaw, ToTextParsesBackToTheIdenticalFault, ()) {
  const Fault fault = *any_fault();
  RC_ASSERT(check(fault, 4));
  for (const FaultContext& context : {volts(), counts(), accelerations()}) {
    const std::string text = to_text(fault, context);
    RC_LOG() << text << "\n";
    const auto back = parse_fault(text, context);
    RC_ASSERT(back);
    RC_ASSERT(*back == fault);
    RC_ASSERT(!describe(fault, context).empty());
  }
}

TEST(FaultText, ReadsTheKindsWithTwoNumbersAndThoseOfTheWholeLog) {
  const Fault spikes = parsed("a1:spikes=0.5g0*1%@1s", volts());
  EXPECT_DOUBLE_EQ(spikes.magnitude, 0.5 * kG0_mps2);
  EXPECT_DOUBLE_EQ(spikes.upper, 0.01);
  EXPECT_EQ(parsed("a1:chatter=50mg0*10s@1s", volts()).upper, 10.0);
  EXPECT_EQ(parsed("a1:warmup=2mg0*5min@1s", volts()).upper, 300.0);
  EXPECT_EQ(parsed("a1:cross=a3*1%@1s", volts()).magnitude, 2.0);
  EXPECT_EQ(parsed("a1:mirror=a2*a3@1s", volts()).upper, 2.0);
  EXPECT_DOUBLE_EQ(parsed("a1:turned=2deg@1s", volts()).magnitude, rad_from_deg(2.0));
  EXPECT_DOUBLE_EQ(parsed("a1:turned=2deg*90deg@1s", volts()).upper, rad_from_deg(90.0));
  EXPECT_EQ(parsed("a1:missing@1s", volts()).magnitude, 1.0);
  EXPECT_DOUBLE_EQ(parsed("a1:missing=30%@1s", volts()).magnitude, 0.3);
  EXPECT_EQ(parsed("a1:pattern=-inf@1s", volts()).magnitude, 2.0);
  EXPECT_DOUBLE_EQ(parsed("a1:coarse=1mg0@1s", volts()).magnitude, 0.003);
  const Fault back = parsed("log:back=2s@#5", volts());
  EXPECT_EQ(back.sensor, kWholeLog);
  EXPECT_EQ(back.magnitude, 2.0);
  EXPECT_EQ(parsed("log:late=5@#5", volts()).sensor, kWholeLog);
  EXPECT_EQ(parsed("a2:late=5@#5", volts()).sensor, 1);
  for (const char* bad :
       {"log:bias=1mg0@1s",  "log:last@1s",      "a1:shake=1g0@1s",    "a1:swap@1s",          "a1:late=101@1s",
        "a1:late=0@1s",      "a1:missing=0%@1s", "a1:missing=101%@1s", "a1:exchange=a1@1s",   "a1:mirror=a2*a2@1s",
        "a1:bit=41@1s",      "a1:bit=-1@1s",     "a1:spikes=1g0@1s",   "a1:spikes=1g0*0%@1s", "a1:chatter=1g0*0s@1s",
        "a1:clip=2V..1V@1s", "log:swap=3@1s",    "a1:pattern=none@1s", "a1:noise=0mg0@1s",    "a1:cross=a9*1%@1s"}) {
    const auto fault = parse_fault(bad, volts());
    ASSERT_FALSE(fault) << bad;
    EXPECT_NE(fault.error().find("Remedy: "), std::string::npos) << fault.error();
  }
}

TEST(FaultText, ASensorThatIsCalledLogIsASensor) {
  FaultContext context = volts();
  context.datasheet.sensor[2].row.id = make_id("log");
  EXPECT_EQ(parsed("log:bias=1mg0@1s", context).sensor, 2);
}

TEST(FaultText, ACountOfOneIsSingularInASentence) {
  const auto words = [](const char* text) { return describe(parsed(text, volts()), volts()); };
  EXPECT_EQ(words("a2:late=1@#5"), "a2 arrives 1 row late from row 5 on");
  EXPECT_EQ(words("a2:late=3@#5"), "a2 arrives 3 rows late from row 5 on");
  EXPECT_EQ(words("a2:slow=1@#5+#1"), "a2 has a new value every 1 row only from row 5 on, for 1 row");
  EXPECT_EQ(words("a2:stuck=0V@station2+station1"), "a2 is stuck at 0 V from station 2 on, for 1 station");
  EXPECT_EQ(words("a2:stuck=0V@station2+station3"), "a2 is stuck at 0 V from station 2 on, for 3 stations");
}

RC_GTEST_PROP(FaultTextLaw, AnyTextIsParsedOrRefusedWithARemedy, ()) {
  static const std::string kLetters = "a123:=@+-#.Vsg0mgSFLBtuckscalebiasdriftrandomstation/ ^e";
  std::string text;
  for (const int i : *rc::gen::container<std::vector<int>>(rc::gen::inRange(0, static_cast<int>(kLetters.size())))) {
    text += kLetters[static_cast<std::size_t>(i)];
  }
  const std::string prefix = *rc::gen::element<std::string>("", "a1:stuck=", "a2:bias=1mg0@", "a3:last@1s+", "a4:");
  const auto fault = parse_fault(prefix + text, volts());
  if (fault) {
    RC_ASSERT(check(*fault, 4));
  } else {
    RC_ASSERT(fault.error().find("Remedy: ") != std::string::npos);
  }
}

}  // namespace
}  // namespace fault_text_test
}  // namespace scenario
}  // namespace plumb
