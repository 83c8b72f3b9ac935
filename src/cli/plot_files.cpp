#include "plot_files.hpp"

#include <unistd.h>

#include <filesystem>

#include "plumb/io/output_file.hpp"
#include "plumb/render/plot.hpp"
#include "tool.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace cli {
namespace {

namespace fs = std::filesystem;

/// One chart as a page holds it. What it printed of its axes is in the page from then on.
io::FileExpected<std::string> read_chart(const std::string& directory, const std::string& name) {
  const fs::path path = fs::path(directory) / name;
  const io::FileExpected<std::string> svg = io::read_file(path.string());
  if (!svg) return tl::unexpected<io::FileError>(svg.error());
  const std::string told = path.string() + render::kAxesSuffix;
  std::error_code ignored;
  std::string axes;
  if (fs::exists(told, ignored)) {
    const io::FileExpected<std::string> text = io::read_file(told);
    if (!text) return tl::unexpected<io::FileError>(text.error());
    axes = *text;
    fs::remove(told, ignored);
  }
  return render::inline_svg(*svg, axes);
}

/// A directory of its own, removed with all that is in it.
class Scratch {
 public:
  Scratch() {
    std::error_code error;
    std::string name = (fs::temp_directory_path(error) / "plumb-report-XXXXXX").string();
    if (!error && ::mkdtemp(name.data()) != nullptr) path_ = name;
  }
  ~Scratch() {
    std::error_code ignored;
    if (!path_.empty()) fs::remove_all(path_, ignored);
  }
  Scratch(const Scratch&) = delete;
  Scratch& operator=(const Scratch&) = delete;
  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

}  // namespace

io::FileExpected<std::vector<std::string>> draw_files(const std::string& directory,
                                                      const std::vector<render::PlotFile>& files, const char* script,
                                                      std::vector<std::string> pictures, std::string& missing,
                                                      render::DrawnFor drawn_for) {
  std::error_code error;
  fs::create_directories(directory, error);
  if (error) {
    return tl::unexpected<io::FileError>(io::FileError{directory, 0, "--plots",
                                                       "cannot create the directory: " + error.message(),
                                                       "choose another directory with --plots", io::ExitCode::other});
  }
  std::vector<std::string> written;
  for (const render::PlotFile& file : files) {
    const io::FileExpected<void> done = io::write_file((fs::path(directory) / file.name).string(), file.text);
    if (!done) return tl::unexpected<io::FileError>(done.error());
    written.push_back(file.name);
  }
  const io::FileExpected<void> drawn = render::run_gnuplot(directory, script, drawn_for);
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
  const io::FileExpected<std::vector<std::string>> drawn =
      draw_files(directory, files, script, names, missing, render::DrawnFor::page);
  if (!drawn) return tl::unexpected<io::FileError>(drawn.error());
  render::PagePictures out;
  if (missing.empty()) {
    const io::FileExpected<void> narrow = render::run_gnuplot(directory, script, render::DrawnFor::phone);
    if (!narrow) missing = narrow.error().text();
  }
  if (!missing.empty()) print_error("plumb: " + missing + "\n");
  for (const std::string& name : names) {
    render::PagePicture picture{"", missing, ""};
    if (missing.empty()) {
      const io::FileExpected<std::string> svg = read_chart(directory, name);
      if (!svg) return tl::unexpected<io::FileError>(svg.error());
      const io::FileExpected<std::string> narrow = read_chart(directory, render::kNarrowPrefix + name);
      if (!narrow) return tl::unexpected<io::FileError>(narrow.error());
      picture.svg = *svg;
      picture.narrow = *narrow;
    }
    out.emplace(name, std::move(picture));
  }
  return out;
}

render::PagePictures draw_for_page(const std::vector<render::PlotFile>& files, const char* script,
                                   const std::vector<std::string>& names) {
  render::PagePictures out;
  if (names.empty()) return out;
  const Scratch scratch;
  io::FileError failure{"TMPDIR",
                        0,
                        "",
                        "cannot create a directory in it, so there are no pictures",
                        "set TMPDIR to a directory that you may write to",
                        io::ExitCode::other};
  if (!scratch.path().empty()) {
    io::FileExpected<render::PagePictures> drawn = draw_pictures(scratch.path(), files, script, names);
    if (drawn) return *std::move(drawn);
    failure = drawn.error();
  }
  print_error("plumb: " + failure.text() + "\n");
  for (const std::string& name : names) out.emplace(name, render::PagePicture{"", failure.text(), ""});
  return out;
}

}  // namespace cli
}  // namespace PLUMB_ABI
}  // namespace plumb
