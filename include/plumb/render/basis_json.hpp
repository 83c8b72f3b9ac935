/// What every verdict of a run rests on, for its health report.
#pragma once

#include "plumb/io/array_file.hpp"
#include "plumb/io/calibration_file.hpp"
#include "plumb/io/json_fields.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace render {

/// The length of gravity, the calibration as it was read, and the drift that is allowed for so many days after it.
/// Null: the calibration was made in flight; events and snapshot tell of it.
io::Json basis_json(const io::ArrayFile& array, const io::CalibrationFile* calibration, double days);

}  // namespace render
}  // namespace PLUMB_ABI
}  // namespace plumb
