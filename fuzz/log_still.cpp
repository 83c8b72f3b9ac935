// Any bytes as a log at rest without an array file: it is refused with a reason, or every column is studied or refused.
#include <cmath>

#include "files.hpp"
#include "plumb/noise/axis_study.hpp"
#include "plumb/noise/load_log.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace plumb::noise;
  const fuzz::MemoryFile file(data, size);
  LoadOptions options;
  options.on_bad_row = size % 2 == 0 ? plumb::io::BadRowPolicy::stop : plumb::io::BadRowPolicy::skip;
  const auto log = load_still_log(file.path(), options);
  if (!log) {
    fuzz::demand_told(log.error());
    return 0;
  }
  fuzz::demand(log->units.size() == log->log.columns.size(), "every column has its unit");
  for (std::size_t c = 0; c < log->log.columns.size() && c < 4; ++c) {
    const AxisStudy study = study_axis(log->log, c, {});
    if (study.stretch.refused != Refused::no) continue;
    for (const Term term : kAllTerms) {
      const TermEstimate& one = study.fit.of(term);
      fuzz::demand(one.low <= one.value && one.value <= one.high, "an estimate lies in its interval");
    }
    fuzz::demand(std::isfinite(study.whiteness.declare_sigma), "the noise to declare is a number");
  }
  return 0;
}
