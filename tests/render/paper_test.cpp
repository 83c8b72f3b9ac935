// What is printed is what was on the screen: colours are spelled out for the program that prints.
#include "plumb/render/paper.hpp"

#include <gtest/gtest.h>

#include "verify_support.hpp"

#include "plumb/render/verification_page.hpp"

namespace paper_test {
namespace {

using namespace plumb;

TEST(Paper, NoColourIsLeftToAVariableOrToTheText) {
  const std::string page = render::for_paper(render::verification_html(plumb_test::paper_report(), {}));
  EXPECT_EQ(page.find("var(--"), std::string::npos) << page.substr(page.find("var(--"), 40);
  EXPECT_EQ(page.find("currentColor"), std::string::npos);
  EXPECT_NE(page.find(".sign p { flex: 1 1 12rem; margin: 0; border-bottom: 1px solid #000;"), std::string::npos)
      << "a line to sign on is a line";
}

TEST(Paper, TheSignOffComesFirstAndTheContentsBehindIt) {
  const std::string page = render::verification_html(plumb_test::paper_report(), {});
  const std::string paper = render::for_paper(page);
  EXPECT_LT(page.find("<nav "), page.find("<section id=\"signoff\""));
  EXPECT_LT(paper.find("<section id=\"signoff\""), paper.find("<nav "));
  EXPECT_LT(paper.find("<nav "), paper.find("<section id=\"verdict\""));
  EXPECT_EQ(paper.find("<nav "), paper.rfind("<nav "));
  EXPECT_EQ(render::for_paper("<nav a>x</nav> no sign-off"), "<nav a>x</nav> no sign-off");
}

}  // namespace
}  // namespace paper_test
