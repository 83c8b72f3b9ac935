/// The files behind the pictures of a fit: complete, and only for what there is to draw.
#include "plumb/render/fit_plot.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace fit_plot_test {
namespace {

using namespace plumb;

render::FitPictures pictures() {
  render::FitPictures p;
  p.sensors = {{"a1", {1.0, 0.1, 20.0}, {0.5, 0.01, 2.0}, {0.3, 0.02, 1.0}},
               {"odd, 'id'", {-1.0, 0.1, 20.0}, {0.5, 0.01, 2.0}, {0.3, 0.02, 1.0}}};
  p.stations = {{{0.0, 0.0, 1.0}, 0.25, 0.5, {0.1, -0.1}, false},
                {{0.0, 1.0, 0.0}, -0.25, std::nullopt, {0.2, -0.2}, true}};
  p.cost = {1000.0, 10.0};
  p.proposed_down = {{1.0, 0.0, 0.0}};
  return p;
}

std::string text_of(const render::FitPictures& p, const std::string& name) {
  for (const render::PlotFile& file : render::fit_plot_files(p)) {
    if (file.name == name) return file.text;
  }
  return "";
}

TEST(FitPlot, DataHoldEveryStationAndSensor) {
  EXPECT_EQ(text_of(pictures(), "fit-stations.csv"),
            "station,norm_mg0,held_out_mg0,stands_out,x,y,z,a1,odd___id_\n1,0.25,0.5,0,0,0,1,0.1,-0.1\n"
            "2,-0.25,,1,0,1,0,0.2,-0.2\n");
  EXPECT_EQ(
      text_of(pictures(), "fit-parameters.csv"),
      "row,id,bias_mg0,sigma,prior,scale_pct,sigma,prior,axis_deg,sigma,prior\n1,a1,1,0.1,20,0.5,0.01,2,0.3,0.02,1\n"
      "2,odd___id_,-1,0.1,20,0.5,0.01,2,0.3,0.02,1\n");
  EXPECT_EQ(text_of(pictures(), "fit-cost.csv"), "iteration,cost\n1,1000\n2,10\n");
  EXPECT_EQ(text_of(pictures(), "fit-next.csv"), "x,y,z\n1,0,0\n");
}

TEST(FitPlot, TheScriptDrawsEveryPictureNamed) {
  const render::FitPictures p = pictures();
  const std::vector<std::string> names = render::fit_picture_names(p);
  EXPECT_EQ(names.size(), 4U);
  const std::string script = text_of(p, render::kFitScript);
  for (const std::string& name : names) EXPECT_NE(script.find(".'" + name + "'\n"), std::string::npos) << name;
  EXPECT_NE(script.find("stands out"), std::string::npos);
}

TEST(FitPlot, EverySigmaIsWrittenAndNoRingCut) {
  const std::string script = text_of(pictures(), render::kFitScript);
  for (const char* part : {"sprintf('±%.2g, %.0f %% from the log', $4, $5 > 0 ?", "$7, $8 > 0 ?", "$10, $11 > 0 ?"})
    EXPECT_NE(script.find(part), std::string::npos) << part;
  const std::size_t residuals = script.find("fit-residuals.svg");
  EXPECT_LT(script.find("set offsets 0,0,graph 0.07,graph 0.07", residuals), script.find("\nplot", residuals));
  render::FitPictures many = pictures();
  many.sensors.resize(6, many.sensors.front());
  for (auto& s : many.stations) s.residual_mg0.resize(6);
  EXPECT_EQ(text_of(many, render::kFitScript).find("from the log"), std::string::npos) << "no room";
}

TEST(FitPlot, AFewCostsNearOneAnotherAreReadFromZeroUp) {
  render::FitPictures p = pictures();
  p.cost = {81.0, 80.6};
  const std::string near = text_of(p, render::kFitScript);
  EXPECT_EQ(near.find("set logscale y"), std::string::npos);
  EXPECT_NE(near.find("set yrange [0:*]"), std::string::npos);
  EXPECT_NE(near.find("sprintf('%.4g', $2)"), std::string::npos);
  p.cost = {1e6, 80.6};
  EXPECT_NE(text_of(p, render::kFitScript).find("set logscale y"), std::string::npos);
  p.cost.assign(30, 80.6);
  EXPECT_EQ(text_of(p, render::kFitScript).find("sprintf('%.4g', $2)"), std::string::npos) << "no room";
}

TEST(FitPlot, LeavesOutWhatIsNotKnown) {
  render::FitPictures p = pictures();
  for (auto& s : p.stations) {
    s.residual_mg0.clear();
    s.stands_out = false;
  }
  p.cost.clear();
  p.proposed_down.clear();
  EXPECT_EQ(render::fit_picture_names(p), std::vector<std::string>{"fit-attitudes.svg"});
  EXPECT_EQ(text_of(p, render::kFitScript).find("stands out"), std::string::npos);
  EXPECT_EQ(text_of(p, "fit-next.csv"), "");
  p.stations.clear();
  EXPECT_TRUE(render::fit_picture_names(p).empty());
}

}  // namespace
}  // namespace fit_plot_test
