/// What every chart by gnuplot begins with (private to src/render).
#pragma once

#include <fmt/format.h>

#include <string>

#include "plumb/core/config.hpp"
#include "plumb/render/plot.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace render {

/// Anything set before is forgotten; the chart goes to the file `name`, data come as CSV. With `gnuplot -e narrow=1`
/// the same is drawn for a phone, `narrow_height` high, into the file kNarrowPrefix + `name`; with `-e page=1` what
/// `print axes(...)` says goes to a file beside it.
inline std::string chart_head(const std::string& name, int width, int height, int narrow_height) {
  return fmt::format(
      "\nreset\nif (!exists('narrow')) narrow = 0\n"
      "set terminal svg size (narrow ? {4} : {0}),(narrow ? {5} : {1}) dynamic font 'sans-serif,15' linewidth 1.2\n"
      "set output (narrow ? '{3}' : '').'{2}'\nset print (exists('page') ? (narrow ? '{3}' : '').'{2}{6}' : "
      "'/dev/null')\n"
      "axes(x, y, logx, logy) = sprintf('%.2f %.2f %.8g %.8g %d %.2f %.2f %.8g %.8g %d|%s|%s', GPVAL_TERM_XMIN, "
      "GPVAL_TERM_XMAX, GPVAL_X_MIN, GPVAL_X_MAX, logx, 1.0 * GPVAL_TERM_YSIZE / GPVAL_TERM_SCALE - GPVAL_TERM_YMIN, "
      "1.0 * GPVAL_TERM_YSIZE / GPVAL_TERM_SCALE - GPVAL_TERM_YMAX, GPVAL_Y_MIN, GPVAL_Y_MAX, logy, x, y)\n"
      "set datafile separator ','\nset border lw 0.7\nset tics scale 0.6 font ',13'\n",
      width, height, name, kNarrowPrefix, kNarrowWidth, narrow_height, kAxesSuffix);
}

/// After a plot: where its axes lie and what they are, so that a page can say what lies under the pointer.
enum class Log { none, x, y, both };
inline std::string axes_told(const std::string& x, const std::string& y, Log log = Log::none) {
  return fmt::format("print axes('{}', '{}', {:d}, {:d})\n", x, y, log == Log::x || log == Log::both,
                     log == Log::y || log == Log::both);
}

}  // namespace render
}  // namespace PLUMB_ABI
}  // namespace plumb
