#include "plumb/render/geometry_plot.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "plumb/render/plot.hpp"

namespace geometry_plot_test {
namespace {

using namespace plumb;

render::GeometryPictures pictures() {
  render::GeometryPictures out;
  out.name = "it's a tool";
  out.samples = 32;
  out.sigma_fine = 0.2;
  for (int inclination = 0; inclination <= 180; inclination += 30) {
    for (int toolface = 0; toolface <= 360; toolface += 30)
      out.map.push_back({1.0 * inclination, 1.0 * toolface, 1.0 + 0.001 * toolface, 0.5 + 0.001 * inclination,
                         inclination == 0 ? 1 : 0});
  }
  out.levels = {{0.1, 0.09, 0.02}, {1.0, 0.9, 0.2}};
  return out;
}

std::string text_of(const std::vector<render::PlotFile>& files, const std::string& name) {
  for (const render::PlotFile& file : files) {
    if (file.name == name) return file.text;
  }
  return "";
}

TEST(GeometryPlot, DataAreWhatWasGiven) {
  const std::vector<render::PlotFile> files = render::geometry_plot_files(pictures());
  const std::string map = text_of(files, "geometry-attitudes.csv");
  EXPECT_EQ(std::count(map.begin(), map.end(), '\n'), 1 + 7 * 13);
  EXPECT_NE(map.find("\n0,30,1.03,0.5,1\n"), std::string::npos) << map;
  EXPECT_EQ(text_of(files, "geometry-protection.csv"),
            "sigma_mg0,one_sample_deg,block_deg\n0.1,0.09,0.02\n1,0.9,0.2\n");
  EXPECT_EQ(files.back().name, render::kGeometryScript);
}

TEST(GeometryPlot, WithoutDataThereIsNoPicture) {
  render::GeometryPictures none = pictures();
  none.map.clear();
  EXPECT_EQ(render::geometry_picture_names(none), std::vector<std::string>{"geometry-protection.svg"});
  EXPECT_EQ(text_of(render::geometry_plot_files(none), "geometry.gp").find("geometry-attitudes"), std::string::npos);
  none.levels.clear();
  EXPECT_TRUE(render::geometry_picture_names(none).empty());
}

TEST(GeometryPlot, GnuplotDrawsEveryPictureWithoutAWord) {
  std::string directory = (std::filesystem::temp_directory_path() / "plumb-geometry-XXXXXX").string();
  ASSERT_NE(::mkdtemp(directory.data()), nullptr);
  for (const render::PlotFile& file : render::geometry_plot_files(pictures()))
    std::ofstream(std::filesystem::path(directory) / file.name) << file.text;
  const io::FileExpected<void> drawn = render::run_gnuplot(directory, render::kGeometryScript);
  if (!drawn && drawn.error().what.find("not installed") != std::string::npos) {
    std::filesystem::remove_all(directory);
    GTEST_SKIP() << drawn.error().what;
  }
  EXPECT_TRUE(drawn) << drawn.error().text();
  for (const std::string& name : render::geometry_picture_names(pictures())) {
    std::ifstream in(std::filesystem::path(directory) / name);
    std::ostringstream svg;
    svg << in.rdbuf();
    EXPECT_NE(svg.str().find("</svg>"), std::string::npos) << name;
    EXPECT_NE(svg.str().find("it s a tool"), std::string::npos) << name;
  }
  std::filesystem::remove_all(directory);
}

}  // namespace
}  // namespace geometry_plot_test
