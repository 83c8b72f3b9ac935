/// What a section of the verification page is made of, in the order in which it was added (private to src/render).
#pragma once

#include <array>
#include <kainjow/mustache.hpp>
#include <nlohmann/json.hpp>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "field_table.hpp"
#include "plumb/render/chapter.hpp"
#include "plumb/render/verification_page.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace render {

/// Four significant digits; "-" for null. All numbers of the page go through here.
std::string shown(double value);
std::string shown(const Json& value, double factor = 1.0);
/// The ends of its interval in percent, rounded outwards.
std::string lower_end(const Json& rate);
std::string upper_end(const Json& rate);
/// "3/714 (0.0866 to 1.23 %)": k of n and the interval.
std::string shown_rate(const Json& rate);
/// A cell of a table; `tone` is "good", "bad", "open" or nothing; `colour` that of the state which it names. What
/// stands in a Json is shown as above.
struct ViewCell {
  std::string text, tone, colour = "";
  std::string rest = "";  ///< behind a click on the text
  ViewCell(std::string t, std::string how = "")
      : text(std::move(t)), tone(std::move(how)) {}  // NOLINT: a text is a cell
  ViewCell(const char* t) : text(t) {}               // NOLINT
  template <class Value, class = std::enable_if_t<std::is_same_v<Value, Json>>>
  ViewCell(const Value& value, std::string how = "") : text(shown(value)), tone(std::move(how)) {}  // NOLINT
};
using ViewRows = std::vector<std::vector<ViewCell>>;
/// One of the few numbers that matter; `tone` as of a cell.
struct ViewFigure {
  std::string question, value, label, tone = "";
};
/// A table behind a click. `omitted`: always, and left out on paper; `when_long`: where it has more than kShortTable
/// rows, and in full on paper.
enum class Fold { no, omitted, when_long };
inline constexpr std::size_t kShortTable = 12;
/// Names of sensors as one cell; more than kShortList of them are counted, and stand behind a click.
inline constexpr std::size_t kShortList = 8;
ViewCell sensors_cell(const Json& ids, const char* key = nullptr);

const char* tone_of(const std::string& result);
std::string joined_list(const Json& list, const char* key = nullptr);

class Section {
 public:
  Section(std::string id, std::string title, std::string gist);
  void heading(const std::string& text);
  /// Lines to be filled in by hand.
  void signature(const std::vector<std::string>& fields);
  void text(const std::string& text);
  /// What differs from run to run: the rest of a page is the same for the same inputs.
  void stamp(const std::string& text);
  void notice(const std::string& text, const std::string& tone);
  /// The few numbers that matter: question, value, what it means.
  void figures(const std::vector<ViewFigure>& answers);
  void table(const std::string& title, const std::vector<std::string>& head, const ViewRows& rows,
             const std::string& note = "", Fold fold = Fold::no);
  void list(const std::string& title, const std::vector<std::string>& items, bool ordered = false);
  /// Files beside the page, each with what it holds.
  void files(const std::string& title, const std::vector<FileLink>& files);
  void commands(const std::vector<std::string>& lines);
  /// `csv` is the file beside the page that holds what is drawn; nothing where a table follows.
  void picture(const std::string& title, const PagePicture& picture, const std::string& alt, const std::string& caption,
               const std::string& csv = "");
  kainjow::mustache::data take();
  bool has_plots() const noexcept { return plots_ > 0; }
  const std::string& id() const noexcept { return id_; }

 private:
  kainjow::mustache::data& block(const char* kind, const std::string& title = "");

  std::string id_, title_, gist_;
  int pictures_ = 0, plots_ = 0;
  std::vector<kainjow::mustache::data> blocks_;
};

/// A page of these sections, in the one style of plumb's reports. `run` is what tells of the run rather than of the
/// result; `index`: cards of all sections with their gist come first.
struct PageFrame {
  std::string title, lead, footer, run;
  bool index = false;
};
std::string sections_html(const PageFrame& frame, std::vector<Section> sections);

/// The titles and the figures of a table of fields (field_table.hpp), behind a column of names.
template <class Table>
std::vector<std::string> page_head(const char* names, const Table& table) {
  std::vector<std::string> out = {names};
  for (const auto& field : table) {
    if (field.page != nullptr) out.emplace_back(field.page);
  }
  return out;
}
template <class Table>
std::vector<ViewCell> page_row(const std::string& name, const Table& table, const Json& json,
                               const Json& beyond = Json::array()) {
  std::vector<ViewCell> out = {name};
  for (const auto& field : table) {
    if (field.page == nullptr) continue;
    const bool none = std::find(beyond.begin(), beyond.end(), Json(field.key)) != beyond.end();
    out.emplace_back(none ? std::string(kBeyondFullScale) : shown(json.at(field.key), field.of_page));
  }
  return out;
}

/// The one with this name, or what says that there is none.
PagePicture picture_of(const PagePictures& pictures, const std::string& name);

/// The sections, from the master JSON and nothing else but its pictures.
Section verdict_view(const Json& report);
Section array_view(const Json& report, const PagePictures& pictures);
Section calibration_view(const Json& report, const PagePictures& pictures);
/// Whether the array of a report states chips, so that grades and faults count units.
inline bool has_chips(const Json& array) {
  return array["figures_of_merit"]["units"].get<std::size_t>() < array["sensors"].size();
}
Section campaign_view(const Json& report, const PagePictures& pictures);
Section machine_view(const Json& report);
Section trace_view(const Json& report);
Section identity_view(const Json& report);
Section change_view(const Json& report);

/// Drawn here, without any other program: the axes, and the states with their transitions.
std::string axes_svg(const Json& array);
std::string machine_svg(const Json& machine, bool narrow);

}  // namespace render
}  // namespace PLUMB_ABI
}  // namespace plumb
