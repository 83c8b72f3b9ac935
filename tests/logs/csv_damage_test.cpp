// Tables that are cut, damaged or none: what is sound is read, the rest is noted with its line.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "csv_told.hpp"
#include "plumb/core/vec3.hpp"

namespace csv_damage_test {
namespace {

using namespace csv_told;

const std::string kHeader = "time_s;ax_mps2;ay_mps2;az_mps2;state\n";

std::string rows(int count) {
  std::string out;
  for (int k = 0; k < count; ++k) out += std::to_string(k) + ",25;0,5;-0,25;9,5;ok\n";
  return out;
}

TEST(CsvDamage, WhatIsNoRowIsLeftOutWithItsLine) {
  const std::string text = kHeader + rows(3) +
                           "3;1;2\n"
                           "4;1;2;3;ok;more\n"
                           "5;1;two;3;ok\n"
                           "6;1;;3;ok\n"
                           "never;1;2;3;ok\n"
                           "8;1;2;nan;ok\n"
                           "9;1;2;1e999;ok\n"
                           "10;1;2;3;ok\n"
                           "9;1;2;3;ok\n";
  const Told told = told_of_table(text);
  EXPECT_EQ(told.records.size(), 5U) << told.all_notes();
  EXPECT_TRUE(told.noted("line 5: 3 cells, the header has 5"));
  EXPECT_TRUE(told.noted("line 6: 6 cells, the header has 5"));
  EXPECT_TRUE(told.noted("line 7: \"two\" is no number"));
  EXPECT_TRUE(told.noted("line 8: an axis is empty"));
  EXPECT_TRUE(told.noted("line 9: \"never\" is no time"));
  EXPECT_EQ(told.notes_with("the specific force is no number"), 2U);
  EXPECT_TRUE(told.noted("line 13: the time of accelerometer goes back by 1.0"));
  EXPECT_EQ(told.notes.size(), 8U) << told.all_notes();
  EXPECT_EQ(told.notes[0].offset, (kHeader + rows(3)).size());
}

TEST(CsvDamage, WhatIsNoTableIsRefusedWithAReason) {
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"", "0 bytes"},
      {"hello world\n", "no rows of at least 3 numbers"},
      {"1,2,3,4\n2,2,3,4\n", "has no header"},
      {"a,b,c,d\n1,2,3,4\n", "called like those of an accelerometer"},
      {"ax_g,ay_g,az_g\n0,0,1\n", "no column of time"},
      {"t_s,ax_g,ay_mps2,az_g\n0,0,0,1\n", "in different units"},
      {std::string("PK\x03\x04", 4) + "rest", "is a zip archive, as spreadsheets (.xlsx, .ods) are, no table of text"},
      {std::string("\x00\x01\x02\x03\x04\x05\x06\x07", 8), "is binary data, no table of text"},
      {"%PDF-1.7", "is a PDF document"},
      {"SQLite format 3" + std::string(1, '\0'), "SQLite"},
  };
  for (const auto& [text, words] : cases) {
    const io::FileError error = refusal_of_table(text);
    EXPECT_NE(error.what.find(words), std::string::npos) << error.text();
    EXPECT_FALSE(error.remedy.empty());
  }
  EXPECT_EQ(refusal_of_table("\n1,2,3,4\n").line, 2);
}

TEST(CsvDamage, HintsThatCannotBeAreRefused) {
  const std::string text = kHeader + rows(3);
  CsvHints time, force, rate, separator, decimal, names;
  time.time_unit_s = 0.5;
  force.force_unit_mps2 = -1.0;
  rate.rate_hz = 0.0;
  separator.separator = 'x';
  decimal.decimal = '\'';
  names.header = {"t", "ax", "ay", "az"};
  for (const auto& [hints, words] : {std::pair<CsvHints, const char*>{time, "unit of time"},
                                     {force, "unit of readings"},
                                     {rate, "this rate"},
                                     {separator, "this separator"},
                                     {decimal, "decimal mark"},
                                     {names, "has 5 columns, 4 names were given"}}) {
    EXPECT_NE(refusal_of_table(text, hints).what.find(words), std::string::npos) << words;
  }
}

TEST(CsvDamage, ALastLineThatJustStopsIsReadOnlyWhereItIsWhole) {
  const Told cut = told_of_table("t_s,ax_mps2,ay_mps2,az_mps2\n0,1,2,3\n1,1,2,3");
  EXPECT_EQ(cut.records.size(), 1U);
  EXPECT_TRUE(cut.noted("line 3: the last line has no end and may be cut")) << cut.all_notes();
  const Told whole = told_of_table(kHeader + rows(1) + "2;1;2;3;o");
  EXPECT_EQ(whole.records.size(), 2U) << "the cell that may be cut is not read";
}

TEST(CsvDamage, LinesWithoutEndTakeNoMemory) {
  const Told told = told_of_table(kHeader + rows(2) + std::string(3U << 20U, '7') + "\n" + rows(2));
  EXPECT_EQ(told.records.size(), 4U) << told.all_notes();
  EXPECT_TRUE(told.noted("line 4 is longer than 1 MiB")) << told.all_notes();
  const std::string wide = "\xFF\xFE" + utf16(kHeader + rows(2) + std::string(3U << 20U, '7') + "\n" + rows(2), false);
  EXPECT_EQ(told_of_table(wide).records.size(), 4U);
  EXPECT_FALSE(refusal_of_table(std::string(3U << 20U, ',')).remedy.empty());
  EXPECT_FALSE(refusal_of_table(std::string(3U << 20U, '7')).remedy.empty());
}

TEST(CsvDamage, NoControlCharacterReachesATerminal) {
  std::string filler;  // a text of mostly control characters is none
  for (int k = 0; k < 40; ++k) filler += "0,0,0,77.0000\n";
  const Told told = told_of_table("time_s,acc\x1b_x_g,acc\x1b_y_g,acc\x1b_z_g\n" + filler + "1,0,\x1b[2J,1\n");
  EXPECT_EQ(told.notes_with("\\x1b[2J"), 1U) << told.all_notes();
  for (const std::string& text : {told.understood, told.all_notes(), told.sources.empty() ? "" : told.sources[0].name})
    EXPECT_EQ(text.find('\x1b'), std::string::npos) << text;
  EXPECT_NE(refusal_of_table("t_s,acc\x1b_x,acc\x1b_y,acc\x1b_z\n" + filler).what.find("\\x1b"), std::string::npos);
}

TEST(CsvDamage, AnArduPilotLogInTextMayBeTorn) {
  const std::string text =
      "FMT, 1, 2\nFMT, 140, 60, IMU, Q, TimeUS,I,AccX,AccY,AccZ\nIMU\nIMU, 5\nIMU, x, 0, 1, 2, 3\n"
      "IMU, 1, 77, 1, 2, 3\nIMU, 1, -1, 1, 2, 3\nIMU, 1, 0, a, 2, 3\nPARM, 1\nPARM, 1, \x1b, 2\n"
      "IMU, 1000000, 0, 1, 2, 3\nIMU, 1000000, 0, 1, 2, 3.5";
  const Told told = told_of_table(text);
  EXPECT_EQ(told.records.size(), 1U) << told.all_notes();
  EXPECT_TRUE(told.parameters.empty());
  EXPECT_EQ(told.notes_with("has no time"), 2U) << told.all_notes();
  EXPECT_EQ(told.notes_with("no chip has this instance"), 2U) << told.all_notes();
  EXPECT_EQ(told.notes_with("the last line has no end"), 1U) << told.all_notes();
}

/// What a table that was cut tells is what the whole table told first.
void expect_cuts(const std::string& text) {
  const Told whole = told_of_table(text);
  ASSERT_GT(whole.records.size(), 3U);
  std::size_t most = 0;
  for (std::size_t cut = 0; cut < text.size(); ++cut) {
    Told told;
    const auto extent = read_table(text.substr(0, cut), told);
    if (!extent) {
      ASSERT_FALSE(extent.error().remedy.empty());
      ASSERT_EQ(most, 0U) << cut;
      continue;
    }
    ASSERT_GE(told.records.size(), most) << cut;
    most = told.records.size();
    ASSERT_NO_FATAL_FAILURE(expect_prefix(told, whole)) << cut;
  }
  EXPECT_GE(most + 1, whole.records.size());
}

TEST(CsvDamage, CutAnywhereTheRowsBeforeTheCutAreHandedOn) {
  expect_cuts(kHeader + rows(8));
  expect_cuts("time_s,ax_mps2,ay_mps2,az_mps2\n0,1.25,2.25,3.25\n1.5,1.5,2.5,3.5\n2,1,2,3\n3,1,2,3\n");
  expect_cuts("\xFF\xFE" + utf16(kHeader + rows(5), false));
  expect_cuts(
      "IMU, TimeUS, I, AccX, AccY, AccZ\nIMU, 1000, 0, 1.5, 2.5, 3.5\nIMU, 2000, 0, 1, 2, 3\nIMU, 3000, 0, 1, 2, 3\n"
      "IMU, 4000, 0, 1, 2, 3\n");
}

RC_GTEST_PROP(CsvDamageProperties, NoByteThatWasChangedDoesHarm, ()) {
  std::string text = *rc::gen::element<std::string>(
      kHeader + rows(12), "\xFE\xFF" + utf16(kHeader + rows(6), true),
      "FMT, 140, 60, IMU, Q, TimeUS,I,AccX,AccY,AccZ\nPARM, 1, A, 2\nIMU, 1000, 0, 1, 2, 3\nIMU, 1000, 1, 1, 2, 3\n");
  for (int k = *rc::gen::inRange(1, 20); k > 0; --k) {
    const std::size_t at = *rc::gen::inRange<std::size_t>(0, text.size());
    const auto value = static_cast<char>(*rc::gen::element(
        static_cast<int>(';'), static_cast<int>(','), static_cast<int>('\n'), 0, 0xFF, static_cast<int>('"'),
        static_cast<int>('9'), static_cast<int>('e'), *rc::gen::inRange(0, 256)));
    switch (*rc::gen::inRange(0, 4)) {
      case 0: text.erase(at, *rc::gen::inRange<std::size_t>(1, 30)); break;
      case 1: text.insert(at, 1, value); break;
      default: text[at] = value; break;
    }
    if (text.empty()) text = "x";
  }
  Told told;
  const auto extent = read_table(text, told);
  if (!extent) {
    RC_ASSERT(!extent.error().remedy.empty());
    return;
  }
  RC_ASSERT(extent->records == told.records.size());
  for (const auto& note : told.notes) RC_ASSERT(note.offset <= text.size());
  for (const auto& one : told.records) RC_ASSERT(std::isfinite(plumb::norm(one.second.specific_force_mps2)));
}

}  // namespace
}  // namespace csv_damage_test
