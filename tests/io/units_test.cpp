#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <cstdlib>
#include <string>
#include <utility>
#include <vector>

#include "plumb/io/units.hpp"

namespace units_test {
namespace {

using namespace plumb;
using namespace plumb::io;

double si(Quantity quantity, const char* text) {
  const auto value = parse_quantity(quantity, text);
  EXPECT_TRUE(value.has_value()) << text;
  return value ? *value : std::nan("");
}

std::string refusal(const FileExpected<double>& value) {
  EXPECT_FALSE(value.has_value());
  return value ? "" : value.error().text();
}

void expect_part(const std::string& text, const std::string& part) {
  EXPECT_NE(text.find(part), std::string::npos) << "no '" << part << "' in: " << text;
}

const RawUnit kVolt = *parse_raw_unit("V");
const RawUnit kMilliVolt = *parse_raw_unit("mV");
const RawUnit kCount = *parse_raw_unit("count");
const RawUnit kMps2 = *parse_raw_unit("m/s^2");
const RawUnit kG = *parse_raw_unit("g0");

// Verifies: REQ-171
TEST(Units, ConvertsToSi) {
  EXPECT_DOUBLE_EQ(si(Quantity::acceleration, "12 mg"), 12e-3 * 9.80665);
  EXPECT_DOUBLE_EQ(si(Quantity::acceleration, "12mg0"), 12e-3 * 9.80665);
  EXPECT_DOUBLE_EQ(si(Quantity::acceleration, " +1.5e1  ug "), 15e-6 * 9.80665);
  EXPECT_DOUBLE_EQ(si(Quantity::acceleration, "1 g98"), 9.8);
  EXPECT_DOUBLE_EQ(si(Quantity::acceleration, "1000 mGal"), 0.01);
  EXPECT_DOUBLE_EQ(si(Quantity::acceleration, "1 ft/s^2"), 0.3048);
  EXPECT_EQ(si(Quantity::acceleration, "9.81 m/s^2"), 9.81);
  EXPECT_EQ(si(Quantity::angle, "1 deg"), rad_from_deg(1.0));
  EXPECT_DOUBLE_EQ(si(Quantity::rate, "0.1 kHz"), 100.0);
  EXPECT_EQ(si(Quantity::temperature, "-25 degC"), -25.0);
  EXPECT_DOUBLE_EQ(si(Quantity::length, "3 km"), 3000.0);
  EXPECT_DOUBLE_EQ(si(Quantity::density, "2.67 g/cm^3"), 2670.0);
  EXPECT_DOUBLE_EQ(si(Quantity::ratio, "2 %"), 0.02);
  EXPECT_DOUBLE_EQ(si(Quantity::ratio, "200 ppm"), 2e-4);
  EXPECT_EQ(si(Quantity::ratio, "0.5"), 0.5);
}

// Negative: REQ-171
TEST(Units, RefusesWhatIsAmbiguousMissingOrUnknown) {
  const std::string bare = refusal(parse_quantity(Quantity::acceleration, "1 g"));
  expect_part(bare, "bare \"g\"");
  expect_part(bare, "g0 (= 9.80665 m/s^2)");
  expect_part(bare, "g98 (= 9.8 m/s^2)");
  const std::string missing = refusal(parse_quantity(Quantity::acceleration, "12"));
  expect_part(missing, "the unit is missing");
  expect_part(missing, "mm/s^2");
  const std::string unknown = refusal(parse_quantity(Quantity::angle, "3 degs"));
  expect_part(unknown, "\"degs\" is not a known unit");
  expect_part(unknown, "did you mean \"deg\"?");
  expect_part(refusal(parse_quantity(Quantity::time, "soon")), "not a number");
  expect_part(refusal(parse_quantity(Quantity::time, "")), "not a number");
  expect_part(refusal(parse_quantity(Quantity::time, "nan s")), "not finite");
  expect_part(refusal(parse_quantity(Quantity::time, "1e999 s")), "too large");
  expect_part(refusal(parse_quantity(Quantity::length, "1e308 km")), "too large");
}

TEST(Units, ScalesAreLogUnitsPerAcceleration) {
  EXPECT_DOUBLE_EQ(*parse_scale("3 V/g0", kVolt), 3.0 / 9.80665);
  EXPECT_DOUBLE_EQ(*parse_scale("3 V/g0", kMilliVolt), 3000.0 / 9.80665);
  EXPECT_DOUBLE_EQ(*parse_scale("2048 count/g0", kCount), 2048.0 / 9.80665);
  EXPECT_EQ(*parse_scale("415 count/(m/s^2)", kCount), 415.0);
  EXPECT_EQ(*parse_scale("415 count/m/s^2", kCount), 415.0);
  EXPECT_EQ(*parse_scale("1", kMps2), 1.0);
  EXPECT_EQ(*parse_scale("1 (m/s^2)/(m/s^2)", kMps2), 1.0);
  EXPECT_DOUBLE_EQ(*parse_scale("1", kG), 1.0 / 9.80665);
  EXPECT_DOUBLE_EQ(*parse_scale("-1 g0/g0", kG), -1.0 / 9.80665);
  expect_part(refusal(parse_scale("3 V/g", kVolt)), "bare \"g\"");
  expect_part(refusal(parse_scale("3", kVolt)), "the unit is missing");
  expect_part(refusal(parse_scale("0 V/g0", kVolt)), "zero");
  expect_part(refusal(parse_scale("3 V/g0", kCount)), "is in V, but the log is in count");
  expect_part(refusal(parse_scale("3 volt/g0", kVolt)), "\"3 V/g0\"");
}

TEST(Units, ValuesAsAccelerationOrRaw) {
  const double scale = *parse_scale("415 count/(m/s^2)", kCount);
  EXPECT_DOUBLE_EQ(*parse_as_acceleration("830 count", kCount, scale), 2.0);
  EXPECT_DOUBLE_EQ(*parse_as_acceleration("2 m/s^2", kCount, scale), 2.0);
  EXPECT_DOUBLE_EQ(*parse_as_raw("2 m/s^2", kCount, scale), 830.0);
  EXPECT_EQ(*parse_as_raw("65535 count", kCount, scale), 65535.0);
  EXPECT_DOUBLE_EQ(*parse_as_raw("5 V", kMilliVolt, 1.0), 5000.0);
  expect_part(refusal(parse_as_raw("5 V", kCount, scale)), "the log is in count");
  expect_part(refusal(parse_as_raw("5", kCount, scale)), "the unit is missing");
}

TEST(Units, TemperatureSlopes) {
  EXPECT_DOUBLE_EQ(*parse_temperature_slope(Quantity::acceleration, "0.1 mg/degC", 1), 1e-4 * 9.80665);
  EXPECT_DOUBLE_EQ(*parse_temperature_slope(Quantity::acceleration, "2 ug/degC^2", 2), 2e-6 * 9.80665);
  EXPECT_DOUBLE_EQ(*parse_temperature_slope(Quantity::ratio, "200 ppm/degC", 1), 2e-4);
  expect_part(refusal(parse_temperature_slope(Quantity::acceleration, "0.1 mg", 1)), "per degC");
  expect_part(refusal(parse_temperature_slope(Quantity::acceleration, "0.1 mg/degC", 2)), "degC^2");
  expect_part(refusal(parse_temperature_slope(Quantity::acceleration, "0.1 g/degC", 1)), "bare \"g\"");
}

TEST(Units, RawUnitRefusesBareG) {
  const auto unit = parse_raw_unit("g");
  ASSERT_FALSE(unit.has_value());
  expect_part(unit.error().text(), "g98");
  const auto near = parse_raw_unit("counts");
  ASSERT_FALSE(near.has_value());
  expect_part(near.error().text(), "did you mean \"count\"?");
}

// Verifies: REQ-171
RC_GTEST_PROP(UnitsLaw, TextInAnyUnitReadsBackWithinTwoUlp, ()) {
  const double mantissa = static_cast<double>(*rc::gen::inRange<std::int64_t>(-1000000000, 1000000001));
  const double value = std::ldexp(mantissa, *rc::gen::inRange(-60, 30));
  const std::vector<std::pair<Quantity, const char*>> units = {{Quantity::acceleration, "mg"},
                                                               {Quantity::acceleration, "ft/s^2"},
                                                               {Quantity::acceleration, "m/s^2"},
                                                               {Quantity::angle, "deg"},
                                                               {Quantity::time, "ms"},
                                                               {Quantity::ratio, "ppm"},
                                                               {Quantity::ratio, ""}};
  const auto unit = units[*rc::gen::inRange<std::size_t>(0, units.size())];
  const auto text = format_quantity(unit.first, value, unit.second);
  RC_ASSERT(text.has_value());
  const auto back = parse_quantity(unit.first, *text);
  RC_ASSERT(back.has_value());
  RC_ASSERT(std::abs(*back - value) <= 4.5e-16 * std::abs(value));
}

RC_GTEST_PROP(UnitsLaw, ShortestTextIsBitExact, ()) {
  const double value =
      std::ldexp(static_cast<double>(*rc::gen::arbitrary<std::int64_t>()), *rc::gen::inRange(-1100, 900));
  RC_ASSERT(std::strtod(shortest(value).c_str(), nullptr) == value);
}

RC_GTEST_PROP(UnitsLaw, AnyTextIsEitherFiniteOrRefusedWithARemedy, ()) {
  const std::string text =
      *rc::gen::container<std::string>(rc::gen::elementOf(std::string("0123456789.eE+- gmu/s^2()VHzdegC%\t")));
  const auto value = parse_quantity(Quantity::acceleration, text);
  const bool sound = value ? std::isfinite(*value) : !value.error().remedy.empty();
  RC_ASSERT(sound);
}

}  // namespace
}  // namespace units_test
