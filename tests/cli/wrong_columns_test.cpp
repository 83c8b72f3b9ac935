// Columns that are absent, half empty, constant or exchanged, and roll groups that are wrong: each is named.
#include <algorithm>
#include <functional>
#include <nlohmann/json.hpp>

#include "tool_runner.hpp"

namespace wrong_columns_test {
namespace {

using namespace plumb_test;
using Json = nlohmann::json;
using Cells = std::vector<std::string>;

/// One line, single blanks: where the report wraps is not what is tested.
std::string flat(const std::string& text) {
  std::istringstream in(text);
  std::string out, word;
  while (in >> word) out += word + " ";
  return out;
}

/// Puts every row of a log through `change`, which gets the number of the row (0: the header) and its cells.
void rewrite(const Directory& where, const char* log, const std::function<void(std::size_t, Cells&)>& change) {
  std::istringstream in(read_text(where / log));
  std::string line, out;
  for (std::size_t row = 0; std::getline(in, line); ++row) {
    Cells cells;
    std::istringstream parts(line + ",");
    for (std::string cell; std::getline(parts, cell, ',');) cells.push_back(cell);
    change(row, cells);
    for (std::size_t k = 0; k < cells.size(); ++k) out += (k == 0 ? "" : ",") + cells[k];
    out += "\n";
  }
  write_text(where / log, out);
}

std::size_t rows_of(const Directory& where, const char* log) {
  const std::string text = read_text(where / log);
  return static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n')) - 1;
}

Outcome calibrate(const Directory& where, const std::vector<std::string>& more = {}) {
  std::vector<std::string> arguments = {"calibrate",       "--array", "array.toml", "--log",
                                        "calibration.csv", "--out",   "new.json"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return run(where, arguments);
}

Json report(const Directory& where, std::vector<std::string> more = {}) {
  more.emplace_back("--json");
  return Json::parse(calibrate(where, more).out);
}

/// t_s, station, a1 .. a4
constexpr std::size_t kA1 = 2, kA3 = 4, kA4 = 5;

TEST(WrongColumns, AnEmptyOneIsReported) {
  const Workshop where;
  where.put("array.toml", with(where.text("array.toml"), "id = \"a3\"\n", "id = \"a3\"\ncolumn = \"third\"\n"));
  rewrite(where, "calibration.csv", [](std::size_t row, Cells& cells) { cells[kA3] = row == 0 ? "third" : ""; });
  const Outcome outcome = calibrate(where);
  EXPECT_EQ(outcome.code, 4);
  EXPECT_TRUE(says(outcome.err, {"the column `third` (a3) is empty in all", "rows", "`column` of a3"}));
  EXPECT_TRUE(says(flat(outcome.out), {"columns `third` (a3) is empty in all"}));
  const Json json = report(where);
  ASSERT_EQ(json["columns"].size(), 1U);
  EXPECT_EQ(json["columns"][0]["column"], "third");
  EXPECT_EQ(json["columns"][0]["of"], "a3");
  EXPECT_EQ(json["columns"][0]["rows_without"], rows_of(where, "calibration.csv"));
  EXPECT_TRUE(json["columns"][0]["dead"]);
}

TEST(WrongColumns, AConstantOneIsReported) {
  const Workshop where;
  rewrite(where, "calibration.csv", [](std::size_t row, Cells& cells) {
    if (row > 0) cells[kA3] = "0.25";
  });
  const Outcome outcome = calibrate(where);
  EXPECT_EQ(outcome.code, 4);
  EXPECT_TRUE(says(outcome.err, {"the column `a3` (a3) reads 0.25 in every row", "`column` of a3"}));
}

TEST(WrongColumns, AHalfEmptyOneIsCounted) {
  const Workshop where;
  const std::size_t rows = rows_of(where, "calibration.csv");
  std::size_t emptied = 0;
  rewrite(where, "calibration.csv", [&](std::size_t row, Cells& cells) {
    if (row <= rows / 2) return;
    cells[kA1] = "";
    cells[kA4] = row % 2 == 0 ? "nan" : "";
    ++emptied;
  });
  const Json json = report(where);
  ASSERT_EQ(json["columns"].size(), 2U);
  EXPECT_EQ(json["columns"][0]["of"], "a1");
  EXPECT_EQ(json["columns"][0]["rows_without"], emptied);
  EXPECT_FALSE(json["columns"][0]["dead"]);
  EXPECT_EQ(json["columns"][1]["rows_without"], emptied);
  const std::string counted = std::to_string(emptied) + " of " + std::to_string(rows) + " rows (50 %)";
  EXPECT_TRUE(says(flat(calibrate(where).out),
                   {"`a1` (a1) is empty in " + counted, "`a4` (a4) is empty, nan or inf in " + counted}));
}

TEST(WrongColumns, WhereTooLittleRemainsTheyAreWhy) {
  const Workshop where;
  const std::size_t rows = rows_of(where, "calibration.csv");
  rewrite(where, "calibration.csv", [&](std::size_t row, Cells& cells) {
    if (row > rows / 16) cells[kA3] = "";
  });
  const Outcome outcome = calibrate(where);
  EXPECT_EQ(outcome.code, 4);
  EXPECT_TRUE(says(outcome.err, {"of the 13 parameters", "the column `a3` (a3) is empty in", "fill in `a3`"}));
}

/// The same log with a temperature column.
class WarmBench : public Workshop {
 public:
  explicit WarmBench(const std::function<std::string(double)>& degc) : total(rows_of(*this, "calibration.csv")) {
    put("array.toml", with(text("array.toml"), "[input]\n", "[input]\ntemperature = \"T\"\n"));
    rewrite(*this, "calibration.csv", [&](std::size_t row, Cells& cells) {
      cells.push_back(row == 0 ? "T" : degc(static_cast<double>(row) / static_cast<double>(total)));
    });
  }
  std::size_t total;
};

TEST(WrongColumns, ATemperatureThatIsHalfEmptyIsCountedAndUsedWhereItIsKnown) {
  const WarmBench where([](double part) { return part <= 0.5 ? "25" : ""; });
  const Outcome outcome = calibrate(where);
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_TRUE(says(flat(outcome.out),
                   {"24 stations", "`T` (temperature) is empty in",
                    "of " + std::to_string(where.total) + " rows (50 %), which use the value of the row before",
                    "stations are not used"}));
  const Json json = report(where);
  EXPECT_EQ(json["stations"].size(), 24U);
  EXPECT_EQ(json["stations_without_temperature"], 24);
}

TEST(WrongColumns, AGapBetweenLikeTemperaturesIsNoLoss) {
  const auto gap = [](const char* after) {
    return [after](double part) { return part <= 0.25 ? std::string("25") : part < 0.75 ? "" : after; };
  };
  EXPECT_EQ(report(WarmBench(gap("27")))["stations_without_temperature"], 0);
  const Json hotter = report(WarmBench(gap("60")));
  EXPECT_GE(hotter["stations_without_temperature"], 22);
  EXPECT_LE(hotter["stations_without_temperature"], 25);
}

TEST(WrongColumns, ATemperatureGivenOnceIsNotEnough) {
  const WarmBench where([](double part) { return part < 1e-3 ? "25" : ""; });
  const Outcome outcome = calibrate(where);
  EXPECT_EQ(outcome.code, 4);
  EXPECT_TRUE(says(outcome.err, {"found, 9 are needed", "`T` (temperature) is empty", "fill in `T`"}));
}

TEST(WrongColumns, KelvinAndFahrenheitAreAskedFor) {
  const WarmBench kelvin([](double) { return "298.2"; });
  EXPECT_TRUE(says(flat(calibrate(kelvin).out), {"`T` reads 298.2 to 298.2: is it in kelvin?", "273.15"}));
  EXPECT_TRUE(report(kelvin)["temperature_unit"].is_string());
  const WarmBench degc([](double) { return "150"; });
  EXPECT_TRUE(report(degc)["temperature_unit"].is_null());
  const std::string span = "[monitor]\ntemperature_min = \"15 degC\"\ntemperature_max = \"60 degC\"\n";
  const WarmBench fahrenheit([](double part) { return part < 0.5 ? "77" : "86"; });
  fahrenheit.put("array.toml", with(fahrenheit.text("array.toml"), "[monitor]\n", span));
  EXPECT_TRUE(says(flat(calibrate(fahrenheit).out), {"`T` reads 77 to 86", "15 to 60 degC: is it in degF?"}));
  fahrenheit.put("array.toml", with(fahrenheit.text("array.toml"), "\"60 degC\"", "\"90 degC\""));
  EXPECT_TRUE(report(fahrenheit)["temperature_unit"].is_null());
}

TEST(WrongColumns, ATemperatureThatFollowsADirectionIsReported) {
  const Workshop where;
  where.put("array.toml", with(where.text("array.toml"), "[input]\n", "[input]\ntemperature = \"T\"\n"));
  rewrite(where, "calibration.csv", [](std::size_t row, Cells& cells) {
    const auto volt = [&cells](std::size_t i) { return std::stod(cells[kA1 + i]); };
    // Along x of the paper's tool, +1 to -1 for 3 V/g0.
    cells.push_back(row == 0 ? "T" : std::to_string(60.0 + 40.0 * (2.0 * volt(0) - volt(1) - volt(2)) / 8.485));
  });
  const Json json = report(where);
  EXPECT_GE(json["temperature"]["order"], 1);
  EXPECT_EQ(json["temperature"]["follows_direction"], "x");
  EXPECT_TRUE(
      says(flat(calibrate(where).out), {"the temperature follows the x direction of gravity (correlation 1.000)"}));
  EXPECT_TRUE(says(calibrate(where).err, {"the temperature of the stations follows the x direction", "30 degC"}));
  const Json none = report(where, {"--temperature-order", "0"});
  EXPECT_TRUE(none["temperature"]["follows_direction"].is_null());
  const WarmBench steady([](double part) { return std::to_string(20.0 + 80.0 * part); });
  EXPECT_TRUE(report(steady)["temperature"]["follows_direction"].is_null());
}

TEST(WrongColumns, ExchangedOnesAreReportedAsAPair) {
  const Workshop where;
  std::string array = with(where.text("array.toml"), "id = \"a1\"\n", "id = \"a1\"\ncolumn = \"a4\"\n");
  where.put("array.toml", with(array, "id = \"a4\"\n", "id = \"a4\"\ncolumn = \"a1\"\n"));
  const Outcome outcome = calibrate(where);
  EXPECT_EQ(outcome.code, 4);
  EXPECT_TRUE(says(outcome.err,
                   {"with the columns of a1 and a4 exchanged the fit would be accepted", "`column` of a1 and a4"}));
  EXPECT_EQ(report(where)["refusal"]["would_settle"]["columns_exchanged"], Json::parse(R"([["a1", "a4"]])"));
}

TEST(WrongColumns, AReversedSignIsReported) {
  const Workshop where;
  where.put("array.toml", with(where.text("array.toml"), "scale = \"3 V/g0\"", "scale = \"-3 V/g0\""));
  const Outcome outcome = calibrate(where);
  EXPECT_EQ(outcome.code, 4);
  EXPECT_TRUE(says(outcome.err, {"with the sign of a1 reversed", "the fit would be accepted", "check the sign of a1"}));
}

TEST(WrongColumns, WhatNoExchangeExplainsPointsToTheKeys) {
  const Workshop where;  // what a1 and a4 measure stands in for one another, and a2 is reversed
  rewrite(where, "calibration.csv", [](std::size_t row, Cells& cells) {
    if (row == 0) return;
    std::swap(cells[kA1], cells[kA4]);
    cells[kA1 + 1] = std::to_string(-std::stod(cells[kA1 + 1]) * 0.5);
  });
  const Json json = report(where);
  EXPECT_FALSE(json["accepted"]);
  EXPECT_TRUE(json["refusal"]["would_settle"].is_null());
  EXPECT_NE(json["refusal"]["next"].get<std::string>().find("`column`"), std::string::npos) << json["refusal"];
}

TEST(WrongColumns, ArraysWithUnobservablePermutationsSaySo) {
  const Workshop where;
  EXPECT_TRUE(says(flat(calibrate(where).out), {"wiring", "OPEN", "47 other wirings", "--known-attitude"}));
  const Json geometry = Json::parse(run(where, {"geometry", "array.toml", "--json"}).out);
  EXPECT_EQ(report(where)["unobservable_permutation_count"], geometry["unobservable_permutations"].size());
}

}  // namespace
}  // namespace wrong_columns_test
