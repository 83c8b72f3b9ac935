// A chart inside a page: what a printer draws is what a screen shows, and what the page says of its axes.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "plumb/render/plot.hpp"

namespace inline_svg_test {
namespace {

using namespace plumb;

/// As gnuplot writes it.
const std::string kChart = R"(<?xml version="1.0"?>
<svg
 viewBox="0 0 400 300"
 xmlns="http://www.w3.org/2000/svg"
 xmlns:xlink="http://www.w3.org/1999/xlink"
>
<title>Gnuplot</title>
<defs>
	<circle id='gpPt5' stroke-width='0.178' stroke='currentColor' cx='0' cy='0' r='1'/>
	<use xlink:href='#gpPt5' id='gpPt6' fill='currentColor' stroke='none'/>
</defs>
<g fill="none" color="black" stroke="currentColor">
	<path stroke='black' d='M1,1 L2,2'/>
	<use xlink:href='#gpPt6' transform='translate(78.75,105.00) scale(5.62)' color='rgb( 44, 143,  87)'/>
	<use xlink:href='#gpPt12' transform='translate(1.00,2.00) scale(4.50)' color='rgb(208,  85,  60)'/>
	<use xlink:href='#gpPt3' transform='translate(9.00,2.00) scale(4.50)' color='rgb(  0,   0,   0)'/>
</g>
</svg>)";

TEST(InlineSvg, EveryMarkHasAShapeAndAColourOfItsOwn) {
  const std::string svg = render::inline_svg(kChart);
  EXPECT_EQ(svg.find("<use"), std::string::npos) << "a reference is black where the page is printed";
  EXPECT_EQ(svg.find("<defs>"), std::string::npos);
  EXPECT_NE(svg.find("fill='rgb( 44, 143,  87)' stroke='none'"), std::string::npos) << svg;
  EXPECT_NE(svg.find("translate(1.00,2.00) scale(4.50) rotate(45)"), std::string::npos) << "a diamond";
  EXPECT_NE(svg.find("fill='none' stroke='currentColor' stroke-width='0.178'"), std::string::npos) << "a ring";
}

TEST(InlineSvg, WhatElseIsReferredToStays) {
  std::string chart = kChart;
  chart.replace(chart.find("#gpPt12"), 7, "#symbol");
  const std::string svg = render::inline_svg(chart);
  EXPECT_NE(svg.find("<use xlink:href='#symbol'"), std::string::npos);
  const std::string label = "<g style=\"filter:url(#textbox)\"></g></svg>";
  chart.replace(chart.rfind("</svg>"), 6, label);
  EXPECT_NE(render::inline_svg(chart).find("<defs>"), std::string::npos) << "a boxed label needs what is defined";
}

TEST(InlineSvg, SaysWhereTheAxesLie) {
  const std::string told =
      "78.75 368.49 0 10 0 105.00 22.51 1 1000 1|station|off, \"mg0\"\n"
      "not a panel\n"
      "78.75 368.49 0 10 0 205.00 122.51 -1 1 0|t, s|inclination, deg\n";
  const std::string svg = render::inline_svg(kChart, told);
  const std::string begins = "<svg data-axes=\"";
  ASSERT_EQ(svg.rfind(begins, 0), 0U) << svg.substr(0, 80);
  std::string json = svg.substr(begins.size(), svg.find('"', begins.size()) - begins.size());
  for (std::size_t at = json.find("&quot;"); at != std::string::npos; at = json.find("&quot;", at))
    json.replace(at, 6, "\"");
  const nlohmann::json axes = nlohmann::json::parse(json);
  ASSERT_EQ(axes.size(), 2U);
  EXPECT_EQ(axes[0]["x"], nlohmann::json({78.75, 368.49, 0.0, 10.0, 0, "station"}));
  EXPECT_EQ(axes[0]["y"], nlohmann::json({105.0, 22.51, 1.0, 1000.0, 1, "off, \"mg0\""}));
  EXPECT_EQ(axes[1]["y"][5], "inclination, deg");
  EXPECT_EQ(render::inline_svg(kChart).find("data-axes"), std::string::npos);
}

}  // namespace
}  // namespace inline_svg_test
