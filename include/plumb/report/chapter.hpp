/// A chapter of a page: text, pictures, tables, files. Whoever measures fills it in; the page lays it out.
#pragma once

#include <string>
#include <vector>

#include "plumb/core/config.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace report {

struct Picture {
  std::string title;
  std::string svg;      ///< fit for inlining (`inline_svg`); empty: `missing` is shown
  std::string missing;  ///< why there is no picture
  std::string caption;  ///< what to see in it
};

struct Table {
  std::string title;
  std::vector<std::string> head;
  std::vector<std::vector<std::string>> rows;
  std::string note;
};

struct FileLink {
  std::string name;  ///< relative to the page
  std::string what;
};

struct Chapter {
  std::string id;     ///< anchor
  std::string title;  ///< "4 Table 2 of the paper"
  std::vector<std::string> text;
  std::vector<Picture> pictures;
  std::vector<Table> tables;
  std::vector<FileLink> files;
};

}  // namespace report
}  // namespace PLUMB_ABI
}  // namespace plumb
