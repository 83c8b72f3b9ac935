/// What `plumb calibrate --from` and `--export` say of what they did: as text and as JSON.
#pragma once

#include <string>

#include "plumb/coefficients/adoption.hpp"
#include "plumb/coefficients/calibration_export.hpp"
#include "plumb/io/json_fields.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace render {

std::string adoption_text(const coefficients::Adoption& adoption, const io::ArrayFile& array);
io::Json adoption_json(const coefficients::Adoption& adoption, const io::ArrayFile& array);

std::string export_text(const coefficients::CalibrationExport& made, const io::ArrayFile& array);
io::Json export_json(const coefficients::CalibrationExport& made, const io::ArrayFile& array);

}  // namespace render
}  // namespace PLUMB_ABI
}  // namespace plumb
