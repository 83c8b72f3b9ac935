/// What is said of the alignment of the calibrated axes to the housing, by calibrate, monitor, verify and the health
/// report alike.
#pragma once

#include <string>

#include "plumb/findings/alignment.hpp"
#include "plumb/io/json_fields.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace render {

/// "the calibrated axes as a whole are within 6.4 deg of the housing, by the axes of the datasheet". Without a full
/// stop.
std::string alignment_words(const findings::Alignment& alignment);

/// Whether the bound alone is beyond an alert limit that is about the housing, so that no output can be valid.
bool alignment_exceeds_alert(const io::ArrayFile& array, const findings::Alignment& alignment);

/// What to do about that. Without a full stop.
std::string alignment_remedy();

/// A note for standard error where it is so. Else empty.
std::string alignment_note(const io::ArrayFile& array, const findings::Alignment& alignment);

io::Json alignment_json(const io::ArrayFile& array, const findings::Alignment& alignment);

}  // namespace render
}  // namespace PLUMB_ABI
}  // namespace plumb
