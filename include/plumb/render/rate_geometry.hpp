/// What `plumb geometry` says of a group of gyros, for people and for machines.
#pragma once

#include <string>

#include "plumb/findings/rate_sizes.hpp"
#include "plumb/io/array_file.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace render {

/// Without a full stop.
inline constexpr const char* kNoRateIsolation =
    "parity detects but cannot isolate a faulty gyro: that takes five axes, no three of them in one plane, or three "
    "triads";

std::string rate_geometry_text(const io::ArrayFile& group, const findings::RateGeometry& found);
/// Rates in rad/s, null where the axes have no such figure.
std::string rate_geometry_json(const io::ArrayFile& group, const findings::RateGeometry& found);

}  // namespace render
}  // namespace PLUMB_ABI
}  // namespace plumb
