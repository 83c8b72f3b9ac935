// What is refused of a scenario file, with which words; and the page that lists its keys.
#include <gtest/gtest.h>

#include <sstream>
#include <vector>

#include "io_test_support.hpp"
#include "plumb/io/output_file.hpp"
#include "plumb/io/scenario_file.hpp"

namespace scenario_refusal_test {
namespace {

using namespace plumb;
using namespace plumb::io;
using namespace io_test;

const std::string kShortest = "tool = \"paper\"\n[attitude]\nlaw = \"drilling-path\"\n";

TEST(ScenarioRefusal, RateComesFromTheArrayFileWhereItDeclaresOne) {
  const std::string array_path = written("array.toml", changed("time = \"t_s\"", "rate = \"250 Hz\""));
  const std::string head = "array = \"" + array_path + "\"\n";
  const std::string attitude = "[attitude]\nlaw = \"random\"\n";
  const auto good = parse_scenario_text(head + attitude, "s.toml");
  ASSERT_TRUE(good) << good.error().text();
  EXPECT_EQ(good->scenario.rate_hz, 250.0);
  const auto refuse = [&](const std::string& text, int line, const std::string& field,
                          std::initializer_list<const char*> parts) {
    const auto file = parse_scenario_text(text, "s.toml");
    ASSERT_FALSE(file) << text;
    expect_error(file.error(), "s.toml", line, field, parts);
  };
  refuse(head + "rate = \"100 Hz\"\n" + attitude, 2, "rate", {"100 Hz", "250 Hz", "no time column"});
  refuse(head + "start = \"5 s\"\n" + attitude, 2, "start", {"no time column"});
  refuse(head + attitude + "record_motion = false\n", 4, "attitude.record_motion", {"gaps"});
  refuse(head + attitude + "tag_stations = true\n", 4, "attitude.tag_stations", {"no station column", "station = "});
}

TEST(ScenarioRefusal, BadFilesAreRefusedWithLineFieldAndRemedy) {
  struct Case {
    std::string text;
    int line;
    std::string field;
    std::vector<const char*> parts;
  };
  const std::string tool = "tool = \"paper\"\n";
  const std::string sensor = kShortest + "[[sensor_truth]]\n";
  const std::vector<Case> cases = {
      {"", 0, "", {"the file is empty", "[attitude]"}},
      {"tool = paper\n", 1, "", {"not valid TOML"}},
      {kShortest + "[nosie]\n", 4, "nosie", {"not a known key", "did you mean \"noise\"?"}},
      {"[attitude]\nlaw = \"fixed\"\n", 0, "array", {"is missing", "tool = \"paper\""}},
      {tool + "array = \"x.toml\"\n", 1, "tool", {"both", "keep one"}},
      {"array = \"nowhere/x.toml\"\n", 1, "array", {"no file", "nowhere/x.toml", "relative to the scenario file"}},
      {"tool = \"papre\"\n", 1, "tool", {"papre", "did you mean \"paper\"?"}},
      {tool, 0, "attitude", {"is missing", "drilling-path"}},
      {tool + "rate = 100\n[attitude]\nlaw = \"random\"", 2, "rate", {"the unit is missing", "Hz"}},
      {tool + "rate = \"0 Hz\"\n[attitude]\nlaw = \"random\"", 2, "rate", {"\"0 Hz\"", "out of range", "100 Hz"}},
      {tool + "seed = -1\n[attitude]\nlaw = \"random\"", 2, "seed", {"not a seed", "seed = 1"}},
      {tool + "seed = 99999999999999999999\n[attitude]\nlaw = \"random\"", 2, "seed", {"not a seed", "in quotes"}},
      {tool + "seed = \"1x\"\n[attitude]\nlaw = \"random\"", 2, "seed", {"not a seed"}},
      {tool + "gravity = \"1 g\"\n[attitude]\nlaw = \"random\"", 2, "gravity", {"ambiguous", "g0"}},
      {tool + "gravity = \"1.62 m/s^2\"\n", 2, "gravity", {"out of range", "9.5 to 10.2"}},
      {tool + "[attitude]\nlaw = \"rol-test\"\n", 3, "attitude.law", {"did you mean \"roll-test\"?"}},
      {tool + "[attitude]\nlaw = \"random\"\nbuild = \"4 deg\"\n",
       4,
       "attitude.build",
       {"cannot be used with", "stations"}},
      {tool + "[attitude]\nlaw = \"random\"\nstatoins = 4\n", 4, "attitude.statoins", {"did you mean \"stations\"?"}},
      {tool + "[attitude]\nlaw = \"random\"\nstations = 0\n", 4, "attitude.stations", {"is 0", "1 to 1000000"}},
      {tool + "[attitude]\nlaw = \"fixed\"\n", 2, "attitude.direction", {"is missing", "[0, 0, 1]"}},
      {tool + "[attitude]\nlaw = \"fixed\"\ndirection = [0, 3, 4]\n",
       4,
       "attitude.direction",
       {"is 5 long", "[0, 0.6, 0.8]"}},
      {tool + "[attitude]\nlaw = \"list\"\ndirections = []\n",
       4,
       "attitude.directions",
       {"must be a list of at least one direction"}},
      {tool + "[attitude]\nlaw = \"list\"\ndirections = [[0, 0, 1], [0, 1]]\n",
       4,
       "attitude.directions[2]",
       {"not a direction"}},
      {kShortest + "dwell = \"-2 s\"\n", 4, "attitude.dwell", {"\"-2 s\"", "out of range"}},
      {kShortest + "dwell = \"1 ms\"\n", 4, "attitude.dwell", {"too short", "raise"}},
      {kShortest + "motion = \"2 deg\"\n", 4, "attitude.motion", {"deg", "accepted: s, ms"}},
      {kShortest + "vibration = \"-1 g0\"\n", 4, "attitude.vibration", {"rms"}},
      {kShortest + "tag_stations = \"yes\"\n", 4, "attitude.tag_stations", {"true or false"}},
      {kShortest + "[truth]\nlaw = \"none\"\nbias = \"1 mg0\"\n", 6, "truth.bias", {"cannot be used with", "\"none\""}},
      {kShortest + "[truth]\nscale = \"80 %\"\n", 5, "truth.scale", {"\"80 %\"", "2 %"}},
      {sensor + "bias = \"1 mg0\"\n", 4, "sensor_truth[1].id", {"is missing", "a1, a2, a3, a4"}},
      {sensor + "id = \"b1\"\n", 5, "sensor_truth[1].id", {"no sensor \"b1\"", "a1, a2, a3, a4"}},
      {sensor + "id = \"a1\"\n[[sensor_truth]]\nid = \"a1\"\n",
       7,
       "sensor_truth[2].id",
       {"two [[sensor_truth]] tables"}},
      {sensor + "id = \"a1\"\nscale = \"3 count/g0\"\n", 6, "sensor_truth[1].scale", {"count", "the log is in V"}},
      {sensor + "id = \"a1\"\nscale_t = [\"3 V\"]\n", 6, "sensor_truth[1].scale_t[1]", {"per degC", "ppm/degC"}},
      {sensor + "id = \"a1\"\ncross = [1, 2]\n", 6, "sensor_truth[1].cross", {"4 numbers", "eq (3)"}},
      {sensor + "id = \"a1\"\naxis = [1, 1, 0]\n", 6, "sensor_truth[1].axis", {"unit length", "divide"}},
      {kShortest + "[temperature]\nrate = \"1 degC/s\"\n", 5, "temperature.rate", {"cannot be used with", "value"}},
      {kShortest + "[temperature]\nlaw = \"linear\"\nrate = \"1 degC\"\n", 6, "temperature.rate", {"3 degC/min"}},
      {kShortest + "[temperature]\nlaw = \"linear\"\n", 4, "temperature.rate", {"is missing", "3 degC/min"}},
      {kShortest + "[noise]\nfactor = -1\n", 5, "noise.factor", {"is -1", "0 none"}},
      {kShortest + "[fault]\nspec = \"a2:stuck=0V@12s\"\n", 4, "fault", {"must be a list", "[[fault]]"}},
      {kShortest + "[[fault]]\nspec = \"a9:stuck=0V@12s\"\n", 5, "fault[1].spec", {"no sensor 'a9'", "a1, a2, a3, a4"}},
      {kShortest + "[[fault]]\nspec = \"a2:stuck=0@12s\"\n", 5, "fault[1].spec", {"no unit", "Remedy: "}},
  };
  for (const Case& c : cases) {
    SCOPED_TRACE(c.text);
    const auto file = parse_scenario_text(c.text, "s.toml");
    ASSERT_FALSE(file);
    expect_error(file.error(), "s.toml", c.line, c.field, {});
    for (const char* part : c.parts) EXPECT_NE(file.error().text().find(part), std::string::npos) << part;
    EXPECT_EQ(file.error().text().find("Remedy: "), file.error().text().rfind("Remedy: ")) << "one remedy";
  }
}

TEST(ScenarioRefusal, ErrorsOfTheArrayFileKeepTheirOwnPlace) {
  const std::string array_path = written("array.toml", changed("noise = \"0.5 mg\"", "nose = \"0.5 mg\""));
  const auto file = parse_scenario_text("array = \"" + array_path + "\"\n", "s.toml");
  ASSERT_FALSE(file);
  EXPECT_EQ(file.error().file, array_path);
  EXPECT_NE(file.error().text().find("did you mean \"noise\"?"), std::string::npos);
}

/// The blocks of TOML in a page.
std::vector<std::string> toml_blocks(const std::string& page) {
  std::vector<std::string> blocks;
  std::istringstream in(page);
  bool inside = false;
  for (std::string line; std::getline(in, line);) {
    if (line == "```toml") blocks.emplace_back();
    const bool fence = line.rfind("```", 0) == 0;
    if (inside && !fence) blocks.back() += line + "\n";
    if (fence) inside = line == "```toml";
  }
  return blocks;
}

TEST(ScenarioPage, TheOfTheDocumentationIsTrue) {
  const auto page = read_file(std::string(PLUMB_SOURCE_DIR) + "/docs/scenario-file.md");
  ASSERT_TRUE(page);
  const std::vector<std::string> blocks = toml_blocks(*page);
  EXPECT_GE(blocks.size(), 3U);
  for (const std::string& block : blocks) {
    const auto file = parse_scenario_text(block, std::string(PLUMB_SOURCE_DIR) + "/examples/page.toml");
    EXPECT_TRUE(file) << block << (file ? "" : file.error().text());
  }
  // A refusal names the keys that are known; each must stand in the page.
  const auto known_keys = [](const std::string& text) {
    const auto file = parse_scenario_text(text, "s.toml");
    EXPECT_FALSE(file);
    const std::string remedy = file.error().remedy;
    const std::size_t at = remedy.find("known keys here: ");
    EXPECT_NE(at, std::string::npos) << remedy;
    return at == std::string::npos ? std::string() : remedy.substr(at + 17);
  };
  std::string keys = known_keys("zzzzzzzz = 1\n" + kShortest) + ", ";
  for (const char* section : {"", "[truth]\n", "[[sensor_truth]]\n", "[temperature]\n", "[noise]\n", "[rotation]\n",
                              "[depth]\n", "[[fault]]\n"}) {
    keys += known_keys(kShortest + section + "zzzzzzzz = 1\n") + ", ";
  }
  std::istringstream in(keys);
  int count = 0;
  for (std::string key; std::getline(in, key, ',');) {
    key.erase(0, key.find_first_not_of(' '));
    if (key.empty()) continue;
    ++count;
    const bool stands = page->find("`" + key + "`") != std::string::npos ||
                        page->find("`[" + key + "]`") != std::string::npos ||
                        page->find("`[[" + key + "]]`") != std::string::npos;
    EXPECT_TRUE(stands) << key;
  }
  EXPECT_EQ(count, 68) << "of nine sections";
}

}  // namespace
}  // namespace scenario_refusal_test
