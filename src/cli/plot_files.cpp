#include "plot_files.hpp"

#include <filesystem>

#include "plumb/io/output_file.hpp"
#include "plumb/render/plot.hpp"
#include "tool.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace cli {

io::FileExpected<std::vector<std::string>> draw_files(const std::string& directory,
                                                      const std::vector<render::PlotFile>& files, const char* script,
                                                      std::vector<std::string> pictures, std::string& missing) {
  std::error_code error;
  std::filesystem::create_directories(directory, error);
  if (error) {
    return tl::unexpected<io::FileError>(io::FileError{directory, 0, "--plots",
                                                       "cannot create the directory: " + error.message(),
                                                       "choose another directory with --plots", io::ExitCode::other});
  }
  std::vector<std::string> written;
  for (const render::PlotFile& file : files) {
    const io::FileExpected<void> done =
        io::write_file((std::filesystem::path(directory) / file.name).string(), file.text);
    if (!done) return tl::unexpected<io::FileError>(done.error());
    written.push_back(file.name);
  }
  const io::FileExpected<void> drawn = render::run_gnuplot(directory, script);
  if (!drawn) {
    missing = drawn.error().text();
    return written;
  }
  return pictures;
}

io::FileExpected<render::PagePictures> draw_pictures(const std::string& directory,
                                                     const std::vector<render::PlotFile>& files, const char* script,
                                                     const std::vector<std::string>& names) {
  std::string missing;
  const io::FileExpected<std::vector<std::string>> drawn = draw_files(directory, files, script, names, missing);
  if (!drawn) return tl::unexpected<io::FileError>(drawn.error());
  render::PagePictures out;
  if (!missing.empty()) print_error("plumb: " + missing + "\n");
  for (const std::string& name : names) {
    render::PagePicture picture{"", missing};
    if (missing.empty()) {
      const io::FileExpected<std::string> svg = io::read_file((std::filesystem::path(directory) / name).string());
      if (!svg) return tl::unexpected<io::FileError>(svg.error());
      picture.svg = render::inline_svg(*svg);
    }
    out.emplace(name, std::move(picture));
  }
  return out;
}

}  // namespace cli
}  // namespace PLUMB_ABI
}  // namespace plumb
