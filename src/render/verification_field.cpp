#include "plumb/render/verification_field.hpp"

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

#include "markup.hpp"
#include "plumb/io/field_json.hpp"
#include "plumb/io/json_fields.hpp"
#include "plumb/render/field_words.hpp"
#include "plumb/render/verification_page.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace render {
namespace {

/// The sections that tell of the array.
constexpr std::array<const char*, 4> kOfTheArray = {"verdict", "array", "calibration", "campaign"};
/// Names that somebody gave, and what a machine looks up: no words of a text.
constexpr std::array<std::string_view, 14> kNames = {"id",      "name",         "key",    "file",   "log",
                                                     "serial",  "made_by",      "date",   "replay", "limits_file",
                                                     "columns", "coefficients", "source", "status"};

/// Names of the tool and of its files that hold a word which would be exchanged.
std::vector<std::string> given_names(const Json& report, io::FieldKind field) {
  std::vector<std::string> out;
  const auto add = [&out, field](const Json& name) {
    if (name.is_string() && in_direction_words(name.get<std::string>(), field) != name.get<std::string>())
      out.push_back(name.get<std::string>());
  };
  if (report.contains("subject")) add(report["subject"].value("name", Json()));
  if (report.contains("identity")) {
    for (const Json& input : report["identity"].value("inputs", Json::array())) add(input.value("name", Json()));
  }
  return out;
}

Json with_words(const Json& value, const Json& report,  // NOLINT(misc-no-recursion) as deep as the report
                io::FieldKind field) {
  if (value.is_string()) return in_direction_words(value.get<std::string>(), report, field);
  if (!value.is_structured()) return value;
  Json out = value;
  for (auto item = out.begin(); item != out.end(); ++item) {
    const bool kept =
        value.is_object() && std::find(kNames.begin(), kNames.end(), std::string_view(item.key())) != kNames.end();
    if (!kept) *item = with_words(*item, report, field);
  }
  return out;
}

/// The title of a criterion is no name, though its key is.
void put_titles(Json& verdict, const Json& report, io::FieldKind field) {
  for (Json& criterion : verdict["criteria"]) criterion["name"] = with_words(criterion["name"], report, field);
}

Json told(const Json& report, io::FieldKind field, Json (*in_units)(const Json&, io::FieldKind)) {
  Json out = report;
  for (const char* const section : kOfTheArray) {
    if (!out.contains(section)) continue;
    out[section] = with_words(in_units(report[section], field), report, field);
  }
  if (out.contains("verdict") && out["verdict"].is_object()) put_titles(out["verdict"], report, field);
  out["subject"]["field"] = to_string(field);
  return out;
}

}  // namespace

std::string in_direction_words(std::string text, io::FieldKind field) {
  if (field == io::FieldKind::gravity) return text;
  for (const auto& [phrase, by] :
       {std::pair<std::string_view, std::string_view>{"Wiring confirmed by a known attitude",
                                                      "Wiring confirmed by the accelerometers"},
        {"One station of known attitude excludes them: --known-attitude.",
         "Axes aligned to the accelerometers exclude them: plumb calibrate --align-by."},
        {"no known attitude confirms the wiring", "nothing ties the wiring to that of the accelerometers"},
        {">Gravity<", ">Field<"},
        {"a gravity that is turned", "a field that is turned"},
        {"the same wrong gravity", "the same wrong field"},
        {"the same rotated gravity", "the same rotated field"},
        {"with the right gravity value", "with the right length of the field"},
        {"Accelerations in", "Errors of readings in"},
        {"tilt errors", "errors of the direction"},
        {"tilt error", "error of the direction"},
        {"Tilt error", "Error of the direction"},
        {"largest tilt", "largest error of the direction"},
        {"tilt before alarm", "error of the direction before alarm"},
        {"tilt while usable", "error of the direction while usable"},
        {"inclination and toolface", "angles from and about z"},
        {"inclination", "angle from z"},
        {"toolface", "angle about z"},
        {"roll test", "roll about z"}}) {
    // Keys of files, in which such a word is a part, are no words.
    for (std::size_t at = text.find(phrase); at != std::string::npos; at = text.find(phrase, at)) {
      const std::size_t end = at + phrase.size();
      const bool part = (at > 0 && text[at - 1] == '_') || (end < text.size() && text[end] == '_');
      if (!part) text.replace(at, phrase.size(), by);
      at += part ? phrase.size() : by.size();
    }
  }
  return in_field_words(std::move(text), field);
}

std::string in_direction_words(std::string text, const Json& report, io::FieldKind field) {
  if (field == io::FieldKind::gravity) return text;
  const std::vector<std::string> names = given_names(report, field);
  const auto mark = [](std::size_t k) { return "\x02" + std::to_string(k) + "\x03"; };
  for (std::size_t k = 0; k < names.size(); ++k) {
    replace_all(text, in_markup(names[k]), mark(2 * k));
    replace_all(text, names[k], mark(2 * k + 1));
  }
  text = in_direction_words(std::move(text), field);
  for (std::size_t k = 0; k < names.size(); ++k) {
    replace_all(text, mark(2 * k), in_markup(names[k]));
    replace_all(text, mark(2 * k + 1), names[k]);
  }
  return text;
}

Json verification_in_field(const Json& report, io::FieldKind field) {
  if (field == io::FieldKind::gravity) return report;
  return told(report, field, [](const Json& value, io::FieldKind of) { return io::in_field_units(value, of); });
}

Json verification_shown(const Json& report, io::FieldKind field) {
  if (field == io::FieldKind::gravity) return report;
  return told(report, field, io::with_fine_as_mg0);
}

std::string verification_page_in_field(const std::string& html, const Json& report, io::FieldKind field) {
  if (field == io::FieldKind::gravity) return html;
  // Sections 5 to 7 tell of plumb: its requirements are of gravity, and its inputs have names.
  const std::size_t first = std::min(html.find("<section id=\"machine\""), html.size());
  const std::size_t last = std::max(first, std::min(html.find("<section id=\"change\""), html.size()));
  return in_direction_words(html.substr(0, first), report, field) + html.substr(first, last - first) +
         in_direction_words(html.substr(last), report, field);
}

std::vector<PlotFile> verification_plots_in_field(std::vector<PlotFile> files, io::FieldKind field) {
  if (field == io::FieldKind::gravity) return files;
  for (PlotFile& file : files) {
    const std::size_t line = std::min(file.text.find('\n'), file.text.size());
    std::string head = file.text.substr(0, line);
    if (file.name != kVerificationScript) replace_all(head, "_mg0", "_nt");
    file.text = head + file.text.substr(line);
    if (file.name == kVerificationScript) file.text = in_direction_words(std::move(file.text), field);
  }
  return files;
}

}  // namespace render
}  // namespace PLUMB_ABI
}  // namespace plumb
