/// The parts of a campaign file, one function per section (private to src/campaign). They throw io::Refusal.
#pragma once

#include <string>
#include <vector>

#include "../io/toml_table.hpp"
#include "plumb/campaign/campaign_file.hpp"
#include "plumb/health/monitor_config.hpp"
#include "plumb/health/stability.hpp"

namespace plumb {
namespace campaign {

/// A key that holds one table or several, `[[key]]`; none where it is missing.
std::vector<io::TomlTable> tables_of(const io::TomlTable& top, const char* key, const std::vector<std::string>& known);
/// A section, empty where it is missing.
io::TomlTable section_of(const io::TomlTable& top, const char* key, const std::vector<std::string>& known);
/// A whole number between the two.
int whole(const io::TomlTable& table, const char* key, int fallback, int least, int most);
/// Numbers without a unit, one or a list of them.
std::vector<double> numbers(const io::TomlTable& table, const char* key, const std::vector<double>& fallback,
                            double least, double most, const std::string& remedy);

/// `usual`: the stability of every sensor that neither its [[tool]] nor its array file states one of. `lookup` answers
/// where a group of an array file states a place and a date.
std::vector<ToolPlan> read_tools(const io::TomlTable& top, const MonitorConfig& monitor, const Stability& usual,
                                 const io::FieldLookup& lookup);
std::vector<AttitudePlan> read_attitudes(const io::TomlTable& top);

/// What one `[[fault]]` contributes: kinds and sizes, and how many sensors at once.
struct FaultFamily {
  std::vector<FaultPlan> faults;
  std::vector<int> sensors;
};
std::vector<FaultFamily> read_faults(const io::TomlTable& top);

}  // namespace campaign
}  // namespace plumb
