/// What became of a calibration, for people and for machines.
#pragma once

#include <string>

#include "plumb/findings/calibration_run.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace render {

/// Why a fit was refused, and what to do about it; both without a full stop.
struct Refusal {
  std::string reason;
  std::string next;
};
/// Of a run that was not accepted: the words of `findings::refusal_of`.
Refusal refusal_of(const findings::CalibrationRun& run, const io::ArrayFile& array);
/// The same for the fits by the paper's method.
Refusal paper_refusal_of(const findings::CalibrationRun& run, const io::ArrayFile& array);

/// The report as text and as JSON. `suggest`: with the attitudes to record next even where the fit is accepted.
struct ReportParts {
  bool stations = false;
  bool suggest = false;
};
std::string fit_text(const findings::CalibrationRun& run, const io::ArrayFile& array, const ReportParts& parts = {});
std::string fit_json(const findings::CalibrationRun& run, const io::ArrayFile& array);
/// The same with the field of a magnetic group at the size of gravity, under the keys of gravity.
std::string fit_document(const findings::CalibrationRun& run, const io::ArrayFile& array);

}  // namespace render
}  // namespace PLUMB_ABI
}  // namespace plumb
