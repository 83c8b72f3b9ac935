#include "plumb/study/paper_form.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <vector>

#include "study_test_support.hpp"

namespace paper_form_test {
namespace {

using namespace study_test;
using plumb::SensorSet;
using plumb::Vec3;
using plumb::study::CommonFrame;
using plumb::study::frame_of;
using plumb::study::paper_form;

/// Eq (3) written out: accelerations of the sensors `used` from their raw values.
std::vector<double> by_eq_3(const plumb::PaperParameters& p, const std::vector<double>& raw) {
  const int n = static_cast<int>(raw.size());
  std::vector<double> a;
  for (int i = 0; i < n; ++i)
    a.push_back(raw[at(i)] / p[plumb::study::scale_index(n, i)] - p[plumb::study::bias_index(i)]);
  std::vector<double> out = a;
  for (int i = 0; i < n; ++i) {
    for (int k = 0; k < n; ++k) {
      if (k != i) out[at(i)] -= p[plumb::study::misalignment_index(n, i, k)] * a[at(k)];
    }
  }
  return out;
}

RC_GTEST_PROP(PaperFormLaw, GivesAccelerationsAlongTheNominalAxes, ()) {
  const auto seed = *rc::gen::inRange<std::uint64_t>(0, 1000000);
  const plumb::scenario::Tool tool = plumb::scenario::paper_tool(seed);
  const CommonFrame frame = frame_of(tool);
  const Vec3 g = plumb::scaled(plumb::scenario::Stream(seed, plumb::scenario::Purpose::test).direction(0), 9.8);
  for (const unsigned bits : {15U, 7U, 11U, 13U, 14U}) {
    const SensorSet used(bits);
    const auto form = paper_form(tool.datasheet, frame, used);
    RC_ASSERT(form.has_value());
    std::vector<double> raw;
    std::vector<double> wanted;
    for (int i = 0; i < 4; ++i) {
      if (!used.has(i)) continue;
      raw.push_back(frame.scale[at(i)] * (plumb::dot(frame.axis[at(i)], g) + frame.bias_mps2[at(i)]));
      wanted.push_back(plumb::dot(tool.datasheet.sensor[at(i)].row.axis, g));
    }
    const std::vector<double> got = by_eq_3(*form, raw);
    for (std::size_t i = 0; i < got.size(); ++i) RC_ASSERT(std::abs(got[i] - wanted[i]) < 1e-11);
  }
}

TEST(PaperForm, IndicesAreThoseOfThePapersFit) {
  const Bench bench = bench_of(3);
  for (const SensorSet used : {SensorSet(15U), SensorSet(13U)}) {
    const auto error = plumb::PaperError::make(bench.tool.datasheet, plumb::study::study_gravity(), used);
    ASSERT_TRUE(error.has_value());
    const auto form = paper_form(bench.tool.datasheet, frame_of(*bench.fits.own), used);
    ASSERT_TRUE(form.has_value());
    plumb::SensorModel model = bench.tool.datasheet.model();
    error->store(*form, model);
    // The truth's raw values through the paper's model: accelerations along the nominal axes, to what the fit leaves.
    const CommonFrame truth = frame_of(bench.tool);
    const Vec3 g = {3.0, -5.0, 7.8};
    std::array<double, plumb::kCapacity> raw{};
    for (int i = 0; i < 4; ++i)
      raw[at(i)] = truth.scale[at(i)] * (plumb::dot(truth.axis[at(i)], g) + truth.bias_mps2[at(i)]);
    const plumb::Readings y = model.apply(raw, 25.0, used);
    for (int i = 0; i < 4; ++i) {
      if (used.has(i)) {
        EXPECT_NEAR(y[at(i)], plumb::dot(bench.tool.datasheet.sensor[at(i)].row.axis, g), 2e-3) << i;
      }
    }
  }
}

TEST(PaperForm, RefusesWhatHasNoAnswer) {
  const plumb::scenario::Tool tool = plumb::scenario::paper_tool(1);
  CommonFrame frame = frame_of(tool);
  EXPECT_FALSE(paper_form(tool.datasheet, frame, SensorSet(3U))) << "two sensors";
  EXPECT_FALSE(paper_form(tool.datasheet, frame, SensorSet(19U))) << "remove an absent sensor";
  frame.axis[2] = frame.axis[1];
  EXPECT_FALSE(paper_form(tool.datasheet, frame, SensorSet(7U)));
  EXPECT_FALSE(paper_form(tool.datasheet, frame, SensorSet(15U)));
}

TEST(PaperForm, APerfectToolHasNoMisalignment) {
  const plumb::Datasheet sheet = plumb::scenario::paper_datasheet();
  const CommonFrame frame = frame_of(plumb::scenario::perfect_tool(sheet));
  for (const unsigned bits : {15U, 7U}) {
    const auto form = paper_form(sheet, frame, SensorSet(bits));
    ASSERT_TRUE(form.has_value());
    const int n = SensorSet(bits).size();
    for (std::size_t k = at(2 * n); k < form->size(); ++k) EXPECT_NEAR((*form)[k], 0.0, 1e-12);
    EXPECT_NEAR((*form)[plumb::study::scale_index(n, 1)], sheet.sensor[1].coefficients.scale[0], 1e-12);
  }
}

}  // namespace
}  // namespace paper_form_test
