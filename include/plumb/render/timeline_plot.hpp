/// The picture of a monitored run.
#pragma once

#include <string>

#include "plumb/render/timeline.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace render {

/// The gnuplot program that draws `csv` (as written by `timeline_csv`) into `name`.svg; both are names without a
/// directory, so that the script runs wherever the files lie together. `narrow`: for a phone, into kNarrowPrefix +
/// `name`.svg.
std::string timeline_script(const Timeline& timeline, const std::string& csv, const std::string& name,
                            bool narrow = false);

}  // namespace render
}  // namespace PLUMB_ABI
}  // namespace plumb
