// Campaigns of magnetometers: those of accelerometers with the field in the place of gravity, and nothing else.
#include <cmath>

#include "campaign_support.hpp"
#include "plumb/campaign/replay.hpp"
#include "plumb/campaign/result_file.hpp"
#include "plumb/geomagnetic/field_reference.hpp"

namespace field_campaign_test {
namespace {

using namespace plumb_test;
using namespace plumb::campaign;

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  for (; at != std::string::npos; at = text.find(from, at + to.size())) text.replace(at, from.size(), to);
  return text;
}

/// A campaign in figures that stand in a double as they are, so that a unit is a power of two and nothing else.
std::string in_mps2() {
  return "scenarios = 600\nseed = 11\n[[tool]]\ngeometry = \"tetrahedron\"\nnoise = \"0.001953125 m/s^2\"\n"
         "resolution = \"0.0009765625 m/s^2\"\nstability = \"0.00390625 m/s^2\"\n"
         "[[tool]]\ngeometry = \"cone\"\nsensors = 5\nnoise = \"0.00390625 m/s^2\"\n"
         "[run]\nonset = [1, 3]\n[gravity]\nvalue = \"9.8125 m/s^2\"\nsigma = \"0.0009765625 m/s^2\"\nerrors = [0, 3]\n"
         "[calibration]\nleft = \"0.00048828125 m/s^2\"\n[monitor]\nacceleration_bound = \"0.001953125 m/s^2\"\n"
         "alert_limit = \"1 deg\"\n"
         "[[attitude]]\nlaw = \"random\"\n[[attitude]]\nlaw = \"drilling-path\"\n"
         "[[fault]]\nspec = [\"none\", \"shake=0.1875m/s^2\"]\n"
         "[[fault]]\nspec = [\"stuck=0m/s^2\", \"random=-8m/s^2..8m/s^2\", \"last\", \"scale=1.1\", "
         "\"noise=0.0625m/s^2\", \"bias=0.5m/s^2+station2\", \"drift=0.0078125m/s^2/s\", \"ghost=20deg*30deg\"]\n"
         "sensors = [1, 2]\n[[fault]]\nbias_mdb = [0.5, 1, 2, 10, {from = 0.5, to = 100}]\n";
}

/// The same of magnetometers: 4 uT for every m/s^2.
std::string in_ut() {
  std::string text = "field = \"magnetic\"\n" + in_mps2();
  text = replaced(text, "[gravity]", "[reference]");
  text = replaced(text, "acceleration_bound", "disturbance_bound");
  for (const auto& [mps2, ut] : {std::pair<const char*, const char*>{"0.001953125 m/s^2", "0.0078125 uT"},
                                 {"0.0009765625 m/s^2", "0.00390625 uT"},
                                 {"0.00048828125 m/s^2", "0.001953125 uT"},
                                 {"0.00390625 m/s^2", "0.015625 uT"},
                                 {"9.8125 m/s^2", "39.25 uT"},
                                 {"0.1875m/s^2", "0.75uT"},
                                 {"stuck=0m/s^2", "stuck=0uT"},
                                 {"-8m/s^2..8m/s^2", "-32uT..32uT"},
                                 {"0.0625m/s^2", "0.25uT"},
                                 {"0.5m/s^2", "2uT"},
                                 {"0.0078125m/s^2/s", "0.03125uT/s"}})
    text = replaced(text, mps2, ut);
  EXPECT_EQ(text.find("m/s^2"), std::string::npos) << text;
  return text;
}

void expect_same_outcomes(const CampaignFile& a, const CampaignFile& b) {
  ASSERT_EQ(a.plan.cells.size(), b.plan.cells.size());
  const auto of_a = kernel_of(a.plan), of_b = kernel_of(b.plan);
  const auto one = std::make_unique<plumb::campaign::Outcome>(), two = std::make_unique<plumb::campaign::Outcome>();
  int alarms = 0, excluded = 0;
  for (std::uint64_t number = 0; number < a.plan.scenarios; ++number) {
    of_a->play(spec_of(a.plan, number), *one);
    of_b->play(spec_of(b.plan, number), *two);
    expect_same(*one, *two, sentence_of(b.plan, spec_of(b.plan, number)));
    alarms += one->alarm_block >= 0 ? 1 : 0;
    excluded += one->ever_excluded != 0 ? 1 : 0;
  }
  EXPECT_GT(alarms, 200);
  EXPECT_GT(excluded, 100);
}

// Verifies: REQ-254
// The monitor knows of a field its length alone: verdicts, states, bounds and angles to the last bit.
TEST(CampaignOfAField, IsThatOfGravityAtFourMicroteslaForEveryMetrePerSecondSquared) {
  const CampaignFile gravity = campaign_from(in_mps2()), field = campaign_from(in_ut());
  EXPECT_TRUE(field.plan.magnetic);
  EXPECT_FALSE(gravity.plan.magnetic);
  EXPECT_NE(hash_of(gravity.plan), hash_of(field.plan)) << "the results of one do not go on in the other";
  expect_same_outcomes(gravity, field);
}

/// The plan with every length of the vector, and of its errors, times `factor`.
CampaignFile scaled(CampaignFile file, double factor) {
  const auto scale = [factor](double& mps2) { mps2 *= factor; };
  Plan& plan = file.plan;
  for (double* const one : {&plan.gravity_mps2, &plan.gravity_sigma_mps2, &plan.calibration_mps2}) scale(*one);
  for (ToolPlan& tool : plan.tools) {
    for (double& one : tool.sigma_mps2) scale(one);
    for (double& one : tool.detectable_mps2) scale(one);
    for (auto& stability : tool.stability) {
      for (double& one : stability) scale(one);
    }
    tool.resolution_raw *= factor;
  }
  return file;
}

// Verifies: REQ-254
// Another length of the field: the same angles and states where noise, bounds and faults are the same parts of it.
TEST(CampaignOfAField, AFieldAndItsErrorsTwiceAsLargeGiveTheSameStates) {
  std::string text = in_ut();
  text = replaced(text, "disturbance_bound = \"0.0078125 uT\"\n", "");
  text = replaced(text, "39.25 uT", "31 uT");
  text = text.substr(0, text.find("[[fault]]"));
  text +=
      "[[fault]]\nspec = [\"none\", \"scale=1.1\", \"turned=10deg\", \"last\", \"ghost=20deg*30deg\"]\nsensors = [1, "
      "2]\n"
      "[[fault]]\nbias_mdb = [0.5, 1, 2, 10, {from = 0.5, to = 100}]\n";
  const CampaignFile once = campaign_from(text), twice = scaled(once, 2.0);
  ASSERT_EQ(twice.plan.gravity_mps2, 62.0 * plumb::io::kInside_per_ut);
  ASSERT_NE(hash_of(once.plan), hash_of(twice.plan));
  expect_same_outcomes(once, twice);
}

// Verifies: REQ-254
TEST(CampaignOfAField, SpeaksOfTheField) {
  const CampaignFile file = campaign_from(in_ut());
  std::string told;
  for (std::uint64_t number = 0; number < 200; ++number) told += sentence_of(file.plan, spec_of(file.plan, number));
  EXPECT_NE(told.find("uT"), std::string::npos);
  EXPECT_NE(told.find("the true field differs"), std::string::npos);
  for (const char* const word : {"m/s^2", "mg0", "gravity differs"})
    EXPECT_EQ(told.find(word), std::string::npos) << word;
}

// Negative: REQ-254
TEST(CampaignOfAField, WhatIsOfAnotherFieldIsRefusedWithAWayOut) {
  const auto refused = [](const std::string& from, const std::string& to) {
    const auto file = parse_campaign_text(replaced(in_ut(), from, to), "test.toml", plumb::geomagnetic::lookup);
    EXPECT_FALSE(file.has_value()) << to;
    return file ? std::string() : file.error().text();
  };
  const std::string tool = "geometry = \"tetrahedron\"\nnoise = \"0.0078125 uT\"";
  const std::string array = std::string("array = \"") + PLUMB_SOURCE_DIR "/examples/six_axis.toml";
  const struct {
    std::string from, to;
    std::vector<const char*> words;
  } all[] = {
      {"\"magnetic\"", "\"rate\"", {"field", "length of the vector, which a rate does not have", "plumb geometry"}},
      {"[reference]", "[gravity]", {"gravity", "accelerometers", "[reference]"}},
      {"field = \"magnetic\"\n", "", {"reference", "magnetometers", "field = \"magnetic\""}},
      {"39.25 uT", "139.25 uT", {"reference.value", "20 to 70 uT"}},
      {"39.25 uT", "9.81 m/s^2", {"reference.value", "m/s^2", "uT"}},
      {"sigma = \"0.00390625 uT\"", "sigma = \"1 uT\"", {"reference.sigma", "400 nT"}},
      {"left = \"0.001953125 uT\"", "left = \"1 uT\"", {"calibration.left", "20 nT"}},
      {"bias=2uT", "bias=50mg0", {"fault[2].spec", "50mg0", "uT"}},
      {"noise = \"0.0078125 uT\"", "noise = \"0.2 mg0\"", {"tool[1].noise", "uT"}},
      {"disturbance_bound", "acceleration_bound", {"acceleration_bound", "disturbance_bound"}},
      {tool, array + "\"", {"tool[1].array", "accelerometers", "#mag"}},
      {tool, array + "#gyros\"", {"tool[1].array", "gyros", "plumb monitor --group"}},
  };
  for (const auto& bad : all) {
    const std::string text = refused(bad.from, bad.to);
    for (const char* const word : bad.words)
      EXPECT_NE(text.find(word), std::string::npos) << word << " is not in: " << text;
  }
  const std::string gravity = "geometry = \"tetrahedron\"\nnoise = \"0.001953125 m/s^2\"";
  const auto group =
      parse_campaign_text(replaced(in_mps2(), gravity, array + "#mag\""), "test.toml", plumb::geomagnetic::lookup);
  ASSERT_FALSE(group.has_value());
  EXPECT_NE(group.error().text().find("set field = \"magnetic\""), std::string::npos) << group.error().text();
  const auto blind = parse_campaign_text(replaced(in_ut(), tool, array + "#mag\""), "test.toml");
  ASSERT_FALSE(blind.has_value());
  EXPECT_NE(blind.error().text().find("model of the Earth's field"), std::string::npos) << blind.error().text();
}

// Verifies: REQ-254
TEST(CampaignOfAField, TakesAGroupOfAnArrayFile) {
  const std::string text = replaced(in_ut(), "geometry = \"tetrahedron\"\nnoise = \"0.0078125 uT\"",
                                    std::string("array = \"") + PLUMB_SOURCE_DIR "/examples/six_axis.toml#mag\"");
  const auto file = parse_campaign_text(text, "test.toml", plumb::geomagnetic::lookup);
  ASSERT_TRUE(file.has_value()) << file.error().text();
  EXPECT_EQ(file->plan.tools[0].name, "six-axis tool mag");
  EXPECT_EQ(file->plan.tools[0].sensors, 4);
  EXPECT_NEAR(file->plan.tools[0].sigma_mps2[0], 0.005, 1e-12) << "20 nT";
}

}  // namespace
}  // namespace field_campaign_test
