#include "plumb/io/calibration_file.hpp"

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <iomanip>
#include <memory>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "io_test_support.hpp"
#include "plumb/io/hash.hpp"
#include "plumb/io/output_file.hpp"

namespace calibration_file_test {
namespace {

using namespace plumb;
using namespace plumb::io;
using namespace io_test;

using Draw = double (*)();

/// From 0 to 1, whatever the number.
double share(double value) { return std::isfinite(value) ? std::fabs(std::fmod(value, 1.0)) : 0.5; }

/// A calibration of `array` whose free numbers come from `draw`, those that a bound holds by way of `share`.
std::unique_ptr<Calibration> calibration_of(const ArrayFile& array, Draw draw) {
  auto out = std::make_unique<Calibration>();
  const int n = array.array.size();
  std::array<SensorRow, kCapacity> rows{};
  for (int i = 0; i < n; ++i) {
    const std::size_t k = static_cast<std::size_t>(i);
    rows[k] = array.array.row(i);
    rows[k].sigma_mps2 = 1e-3 * (1.0 + 1.0 / 3.0 * i);
    for (std::size_t t = 0; t < 4; ++t) {
      out->model.sensor[k].scale[t] = draw();
      out->model.sensor[k].bias[t] = draw();
    }
    out->report.e_cal_mps2[k] = share(draw());
    out->report.residual_rms_mps2[k] = share(draw());
    for (std::size_t t = 4 * k; t < 4 * k + 4; ++t) {
      out->report.sigma[t] = share(draw());
      out->report.data_share[t] = share(draw());
    }
  }
  out->array = *SensorArray::make(rows.data(), n);
  RowUncertainty uncertainty;
  for (std::size_t a = 0; a < static_cast<std::size_t>(4 * n); ++a) {
    for (std::size_t b = 0; b <= a; ++b)
      uncertainty.covariance[a * (a + 1) / 2 + b] =
          (a == b ? 4.0 * n : 0.0) + share(draw());  // above the sum of its row
  }
  for (std::size_t k = 0; k < static_cast<std::size_t>(n); ++k) uncertainty.misfit_mps2[k] = share(draw());
  out->array.set_uncertainty(uncertainty);
  out->model.size = n;
  out->model.reads = array.datasheet.reads;
  FitReport& report = out->report;
  report.stations = 48;
  report.parameters = 4 * n;
  report.rank = 4 * n - 3;
  report.null_directions = 2;
  for (std::size_t k = 0; k < static_cast<std::size_t>(4 * n); ++k) report.null_direction[1].component[k] = draw();
  for (double* value : {&report.condition, &report.norm_rms_mps2, &report.parity_rms_mps2, &report.misfit_mps2,
                        &report.chi2, &report.p_value, &report.excitation, &report.temperature_min_degc})
    *value = share(draw());
  report.temperature_max_degc = report.temperature_min_degc + share(draw());
  report.stop = StopReason::converged;
  return out;
}

double third() {
  static double next = 1.0;
  next = std::fmod(next * 1.37 + 0.1, 1.0);
  return next / 3.0 - 0.1;
}

CalibrationContext context_of(const ArrayFile& array) {
  CalibrationContext context;
  context.log_file = "/somewhere/stations.csv";
  context.log_bytes = 12345;
  context.log_hash = 0xFEDCBA9876543210ULL;
  context.stations = 48;
  context.plumb_version = "0.1.0";
  context.gravity = array.gravity;
  return context;
}

std::string good_json(const ArrayFile& array = array_of()) {
  return calibration_json(*calibration_of(array, &third), array, context_of(array));
}

/// Refuses `json` for `array`; returns the error, whose path is checked here.
FileError refusal_of(const std::string& json, const ArrayFile& array = array_of()) {
  const std::string path = written("cal.json", json);
  const auto file = read_calibration(path, array);
  EXPECT_FALSE(file.has_value());
  if (file) return {};
  EXPECT_EQ(file.error().file, path);
  return file.error();
}

int line_of(const std::string& json, const std::string& part) {
  EXPECT_NE(json.find(part), std::string::npos) << part;
  const auto end = json.begin() + static_cast<std::ptrdiff_t>(std::min(json.find(part), json.size()));
  return 1 + static_cast<int>(std::count(json.begin(), end, '\n'));
}

void expect_refusal(const FileError& error, int line, const std::string& field,
                    std::initializer_list<const char*> parts) {
  expect_error(error, error.file, line, field, parts);
}

TEST(CalibrationFile, HasTheSameBytesForTheSameContent) {
  const ArrayFile array = array_of();
  const auto calibration = calibration_of(array, &third);
  const std::string json = calibration_json(*calibration, array, context_of(array));
  EXPECT_EQ(json, calibration_json(*calibration, array, context_of(array)));
  EXPECT_EQ(json.find("somewhere"), std::string::npos) << "paths of one machine do not belong here";
  EXPECT_EQ(json.substr(0, 49), "{\n \"schema\": \"plumb-calibration\",\n \"version\": 2,\n");
}

/// They are a matter of the array file, whose calibration it is.
// Verifies: REQ-206
TEST(CalibrationFile, IsReadWithTheChipsOfTheArrayFile) {
  std::string text = changed("id = \"A2\"", "id = \"A2\"\npackage = \"left\"");
  text = changed("id = \"A4\"", "id = \"A4\"\npackage = \"left\"", text);
  const auto file = read_calibration(written("cal.json", good_json()), array_of(text));
  ASSERT_TRUE(file.has_value());
  EXPECT_EQ(file->calibration.array.units().size(), 3);
  const auto fitted = calibration_of(array_of(text), &third);
  EXPECT_EQ(fitted->array.units().size(), 3);
}

TEST(CalibrationFile, KeepsContext) {
  const ArrayFile array = array_of();
  const std::string path = written("cal.json", "");
  ASSERT_TRUE(write_calibration(path, *calibration_of(array, &third), array, context_of(array)).has_value());
  const auto file = read_calibration(path, array);
  ASSERT_TRUE(file.has_value()) << file.error().text();
  EXPECT_EQ(file->context.log_file, "stations.csv");
  EXPECT_EQ(file->context.log_hash, 0xFEDCBA9876543210ULL);
  EXPECT_EQ(file->context.log_bytes, 12345U);
  EXPECT_EQ(file->context.gravity.g_mps2, 9.81);
  EXPECT_EQ(file->context.plumb_version, "0.1.0");
  EXPECT_EQ(file->array_name, "four on a tool");
  EXPECT_EQ(file->calibration.report.stop, StopReason::converged);
  EXPECT_EQ(file->calibration.report.stations, 48);
}

// Verifies: REQ-040
TEST(CalibrationFile, DateAndSerialNumberAreKeptWhereTheyAreGiven) {
  const ArrayFile array = array_of();
  CalibrationContext context = context_of(array);
  const std::string plain = calibration_json(*calibration_of(array, &third), array, context);
  for (const char* key : {"\"date\"", "\"serial\""}) EXPECT_EQ(plain.find(key), std::string::npos) << key;
  context.date = "2026-03-31";
  context.serial = "T-7";
  const auto file =
      read_calibration(written("cal.json", calibration_json(*calibration_of(array, &third), array, context)), array);
  ASSERT_TRUE(file.has_value()) << file.error().text();
  EXPECT_EQ(file->context.date, "2026-03-31");
  EXPECT_EQ(file->context.serial, "T-7");
  context.date = "2026-02-30";
  const FileError error = refusal_of(calibration_json(*calibration_of(array, &third), array, context), array);
  EXPECT_EQ(error.field, "provenance.date");
  EXPECT_NE(error.what.find("is no date"), std::string::npos);
}

TEST(CalibrationFile, HoldsThePapersParametersOrSaysWhyNot) {
  const ArrayFile array = array_of(changed("[0.6, 0.0, 0.8]", "[0.6, 0.48, 0.64]"));
  const auto calibration = calibration_of(array, &third);
  const auto root = nlohmann::json::parse(calibration_json(*calibration, array, context_of(array)));
  const auto& sensors = root["paper_parameters"]["sensors"];
  ASSERT_EQ(sensors.size(), 4U);
  for (std::size_t i = 0; i < 4; ++i) {
    // Axes as nominal, so no misalignment, and SF and B are those of the sensor.
    EXPECT_EQ(sensors[i]["id"], array.array.row(static_cast<int>(i)).id.data());
    EXPECT_EQ(sensors[i]["SF_per_mps2"], root["sensors"][i]["scale"]);
    EXPECT_EQ(sensors[i]["B_mps2"], root["sensors"][i]["bias_mps2"]);
    for (const auto& m : sensors[i]["m"]) EXPECT_EQ(m, 0.0);
  }
  const std::string fifth = "[[sensor]]\nid = \"fifth\"\naxis = [0, 0.6, 0.8]\nscale = \"3 V/g0\"\nnoise = \"1 mg0\"\n";
  const ArrayFile five = array_of(std::string(kArrayText) + fifth);
  const auto none = nlohmann::json::parse(calibration_json(*calibration_of(five, &third), five, context_of(five)));
  EXPECT_NE(none["paper_parameters"]["why_not"].get<std::string>().find("unique"), std::string::npos);
}

TEST(CalibrationFile, KeepsWhatTheRollGroupsWereOnlyWhereThereWereSome) {
  const ArrayFile array = array_of();
  const auto in = calibration_of(array, &third);
  EXPECT_EQ(nlohmann::json::parse(calibration_json(*in, array, context_of(array)))["report"].count("roll"), 0U);
  in->report.roll_groups = 4;
  in->report.single_station_groups = 1;
  in->report.roll_axis = {0.6, 0.0, 0.8};
  in->report.roll_axis_deviation_rad = 1.0 / 3000.0;
  in->report.inclination_sigma_rad = 1.0 / 7000.0;
  in->report.common_turn.rad = 1.0 / 70.0;
  in->report.common_turn.sigma_rad = 1.0 / 30.0;
  const auto file = read_calibration(written("cal.json", calibration_json(*in, array, context_of(array))), array);
  ASSERT_TRUE(file.has_value()) << file.error().text();
  const FitReport& out = file->calibration.report;
  EXPECT_EQ(out.roll_groups, 4);
  EXPECT_EQ(out.single_station_groups, 1);
  EXPECT_EQ(out.roll_axis, in->report.roll_axis);
  EXPECT_EQ(out.roll_axis_deviation_rad, in->report.roll_axis_deviation_rad);
  EXPECT_EQ(out.inclination_sigma_rad, in->report.inclination_sigma_rad);
  EXPECT_EQ(out.common_turn.rad, in->report.common_turn.rad);
  EXPECT_EQ(out.common_turn.sigma_rad, in->report.common_turn.sigma_rad);
  EXPECT_EQ(calibration_json(file->calibration, array, context_of(array)),
            calibration_json(*in, array, context_of(array)));
}

TEST(CalibrationFile, WhiteSpaceMayChange) {
  std::string json = good_json();
  for (std::size_t at = json.find('\n'); at != std::string::npos; at = json.find('\n', at + 2)) json.insert(at, "\r");
  EXPECT_TRUE(read_calibration(written("cal.json", json), array_of()).has_value());
}

TEST(CalibrationFileRefuses, UnreadableAndTruncated) {
  const auto missing = read_calibration("/nonexistent/cal.json", array_of());
  ASSERT_FALSE(missing.has_value());
  expect_error(missing.error(), "/nonexistent/cal.json", 0, "", {"No such file"});
  expect_refusal(refusal_of(""), 0, "", {"empty", "plumb calibrate"});
  const std::string json = good_json();
  const std::string half = json.substr(0, json.size() / 2);
  expect_refusal(refusal_of(half), line_of(half + "@", "@"), "", {"truncated", "plumb calibrate"});
  const std::string tail_cut = json.substr(0, json.size() - 3);
  expect_refusal(refusal_of(tail_cut), line_of(tail_cut + "@", "@"), "", {"truncated"});
  expect_refusal(refusal_of(changed("\"version\": 2", "\"version\" 1", json)), 3, "", {"not valid JSON"});
  expect_refusal(refusal_of(std::string(1000, '[') + std::string(1000, ']')), 0, "", {"nested too deeply"});
}

// Negative: REQ-037
TEST(CalibrationFileRefuses, Edited) {
  const std::string json = good_json();
  const std::string edited = changed("\"g_mps2\": 9.81", "\"g_mps2\": 9.82", json);
  expect_refusal(refusal_of(edited), 4, "checksum", {"edited or damaged", "do not edit", "plumb calibrate"});
  expect_refusal(refusal_of(changed("fnv1a64:", "fnv1a64:0", json)), 4, "checksum", {"edited or damaged"});
  expect_refusal(refusal_of(changed("\n \"gravity\"", "\n \"extra\": 1,\n \"gravity\"", json)), 4, "checksum",
                 {"edited"});
}

// Negative: REQ-037
TEST(CalibrationFileRefuses, OtherSchemasAndVersions) {
  const std::string json = good_json();
  expect_refusal(refusal_of(changed("plumb-calibration", "plumb-report", json)), 2, "schema",
                 {"plumb-report", "plumb calibrate wrote"});
  expect_refusal(refusal_of("[1, 2, 3]"), 0, "schema", {"none"});
  expect_refusal(refusal_of(changed("\"version\": 2", "\"version\": 3", json)), 3, "version",
                 {"is 3", "reads versions 1 and 2"});
}

// Negative: REQ-037
TEST(CalibrationFileRefuses, AnotherArrayByWhatDiffers) {
  const std::string json = good_json();
  const auto refusal = [&json](const std::string& from, const std::string& to) {
    return refusal_of(json, array_of(changed(from, to)));
  };
  expect_refusal(refusal("id = \"A3\"", "id = \"B3\""), line_of(json, "\"A3\""), "array.nominal[3].id",
                 {"another array", "\"A3\" in the calibration and \"B3\"", "plumb calibrate"});
  expect_refusal(refusal("[0.6, 0.0, 0.8]", "[0.8, 0.0, 0.6]"), line_of(json, "\"A4\""), "array.nominal[4].axis",
                 {"A4 differs by 16.26", "deg"});
  expect_refusal(refusal("\"3 V/g0\"", "\"2 V/g0\""), line_of(json, "\"A1\""), "array.nominal[1].scale",
                 {"scale of A1 is 0.30591", "and 0.2039"});
  expect_refusal(refusal("\"12 mg\"", "\"13 mg\""), line_of(json, "\"A1\""), "array.nominal[1].bias", {"bias of A1"});
  expect_refusal(refusal("\"gravity\"", "\"specific-force\""), line_of(json, "\"reads\""), "array.reads",
                 {"reads = gravity", "specific-force"});
  const std::string fifth = "[[sensor]]\nid = \"A5\"\naxis = [0, 0, 1]\nscale = \"3 V/g0\"\nnoise = \"1 mg\"\n";
  expect_refusal(refusal_of(json, array_of(kArrayText + fifth)), line_of(json, "\"nominal\""), "array.nominal",
                 {"has 4 sensors", "has 5"});
}

/// The file with one value put in the place of another and the checksum made right again, as an attacker would.
std::string resealed(const std::string& json, const std::vector<std::string>& path,
                     const nlohmann::ordered_json& value) {
  nlohmann::ordered_json root = nlohmann::ordered_json::parse(json);
  nlohmann::ordered_json* at = &root;
  for (const std::string& step : path) {
    at = at->is_array() ? &(*at)[static_cast<std::size_t>(std::stoi(step))] : &(*at)[step];
  }
  *at = value;
  root.erase("checksum");
  const std::string text = root.dump();
  std::ostringstream sum;
  sum << "fnv1a64:" << std::hex << std::setw(16) << std::setfill('0') << fnv1a(text.data(), text.size());
  root["checksum"] = sum.str();
  return root.dump(1);
}

/// Version 1 has the gravity at which it was calibrated in the covariance. A later file without the key, or one that is
/// passed off as version 1, must not promise more than it did.
// Negative: REQ-037
TEST(CalibrationFileRefuses, AFileWithoutTheScaleThatItsVersionHas) {
  const auto without = [](int version) {
    nlohmann::ordered_json root = nlohmann::ordered_json::parse(good_json());
    root.erase("common_scale_sigma");
    return resealed(root.dump(1), {"version"}, version);
  };
  expect_refusal(refusal_of(without(2)), 0, "common_scale_sigma", {"is missing", "plumb calibrate"});
  const auto old = read_calibration(written("cal.json", without(1)), array_of());
  ASSERT_TRUE(old.has_value());
  const GravityReference& gravity = old->context.gravity;
  EXPECT_GT(gravity.sigma_mps2, 0.0);
  EXPECT_DOUBLE_EQ(old->calibration.array.uncertainty().common_scale, gravity.sigma_mps2 / gravity.g_mps2);
}

// Negative: REQ-037, REQ-183
TEST(CalibrationFileRefuses, AttitudesThatNoStationHas) {
  using J = nlohmann::ordered_json;
  const auto with = [](const J& down, const J& known) {
    return resealed(good_json(), {"attitudes"}, J{{"down", down}, {"known", known}});
  };
  const auto known = [](int station, double inclination, double toolface, double tolerance) {
    return J::array({J{{"station", station},
                       {"inclination_rad", inclination},
                       {"toolface_rad", toolface},
                       {"tolerance_rad", tolerance}}});
  };
  const auto refused = [](const std::string& json, const char* member, const char* field, const char* words) {
    expect_refusal(refusal_of(json), line_of(json, member), field, {words, "plumb calibrate"});
  };
  const J unit = J::array({J::array({0.0, 0.6, 0.8}), J::array({0.0, 0.0, 0.0})});
  EXPECT_TRUE(read_calibration(written("cal.json", with(unit, known(1, 0.5, 6.0, 0.1))), array_of()).has_value());
  refused(with(J::array({J::array({0.0, 0.6, 0.7})}), J::array()), "\"down\"", "attitudes.down", "unit vector");
  refused(with(unit, known(3, 0.5, 6.0, 0.1)), "\"known\"", "attitudes.known", "station of this file");
  for (const J& wrong : {known(1, 3.2, 6.0, 0.1), known(1, 0.5, 6.3, 0.1), known(1, 0.5, 6.0, 0.99),
                         known(1, 0.5, 6.0, 1e-300), known(1, -0.5, 6.0, 0.1)})
    refused(with(unit, wrong), "\"known\"", "attitudes.known", "tolerance of 0.01 to 45 deg");
}

// Negative: REQ-037
TEST(CalibrationFileRefuses, FiguresThatNoCalibrationHas) {
  using J = nlohmann::ordered_json;
  const std::string json = good_json();
  ASSERT_TRUE(read_calibration(written("cal.json", resealed(json, {"report", "rank"}, 12)), array_of()).has_value());
  const struct {
    std::vector<std::string> path;
    std::vector<J> values;
    const char* field;
  } cases[] = {{{"report", "rank"}, {17, -1}, "report.rank"},
               {{"report", "parameters"}, {-16, 15, 41}, "report.parameters"},
               {{"report", "gauge"}, {-1, 4}, "report.gauge"},
               {{"report", "stations"}, {-1}, "report.stations"},
               {{"report", "iterations"}, {-1}, "report.iterations"},
               {{"report", "degrees_of_freedom"}, {-1}, "report.degrees_of_freedom"},
               {{"report", "condition"}, {"nan", "inf", -1.0, 1e308}, "report.condition"},
               {{"report", "norm_rms_mps2"}, {"nan", -1.0, 1e308}, "report.norm_rms_mps2"},
               {{"report", "parity_rms_mps2"}, {"nan", -1.0, 1e308}, "report.parity_rms_mps2"},
               {{"report", "misfit_mps2"}, {"nan", -1.0, 1e308}, "report.misfit_mps2"},
               {{"report", "chi2"}, {"nan", -1.0, 1e308}, "report.chi2"},
               {{"report", "p_value"}, {"nan", -0.1, 1.1}, "report.p_value"},
               {{"report", "excitation"}, {"nan", -1.0, 1e308}, "report.excitation"},
               {{"report", "temperature_min_degc"}, {"nan", 900.0, -1e308}, "report.temperature_m"},
               {{"report", "temperature_max_degc"}, {"inf", -200.0}, "report.temperature_max_degc"},
               {{"report", "null_direction", "1", "3"}, {"nan", 1e308}, "report.null_direction"},
               {{"sensors", "1", "misfit_mps2"}, {"nan", -1.0, 1e308}, "sensors[2].misfit_mps2"},
               {{"sensors", "1", "e_cal_mps2"}, {"nan", -1.0, 1e308}, "sensors[2].e_cal_mps2"},
               {{"sensors", "1", "residual_rms_mps2"}, {"nan", -1.0}, "sensors[2].residual_rms_mps2"},
               {{"sensors", "1", "sigma_mps2"}, {1e308}, "sensors[2].sigma_mps2"},
               {{"sensors", "1", "scale", "0"}, {"nan", 0.0, 1e308}, "sensors[2].scale"},
               {{"sensors", "1", "bias_mps2", "3"}, {"nan", 1e308}, "sensors[2].bias_mps2"},
               {{"sensors", "1", "reference_degc"}, {"nan", 1e308}, "sensors[2].reference_degc"},
               {{"sensors", "1", "fit_sigma", "2"}, {"nan", -1.0, 1e308}, "sensors[2].fit_sigma"},
               {{"sensors", "1", "data_share", "2"}, {"nan", -0.1, 1.1}, "sensors[2].data_share"},
               {{"covariance", "4", "4"}, {"nan", -1.0, 1e308}, "covariance[5][5]"},
               {{"covariance", "4", "1"}, {"nan", 99.0, -99.0}, "covariance[5][2]"},
               {{"gravity", "g_mps2"}, {"nan", -9.8, 98.0}, "gravity.g_mps2"},
               {{"gravity", "sigma_mps2"}, {"nan", -1.0, 1e308}, "gravity.sigma_mps2"},
               {{"provenance", "stations"}, {-1}, "provenance.stations"}};
  for (const auto& one : cases) {
    for (const J& value : one.values) {
      const FileError error = refusal_of(resealed(json, one.path, value));
      EXPECT_EQ(error.field.rfind(one.field, 0), 0U) << error.text();
      EXPECT_FALSE(error.remedy.empty());
      EXPECT_EQ(error.code, ExitCode::invalid_input);
    }
  }
  // Whole numbers that no counter holds.
  for (const char* key : {"stations", "rank", "null_directions"})
    EXPECT_EQ(refusal_of(resealed(json, {"report", key}, 4294967297)).field, key);
  EXPECT_EQ(refusal_of(resealed(json, {"provenance", "log_bytes"}, -1)).field, "log_bytes");
}

/// Three parameters of which each two may go against one another, and not all three.
// Negative: REQ-037
TEST(CalibrationFileRefuses, ACovarianceThatIsNotPositiveSemidefinite) {
  const auto correlated = [](double by) {
    std::string json = good_json();
    for (const auto& [row, column] : {std::pair("5", "4"), {"6", "4"}, {"6", "5"}}) {
      json = resealed(json, {"covariance", row, row}, 1.0);
      json = resealed(json, {"covariance", row, column}, by);
    }
    json = resealed(json, {"covariance", "4", "4"}, 1.0);
    for (const char* row : {"4", "5", "6"}) {
      for (const char* column : {"0", "1", "2", "3"}) json = resealed(json, {"covariance", row, column}, 0.0);
    }
    for (const char* row : {"7", "8", "9", "10", "11", "12", "13", "14", "15"}) {
      for (const char* column : {"4", "5", "6"}) json = resealed(json, {"covariance", row, column}, 0.0);
    }
    return json;
  };
  const ArrayFile array = array_of();
  EXPECT_TRUE(read_calibration(written("cal.json", correlated(-0.5)), array).has_value()) << "singular is allowed";
  const FileError error = refusal_of(correlated(-0.6));
  EXPECT_EQ(error.field, "covariance");
  EXPECT_NE(error.what.find("not positive semidefinite: its correlations have the eigenvalue -0.2"), std::string::npos)
      << error.text();
  EXPECT_NE(error.what.find(std::string("(") + array.array.row(1).id.data() + ")"), std::string::npos) << error.text();
  EXPECT_GT(error.line, 0);
  EXPECT_FALSE(error.remedy.empty());
}

TEST(CalibrationFileRefuses, RollGroupsThatNoFitHas) {
  using J = nlohmann::ordered_json;
  const ArrayFile array = array_of();
  const auto in = calibration_of(array, &third);
  in->report.roll_groups = 4;
  in->report.roll_axis = {0.6, 0.0, 0.8};
  const std::string json = calibration_json(*in, array, context_of(array));
  ASSERT_TRUE(read_calibration(written("cal.json", json), array).has_value());
  const std::pair<const char*, J> cases[] = {{"groups", -1},
                                             {"groups", 17},
                                             {"single_station_groups", 5},
                                             {"axis_deviation_rad", -0.1},
                                             {"axis_deviation_rad", "nan"},
                                             {"axis", J{0.6, 0.0, 0.9}},
                                             {"inclination_sigma_rad", -1.0}};
  for (const auto& [key, value] : cases)
    EXPECT_EQ(refusal_of(resealed(json, {"report", "roll", key}, value)).field, std::string("report.roll.") + key);
}

TEST(CalibrationFile, DoesNotWriteWhereItCannot) {
  const ArrayFile array = array_of();
  const auto done =
      write_calibration("/nonexistent/cal.json", *calibration_of(array, &third), array, context_of(array));
  ASSERT_FALSE(done.has_value());
  EXPECT_EQ(done.error().code, ExitCode::other);
}

/// Any that a calibration may hold: of either sign, with any digits, down to the smallest.
double any_double() {
  const std::uint64_t bits = *rc::gen::arbitrary<std::uint64_t>();
  double value = 0.0;
  std::memcpy(&value, &bits, sizeof value);
  if (!std::isfinite(value) || value == 0.0) return 1.0;
  int exponent = 0;
  return std::fabs(value) < 1e15 ? value : std::frexp(value, &exponent);
}

template <class T>
bool same_bits(const T& a, const T& b) {
  return std::memcmp(&a, &b, sizeof a) == 0;
}

// Verifies: REQ-037
RC_GTEST_PROP(CalibrationFileLaw, EveryDoubleComesBackBitForBit, ()) {
  static const ArrayFile array = array_of();
  const auto in = calibration_of(array, &any_double);
  if (*rc::gen::arbitrary<bool>()) in->model.misalignment[kCapacity + 2] = 0.1;
  const std::string path = written("cal.json", calibration_json(*in, array, context_of(array)));
  const auto file = read_calibration(path, array);
  RC_ASSERT(file.has_value());
  const Calibration& out = file->calibration;
  for (std::size_t k = 0; k < 4; ++k) {
    RC_ASSERT(same_bits(in->model.sensor[k].scale, out.model.sensor[k].scale));
    RC_ASSERT(same_bits(in->model.sensor[k].bias, out.model.sensor[k].bias));
    const SensorRow& a = in->array.row(static_cast<int>(k));
    const SensorRow& b = out.array.row(static_cast<int>(k));
    RC_ASSERT(same_bits(a, b));
  }
  RC_ASSERT(same_bits(in->model.misalignment, out.model.misalignment));
  RC_ASSERT(same_bits(in->array.uncertainty(), out.array.uncertainty()));
  RC_ASSERT(same_bits(in->report.sigma, out.report.sigma));
  RC_ASSERT(same_bits(in->report.data_share, out.report.data_share));
  RC_ASSERT(same_bits(in->report.null_direction, out.report.null_direction));
  RC_ASSERT(same_bits(in->report.chi2, out.report.chi2));
  RC_ASSERT(same_bits(in->report.p_value, out.report.p_value));
  RC_ASSERT(calibration_json(out, array, context_of(array)) == calibration_json(*in, array, context_of(array)));
}

}  // namespace
}  // namespace calibration_file_test
