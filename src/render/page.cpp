#include "plumb/render/page.hpp"

#include <algorithm>
#include <array>

#include "html_view.hpp"
#include "plumb/render/plot.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace render {
namespace {

constexpr std::array kStates = {HealthState::nominal,           HealthState::suspect,       HealthState::isolated,
                                HealthState::degraded_3_sensor, HealthState::recalibrating, HealthState::failed};

std::string colour_of_name(const std::string& state) {
  const auto* const found =
      std::find_if(kStates.begin(), kStates.end(), [&state](HealthState s) { return state == to_string(s); });
  return found == kStates.end() ? "" : colour_of(*found);
}

void add_table(const Table& table, Section& out) {
  ViewRows rows;
  for (const std::vector<std::string>& row : table.rows) {
    std::vector<ViewCell>& cells = rows.emplace_back(row.begin(), row.end());
    if (table.state_column < 0) continue;
    ViewCell& state = cells[static_cast<std::size_t>(table.state_column)];
    state.colour = colour_of_name(state.text);
  }
  out.table(table.title, table.head, rows, table.note);
}

Section section_of(const Chapter& chapter) {
  Section out(chapter.id, chapter.title, chapter.gist);
  for (const std::string& text : chapter.text) out.text(text);
  std::vector<ViewFigure> figures;
  for (const Figure& figure : chapter.figures) figures.push_back({"", figure.value, figure.label, figure.tone});
  if (!figures.empty()) out.figures(figures);
  if (!chapter.story.empty()) out.list("What happened", chapter.story, true);
  for (const Picture& picture : chapter.pictures)
    out.picture(picture.title, {picture.svg, picture.missing, picture.narrow}, "", picture.caption);
  for (const Table& table : chapter.tables) add_table(table, out);
  if (!chapter.commands.empty()) {
    out.heading("Do it by hand");
    out.text("The demo used no private path: these commands give the same bytes.");
    out.commands(chapter.commands);
  }
  if (!chapter.files.empty()) out.files("Files", chapter.files);
  return out;
}

}  // namespace

std::string page_html(const Page& page) {
  std::vector<Section> sections;
  for (const Chapter& chapter : page.chapters) sections.push_back(section_of(chapter));
  return sections_html({page.title, page.lead, page.footer, "", true}, std::move(sections));
}

}  // namespace render
}  // namespace PLUMB_ABI
}  // namespace plumb
