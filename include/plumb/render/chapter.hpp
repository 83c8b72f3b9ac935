/// A chapter of a page: text, pictures, tables, files. Whoever measures fills it in; the page lays it out.
#pragma once

#include <string>
#include <vector>

#include "plumb/core/config.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace render {

struct Picture {
  std::string title;
  std::string svg;      ///< fit for inlining (`inline_svg`); empty: `missing` is shown
  std::string missing;  ///< why there is no picture
  std::string caption;  ///< what to see in it
  std::string narrow;   ///< the same drawn for a phone; empty: there is the one only
};

struct Table {
  std::string title;
  std::vector<std::string> head;
  std::vector<std::vector<std::string>> rows;
  std::string note;
  int state_column = -1;  ///< its cells are names of states, shown in their colours
};

struct FileLink {
  std::string name;  ///< relative to the page
  std::string what;
};

/// One of the few numbers that matter.
struct Figure {
  std::string value, label;
  std::string tone = "";  ///< "good", "bad" or "open": its colour
};

/// Shown in this order: text, figures, story, pictures, tables, commands, files.
struct Chapter {
  std::string id;     ///< anchor, of letters, digits, '-' and '_'
  std::string title;  ///< "4 Table 2 of the paper"
  std::vector<std::string> text;
  std::vector<Picture> pictures;
  std::vector<Table> tables;
  std::vector<FileLink> files;
  std::string gist;  ///< one line for the index
  std::vector<Figure> figures;
  std::vector<std::string> story;     ///< what happened, a sentence each
  std::vector<std::string> commands;  ///< that redo the chapter by hand
};

}  // namespace render
}  // namespace PLUMB_ABI
}  // namespace plumb
