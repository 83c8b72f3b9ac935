#include "html_view.hpp"

#include "plumb/render/figures.hpp"

#include <fmt/format.h>

#include <cctype>
#include <cmath>

#include "markup.hpp"
#include "page_script.hpp"
#include "page_template.hpp"
#include "plumb/io/json_fields.hpp"
#include "plumb/study/proportion.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace render {
namespace {

using kainjow::mustache::data;

/// A cell of more than this is a sentence or a path: it may be broken anywhere.
constexpr std::size_t kLongCell = 34;

/// Starts like a number, or stands for one that is not known.
bool is_numeric(const std::string& cell) {
  if (cell.size() > kLongCell) return false;
  if (cell.empty() || cell == "-" || cell == "–") return true;
  const std::size_t begin = cell.find_first_not_of("+-<≤≥± ");
  return begin != std::string::npos && std::isdigit(static_cast<unsigned char>(cell[begin])) != 0;
}

/// A text, and whether there is one: mustache shows its surroundings only where asked.
void set_text(data& out, const std::string& name, const std::string& text) {
  out.set("has_" + name, !text.empty());
  out.set(name, text);
}

data texts(const std::vector<std::string>& lines) {
  data list{data::type::list};
  for (const std::string& line : lines) list << data{"text", line};
  return list;
}

}  // namespace

std::string shown(double value) { return std::isfinite(value) ? unsigned_zero(fmt::format("{:.4g}", value)) : "-"; }

std::string shown(const Json& value, double factor) {
  if (value.is_number_integer() && factor == 1.0) return value.dump();
  if (value.is_number()) return shown(factor * value.get<double>());
  return value.is_string() ? value.get<std::string>() : "-";
}

std::string lower_end(const Json& rate) { return study::rounded_down(100.0 * rate["low"].get<double>(), 3, 100.0); }

std::string upper_end(const Json& rate) { return study::rounded_up(100.0 * rate["high"].get<double>(), 3, 100.0); }

std::string shown_rate(const Json& rate) {
  return fmt::format("{}/{} ({} to {} %)", rate["count"].dump(), rate["of"].dump(), lower_end(rate), upper_end(rate));
}

const char* tone_of(const std::string& result) {
  for (const char* good : {"met", "fit", "verified", "passed", "holds"}) {
    if (result == good) return "good";
  }
  for (const char* bad : {"not met", "not fit", "failed", "fails"}) {
    if (result == bad) return "bad";
  }
  return "open";
}

std::string joined_list(const Json& list, const char* key) {
  std::string out;
  for (const Json& item : list) {
    const Json& value = key == nullptr ? item : item[key];
    out += (out.empty() ? "" : ", ") + (value.is_string() ? value.get<std::string>() : value.dump());
  }
  return out.empty() ? "-" : out;
}

ViewCell sensors_cell(const Json& ids, const char* key) {
  const std::string all = joined_list(ids, key);
  if (ids.size() <= kShortList) return all;
  ViewCell out(std::to_string(ids.size()) + " sensors");
  out.rest = all;
  return out;
}

Section::Section(std::string id, std::string title, std::string gist)
    : id_(std::move(id)), title_(std::move(title)), gist_(std::move(gist)) {}

data& Section::block(const char* kind, const std::string& title) {
  data one;
  one.set(std::string("is_") + kind, true);
  set_text(one, "title", title);
  one.set("label", title.empty() ? title_ : title);
  blocks_.push_back(one);
  return blocks_.back();
}

void Section::signature(const std::vector<std::string>& fields) { block("signature").set("fields", texts(fields)); }

void Section::heading(const std::string& text) { block("heading").set("text", text); }
void Section::stamp(const std::string& text) { block("stamp").set("text", text); }
void Section::text(const std::string& text) { block("text").set("text", text); }

void Section::notice(const std::string& text, const std::string& tone) {
  data& one = block("notice");
  one.set("text", text);
  one.set("tone", tone);
}

void Section::figures(const std::vector<ViewFigure>& answers) {
  data list{data::type::list};
  for (const ViewFigure& answer : answers) {
    data figure;
    set_text(figure, "question", answer.question);
    set_text(figure, "tone", answer.tone);
    figure.set("value", answer.value);
    figure.set("label", answer.label);
    list << figure;
  }
  block("figures").set("figures", list);
}

void Section::table(const std::string& title, const std::vector<std::string>& head, const ViewRows& rows,
                    const std::string& note, Fold fold) {
  std::vector<bool> numeric(head.size(), true);
  for (const std::vector<ViewCell>& row : rows) {
    for (std::size_t k = 0; k < numeric.size() && k < row.size(); ++k)
      numeric[k] = numeric[k] && is_numeric(row[k].text);
  }
  const auto cell_data = [&numeric](const ViewCell& from, std::size_t column) {
    data cell;
    cell.set("text", from.text);
    set_text(cell, "rest", from.rest);
    cell.set("n", column < numeric.size() && numeric[column]);
    const bool right = column < numeric.size() && numeric[column];
    const char* const width = from.text.size() > kLongCell ? "long " : "";
    set_text(cell, "colour", from.colour);
    cell.set("classes", std::string(right ? "n " : "") + width + from.tone);
    cell.set("has_classes", right || *width != '\0' || !from.tone.empty());
    return cell;
  };
  data heads{data::type::list}, lines{data::type::list};
  for (std::size_t k = 0; k < head.size(); ++k) heads << cell_data(head[k], k);
  for (const std::vector<ViewCell>& row : rows) {
    data cells{data::type::list}, line;
    for (std::size_t k = 0; k < row.size(); ++k) cells << cell_data(row[k], k);
    line.set("cells", cells);
    lines << line;
  }
  data& one = block("table", title);
  const bool behind = fold == Fold::omitted || (fold == Fold::when_long && rows.size() > kShortTable);
  one.set("folded", behind);
  one.set("fold", fold == Fold::omitted ? "folded" : "long");
  if (behind && fold == Fold::when_long)
    one.set("title", fmt::format("{} ({} rows)", title.empty() ? title_ : title, rows.size()));
  one.set("head", heads);
  one.set("rows", lines);
  set_text(one, "note", note);
}

void Section::list(const std::string& title, const std::vector<std::string>& items, bool ordered) {
  data& one = block("list", title);
  one.set("kind", ordered ? "ol" : "ul");
  one.set("items", texts(items));
}

void Section::files(const std::string& title, const std::vector<FileLink>& files) {
  data list{data::type::list};
  for (const FileLink& file : files) {
    data item{"text", file.what};
    set_text(item, "link", file.name);
    list << item;
  }
  data& one = block("list", title);
  one.set("kind", "ul");
  one.set("items", list);
}

void Section::commands(const std::vector<std::string>& lines) { block("commands").set("lines", texts(lines)); }

void Section::picture(const std::string& title, const PagePicture& picture, const std::string& alt,
                      const std::string& caption, const std::string& csv) {
  data& one = block("picture", title);
  const std::string own = id_ + "-" + std::to_string(++pictures_) + "-";
  one.set("has_svg", !picture.svg.empty());
  one.set("svg", with_own_names(picture.svg, own));
  one.set("has_narrow", !picture.narrow.empty());
  one.set("narrow", with_own_names(picture.narrow, own + "narrow-"));
  if (!picture.svg.empty()) ++plots_;
  one.set("missing", picture.missing);
  if (!alt.empty()) one.set("label", alt);
  one.set("caption", caption);
  set_text(one, "csv", csv.empty() ? "" : std::string(kChartFolder) + "/" + csv);
}

data Section::take() {
  data out, list{data::type::list};
  for (const data& one : blocks_) list << one;
  out.set("id", id_);
  out.set("title", title_);
  out.set("gist", gist_);
  out.set("blocks", list);
  return out;
}

PagePicture picture_of(const PagePictures& pictures, const std::string& name) {
  const auto found = pictures.find(name);
  return found == pictures.end() ? PagePicture{"", "it was not drawn", ""} : found->second;
}

std::string sections_html(const PageFrame& frame, std::vector<Section> sections) {
  data root, list{data::type::list};
  bool plots = false;
  for (Section& section : sections) {
    plots = plots || section.has_plots();
    list << section.take();
  }
  root.set("script", kPageScript);
  root.set("has_plots", plots);
  root.set("title", frame.title);
  root.set("lead", frame.lead);
  root.set("sections", list);
  root.set("footer", frame.footer);
  set_text(root, "run", frame.run);
  root.set("has_index", frame.index);
  kainjow::mustache::mustache page{kPageTemplate};
  return page.render(root);
}

}  // namespace render
}  // namespace PLUMB_ABI
}  // namespace plumb
