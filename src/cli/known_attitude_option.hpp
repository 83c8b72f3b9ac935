/// --known-attitude of calibrate and verify.
#pragma once

#include <string>
#include <vector>

#include "plumb/io/array_file.hpp"
#include "tool.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace cli {

/// `list`: as written; each is read before anything else is done.
void add_known_attitude_option(const Options& command, std::vector<std::string>& list);

/// Joins them to those of the array file.
void take_known_attitudes(const std::vector<std::string>& list, io::ArrayFile& array);

}  // namespace cli
}  // namespace PLUMB_ABI
}  // namespace plumb
