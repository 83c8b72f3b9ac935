/// What every chart by gnuplot begins with (private to src/render).
#pragma once

#include <fmt/format.h>

#include <string>

#include "plumb/core/config.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace render {

/// Anything set before is forgotten; the chart goes to the file `name`, data come as CSV.
inline std::string chart_head(const char* name, int width, int height) {
  return fmt::format(
      "\nreset\nset terminal svg size {},{} dynamic font 'sans-serif,15' linewidth 1.2\nset output '{}'\n"
      "set datafile separator ','\nset border lw 0.7\nset tics scale 0.6 font ',13'\n",
      width, height, name);
}

}  // namespace render
}  // namespace PLUMB_ABI
}  // namespace plumb
