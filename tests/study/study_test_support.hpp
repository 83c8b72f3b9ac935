/// What the tests of the study share.
#pragma once

#include <gtest/gtest.h>

#include <stdexcept>
#include <string>

#include "plumb/scenario/library.hpp"
#include "plumb/study/fits.hpp"

namespace study_test {

inline std::size_t at(int i) { return static_cast<std::size_t>(i); }

/// The paper's tool of a seed with both calibrations. Throws where they fail: a test cannot go on.
struct Bench {
  plumb::scenario::Tool tool;
  std::uint64_t seed;
  plumb::study::Fits fits;
};

inline Bench bench_of(std::uint64_t seed) {
  Bench out{plumb::scenario::paper_tool(seed), seed, {}};
  const auto stations = plumb::study::calibration_stations(out.tool, seed);
  if (!stations) throw std::runtime_error(stations.error());
  auto fits = plumb::study::fit_both(out.tool.datasheet, *stations);
  if (!fits) throw std::runtime_error(fits.error());
  out.fits = *std::move(fits);
  return out;
}

}  // namespace study_test
