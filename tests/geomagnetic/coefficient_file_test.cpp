// Files in the form of WMM.COF, whole and broken, and references with their uncertainties.
#include "plumb/geomagnetic/coefficient_file.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "plumb/core/units.hpp"
#include "plumb/geomagnetic/field_reference.hpp"

namespace coefficient_file_test {
namespace {

using namespace plumb;
using namespace plumb::geomagnetic;

std::vector<std::string> lines_of_wmm() {
  std::vector<std::string> out{"    2025.0            WMM-2025     11/13/2024"};
  const FieldModel& model = wmm2025();
  for (int n = 1; n <= kMaxDegree; ++n) {
    for (int m = 0; m <= n; ++m) {
      const std::size_t k = coefficient_index(n, m);
      out.push_back(fmt::format("{:3d}{:3d}{:10.1f}{:10.1f}{:12.1f}{:12.1f}", n, m, model.g_nt[k], model.h_nt[k],
                                model.g_nt_per_year[k], model.h_nt_per_year[k]));
    }
  }
  out.push_back("999999999999999999999999999999999999999999999999");
  out.push_back("999999999999999999999999999999999999999999999999");
  return out;
}

std::string joined(const std::vector<std::string>& lines, const char* end = "\n") {
  std::string out;
  for (const std::string& line : lines) out += line + end;
  return out;
}

TEST(CoefficientFile, OfWmmIsTheModelThatIsBuiltIn) {
  for (const char* end : {"\n", "\r\n"}) {
    const auto model = parse_coefficients(joined(lines_of_wmm(), end), "WMM.COF");
    ASSERT_TRUE(model.has_value()) << model.error().text();
    EXPECT_EQ(model->name, "WMM-2025");
    EXPECT_EQ(model->first_year, 2025.0);
    EXPECT_EQ(model->last_year, 2030.0);
    EXPECT_EQ(model->g_nt, wmm2025().g_nt);
    EXPECT_EQ(model->h_nt, wmm2025().h_nt);
    EXPECT_EQ(model->g_nt_per_year, wmm2025().g_nt_per_year);
    EXPECT_EQ(model->h_nt_per_year, wmm2025().h_nt_per_year);
  }
}

void expect_refused(const std::vector<std::string>& lines, int line, const char* text) {
  const auto model = parse_coefficients(joined(lines), "x.cof");
  ASSERT_FALSE(model.has_value()) << text;
  EXPECT_NE(model.error().what.find(text), std::string::npos) << model.error().text();
  if (line > 0) {
    EXPECT_EQ(model.error().line, line);
  }
}

TEST(CoefficientFile, IsRefusedByLine) {
  const std::vector<std::string> good = lines_of_wmm();
  auto with = [&good](std::size_t at, const std::string& line) {
    std::vector<std::string> out = good;
    out[at] = line;
    return out;
  };
  expect_refused({}, 0, "is empty");
  expect_refused(with(0, "WMM-2025"), 1, "does not begin");
  expect_refused(with(0, "nan WMM-2025 1/1/2025"), 1, "does not begin");
  expect_refused(with(5, "2 2 1649.3 -815.1 -8.0"), 6, "is no row");
  expect_refused(with(5, "2 2 1649.3 -815.1 -8.0 nan"), 6, "is no row");
  expect_refused(with(5, "2 2 1649.3x -815.1 -8.0 1"), 6, "is no row");
  expect_refused(with(5, "2 2 1e300 -815.1 -8.0 1"), 6, "is no row");
  expect_refused(with(5, "2 1 1649.3 -815.1 -8.0 1"), 6, "a second time");
  expect_refused(with(5, "13 2 1649.3 -815.1 -8.0 1"), 6, "degree 13");
  expect_refused(with(5, "2 3 1649.3 -815.1 -8.0 1"), 6, "order 3");
  expect_refused(with(5, "2 -1 1649.3 -815.1 -8.0 1"), 6, "order -1");
  expect_refused(with(3, "2 0 1649.3 -815.1 -8.0 0"), 4, "h of order 0");
  expect_refused(with(5, ""), 0, "no coefficient of degree 2 and order 2");
  EXPECT_FALSE(read_coefficients("/nonexistent/x.cof").has_value());
  EXPECT_FALSE(read_coefficients("/").has_value());
}

RC_GTEST_PROP(CoefficientFileLaw, AnyBytesAreAModelOrAnError, ()) {
  std::string text = joined(lines_of_wmm());
  const int changes = *rc::gen::inRange(1, 20);
  for (int k = 0; k < changes; ++k)
    text[static_cast<std::size_t>(*rc::gen::inRange(0, static_cast<int>(text.size())))] = *rc::gen::arbitrary<char>();
  text.resize(static_cast<std::size_t>(*rc::gen::inRange(0, static_cast<int>(text.size()) + 1)));
  const auto model = parse_coefficients(text, "x.cof");
  if (!model) {
    RC_ASSERT(!model.error().what.empty() && !model.error().remedy.empty());
    return;
  }
  for (const char c : model->name) RC_ASSERT(static_cast<unsigned char>(c) >= 0x20 && c != 0x7F);
  const auto field = field_at(*model, {60.0, 2.0, 0.0}, model->epoch_year);
  RC_ASSERT(field.has_value() && std::isfinite(field->value.total_tesla));
}

TEST(FieldReference, HasTheSigmasOfTheErrorModels) {
  const auto field = field_at(wmm2025(), {60.0, 2.0, 0.0}, 2026.5);
  ASSERT_TRUE(field.has_value());
  const FieldReference noaa = reference_of(*field, wmm2025_errors()), trade = reference_of(*field, iscwsa_errors());
  const double h_nt = field->value.horizontal_tesla * 1e9;
  EXPECT_NEAR(noaa.total_tesla_sigma.common, 138e-9, 1e-20);
  EXPECT_NEAR(deg_from_rad(noaa.dip_rad_sigma.common), 0.20, 1e-12);
  EXPECT_NEAR(deg_from_rad(noaa.declination_rad_sigma.common), std::hypot(0.26, 5417.0 / h_nt), 1e-12);
  EXPECT_EQ(noaa.declination_rad_sigma.random, 0.0);
  EXPECT_NEAR(trade.total_tesla_sigma.common, 130e-9, 1e-20);
  EXPECT_NEAR(trade.total_tesla_sigma.random, 60e-9, 1e-20);
  EXPECT_NEAR(deg_from_rad(trade.declination_rad_sigma.common), std::hypot(0.36, 5000.0 / h_nt), 1e-12);
  EXPECT_NEAR(deg_from_rad(trade.declination_rad_sigma.random), std::hypot(0.10, 3000.0 / h_nt), 1e-12);
  EXPECT_TRUE(noaa.declination_known);
  EXPECT_EQ(noaa.source, "WMM-2025, WMM2025 error model");
}

TEST(FieldReference, DeclinationFallsWithTheHorizontalField) {
  // The parts of ISCWSA's terms, whose squares sum to what is used.
  EXPECT_NEAR(std::sqrt(0.16 * 0.16 + 0.24 * 0.24 + 0.21 * 0.21 + 0.05 * 0.05), iscwsa_errors().common.declination_deg,
              5e-4);
  EXPECT_NEAR(std::sqrt(2350.0 * 2350 + 3359.0 * 3359 + 2840.0 * 2840 + 356.0 * 356),
              iscwsa_errors().common.declination_deg_nt, 0.5);
  EXPECT_NEAR(std::sqrt(0.09 * 0.09 + 0.14 * 0.14 + 0.11 * 0.11 + 0.03 * 0.03), iscwsa_errors().common.dip_deg, 2e-3);
  EXPECT_NEAR(std::sqrt(61.0 * 61 + 88.0 * 88 + 73.0 * 73 + 13.0 * 13), iscwsa_errors().common.total_nt, 0.5);
  EarthField field;
  double last = 0.0;
  for (const double h_nt : {40e3, 10e3, 2e3, 300.0, 31.0, 30.0, 1.0, 0.0}) {
    field.value.horizontal_tesla = h_nt * 1e-9;
    const double sigma = reference_of(field, wmm2025_errors()).declination_rad_sigma.common;
    EXPECT_GE(sigma, last);
    EXPECT_LE(sigma, kPi);
    last = sigma;
  }
  EXPECT_EQ(last, kPi);
}

TEST(FieldReference, OfAPoleKnowsNoDeclination) {
  const auto field = field_at(wmm2025(), {90.0, 0.0, 0.0}, 2026.5);
  EXPECT_FALSE(reference_of(*field, wmm2025_errors()).declination_known);
}

TEST(FieldReference, IsRefusedWhereItIsNoFieldOfTheEarth) {
  const StatedField good{50000.0, 130.0, 72.0, 0.2, true, -4.0, 0.4};
  ASSERT_TRUE(stated_reference(good).has_value());
  EXPECT_NEAR(stated_reference(good)->total_tesla, 50e-6, 1e-18);
  EXPECT_EQ(stated_reference(good)->year, 0.0);
  const auto broken = [&good](auto change) {
    StatedField out = good;
    change(out);
    return stated_reference(out);
  };
  EXPECT_EQ(broken([](StatedField& s) { s.total_nt = 50.0; }).error().field, "total field");
  EXPECT_EQ(broken([](StatedField& s) { s.total_nt = NAN; }).error().field, "total field");
  EXPECT_EQ(broken([](StatedField& s) { s.total_sigma_nt = 0.0; }).error().field, "sigma of the total field");
  EXPECT_EQ(broken([](StatedField& s) { s.dip_deg = 91.0; }).error().field, "dip");
  EXPECT_EQ(broken([](StatedField& s) { s.dip_sigma_deg = 11.0; }).error().field, "sigma of the dip");
  EXPECT_EQ(broken([](StatedField& s) { s.declination_deg = 181.0; }).error().field, "declination");
  EXPECT_EQ(broken([](StatedField& s) { s.declination_sigma_deg = 0.0; }).error().field, "sigma of the declination");
  EXPECT_TRUE(broken([](StatedField& s) { s.declination_deg = NAN, s.declination_known = false; }).has_value());
}

TEST(FieldReference, ReadsFieldsWithTheirUnit) {
  EXPECT_DOUBLE_EQ(*parse_field("50123 nT"), 50123e-9);
  EXPECT_DOUBLE_EQ(*parse_field("50.5uT"), 50.5e-6);
  EXPECT_DOUBLE_EQ(*parse_field("0.5 G"), 50e-6);
  EXPECT_DOUBLE_EQ(*parse_field("500  mG"), 50e-6);
  EXPECT_DOUBLE_EQ(*parse_field("5e-5 T"), 50e-6);
  for (const char* wrong : {"", "50123", "nT", "50123 nt", "50123 nT x", "nan nT", "inf nT", "1e999 nT", " 5 nT"})
    EXPECT_FALSE(parse_field(wrong).has_value()) << wrong;
}

}  // namespace
}  // namespace coefficient_file_test
