/// Plot data and programs, written to a directory and drawn.
#pragma once

#include <string>
#include <vector>

#include "plumb/io/file_error.hpp"
#include "plumb/render/fit_plot.hpp"
#include "plumb/render/plot.hpp"
#include "plumb/render/verification_page.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace cli {

/// Writes the files and runs gnuplot on `script`, which draws `pictures`. `missing` says why there are no pictures
/// where gnuplot cannot draw them; the returned names are those of the files that exist then. Error: a file or the
/// directory cannot be written.
io::FileExpected<std::vector<std::string>> draw_files(const std::string& directory,
                                                      const std::vector<render::PlotFile>& files, const char* script,
                                                      std::vector<std::string> pictures, std::string& missing,
                                                      render::DrawnFor drawn_for = render::DrawnFor::itself);

/// The same, ready to stand in a page. Where gnuplot cannot draw, standard error and each picture say why.
io::FileExpected<render::PagePictures> draw_pictures(const std::string& directory,
                                                     const std::vector<render::PlotFile>& files, const char* script,
                                                     const std::vector<std::string>& names);

/// The same, drawn in a directory that is removed again. A page without pictures is a page still: what hinders the
/// drawing is said in their place.
render::PagePictures draw_for_page(const std::vector<render::PlotFile>& files, const char* script,
                                   const std::vector<std::string>& names);

}  // namespace cli
}  // namespace PLUMB_ABI
}  // namespace plumb
