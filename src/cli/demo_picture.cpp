#include "demo_picture.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <utility>

#include "plumb/io/output_file.hpp"
#include "plumb/render/plot.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace cli {
namespace {

std::string path_of(const std::string& directory, const std::string& name) {
  return (std::filesystem::path(directory) / name).string();
}

/// The picture that a program draws into NAME.svg; empty where gnuplot does not draw, with the reason in `missing`.
io::FileExpected<std::string> drawn_by(const std::string& directory, const std::string& name, const std::string& script,
                                       std::string& missing) {
  const io::FileExpected<void> written = write_into(directory, name + ".gp", script);
  if (!written) return tl::unexpected<io::FileError>(written.error());
  const io::FileExpected<void> drawn = render::run_gnuplot(directory, name + ".gp");
  if (!drawn) {
    missing = drawn.error().text();
    return std::string();
  }
  io::FileExpected<std::string> svg = io::read_file(path_of(directory, name + ".svg"));
  return svg ? io::FileExpected<std::string>(render::inline_svg(*svg)) : svg;
}

}  // namespace

std::string plot_head(const std::string& name, int width, Heights heights, bool narrow) {
  return fmt::format(
      "# Draws {0}.svg. Run: gnuplot {0}.gp\n"
      "set terminal svg size {1},{2} dynamic font 'sans-serif,15' name '{3}' linewidth 1.2\nset output '{0}.svg'\n"
      "set datafile separator ','\nset datafile missing ''\nset border lw 0.7\nset tics scale 0.6\n",
      narrow ? render::kNarrowPrefix + name : name, narrow ? render::kNarrowWidth : width,
      narrow ? heights.narrow : heights.broad, narrow ? "narrow_" + name : name);
}

io::FileExpected<render::Picture> draw(const std::string& directory, const std::string& name, const ScriptOf& script_of,
                                       std::string title, std::string caption) {
  render::Picture out;
  out.title = std::move(title);
  out.caption = std::move(caption);
  const io::FileExpected<std::string> broad = drawn_by(directory, name, script_of(false), out.missing);
  if (!broad) return tl::unexpected<io::FileError>(broad.error());
  out.svg = *broad;
  if (!out.missing.empty()) return out;
  const std::string phone = render::kNarrowPrefix + name;
  const io::FileExpected<std::string> narrow = drawn_by(directory, phone, script_of(true), out.missing);
  if (!narrow) return tl::unexpected<io::FileError>(narrow.error());
  out.narrow = *narrow;
  std::error_code ignored;
  for (const char* ending : {".gp", ".svg"}) std::filesystem::remove(path_of(directory, phone + ending), ignored);
  return out;
}

void link_drawn(render::Chapter& chapter, const std::string& name, const std::string& shows) {
  if (!chapter.pictures.back().svg.empty()) chapter.files.push_back({name + ".svg", shows});
  chapter.files.push_back({name + ".gp", "the gnuplot program that draws it"});
}

io::FileExpected<void> write_into(const std::string& directory, const std::string& name, const std::string& text) {
  return io::write_file(path_of(directory, name), text);
}

tl::unexpected<io::FileError> study_failed(const std::string& why) {
  return tl::unexpected<io::FileError>(
      io::FileError{"plumb demo", 0, "", why, "report this as a bug of plumb", io::ExitCode::other});
}

std::string csv_line(const std::vector<std::string>& cells) { return fmt::format("{}\n", fmt::join(cells, ",")); }

}  // namespace cli
}  // namespace PLUMB_ABI
}  // namespace plumb
