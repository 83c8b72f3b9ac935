/// Pictures and files of the demo's sections.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "plumb/io/file_error.hpp"
#include "plumb/render/chapter.hpp"
#include "plumb/study/survey.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace cli {

/// Colours that are readable on white and on black: of sensors a1 to a4, and of the two methods.
inline constexpr const char* kSensorColour[] = {"#d0553c", "#2f78b7", "#c98a00", "#2c8f57"};
inline constexpr const char* kPaperColour = "#d0553c";
inline constexpr const char* kOwnColour = "#2f78b7";
inline constexpr const char* kDatasheetColour = "#8a8a8a";

/// Height of a picture in pixels: `broad` of one for a desk, `narrow` of one as wide as a phone.
struct Heights {
  int broad, narrow;
};

/// Head of a gnuplot program: terminal, output NAME.svg, separator, thin frame. `narrow`: for a phone, in place of
/// `width`.
std::string plot_head(const std::string& name, int width, Heights heights, bool narrow);

/// The gnuplot program of a picture, for a desk or for a phone.
using ScriptOf = std::function<std::string(bool narrow)>;

/// Writes NAME.gp into `directory`, draws it with gnuplot and reads NAME.svg for inlining; likewise for a phone, of
/// which no file is left. Where gnuplot is missing or fails the picture says so; only a file that cannot be written or
/// read is an error.
io::FileExpected<render::Picture> draw(const std::string& directory, const std::string& name, const ScriptOf& script_of,
                                       std::string title, std::string caption);

/// Links the files that `draw` wrote for the chapter's last picture: NAME.svg only where there is one, and NAME.gp.
/// `name` is relative to the page.
void link_drawn(render::Chapter& chapter, const std::string& name, const std::string& shows);

io::FileExpected<void> write_into(const std::string& directory, const std::string& name, const std::string& text);

/// A study that refused: nothing that a user did, or could mend.
tl::unexpected<io::FileError> study_failed(const std::string& why);

/// The given columns joined by commas, with a newline.
std::string csv_line(const std::vector<std::string>& cells);

}  // namespace cli
}  // namespace PLUMB_ABI
}  // namespace plumb
