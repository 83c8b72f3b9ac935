/// The section of the calibration file that holds the paper's own fits.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "io_test_support.hpp"
#include "plumb/io/calibration_file.hpp"
#include "plumb/io/output_file.hpp"

namespace calibration_paper_test {
namespace {

using namespace plumb;
using namespace plumb::io;
using namespace io_test;
using Json = nlohmann::ordered_json;

/// Numbers that need all their digits.
PaperFit fit_of(const ArrayFile& array, SensorSet used, double seed) {
  PaperFit fit;
  fit.used = used;
  fit.model = array.datasheet.model();
  fit.converged = true;
  fit.stop = StopReason::converged;
  fit.iterations = 5;
  fit.rank = 9;
  fit.start_cost = seed / 3.0;
  fit.cost = seed / 7e9;
  for (int i = 0; i < array.array.size(); ++i) {
    if (!used.has(i)) continue;
    const auto a = static_cast<std::size_t>(i);
    fit.model.sensor[a].scale[0] *= 1.0 + seed / 3000.0;
    fit.model.sensor[a].bias[0] += seed / 1100.0;
    for (int j = 0; j < array.array.size(); ++j) {
      if (used.has(j) && i != j)
        fit.model.misalignment[a * kCapacity + static_cast<std::size_t>(j)] = seed * (i - 1.7 * j) / 90000.0;
    }
  }
  return fit;
}

std::unique_ptr<PaperCalibration> paper_of(const ArrayFile& array) {
  auto out = std::make_unique<PaperCalibration>();
  out->all = fit_of(array, array.array.all(), 1.0);
  out->triples = array.array.triple_count();
  for (int k = 0; k < out->triples; ++k)
    out->triple[static_cast<std::size_t>(k)] = fit_of(array, array.array.triple(k).set(), 2.0 + k);
  out->triple[2].converged = false;
  out->triple[2].stop = StopReason::iteration_limit;
  return out;
}

std::string json_of(const ArrayFile& array, const PaperCalibration* paper) {
  Calibration calibration;
  calibration.model = array.datasheet.model();
  calibration.array = array.array;
  calibration.report.parameters = 4 * array.array.size();
  CalibrationContext context;
  context.gravity = array.gravity;
  return calibration_json(calibration, array, context, paper);
}

/// Edits the content and seals it again: what only a program that means it can do.
template <class Edit>
std::string resealed(const std::string& json, Edit edit) {
  Json root = Json::parse(json);
  edit(root);
  root.erase("checksum");
  const std::string text = root.dump();
  char sum[40];
  std::snprintf(sum, sizeof sum, "fnv1a64:%016llx", static_cast<unsigned long long>(fnv1a(text.data(), text.size())));
  root["checksum"] = sum;
  return root.dump();
}

FileError refusal_of(const std::string& json) {
  const auto file = read_calibration(written("cal.json", json), array_of());
  EXPECT_FALSE(file.has_value());
  return file ? FileError{} : file.error();
}

void expect_words(const FileError& error, const std::string& field, const std::string& words) {
  EXPECT_EQ(error.field, field) << error.text();
  EXPECT_NE(error.what.find(words), std::string::npos) << error.text();
  EXPECT_NE(error.remedy.find("plumb calibrate"), std::string::npos) << error.text();
}

TEST(CalibrationFilePaper, ComesBackBitForBit) {
  const ArrayFile array = array_of();
  const auto in = paper_of(array);
  const auto file = read_calibration(written("cal.json", json_of(array, in.get())), array);
  ASSERT_TRUE(file.has_value()) << file.error().text();
  ASSERT_NE(file->paper, nullptr);
  const PaperCalibration& out = *file->paper;
  ASSERT_EQ(out.triples, 4);
  const auto same = [](const PaperFit& a, const PaperFit& b) {
    EXPECT_EQ(a.used, b.used);
    EXPECT_EQ(a.converged, b.converged);
    EXPECT_EQ(a.stop, b.stop);
    EXPECT_EQ(a.iterations, b.iterations);
    EXPECT_EQ(a.rank, b.rank);
    EXPECT_EQ(a.start_cost, b.start_cost);
    EXPECT_EQ(a.cost, b.cost);
    EXPECT_EQ(a.model.misalignment, b.model.misalignment);
    for (std::size_t i = 0; i < 4; ++i) {
      EXPECT_EQ(a.model.sensor[i].scale, b.model.sensor[i].scale);
      EXPECT_EQ(a.model.sensor[i].bias, b.model.sensor[i].bias);
      EXPECT_EQ(a.model.sensor[i].reference_degc, b.model.sensor[i].reference_degc);
    }
  };
  same(in->all, out.all);
  for (std::size_t k = 0; k < 4; ++k) same(in->triple[k], out.triple[k]);
  EXPECT_EQ(json_of(array, &out), json_of(array, in.get()));
}

TEST(CalibrationFilePaper, NeedNotBeThere) {
  const ArrayFile array = array_of();
  const std::string json = json_of(array, nullptr);
  EXPECT_EQ(Json::parse(json).count("paper"), 0U);
  const auto file = read_calibration(written("cal.json", json), array);
  ASSERT_TRUE(file.has_value()) << file.error().text();
  EXPECT_EQ(file->paper, nullptr);
}

TEST(CalibrationFilePaper, ResealingAloneIsNoHarm) {
  const ArrayFile array = array_of();
  const std::string json = resealed(json_of(array, paper_of(array).get()), [](Json&) {});
  EXPECT_TRUE(read_calibration(written("cal.json", json), array).has_value());
}

TEST(CalibrationFilePaperRefuses, DamageByItsChecksum) {
  const ArrayFile array = array_of();
  const std::string json = json_of(array, paper_of(array).get());
  expect_words(refusal_of(changed("\"rank\": 9", "\"rank\": 8", json)), "checksum", "edited or damaged");
}

TEST(CalibrationFilePaperRefuses, AnotherVersionAndOtherSensors) {
  const ArrayFile array = array_of();
  const std::string json = json_of(array, paper_of(array).get());
  const auto refused = [&json](auto edit) { return refusal_of(resealed(json, edit)); };
  expect_words(refused([](Json& r) { r["paper"]["version"] = 2; }), "paper.version", "is 2");
  expect_words(refused([](Json& r) { r["paper"].erase("all"); }), "all", "is missing");
  expect_words(refused([](Json& r) { r["paper"]["triples"].erase(3); }), "paper.triples", "list of 4");
  expect_words(refused([](Json& r) { std::swap(r["paper"]["triples"][1], r["paper"]["triples"][2]); }),
               "paper.triples[2].used", "must be [\"A1\",\"A2\",\"A4\"]");
  expect_words(refused([](Json& r) { r["paper"]["triples"][0]["scale"].erase(0); }), "paper.triples[1].scale",
               "list of 3");
  expect_words(refused([](Json& r) { r["paper"]["all"]["misalignment"][1].erase(0); }), "paper.all.misalignment",
               "list of 4");
  expect_words(refused([](Json& r) { r["paper"]["all"]["converged"] = 1; }), "paper.all.converged",
               "must be true or false");
  expect_words(refused([](Json& r) { r["paper"]["all"]["bias_mps2"][0][0] = "lots"; }), "paper.all.bias_mps2",
               "not a number");
  expect_words(refused([](Json& r) { r["paper"] = 7; }), "version", "is missing");
}

TEST(CalibrationFilePaperRefuses, CoefficientsThatDifferFromTheCalibrationBesideThem) {
  const ArrayFile array = array_of();
  const std::string json = json_of(array, paper_of(array).get());
  const auto refused = [&json](auto edit) { return refusal_of(resealed(json, edit)); };
  expect_words(refused([](Json& r) { r["paper"]["all"]["scale"][1][0] = 3.4 / kG0_mps2; }), "paper.all",
               "gravity differs by");
  expect_words(refused([](Json& r) { r["paper"]["triples"][1]["bias_mps2"][0][0] = 5.0; }), "paper.triples[2]",
               "gravity differs by");
  expect_words(refused([](Json& r) { r["paper"]["triples"][3]["misalignment"][0][1] = 1e9; }), "paper.triples[4]",
               "gravity differs by");
  expect_words(refused([](Json& r) { r["paper"]["all"]["scale"][1][0] = "nan"; }), "paper.all", "gravity differs by");
  // A turn of the frame keeps the length: all axes by 20 deg about z, where the first three are x, y and z.
  expect_words(refused([](Json& r) {
                 Json& m = r["paper"]["triples"][0]["misalignment"];
                 const double c = std::cos(0.35), s = std::sin(0.35);
                 m[0][1] = s / c;
                 m[1][0] = -s / c;
                 for (std::size_t i = 0; i < 2; ++i)
                   r["paper"]["triples"][0]["scale"][i][0] = r["paper"]["triples"][0]["scale"][i][0].get<double>() / c;
               }),
               "paper.triples[1]", "direction of gravity differs by 20");
  // One that is not sound has no say, whatever it holds.
  EXPECT_TRUE(
      read_calibration(
          written("cal.json", resealed(json, [](Json& r) { r["paper"]["triples"][2]["scale"][0][0] = 1e9; })), array)
          .has_value());
}

}  // namespace
}  // namespace calibration_paper_test
