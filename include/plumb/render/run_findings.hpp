/// What a run says about the array file and the calibration: lines of `plumb monitor` behind its summary.
#pragma once

#include <string>

#include "plumb/health/verdict.hpp"
#include "plumb/io/array_file.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace render {

/// One line each, with what to do, `array` being the file that the monitor was configured by: gravity that is off,
/// noise other than stated, a calibration that is contradicted. Empty where there is nothing to say.
std::string findings_text(const Verdict& last, const io::ArrayFile& array);

}  // namespace render
}  // namespace PLUMB_ABI
}  // namespace plumb
