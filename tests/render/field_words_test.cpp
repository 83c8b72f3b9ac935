// Results of a group in the words and the units of its field.
#include "plumb/render/field_words.hpp"

#include <gtest/gtest.h>

#include "plumb/io/field_json.hpp"

namespace field_words_test {
namespace {

using namespace plumb;
using io::FieldKind;
using render::in_field_words;

TEST(FieldWords, ATextTakesTheUnitsOfItsField) {
  const std::string text = "a1 scatters by 3 mg0, |G| is off; gravity 9.8 m/s^2, see [gravity] of the accelerometer";
  EXPECT_EQ(in_field_words(text, FieldKind::gravity), text);
  EXPECT_EQ(in_field_words(text, FieldKind::magnetic),
            "a1 scatters by 3 nT, |B| is off; the magnetic field 9.8 uT, see [group.reference] of the magnetometer");
}

TEST(FieldWords, OnlyWholeWordsAreReplaced) {
  EXPECT_EQ(in_field_words("mg0_1 mg07 my_gravity", FieldKind::magnetic), "mg0_1 mg07 my_gravity");
  EXPECT_EQ(in_field_words("mg0", FieldKind::magnetic), "nT");
  EXPECT_EQ(in_field_words("", FieldKind::magnetic), "");
}

TEST(FieldWords, AFigureInANameIsConverted) {
  EXPECT_EQ(in_field_words("stability 0.2 mg0", FieldKind::magnetic), "stability 7.85 nT");
  EXPECT_NEAR(0.2e-3 * kG0_mps2 * io::units_of(FieldKind::magnetic).fine_per_inside, 7.85, 0.005);
}

TEST(FieldJson, KeysAndNumbersTakeTheUnitTogether) {
  const io::Json in = io::parsed(
      R"({"gravity_mps2":[1,-2,null],"scale_per_mps2":8,"drift_mps2_per_h":[0.25],"covariance_mps2_2":[1],
          "bias_mg0":1,"id":"a1","stability_0_2_mg0":{"bias_mps2":0.5},"rows":3})");
  EXPECT_EQ(io::in_field_units(in, FieldKind::gravity), in);
  const io::Json out = io::in_field_units(in, FieldKind::magnetic);
  EXPECT_EQ(out["field_nt"], io::parsed("[4000.0,-8000.0,null]")) << "1 inside is 4 uT";
  EXPECT_EQ(out["scale_per_nt"], 0.002);
  EXPECT_EQ(out["drift_nt_per_h"][0], 1000.0);
  EXPECT_EQ(out["covariance_nt_2"][0], 1.6e7);
  EXPECT_NEAR(out["bias_nt"].get<double>(), 4.0 * kG0_mps2, 1e-9);
  EXPECT_EQ(out["stability_7_85_nt"]["bias_nt"], 2000.0);
  EXPECT_EQ(out["id"], "a1");
  EXPECT_EQ(out["rows"], 3);
  EXPECT_EQ(out.size(), in.size()) << "nothing is lost";
  EXPECT_EQ(io::in_field_units(std::string("{\"a_mps2\":1}\n"), FieldKind::magnetic), "{\"a_nt\":4000.0}\n");
}

TEST(FieldJson, APageThatShowsMg0ShowsTheFineUnit) {
  const io::Json in = io::parsed(R"({"off_mps2":0.25,"list":[{"bound_mps2":1}],"scale_per_mps2":1,"t_s":2})");
  const io::Json out = io::with_fine_as_mg0(in, FieldKind::magnetic);
  const double mg0 = io::units_of(FieldKind::gravity).fine_per_inside;
  EXPECT_NEAR(mg0 * out["off_mps2"].get<double>(), 1000.0, 1e-9) << "nT";
  EXPECT_NEAR(mg0 * out["list"][0]["bound_mps2"].get<double>(), 4000.0, 1e-9);
  EXPECT_EQ(out["scale_per_mps2"], 0.25) << "per uT";
  EXPECT_EQ(io::with_fine_as_mg0(io::parsed(R"({"g_mps2":12.5})"), FieldKind::magnetic)["g_mps2"], 50.0) << "uT";
  EXPECT_EQ(out["t_s"], 2);
  EXPECT_EQ(io::with_fine_as_mg0(in, FieldKind::gravity), in);
}

}  // namespace
}  // namespace field_words_test
