/// What is said of the wirings that gravity cannot see, by calibrate, verify and the health report alike.
#pragma once

#include <string>

#include "plumb/findings/unseen_wiring.hpp"
#include "plumb/io/json_fields.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace render {

/// The name of the open item, in files.
inline constexpr const char* kWiringItem = "wiring_confirmed";

/// "a2 and a3 exchanged", "all sensors reversed", "a1 carries a2, a2 carries a4 reversed, ..."
std::string wiring_words(const Wiring& wiring, const SensorArray& array);

/// "confirmed by station 7", "47 other wirings give the same residuals"
std::string wiring_found(const findings::WiringCheck& check);

/// What ties the axes of magnetometers to the tool: no attitude tells how the field lies in it.
inline constexpr const char* kAlignByAccelerometers =
    "calibrate with --align-by, the calibration of the accelerometers, which ties the axes to theirs by the dip";

/// The finding in full, and what to do where something is to be done. Without a full stop.
std::string wiring_reason(const findings::WiringCheck& check, const io::ArrayFile& array);
std::string wiring_remedy(const findings::WiringCheck& check, const io::ArrayFile& array);
/// Both.
std::string wiring_text(const findings::WiringCheck& check, const io::ArrayFile& array);

/// The item by name where it is open or contradicted: a list of none or one.
io::Json wiring_items(const findings::WiringCheck& check, const io::ArrayFile& array);

io::Json wiring_json(const findings::WiringCheck& check, const io::ArrayFile& array);

}  // namespace render
}  // namespace PLUMB_ABI
}  // namespace plumb
