/// The verification report of a magnetic group. It is made as that of accelerometers, with the field at the size of
/// gravity (plumb/io/field.hpp), and told in the units and the words of the field. Of accelerometers nothing changes.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "plumb/io/field.hpp"
#include "plumb/render/fit_plot.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace render {

using Json = nlohmann::ordered_json;

/// `in_field_words`, and what is an inclination or a tilt of gravity is an angle of the field in the tool: the
/// direction of the field, which tells no inclination by itself.
std::string in_direction_words(std::string text, io::FieldKind field);
/// The same beside the names of the tool and of the files that the report has, which stay as they are.
std::string in_direction_words(std::string text, const Json& report, io::FieldKind field);

/// The master report: keys and figures in the field's units, texts in its words. What tells of plumb and not of the
/// array (state machine, traceability, resources, identity) stays.
Json verification_in_field(const Json& report, io::FieldKind field);

/// What `verification_html` and `verification_plot_files` are given: the same keys, with such numbers that the page
/// shows the field's units; and what they made, in its words.
Json verification_shown(const Json& report, io::FieldKind field);
std::string verification_page_in_field(const std::string& html, const Json& report, io::FieldKind field);
std::vector<PlotFile> verification_plots_in_field(std::vector<PlotFile> files, io::FieldKind field);

}  // namespace render
}  // namespace PLUMB_ABI
}  // namespace plumb
