/// Text inside XML, SVG and HTML that is not made by a template (private to src/render).
#pragma once

#include <string>

#include "plumb/core/config.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace render {

/// Text between tags and inside attributes; what XML cannot hold becomes a blank.
inline std::string in_markup(const std::string& text) {
  std::string out;
  for (const char c : text) {
    switch (c) {
      case '<': out += "&lt;"; break;
      case '>': out += "&gt;"; break;
      case '&': out += "&amp;"; break;
      case '"': out += "&quot;"; break;
      default: out += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
    }
  }
  return out;
}

inline void replace_all(std::string& text, const std::string& from, const std::string& to) {
  for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size()))
    text.replace(at, from.size(), to);
}

/// Gives every name inside the picture a prefix, where it is defined and where it is used.
inline std::string with_own_names(std::string svg, const std::string& prefix) {
  for (const char* mark : {" id=\"", " id='", "url(#", "href=\"#", "href='#"}) {
    const std::string text = mark;
    for (std::size_t at = svg.find(text); at != std::string::npos; at = svg.find(text, at + text.size()))
      svg.insert(at + text.size(), prefix);
  }
  return svg;
}

}  // namespace render
}  // namespace PLUMB_ABI
}  // namespace plumb
