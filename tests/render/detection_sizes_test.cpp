// The four sizes in text and JSON: the same figures, and words where there is none.
#include "plumb/render/detection_sizes.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "plumb/core/units.hpp"
#include "support/simulated_tool.hpp"

// Serves: REQ-016

namespace sizes_render_test {
namespace {

using namespace plumb;
using namespace plumb_test;
using findings::size_table;
using findings::SizeTable;

const GravityReference kExact{kG0_mps2, 0.0, GravityModel::value};

bool says(const std::string& text, const std::string& words) { return text.find(words) != std::string::npos; }

// Verifies: REQ-016
TEST(SizesInWords, TextAndJsonHaveTheSameFigures) {
  const SensorArray array = cone_array(5);
  const SizeTable table = size_table(array, kExact, TestSettings{}, true, {{0.0, 0.0, 1.0}, {}});
  const std::string text = render::sizes_text(table, 5, io::FieldKind::gravity);
  const render::Json json = render::sizes_json(table, 5);
  for (const char* const row : {"stability_0", "stability_0_2_mg0", "as_stated"}) {
    for (const auto& [key, value] : json.at(row).items()) {
      if (key == "drift_tolerance_mps2" || key == "acceleration_mps2" || key == "beyond_full_scale") continue;
      const bool angle = key == "protection_level_at_rest_deg";
      const double figure = value.get<double>();
      EXPECT_TRUE(
          says(text, angle ? fmt::format("{:.4f} deg", figure) : fmt::format("{:.3f} mg0", 1e3 * g0_from_mps2(figure))))
          << row << ' ' << key << '\n'
          << text;
    }
  }
  EXPECT_EQ(json["visited_attitudes"], 1);
  EXPECT_EQ(json["isolation_attitudes"], 4);
  EXPECT_TRUE(says(text, "P_MD 0.001, P_FA 1e-05 per block"));
  EXPECT_TRUE(says(text, "visited: the 1 attitude of the calibration"));
}

/// Of a sensor that reads no further than 5 mg0: at a stability of 0.2 mg0 its faults are larger or not found.
// Negative: REQ-016
TEST(SizesInWords, ASizeBeyondTheFullScaleIsNone) {
  const SensorArray array = cone_array(5);
  Readings full_scale{};
  const SizeTable plain = size_table(array, kExact, TestSettings{}, true, {}, full_scale);
  EXPECT_FALSE(says(render::sizes_text(plain, 5, io::FieldKind::gravity), "full scale"));
  full_scale[3] = 5e-3 * kG0_mps2;
  const SizeTable table = size_table(array, kExact, TestSettings{}, true, {}, full_scale);
  const std::string text = render::sizes_text(table, 5, io::FieldKind::gravity);
  EXPECT_TRUE(says(text, "none (beyond full scale)")) << text;
  const render::Json json = render::sizes_json(table, 5);
  EXPECT_TRUE(json["stability_0"]["minimum_detectable_bias_mps2"].is_number());
  EXPECT_EQ(json["stability_0"]["beyond_full_scale"], render::Json::array());
  const render::Json& beyond = json["stability_0_2_mg0"]["beyond_full_scale"];
  ASSERT_FALSE(beyond.empty()) << json.dump(1);
  for (const render::Json& key : beyond)
    EXPECT_TRUE(json["stability_0_2_mg0"][key.get<std::string>()].is_null()) << key;
  full_scale.fill(0.0);
  full_scale[3] = 1.0;
  EXPECT_FALSE(says(
      render::sizes_text(size_table(array, kExact, TestSettings{}, true, {}, full_scale), 5, io::FieldKind::gravity),
      "full scale"));
}

/// An exact tool, and a calibration file of an earlier plumb.
// Negative: REQ-016
TEST(SizesInWords, SayWhyTheVisitedAttitudesHaveNoFigure) {
  const SensorArray array = cone_array(5);
  const SizeTable exact = size_table(array, kExact, TestSettings{}, false, {});
  const SizeTable old = size_table(array, kExact, TestSettings{}, true, {});
  EXPECT_TRUE(says(render::sizes_text(exact, 5, io::FieldKind::gravity), "no figure without a calibration"));
  EXPECT_TRUE(says(render::sizes_text(old, 5, io::FieldKind::gravity),
                   "does not keep the attitudes of its stations; run plumb calibrate again"));
  for (const SizeTable& table : {exact, old}) {
    const render::Json json = render::sizes_json(table, 5);
    EXPECT_TRUE(json["visited_attitudes"].is_null());
    EXPECT_TRUE(json["stability_0"]["guaranteed_detection_visited_mps2"].is_null());
    EXPECT_TRUE(says(render::sizes_text(table, 5, io::FieldKind::gravity), json["visited_text"].get<std::string>()));
  }
}

}  // namespace
}  // namespace sizes_render_test
