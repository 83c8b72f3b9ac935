/// Coefficients in the form of NOAA's WMM.COF, for the model after the next one.
#pragma once

#include <string>
#include <string_view>

#include "plumb/geomagnetic/field_model.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace geomagnetic {

/// First line: epoch, name, date of release. Then one line a coefficient: degree, order, g, h [nT], and their change
/// [nT a year]; all 90 of degree 1 to 12, each once, in any order. Lines of 9s end it. Valid from the epoch for five
/// years. `name` stands in error messages. Refuses anything else by line: no number, a coefficient twice or missing, a
/// degree above 12 (cut the file at degree 12), h of order 0 other than 0, coefficients beyond 100 000 nT.
io::FileExpected<FieldModel> parse_coefficients(std::string_view text, const std::string& name);

/// The same from a file, of 1 MB at the most.
io::FileExpected<FieldModel> read_coefficients(const std::string& path);

}  // namespace geomagnetic
}  // namespace PLUMB_ABI
}  // namespace plumb
