/// The sections of the verification report that tell of the array, its calibration and the state machine.
#pragma once

#include <optional>
#include <string>

#include "plumb/findings/geometry_study.hpp"
#include "plumb/io/array_file.hpp"
#include "plumb/io/json_fields.hpp"
#include "plumb/scenario/truth.hpp"
#include "plumb/session/calibration_pipeline.hpp"
#include "plumb/verification/replayed.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace render {

using Json = nlohmann::ordered_json;

/// A calibration as the report needs it: where it comes from, what it leaves, what the fit said.
struct CalibrationPart {
  std::unique_ptr<const Calibration> calibration;  ///< null where it was refused
  verification::CalibrationFacts facts;
  verification::WiringFacts wiring;
  verification::AlignmentFacts alignment;
  Json section;
  findings::Visited visited;          ///< attitudes of its stations
  double e_cal_mps2 = 0.0;            ///< of the worst sensor; 0 where there is none
  std::uint32_t samples_per_row = 1;  ///< fewest behind a station of the log, where its rows are means that say so
};

/// Of a file that `plumb calibrate` wrote.
io::FileExpected<CalibrationPart> calibration_of_file(const std::string& path, const io::ArrayFile& array);
/// What its known attitudes and those of the array file say of the wiring.
io::FileExpected<findings::WiringCheck> wiring_of(const io::CalibrationFile& file, const io::ArrayFile& array);
/// Of a log of attitudes at rest.
io::FileExpected<CalibrationPart> calibration_of_stations(const std::string& path, const io::ArrayFile& array);
/// Of a simulated stand: sensors drawn within the priors of the array file, at random attitudes.
CalibrationPart predicted_calibration(const io::ArrayFile& array, std::uint64_t seed);

/// The smallest prior of any sensor: tools drawn with these lie within the priors of all of them.
scenario::TruthSpans smallest_priors(const Datasheet& datasheet);

/// The array with that calibration, so many days after it.
findings::GeometrySubject subject_of(const io::ArrayFile& array, const CalibrationPart& part,
                                     double days_since_calibration);
/// The array as `plumb geometry` judges it, its maps included.
Json array_section(const findings::GeometrySubject& subject, const findings::GeometryStudy& study);
/// The same as it is judged.
verification::ArrayFacts array_facts(const findings::GeometrySubject& subject, const findings::GeometryStudy& study);

/// The table of the state machine; `replayed` tells where the campaigns went, nothing where none were played.
Json machine_section(const std::optional<verification::Replayed>& replayed);

}  // namespace render
}  // namespace PLUMB_ABI
}  // namespace plumb
