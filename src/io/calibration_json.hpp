/// What the writer and the reader of the calibration file share (private to src/io). Only they include
/// nlohmann_json, which is slow to compile.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>

#include "plumb/calibration/sensor_model.hpp"
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

}  // namespace io
}  // namespace PLUMB_ABI
}  // namespace plumb
