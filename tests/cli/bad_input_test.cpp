// Bad input through the tool: a message with file, line, field and remedy, and the right exit code.
#include "tool_runner.hpp"

namespace bad_input_test {
namespace {

using namespace plumb_test;

Outcome geometry_of(const std::string& array_text) {
  const Directory where;
  write_text(where / "array.toml", array_text);
  return run(where, {"geometry", "array.toml"});
}

std::string good_array() { return read_text(example_files() / "array.toml"); }

void refused(const Outcome& outcome, int code, const std::vector<std::string>& words) {
  EXPECT_EQ(outcome.code, code) << outcome.out << outcome.err;
  EXPECT_TRUE(says(outcome.err, words));
  EXPECT_NE(outcome.err.find("Remedy: "), std::string::npos) << outcome.err;
}

TEST(BadArrayFile, MissingFileIsRefused) {
  const Directory where;
  refused(run(where, {"geometry", "nowhere.toml"}), 3, {"nowhere.toml", "No such file"});
}

TEST(BadArrayFile, EmptyFileIsRefused) {
  refused(geometry_of(""), 3, {"array.toml", "the file is empty", "[[sensor]]"});
}

TEST(BadArrayFile, UnitMissing) {
  refused(geometry_of(with(good_array(), "unit = \"V\"", "")), 3,
          {"array.toml:", "input.unit", "Remedy: state the unit"});
}

TEST(BadArrayFile, UnitUnknown) {
  refused(geometry_of(with(good_array(), "unit = \"V\"", "unit = \"furlong\"")), 3,
          {"array.toml:", "input.unit", "furlong"});
}

TEST(BadArrayFile, NumberWithoutUnitIsRefused) {
  refused(geometry_of(with(good_array(), "noise = \"200 ug0\"", "noise = \"200\"")), 3,
          {"array.toml:", "sensor[1].noise"});
}

TEST(BadArrayFile, BareGIsRefused) {
  refused(geometry_of(with(good_array(), "noise = \"200 ug0\"", "noise = \"0.0002 g\"")), 3,
          {"array.toml:", "sensor[1].noise", "g0"});
}

TEST(BadArrayFile, AxisNotUnit) {
  refused(geometry_of(with(good_array(), "axis = [0.0, 0.0, 1.0]", "axis = [0.0, 0.0, 1.02]")), 3,
          {"array.toml:", "sensor[4].axis", "1.02 long", "Remedy: divide it by its length"});
}

std::string array_with_axes(const std::vector<std::string>& axes, const std::vector<std::string>& ids) {
  std::string text =
      "[gravity]\nmodel = \"value\"\nvalue = \"9.81 m/s^2\"\n[input]\nreads = \"gravity\"\nunit = \"V\"\ntime = "
      "\"t_s\"\n";
  for (std::size_t i = 0; i < axes.size(); ++i) {
    text += "[[sensor]]\nid = \"" + ids[i] + "\"\ncolumn = \"c" + std::to_string(i) + "\"\naxis = " + axes[i] +
            "\nscale = \"3 V/g0\"\nnoise = \"0.2 mg\"\n";
  }
  return text;
}

const std::vector<std::string> kFourIds = {"a1", "a2", "a3", "a4"};

TEST(BadArrayFile, CoplanarAxes) {
  refused(geometry_of(array_with_axes({"[1, 0, 0]", "[0, 1, 0]", "[0.6, 0.8, 0]", "[0.8, -0.6, 0]"}, kFourIds)), 3,
          {"array.toml:", "axis", "one plane"});
}

TEST(BadArrayFile, FewerThanThreeSensors) {
  refused(geometry_of(array_with_axes({"[1, 0, 0]", "[0, 1, 0]"}, kFourIds)), 3,
          {"array.toml:", "2 sensors", "3 are needed"});
}

TEST(BadArrayFile, ParallelAxesAreAllowed) {
  const Outcome outcome = geometry_of(array_with_axes({"[1, 0, 0]", "[0, 1, 0]", "[0, 0, 1]", "[0, 0, 1]"}, kFourIds));
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_TRUE(says(outcome.out, {"near singular", "a1, a3, a4"}));
}

TEST(BadArrayFile, DuplicateIdsAreRefused) {
  refused(geometry_of(array_with_axes({"[1, 0, 0]", "[0, 1, 0]", "[0, 0, 1]"}, {"a1", "a2", "a1"})), 3,
          {"array.toml:", "sensor[3].id", "\"a1\" is already"});
}

TEST(BadArrayFile, UnknownKeyNamesTheNearest) {
  refused(geometry_of(with(good_array(), "noise = ", "nose = ")), 3,
          {"array.toml:", "nose", "did you mean \"noise\"?"});
}

Outcome calibrate(const Workshop& where, const std::vector<std::string>& more = {}) {
  std::vector<std::string> arguments = {"calibrate",       "--array", "array.toml", "--log",
                                        "calibration.csv", "--out",   "new.json"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return run(where, arguments);
}

/// The calibration log with line `number` put through `change`.
template <class Change>
void change_line(const Workshop& where, int number, Change change) {
  const std::string line = line_of(where.text("calibration.csv"), number);
  where.put("calibration.csv", with(where.text("calibration.csv"), "\n" + line + "\n", "\n" + change(line) + "\n"));
}

TEST(BadLog, EmptyFile) {
  const Workshop where;
  where.put("calibration.csv", "");
  refused(calibrate(where), 3, {"calibration.csv", "the log is empty", "header row"});
  EXPECT_FALSE(std::filesystem::exists(where / "new.json"));
}

TEST(BadLog, MissingColumn) {
  const Workshop where;
  where.put("calibration.csv", with(where.text("calibration.csv"), "a2", "a_2"));
  refused(calibrate(where), 3, {"calibration.csv:1", "a2", "missing", "did you mean \"a_2\"?"});
}

TEST(BadLog, TextInANumber) {
  const Workshop where;
  change_line(where, 40, [](const std::string& line) { return line.substr(0, line.rfind(',')) + ",n/a"; });
  refused(calibrate(where), 3, {"calibration.csv:40", "a4", "\"n/a\" is not a number"});
}

TEST(BadLog, NanIsCountedAndNotABadRow) {
  const Workshop where;
  change_line(where, 40, [](const std::string& line) { return line.substr(0, line.rfind(',')) + ",nan"; });
  const Outcome outcome = calibrate(where);
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_TRUE(says(outcome.out, {"9600 rows used, 0 bad rows", "accepted"}));
}

TEST(BadLog, ShortRow) {
  const Workshop where;
  change_line(where, 41, [](const std::string& line) { return line.substr(0, line.rfind(',')); });
  refused(calibrate(where), 3, {"calibration.csv:41", "cells", "--on-bad-row skip"});
}

TEST(BadLog, TimeThatDoesNotIncrease) {
  const Workshop where;
  const std::string before = line_of(where.text("calibration.csv"), 41);
  change_line(where, 42, [&before](const std::string& line) {
    return before.substr(0, before.find(',')) + line.substr(line.find(','));
  });
  refused(calibrate(where), 3, {"calibration.csv:42", "t_s", "does not increase"});
}

/// The library's own message showed the enumeration's numbers as control characters.
TEST(BadLog, AWordThatIsNoPolicyIsAnsweredWithThoseThatAre) {
  const Workshop where;
  const Outcome outcome = calibrate(where, {"--on-bad-row", "maybe"});
  EXPECT_EQ(outcome.code, 2);
  EXPECT_TRUE(says(outcome.err, {"--on-bad-row: \"maybe\" is not skip or stop"})) << outcome.err;
}

TEST(BadLog, BadRowsAreSkippedWhereAskedFor) {
  const Workshop where;
  change_line(where, 41, [](const std::string& line) { return line.substr(0, line.rfind(',')); });
  const Outcome outcome = calibrate(where, {"--on-bad-row", "skip"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_TRUE(says(outcome.out, {"9599 rows used, 1 bad row skipped", "accepted"}));
}

// Negative: REQ-175
TEST(BadLog, TooFewStationsAreNotAccepted) {
  const Workshop where;
  const std::string log = where.text("calibration.csv");
  std::size_t end = 0;
  for (int k = 0; k < 1 + 3 * 200; ++k) end = log.find('\n', end) + 1;
  where.put("calibration.csv", log.substr(0, end));
  const Outcome outcome = calibrate(where);
  refused(outcome, 4, {"not accepted", "new.json was not written", "inclination"});
  EXPECT_TRUE(says(outcome.out, {"3 stations", "NOT ACCEPTED"})) << "the report is printed all the same";
  EXPECT_FALSE(std::filesystem::exists(where / "new.json"));
}

TEST(BadLog, StationsInOnePlaneAreNotObservable) {
  const Workshop where;
  where.put("array.toml", with(array_with_axes({"[1, 0, 0]", "[0, 1, 0]", "[0, 0, 1]", "[0.6, 0.8, 0]"}, kFourIds),
                               "time = \"t_s\"", "rows = \"stations\""));
  std::string log = "c0,c1,c2,c3\n";
  for (const char* xy : {"3,0", "0,3", "-3,0", "0,-3", "1.8,2.4", "-1.8,2.4", "-1.8,-2.4", "1.8,-2.4", "2.4,1.8",
                         "-2.4,1.8", "-2.4,-1.8", "2.4,-1.8"}) {
    double x = 0.0;
    double y = 0.0;
    char comma = ',';
    std::istringstream(xy) >> x >> comma >> y;
    // Not quite constant, or the column itself would be the complaint.
    log += std::string(xy) + (x > 0.0 ? ",0.0001," : ",-0.0001,") + std::to_string(0.6 * x + 0.8 * y) + "\n";
  }
  where.put("calibration.csv", log);
  const Outcome outcome = calibrate(where);
  refused(outcome, 4,
          {"not accepted", "of the 13 parameters", "new.json was not written", "Remedy: hold the tool still"});
  EXPECT_TRUE(says(outcome.out, {"not determined", "scale of a3"}));
}

TEST(BadOutput, UnwritableOutput) {
  const Workshop where;
  refused(run(where, {"calibrate", "--array", "array.toml", "--log", "calibration.csv", "--out", "no/such/dir.json"}),
          1, {"no/such/dir.json", "cannot write"});
  refused(run(where, {"monitor", "--array", "array.toml", "--calibration", "calibration.json", "--log", "drilling.csv",
                      "--events", "no/such/events.jsonl"}),
          1, {"no/such/events.jsonl", "cannot write"});
  refused(run(where, {"demo", "--out", "array.toml"}), 1, {"array.toml", "cannot create the directory"});
}

Outcome monitor(const Workshop& where) {
  return run(where, {"monitor", "--array", "array.toml", "--calibration", "calibration.json", "--log", "drilling.csv"});
}

TEST(BadCalibration, OfAnotherArray) {
  const Workshop where;
  where.put("array.toml", with(where.text("array.toml"), "scale = \"3 V/g0\"", "scale = \"2.5 V/g0\""));
  refused(monitor(where), 3, {"calibration.json", "array.nominal[1].scale", "another array", "scale of a1"});
}

TEST(BadCalibration, Truncated) {
  const Workshop where;
  const std::string text = where.text("calibration.json");
  where.put("calibration.json", text.substr(0, text.size() / 2));
  refused(monitor(where), 3, {"calibration.json"});
}

TEST(BadCalibration, Edited) {
  const Workshop where;
  const std::string text = where.text("calibration.json");
  const std::size_t digit = text.find_first_of("123456789", text.find("\"bias"));
  ASSERT_NE(digit, std::string::npos);
  std::string edited = text;
  edited[digit] = edited[digit] == '1' ? '2' : '1';
  where.put("calibration.json", edited);
  refused(monitor(where), 3, {"calibration.json", "checksum"});
}

TEST(BadCommandLine, IsAnsweredWithTheNearestName) {
  const Directory where;
  const std::vector<std::pair<std::vector<std::string>, std::vector<std::string>>> cases = {
      {{"monitr"}, {"\"monitr\"", "Did you mean \"monitor\"?"}},
      {{"monitor", "--aray", "x"}, {"\"--aray\"", "Did you mean \"--array\"?", "plumb monitor --help"}},
      {{"monitor"}, {"--array is required"}},
      {{"geometry"}, {"no array is given", "Remedy"}},
      {{"geometry", "--name", "con:5"}, {"con:5", "did you mean \"cone\"?"}},
      {{"geometry", "--name", "cone:2"}, {"cone:2", "is not a built-in geometry"}},
      {{"model", "--format", "pdf"}, {"--format"}},
      {{}, {"Usage: plumb", "demo"}},
  };
  for (const auto& [arguments, words] : cases) {
    const Outcome outcome = run(where, arguments);
    EXPECT_EQ(outcome.code, 2) << outcome.out << outcome.err;
    EXPECT_TRUE(says(outcome.err, words));
  }
}

TEST(BadCommandLine, FaultThatCannotBeReadIsExplained) {
  const Workshop where;
  const Outcome outcome = run(where, {"inject", "--array", "array.toml", "--log", "drilling.csv", "--fault",
                                      "a1:stuk=0V@3s", "--out", "x.csv"});
  EXPECT_EQ(outcome.code, 2);
  EXPECT_TRUE(says(outcome.err, {"stuk", "stuck"}));
  EXPECT_FALSE(std::filesystem::exists(where / "x.csv"));
}

TEST(SameFile, AnOutputThatIsAnInputIsRefusedAndTheInputKept) {
  const Directory where;
  const std::string array = read_text(example_files() / "array.toml"),
                    log = read_text(example_files() / "drilling.csv");
  write_text(where / "array.toml", array);
  write_text(where / "log.csv", log);
  write_text(where / "cal.json", read_text(example_files() / "calibration.json"));
  refused(run(where,
              {"inject", "--array", "array.toml", "--log", "log.csv", "--fault", "a2:last@3s", "--out", "./log.csv"}),
          2, {"log.csv", "--out", "--log"});
  refused(run(where, {"monitor", "--array", "array.toml", "--calibration", "cal.json", "--log", "log.csv", "--events",
                      "log.csv"}),
          2, {"log.csv", "--events"});
  refused(run(where, {"monitor", "--array", "array.toml", "--calibration", "cal.json", "--log", "log.csv", "--events",
                      "z", "--verdicts", "z"}),
          2, {"--verdicts", "--events"});
  refused(run(where, {"calibrate", "--array", "array.toml", "--log", "log.csv", "--out", "array.toml"}), 2,
          {"array.toml"});
  EXPECT_EQ(read_text(where / "log.csv"), log);
  EXPECT_EQ(read_text(where / "array.toml"), array);
}

}  // namespace
}  // namespace bad_input_test
