#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "plumb/io/json_fields.hpp"

namespace json_fields_test {
namespace {

using namespace plumb::io;

TEST(JsonFields, KeepsTheOrderOfTheFields) {
  EXPECT_EQ(object({{"zulu", 1}, {"alpha", 2}, {"mike", 3}}).dump(), R"({"zulu":1,"alpha":2,"mike":3})");
}

TEST(JsonFields, NoFieldMakesAnEmptyObject) {
  EXPECT_TRUE(object({}).is_object());
  EXPECT_EQ(object({}).dump(), "{}");
}

TEST(JsonFields, ZeroIsANumberAndNoText) {
  const Json json = object({{"int", 0}, {"double", 0.0}, {"unsigned", 0U}, {"false", false}, {"null", nullptr}});
  EXPECT_TRUE(json["int"].is_number_integer());
  EXPECT_TRUE(json["double"].is_number_float());
  EXPECT_TRUE(json["unsigned"].is_number_unsigned());
  EXPECT_TRUE(json["false"].is_boolean());
  EXPECT_TRUE(json["null"].is_null());
  EXPECT_EQ(json.dump(), R"({"int":0,"double":0.0,"unsigned":0,"false":false,"null":null})");
}

TEST(JsonFields, ALiteralIsText) {
  const char* const pointer = "by pointer";
  char buffer[] = "in a buffer";
  const Json json =
      object({{"a", ""}, {"b", "a \"quoted\" word"}, {"c", pointer}, {"d", buffer}, {"e", std::string("x")}});
  EXPECT_EQ(json.dump(), R"({"a":"","b":"a \"quoted\" word","c":"by pointer","d":"in a buffer","e":"x"})");
}

TEST(JsonFields, IntegersKeepAll64Bits) {
  EXPECT_EQ(object({{"low", INT64_MIN}, {"high", UINT64_MAX}, {"small", std::uint8_t{7}}}).dump(),
            R"({"low":-9223372036854775808,"high":18446744073709551615,"small":7})");
}

TEST(JsonFields, WhatIsNoNumberIsNull) { EXPECT_EQ(object({{"nan", std::nan("")}}).dump(), R"({"nan":null})"); }

TEST(JsonFields, ObjectsAndListsNest) {
  const std::array<double, 3> axis = {1.0, 0.0, -0.5};
  const std::vector<std::string> names = {"a1"};
  EXPECT_EQ(
      object({{"inner", object({{"axis", axis}})}, {"names", names}, {"words", texts({"x", "y"})}, {"none", Json()}})
          .dump(),
      R"({"inner":{"axis":[1.0,0.0,-0.5]},"names":["a1"],"words":["x","y"],"none":null})");
}

TEST(JsonFields, AVariableIsCopiedAndStaysAsItIs) {
  const Json constant = Json::array({1, 2});
  Json variable = "kept";
  const std::string text = "text";
  const Json json = object({{"constant", constant}, {"variable", variable}, {"moved", Json(true)}, {"text", text}});
  EXPECT_EQ(json.dump(), R"({"constant":[1,2],"variable":"kept","moved":true,"text":"text"})");
  EXPECT_EQ(constant.size(), 2U);
  EXPECT_EQ(variable, "kept");
  EXPECT_EQ(text, "text");
}

TEST(JsonFields, AFigureThatIsNotFiniteIsNull) {
  EXPECT_EQ(finite_or_null(0.5).dump(), "0.5");
  EXPECT_TRUE(finite_or_null(std::numeric_limits<double>::infinity()).is_null());
  EXPECT_TRUE(finite_or_null(std::numeric_limits<double>::quiet_NaN()).is_null());
}

TEST(JsonFields, TheFirstOfTwoWithOneKeyCounts) { EXPECT_EQ(object({{"key", 1}, {"key", 2}}).dump(), R"({"key":1})"); }

TEST(JsonFields, SaysTheSameAsTheInitializerListsOfTheLibrary) {
  const Json theirs = {{"id", "a1"}, {"count", 3}, {"none", nullptr}, {"inner", {{"low", 0.1}, {"ok", true}}}};
  EXPECT_EQ(object({{"id", "a1"}, {"count", 3}, {"none", nullptr}, {"inner", object({{"low", 0.1}, {"ok", true}})}}),
            theirs);
}

TEST(JsonFields, ParsedKeepsTheOrderAndDiscardsWhatIsNoJson) {
  EXPECT_EQ(parsed(R"({"b":1,"a":[2]})").dump(), R"({"b":1,"a":[2]})");
  for (const char* bad : {"", "{", "{\"a\":}", "nan", "{} x"}) EXPECT_TRUE(parsed(bad).is_discarded()) << bad;
}

}  // namespace
}  // namespace json_fields_test
