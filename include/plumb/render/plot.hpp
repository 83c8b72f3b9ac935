/// Pictures are drawn by gnuplot (a program that must be installed at run time) and stand inside pages as SVG.
#pragma once

#include <string>
#include <vector>

#include "plumb/health/state.hpp"
#include "plumb/io/file_error.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace render {

/// What a chart for a phone has before its name, and the file beside a chart that says where its axes lie has behind
/// it.
inline constexpr const char* kNarrowPrefix = "narrow-";
/// A phone shows its chart as wide as this; letters keep the size that they have on a desk.
inline constexpr int kNarrowWidth = 400;
inline constexpr const char* kAxesSuffix = ".axes";

/// A picture of its own; for a page, with its axes beside it; the same for a phone.
enum class DrawnFor { itself, page, phone };

/// Runs `gnuplot script` inside `directory`. Where gnuplot is not installed the error names it, and the package to
/// install.
io::FileExpected<void> run_gnuplot(const std::string& directory, const std::string& script,
                                   DrawnFor drawn_for = DrawnFor::itself);

/// Runs a program inside `directory` and waits for it. `package` is the Debian package that an error names where the
/// program is not installed, `what` what there is none of then.
io::FileExpected<void> run_program(const std::string& directory, const std::string& program,
                                   const std::vector<std::string>& arguments, const std::string& package,
                                   const std::string& what);

/// The SVG made fit to stand inside a page: no XML prologue, no namespace attributes, no names of
/// programs, black replaced by the colour of the surrounding text (so that it is readable on dark pages), every mark a
/// shape with its own colour (a reference to one shape in the colour of the place is black where a page is printed).
/// `axes`: what the chart printed of its axes, for the readout of the page.
std::string inline_svg(const std::string& svg, const std::string& axes = "");

/// verification::Colour of a state in plots and pages, "#rrggbb".
const char* colour_of(HealthState state) noexcept;

}  // namespace render
}  // namespace PLUMB_ABI
}  // namespace plumb
