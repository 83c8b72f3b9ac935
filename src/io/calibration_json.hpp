/// What the writer and the reader of the calibration file share (private to src/io). Only they include
/// nlohmann_json, which is slow to compile.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>

#include "plumb/calibration/calibration.hpp"
#include "plumb/core/config.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace io {

/// Keeps the order of the keys.
using Json = nlohmann::ordered_json;

/// 16 hexadecimal digits.
std::string hex(std::uint64_t value);
const char* reads_word(Reads reads) noexcept;
/// Over the compact text of everything but the checksum itself: white space may change, content may not.
std::string checksum_of(Json content);
/// B, SF and m_ij of eqs (1)-(3), or `why_not`. Derived: the reader takes the common-frame form.
Json paper_json(const SensorArray& nominal, const Calibration& calibration);

}  // namespace io
}  // namespace PLUMB_ABI
}  // namespace plumb
