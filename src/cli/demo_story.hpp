/// The demo's page: what happened, told from the records alone, so that it holds for every seed.
#pragma once

#include <cstdint>

#include "fit_summary.hpp"
#include "plumb/report/page.hpp"
#include "plumb/report/timeline.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace cli {

struct DemoFacts {
  std::uint64_t seed;
  const io::ArrayFile& array;
  const CalibrationRun& fit;
  const report::Timeline& timeline;
  const Verdict& last;
  SensorSet dead;  ///< what really died
  double fault_s;  ///< and when
};

report::RunPage demo_page(const DemoFacts& facts);

}  // namespace cli
}  // namespace PLUMB_ABI
}  // namespace plumb
