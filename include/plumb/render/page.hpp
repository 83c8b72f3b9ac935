/// An index page: one self-contained HTML file of chapters, no network, light and dark, phone and desk. All figures
/// come in as text, so that page and terminal say the same.
#pragma once

#include <string>
#include <vector>

#include "plumb/render/chapter.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace render {

struct Page {
  std::string title;
  std::string lead;  ///< a sentence or two below the title
  std::vector<Chapter> chapters;
  std::string footer;
};

/// Names inside a chapter's pictures are made its own, so that pictures from the same program do not mix.
std::string page_html(const Page& page);

}  // namespace render
}  // namespace PLUMB_ABI
}  // namespace plumb
