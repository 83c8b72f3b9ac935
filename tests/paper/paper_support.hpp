/// Fits by hand and by the paper's method, for the tests of paper mode.
#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <vector>

#include "calibration/calibration_support.hpp"
#include "plumb/paper/paper_rule.hpp"

namespace paper_test {

using calibration_test::at;

/// The datasheet taken for the truth: every fit is exact where the sensors are those of the datasheet.
inline std::unique_ptr<plumb::PaperCalibration> exact_fits(const plumb::Datasheet& sheet) {
  auto out = std::make_unique<plumb::PaperCalibration>();
  const auto fit_of = [&sheet](plumb::SensorSet used) {
    plumb::PaperFit fit;
    fit.used = used;
    fit.model = sheet.model();
    fit.converged = true;
    fit.stop = plumb::StopReason::converged;
    fit.rank = plumb::kPaperRank;
    return fit;
  };
  out->all = fit_of(plumb::SensorSet::first(sheet.size));
  for (int i = 0; i < sheet.size; ++i) {
    for (int j = i + 1; j < sheet.size; ++j) {
      for (int k = j + 1; k < sheet.size; ++k)
        out->triple[at(out->triples++)] = fit_of(plumb::SensorSet::of(i).with(j).with(k));
    }
  }
  return out;
}

/// What the sensors of the datasheet show for these accelerations along their axes, at 25 degC.
inline std::array<double, plumb::kCapacity> raw_of(const plumb::Datasheet& sheet, const plumb::Readings& y_mps2) {
  const auto raw = sheet.model().raw_from(y_mps2, 25.0);
  EXPECT_TRUE(raw.has_value());
  return raw ? *raw : std::array<double, plumb::kCapacity>{};
}

inline plumb::Readings along_axes(const plumb::SensorArray& array, const plumb::Vec3& gravity_mps2) {
  plumb::Readings y{};
  for (int i = 0; i < array.size(); ++i) y[at(i)] = plumb::dot(array.axis(i), gravity_mps2);
  return y;
}

}  // namespace paper_test
