// plumb model: the state machine as it runs, printed from the one table in the code.
#include <map>
#include <memory>

#include "plumb/render/machine_tables.hpp"
#include "tool.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace cli {
namespace {

enum class Format { markdown, dot, json };

struct ModelOptions {
  Format format = Format::markdown;
};

constexpr const char* kModelAbout =
    "Print the state machine of the monitor: for every state and every event, the action and the next state.\n"
    "It is printed from the table that the monitor itself uses, so it is always up to date.";
constexpr const char* kModelNotes =
    "Examples:\n"
    "  plumb model                                  a Markdown table, events in rank order\n"
    "  plumb model --format dot | dot -Tsvg > m.svg a drawing (needs Graphviz)\n"
    "  plumb model --format json                    every cell, for machines\n\n"
    "Events are in rank order: where several apply at once, the first is taken. \"by size\" = failed, degraded,\n"
    "nominal or isolated, by what is left in service. PL = protection level, AL = alert limit.\n\n";

io::ExitCode run_model(const ModelOptions& options) {
  switch (options.format) {
    case Format::markdown: print(render::machine_markdown()); break;
    case Format::dot: print(render::machine_graph()); break;
    case Format::json: print(render::machine_json()); break;
  }
  return io::ExitCode::done;
}

}  // namespace

Command add_model(const Options& tool) {
  auto options = std::make_shared<ModelOptions>();
  const Options command = tool.add_command("model", "print the state machine of the monitor: table, drawing or JSON");
  const std::map<std::string, Format> names{
      {"markdown", Format::markdown}, {"dot", Format::dot}, {"json", Format::json}};
  command.add_option("--format", options->format, names, "`markdown` (default), `dot` (Graphviz) or `json`")
      .type_name("markdown|dot|json");
  command.footer(kModelNotes + exit_codes_help());
  return {command, kModelAbout, [options] { return run_model(*options); }};
}

}  // namespace cli
}  // namespace PLUMB_ABI
}  // namespace plumb
