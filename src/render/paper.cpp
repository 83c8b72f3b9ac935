#include "plumb/render/paper.hpp"

#include <regex>

#include "markup.hpp"
#include "page_template.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace render {
namespace {

/// `from` up to the end of `to`; nothing where one of them is not there.
std::string part_of_page(const std::string& text, const std::string& from, const std::string& to) {
  const std::size_t begin = text.find(from), end = text.find(to, begin == std::string::npos ? 0 : begin);
  if (begin == std::string::npos || end == std::string::npos) return "";
  return text.substr(begin, end + to.size() - begin);
}

}  // namespace

std::string for_paper(std::string html) {
  // A variable that paper does not set keeps the value of the light page: the last one counts.
  const std::string style = part_of_page(kPageTemplate, "<style>", "</style>"),
                    light = part_of_page(style, ":root {", "}"),
                    paper = part_of_page(part_of_page(style, "@media print {\n  :root {", "}"), ":root {", "}");
  static const std::regex variable("(--[a-z-]+): ([^;]+);");
  for (const std::string& block : {paper, light}) {
    for (std::sregex_iterator it(block.begin(), block.end(), variable), end; it != end; ++it)
      replace_all(html, "var(" + (*it)[1].str() + ")", (*it)[2].str());
  }
  replace_all(html, "currentColor", "#000000");
  const std::string contents = part_of_page(html, "<nav ", "</nav>"),
                    first = part_of_page(html, "<section id=\"signoff\"", "</section>");
  if (contents.empty() || first.empty()) return html;
  html.erase(html.find(contents), contents.size());
  html.insert(html.find(first) + first.size(), "\n" + contents);
  return html;
}

}  // namespace render
}  // namespace PLUMB_ABI
}  // namespace plumb
