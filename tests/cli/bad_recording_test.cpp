// Recordings that cannot be what the array file says, through the tool: each is refused or reported by name.
#include <nlohmann/json.hpp>

#include "tool_runner.hpp"

namespace bad_recording_test {
namespace {

using namespace plumb_test;
using Table = std::vector<std::vector<double>>;

/// One row per station: the 48 stations of the example's log, as its report has them, by four sensors.
class StationBench : public Workshop {
 public:
  StationBench() {
    std::istringstream in(text("calibration.csv"));
    std::string line;
    std::getline(in, line);
    std::string last;
    for (int in_station = 0; std::getline(in, line); ++in_station) {
      std::istringstream cells(line);
      std::string cell, station;
      std::getline(cells, cell, ',');
      std::getline(cells, station, ',');
      if (station != last) rows.emplace_back(4, 0.0);
      last = station;
      for (double& value : rows.back()) {
        std::getline(cells, cell, ',');
        value += std::stod(cell) / 200.0;
      }
    }
    std::string array = with(text("array.toml"), "time = \"t_s\"\n", "rows = \"stations\"\ncount = \"n\"\n");
    array.erase(array.find("station = \"station\""),
                array.find('\n', array.find("station = \"station\"")) - array.find("station = \"station\""));
    put("array.toml", array);
  }
  Outcome calibrate(const std::vector<std::string>& more = {}) const {
    std::string log = "n,a1,a2,a3,a4\n";
    for (const std::vector<double>& row : rows) {
      log += "200";
      for (const double value : row) {
        std::ostringstream cell;
        cell.precision(15);
        cell << value;
        log += "," + cell.str();
      }
      log += "\n";
    }
    put("calibration.csv", log);
    std::vector<std::string> arguments = {"calibrate",       "--array", "array.toml", "--log",
                                          "calibration.csv", "--out",   "new.json"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run(*this, arguments);
  }
  Table rows;
};

/// Takes keys out of the array file.
void forget(const Workshop& where, const std::vector<std::string>& keys) {
  std::string array = where.text("array.toml");
  for (const std::string& key : keys) {
    for (std::size_t at = array.find(key); at != std::string::npos; at = array.find(key, at))
      array.erase(at, array.find('\n', at) - at);
  }
  where.put("array.toml", array);
}

/// One line, single blanks: where the report wraps is not what is tested.
std::string flat(const std::string& text) {
  std::istringstream in(text);
  std::string out, word;
  while (in >> word) out += word + " ";
  return out;
}

void refused(const Outcome& outcome, const std::vector<std::string>& words) {
  EXPECT_EQ(outcome.code, 4) << outcome.out << outcome.err;
  EXPECT_TRUE(says(outcome.err, words));
  EXPECT_TRUE(says(outcome.err, {"new.json was not written", "Remedy: "}));
}

TEST(BadRecording, TheBenchItselfIsFine) {
  const StationBench where;
  ASSERT_EQ(where.rows.size(), 48U);
  const Outcome outcome = where.calibrate();
  EXPECT_EQ(outcome.code, 0) << outcome.err;
}

TEST(BadRecording, FewerPositionsThanUnknowns) {
  StationBench where;
  where.rows.resize(8);
  refused(where.calibrate(), {"8 stations were found, 9 are needed", "inclination"});
}

TEST(BadRecording, OneAttitudeRepeated) {
  StationBench where;
  for (std::size_t k = 1; k < where.rows.size(); ++k) {
    for (std::size_t i = 0; i < 4; ++i)
      where.rows[k][i] = where.rows[0][i] + 1e-5 * static_cast<double>((k * 7 + i * 3) % 11);
  }
  refused(where.calibrate(), {"2 of the 13 parameters"});
}

TEST(BadRecording, OneSensorInTwoColumns) {
  StationBench where;
  for (auto& row : where.rows) row[2] = row[1];
  refused(where.calibrate(), {"a2 and a3 hold the same numbers at every station", "`column`"});
}

TEST(BadRecording, TwoSensorsAlongOneAxisWithOneChannelBetweenThem) {
  StationBench where;
  where.put("array.toml", where.text("array.toml") +
                              "\n[[sensor]]\nid = \"a5\"\ncolumn = \"a4b\"\naxis = [0.0, 0.0, 1.0]\nscale = \"3 "
                              "V/g0\"\nnoise = \"200 ug0\"\n");
  where.calibrate();
  std::istringstream in(where.text("calibration.csv"));
  std::string line, log;
  for (int row = 0; std::getline(in, line); ++row)
    log += line + (row == 0 ? ",a4b" : line.substr(line.rfind(','))) + "\n";
  where.put("calibration.csv", log);
  refused(run(where, {"calibrate", "--array", "array.toml", "--log", "calibration.csv", "--out", "new.json"}),
          {"a4 and a5 hold the same numbers"});
}

TEST(BadRecording, AScaleOfZeroOrOfTheWrongSign) {
  const StationBench where;
  const std::string array = where.text("array.toml");
  where.put("array.toml", with(array, "scale = \"3 V/g0\"", "scale = \"0 V/g0\""));
  const Outcome zero = where.calibrate();
  EXPECT_EQ(zero.code, 3);
  EXPECT_TRUE(says(zero.err, {"array.toml:", "sensor[1].scale", "zero"}));
  where.put("array.toml", with(array, "scale = \"3 V/g0\"", "scale = \"-3 V/g0\""));
  refused(where.calibrate(), {"a1", "sign"});
}

TEST(BadRecording, SaturatedReadingsAreNotUsedAndReported) {
  StationBench where;
  std::string array = where.text("array.toml");
  for (int k = 0; k < 4; ++k) array = with(array, "full_scale = \"5 V\"", "full_scale = \"3.2 V\" ");
  where.put("array.toml", array);
  int clipped = 0;
  for (auto& row : where.rows) {
    for (double& value : row) {
      if (value > -2.5) continue;
      value = -3.2;
      ++clipped;
    }
  }
  ASSERT_GE(clipped, 4);
  const Outcome outcome = where.calibrate();
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_TRUE(says(outcome.out, {"at full scale", std::to_string(clipped) + " readings of", "not used"}));
}

TEST(BadRecording, ReadingsThatNoSensorGives) {
  for (const double value : {1e308, -1e308}) {
    StationBench where;
    where.rows[6][2] = value;
    const Outcome outcome = where.calibrate();  // beyond full scale, which the array file knows
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_TRUE(says(outcome.out, {"at full scale", "1 reading of a3, not used"}));
    forget(where, {"full_scale"});
    refused(where.calibrate(),
            {"station 7 holds a reading that no sensor gives (a3 reads", "e+308 V)", "correct or remove the row"});
  }
  for (const char* cell : {"nan", "inf", "-inf"}) {
    StationBench where;
    where.calibrate();
    const std::string line = line_of(where.text("calibration.csv"), 8);
    where.put("calibration.csv", with(where.text("calibration.csv"), line, line.substr(0, line.rfind(',') + 1) + cell));
    const Outcome outcome =
        run(where, {"calibrate", "--array", "array.toml", "--log", "calibration.csv", "--out", "new.json", "--json"});
    EXPECT_EQ(outcome.code, 0) << outcome.err;  // the other three sensors of that station are used
    EXPECT_TRUE(nlohmann::json::parse(outcome.out)["accepted"]);
  }
}

TEST(BadRecording, EmptyLogs) {
  for (const char* log : {"", "\n\n", "n,a1,a2,a3,a4\n"}) {
    const StationBench where;
    where.put("calibration.csv", log);
    const Outcome outcome =
        run(where, {"calibrate", "--array", "array.toml", "--log", "calibration.csv", "--out", "new.json"});
    EXPECT_EQ(outcome.code, 3);
    EXPECT_TRUE(says(outcome.err, {"calibration.csv", "Remedy"}));
  }
}

TEST(BadRecording, AnotherUnitIsReported) {
  const struct {
    double factor;  ///< of the numbers, which are V at 3 V/g0
    const char* unit;
  } cases[] = {
      {1e3, "they look like mV"},       {1e6, "they look like uV"},        {9.80665 / 3.0, "they look like m/s^2"},
      {1.0 / 3.0, "they look like g0"}, {1e3 / 3.0, "they look like mg0"}, {6553.6, "are they counts of a converter?"}};
  for (const auto& one : cases) {
    StationBench where;
    for (auto& row : where.rows) {
      for (double& value : row) value *= one.factor;
    }
    forget(where, {"full_scale"});
    refused(where.calibrate(), {"times as long as gravity", "are not in V", one.unit, "`unit`"});
  }
  StationBench volts;  // counts stated, volts in the log
  std::string array = with(volts.text("array.toml"), "unit = \"V\"", "unit = \"count\"");
  for (int k = 0; k < 4; ++k) array = with(array, "3 V/g0", "19661 count/g0");
  volts.put("array.toml", array);
  forget(volts, {"full_scale", "resolution"});
  refused(volts.calibrate(), {"are not in count", "are they volts?"});
}

TEST(BadRecording, TheFaultySensorIsReportedByParityAndByOutliers) {
  StationBench where;
  for (std::size_t k = 20; k < where.rows.size(); ++k) where.rows[k][2] += 0.06;  // 20 mg0 from station 21 on
  refused(where.calibrate(), {"a3"});
  StationBench spikes;
  for (std::size_t k = 0; k < spikes.rows.size(); k += 12) spikes.rows[k][1] += 0.3;
  const Outcome outcome = spikes.calibrate();
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_TRUE(says(outcome.out, {"rejected", "station 1 (", "of it from a2", "station 37 ("}));
}

TEST(BadRecording, MoreOutliersThanAreListedAreAllRejected) {
  StationBench where;
  const Table once = where.rows;
  for (int copy = 1; copy < 3; ++copy) {
    for (std::size_t k = 0; k < once.size(); ++k) {
      where.rows.push_back(once[k]);
      for (std::size_t i = 0; i < 4; ++i)  // noise of its own
        where.rows.back()[i] += 1e-5 * static_cast<double>((k * 5 + i * 3 + static_cast<std::size_t>(copy)) % 9) - 4e-5;
    }
  }
  std::size_t spikes = 0;
  for (std::size_t k = 3; k < where.rows.size(); k += 7, ++spikes) where.rows[k][k % 4] += 0.3;
  ASSERT_GT(spikes, 16U);
  const Outcome outcome = where.calibrate({"--json"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  const auto json = nlohmann::json::parse(outcome.out);
  EXPECT_EQ(json["outliers"]["count"], spikes);
  ASSERT_EQ(json["outliers"]["stations"].size(), spikes);
  for (std::size_t k = 0; k < spikes; ++k) EXPECT_EQ(json["outliers"]["stations"][k], 4 + 7 * k);
  EXPECT_EQ(json["outliers"]["listed"].size(), 16U);
  EXPECT_EQ(json["hold_out"]["judged"], where.rows.size() - spikes);
  EXPECT_LT(json["hold_out"]["sigmas"].get<double>(), 3.0);
  EXPECT_TRUE(says(flat(where.calibrate().out), {"rejected", "and " + std::to_string(spikes - 16) + " more"}));
}

TEST(BadRecording, NoiseFiveTimesAsDeclaredOfOneSensorIsReportedByName) {
  StationBench where;
  const double wiggle[] = {0.9, -1.2, 0.3, 1.4, -0.7, -1.0, 1.1, -0.2, 0.5, -1.3, 0.1};
  for (std::size_t k = 0; k < where.rows.size(); ++k) where.rows[k][1] += 3e-4 * wiggle[k % 11];
  const Outcome outcome = where.calibrate();
  EXPECT_TRUE(says(flat(outcome.out),
                   {"chi^2", "times what the declared noise alone leaves", "stands out a2: its residuals are"}));
}

TEST(BadRecording, AxesNearOnePlaneAndThePapersFit) {
  StationBench where;
  // Four axes within a tenth of a degree of the plane z = 0, by the datasheet; in truth they lie a degree or two off.
  const double tilt[] = {0.002, -0.001, 0.0015, -0.002};
  const double off[4][3] = {{0.0, 0.01, -0.03}, {0.02, 0.0, 0.025}, {-0.01, 0.02, -0.02}, {0.01, -0.02, 0.03}};
  std::string array =
      "[gravity]\nmodel = \"value\"\nvalue = \"9.80665 m/s^2\"\n[input]\nreads = \"gravity\"\nunit = "
      "\"V\"\nrows = \"stations\"\ncount = \"n\"\n";
  std::vector<std::vector<double>> axes;
  for (int i = 0; i < 4; ++i) {
    const double angle = 0.8 * i, z = tilt[i], flat = std::sqrt(1.0 - z * z);
    axes.push_back({flat * std::cos(angle), flat * std::sin(angle), z});
    std::ostringstream text;
    text.precision(17);
    text << "[" << axes.back()[0] << ", " << axes.back()[1] << ", " << axes.back()[2] << "]";
    array += "[[sensor]]\nid = \"a" + std::to_string(i + 1) + "\"\naxis = " + text.str() +
             "\nscale = \"3 V/g0\"\nnoise = \"0.2 mg\"\n";
  }
  where.put("array.toml", array);
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t p = 0; p < 3; ++p) axes[i][p] += off[i][p];
  }
  for (std::size_t k = 0; k < where.rows.size(); ++k) {
    const double z = 1.0 - (2.0 * static_cast<double>(k) + 1.0) / 48.0, a = 2.4 * static_cast<double>(k),
                 r = std::sqrt(1.0 - z * z);
    for (std::size_t i = 0; i < 4; ++i)
      where.rows[k][i] = 3.0 * (axes[i][0] * r * std::cos(a) + axes[i][1] * r * std::sin(a) + axes[i][2] * z) +
                         1e-5 * static_cast<double>((k * 7 + i * 5) % 13);
  }
  const Outcome plain = where.calibrate({"--hold-out", "none"});
  ASSERT_EQ(plain.code, 0) << plain.err;
  refused(where.calibrate({"--paper", "--hold-out", "none"}),
          {"the nominal axes lie near one plane", "calibrate without --paper"});
}

}  // namespace
}  // namespace bad_recording_test
