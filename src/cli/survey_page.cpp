#include "survey_page.hpp"

#include <nlohmann/json.hpp>

#include "plot_files.hpp"
#include "plumb/io/output_file.hpp"
#include "plumb/render/identity.hpp"
#include "plumb/render/survey_page.hpp"
#include "tool.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace cli {

io::FileExpected<void> write_survey_page(const std::string& path, const render::SurveyReport& found,
                                         const std::vector<std::pair<const char*, std::string>>& inputs,
                                         const std::string& command) {
  render::SurveyIdentity identity;
  for (const auto& [role, file] : inputs) {
    if (file.empty()) continue;
    if (file == "-") {
      identity.inputs.push_back({{"role", role}, {"name", "standard input"}});
      continue;
    }
    const io::FileExpected<std::string> bytes = io::read_file(file);
    if (!bytes) return tl::unexpected<io::FileError>(bytes.error());
    identity.inputs.push_back(render::input_json(role, file, *bytes));
  }
  identity.command = command;
  identity.time = now_utc();
  identity.host = host_name();
  const render::PagePictures pictures =
      draw_for_page(render::survey_plot_files(found), render::kSurveyScript, render::survey_picture_names(found));
  return io::write_file(path, render::survey_html(found, identity, pictures));
}

}  // namespace cli
}  // namespace PLUMB_ABI
}  // namespace plumb
