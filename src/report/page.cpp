#include "plumb/report/page.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <kainjow/mustache.hpp>

#include "markup.hpp"
#include "page_template.hpp"
#include "plumb/report/plot.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace report {
namespace {

using kainjow::mustache::data;

constexpr std::array kStates = {HealthState::nominal,           HealthState::suspect,       HealthState::isolated,
                                HealthState::degraded_3_sensor, HealthState::recalibrating, HealthState::failed};

data texts(const std::vector<std::string>& lines) {
  data list{data::type::list};
  for (const std::string& line : lines) list << data{"text", line};
  return list;
}

/// A list and whether it has anything in it: mustache shows headings only where asked.
void set_list(data& out, const std::string& name, const std::vector<std::string>& lines) {
  out.set("has_" + name, !lines.empty());
  out.set(name, texts(lines));
}

/// Starts like a number, or stands for one that is not known.
bool is_figure(const std::string& cell) {
  if (cell.empty() || cell == "-" || cell == "–") return true;
  const std::size_t begin = cell.find_first_not_of("+-<≤≥± ");
  return begin != std::string::npos && std::isdigit(static_cast<unsigned char>(cell[begin])) != 0;
}

/// Columns of numbers are set flush right.
std::vector<bool> numeric_columns(const Table& table) {
  std::vector<bool> numeric(table.head.size(), true);
  for (const std::vector<std::string>& row : table.rows) {
    for (std::size_t k = 0; k < numeric.size() && k < row.size(); ++k) numeric[k] = numeric[k] && is_figure(row[k]);
  }
  return numeric;
}

std::string colour_of_name(const std::string& state) {
  const auto* const found =
      std::find_if(kStates.begin(), kStates.end(), [&state](HealthState s) { return state == to_string(s); });
  return found == kStates.end() ? "" : colour_of(*found);
}

data table_data(const Table& table) {
  const std::vector<bool> numeric = numeric_columns(table);
  const auto cell_data = [&numeric](const std::string& text, std::size_t column) {
    data cell;
    cell.set("text", text);
    cell.set("numeric", column < numeric.size() && numeric[column]);
    return cell;
  };
  data head{data::type::list};
  for (std::size_t k = 0; k < table.head.size(); ++k) head << cell_data(table.head[k], k);
  data rows{data::type::list};
  for (const std::vector<std::string>& row : table.rows) {
    data cells{data::type::list};
    for (std::size_t k = 0; k < row.size(); ++k) {
      data cell = cell_data(row[k], k);
      const std::string colour = table.state_column == static_cast<int>(k) ? colour_of_name(row[k]) : "";
      cell.set("is_state", !colour.empty());
      cell.set("colour", colour);
      cells << cell;
    }
    data one;
    one.set("cells", cells);
    rows << one;
  }
  data out;
  out.set("title", table.title);
  out.set("has_title", !table.title.empty());
  out.set("head", head);
  out.set("rows", rows);
  out.set("note", table.note);
  out.set("has_note", !table.note.empty());
  return out;
}

data picture_data(const Picture& picture, const std::string& prefix) {
  data out;
  out.set("title", picture.title);
  out.set("has_title", !picture.title.empty());
  out.set("svg", with_own_names(picture.svg, prefix));
  out.set("has_svg", !picture.svg.empty());
  out.set("missing", picture.missing);
  out.set("caption", picture.caption);
  out.set("has_caption", !picture.caption.empty());
  return out;
}

data chapter_data(const Chapter& chapter) {
  data out;
  out.set("id", chapter.id);
  out.set("title", chapter.title);
  out.set("gist", chapter.gist);
  set_list(out, "text", chapter.text);
  set_list(out, "story", chapter.story);
  set_list(out, "commands", chapter.commands);
  data figures{data::type::list};
  for (const Figure& figure : chapter.figures) {
    data one;
    one.set("value", figure.value);
    one.set("label", figure.label);
    figures << one;
  }
  out.set("figures", figures);
  out.set("has_figures", !chapter.figures.empty());
  data pictures{data::type::list};
  for (std::size_t k = 0; k < chapter.pictures.size(); ++k) {
    pictures << picture_data(chapter.pictures[k], chapter.id + "-" + std::to_string(k + 1) + "-");
  }
  out.set("pictures", pictures);
  data tables{data::type::list};
  for (const Table& table : chapter.tables) tables << table_data(table);
  out.set("tables", tables);
  data files{data::type::list};
  for (const FileLink& file : chapter.files) {
    data one;
    one.set("name", file.name);
    one.set("what", file.what);
    files << one;
  }
  out.set("files", files);
  out.set("has_files", !chapter.files.empty());
  return out;
}

}  // namespace

std::string page_html(const Page& page) {
  data root;
  root.set("title", page.title);
  root.set("lead", page.lead);
  root.set("footer", page.footer);
  data chapters{data::type::list};
  for (const Chapter& chapter : page.chapters) chapters << chapter_data(chapter);
  root.set("chapters", chapters);
  kainjow::mustache::mustache page_template{kPageTemplate};
  return page_template.render(root);
}

}  // namespace report
}  // namespace PLUMB_ABI
}  // namespace plumb
