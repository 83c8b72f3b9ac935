#include "fault_options.hpp"

#include <utility>

#include "plumb/io/scenario_file.hpp"
#include "plumb/scenario/fault_text.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace cli {
namespace {

/// One text for each sensor of the chip that it begins with; else the text itself.
std::vector<std::string> by_sensor(const std::string& text, const io::ArrayFile& array) {
  const std::size_t colon = text.find(':');
  if (colon == std::string::npos) return {text};
  const std::string name = text.substr(0, colon), rest = text.substr(colon);
  std::vector<std::string> out;
  for (int i = 0; i < array.array.size(); ++i) {
    const std::string id = array.array.row(i).id.data();
    if (id == name) return {text};
    if (io::package_of(array, i) == name) out.push_back(id + rest);
  }
  return out.empty() ? std::vector<std::string>{text} : out;
}

bool has_sensor(const io::ArrayFile& array, const std::string& name) {
  for (int i = 0; i < array.array.size(); ++i) {
    if (array.array.row(i).id.data() == name || io::package_of(array, i) == name) return true;
  }
  return false;
}

}  // namespace

io::FileError fault_error(std::string what) {
  return io::FileError{"--fault", 0, "", std::move(what), "", io::ExitCode::usage};
}

io::FileExpected<std::vector<scenario::Fault>> faults_of(const std::vector<std::string>& texts,
                                                         const io::ArrayFile& array) {
  const scenario::FaultContext context = io::fault_context(array);
  std::vector<scenario::Fault> out;
  for (const std::string& given : texts) {
    for (const std::string& text : by_sensor(given, array)) {
      const tl::expected<std::vector<scenario::Fault>, std::string> named = scenario::parse_faults(text, context);
      if (!named) return tl::unexpected<io::FileError>(fault_error(named.error()));
      out.insert(out.end(), named->begin(), named->end());
    }
  }
  return out;
}

io::FileExpected<ToolFaults> tool_faults_of(const std::vector<std::string>& texts, const io::ArrayFile& tool) {
  std::vector<std::string> own;
  std::vector<std::vector<std::string>> of_group(tool.groups.size());
  for (const std::string& text : texts) {
    const std::string name = text.substr(0, text.find(':'));
    std::vector<std::string>* to = &own;
    for (std::size_t k = 0; k < tool.groups.size() && !has_sensor(tool, name); ++k) {
      if (has_sensor(tool.groups[k], name)) to = &of_group[k];
    }
    to->push_back(text);
  }
  ToolFaults out;
  io::FileExpected<std::vector<scenario::Fault>> found = faults_of(own, tool);
  if (!found) return tl::unexpected<io::FileError>(found.error());
  out.own = *std::move(found);
  for (std::size_t k = 0; k < of_group.size(); ++k) {
    found = faults_of(of_group[k], tool.groups[k]);
    if (!found) return tl::unexpected<io::FileError>(found.error());
    out.group.push_back(*std::move(found));
  }
  return out;
}

}  // namespace cli
}  // namespace PLUMB_ABI
}  // namespace plumb
