/// What the writer and the reader of the calibration file share (private to src/io). Only they include
/// nlohmann_json, which is slow to compile.
#pragma once

#include <cstdint>
#include <string>

#include "plumb/calibration/calibration.hpp"
#include "plumb/core/config.hpp"
#include "plumb/io/array_file.hpp"
#include "plumb/io/json_fields.hpp"
#include "plumb/paper/paper_calibration.hpp"

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

/// JSON has no nan and inf; they become words, so that nothing is lost.
Json from_double(double value);

template <class Array>
Json from_array(const Array& values, std::size_t count) {
  Json out = Json::array();
  for (std::size_t k = 0; k < count; ++k) out.push_back(from_double(values[k]));
  return out;
}

/// The section `array`: which array it is of, with all that a calibration depends on.
Json from_nominal(const ArrayFile& array);

/// Objects one member a line, lists of plain values on one line.
std::string printed(const Json& value);

/// The section `paper_parameters`: B, SF and m_ij of eqs (1)-(3), or `why_not`. Derived: the reader takes the
/// common-frame form.
Json from_paper_parameters(const SensorArray& nominal, const Calibration& calibration);

/// The section `paper`, the paper's own fits; sensors are named as in the array.
Json from_paper(const PaperCalibration& paper, const SensorArray& array);

}  // namespace io
}  // namespace PLUMB_ABI
}  // namespace plumb
