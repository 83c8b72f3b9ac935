#include <array>
#include <cctype>
#include <string_view>

#include "plumb/noise/load_log.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace noise {
namespace {

struct UnitEnd {
  std::string_view end;
  ColumnUnit unit;
};

std::string lower(std::string_view text) {
  std::string out;
  for (const char c : text) out += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return out;
}

/// The words of a name: "Time [us]" is "time", "us".
std::vector<std::string> words_of(const std::string& name) {
  std::vector<std::string> out;
  bool within = false;
  for (const char c : lower(name)) {
    const bool letter = std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '^' || c == '/';
    if (letter && !within) out.emplace_back();
    if (letter) out.back() += c;
    within = letter;
  }
  return out;
}

}  // namespace

ColumnUnit unit_of_name(const std::string& name) {
  static const std::array<UnitEnd, 14> ends = {{{"mps2", {"m/s^2", true, true}},
                                                {"m/s2", {"m/s^2", true, true}},
                                                {"m/s^2", {"m/s^2", true, true}},
                                                {"cnt", {"count", false, true}},
                                                {"count", {"count", false, true}},
                                                {"counts", {"count", false, true}},
                                                {"lsb", {"count", false, true}},
                                                {"v", {"V", false, true}},
                                                {"mv", {"mV", false, true}},
                                                {"uv", {"uV", false, true}},
                                                {"radps", {"rad/s", false, false}},
                                                {"degps", {"deg/s", false, false}},
                                                {"degc", {"degC", false, false}},
                                                {"ut", {"uT", false, false}}}};
  const std::vector<std::string> words = words_of(name);
  if (words.size() < 2) return {};
  for (const UnitEnd& one : ends) {
    if (words.back() == one.end) return one.unit;
  }
  return {};
}

std::optional<double> time_unit_of_name(const std::string& name) {
  const std::vector<std::string> words = words_of(name);
  if (words.empty()) return std::nullopt;
  const std::string& first = words.front();
  if (first != "t" && first != "time" && first != "timestamp" && first != "stamp") return std::nullopt;
  if (words.size() == 1) return 1.0;
  static const std::array<std::pair<std::string_view, double>, 8> units = {{{"s", 1.0},
                                                                            {"sec", 1.0},
                                                                            {"seconds", 1.0},
                                                                            {"ms", 1e-3},
                                                                            {"us", 1e-6},
                                                                            {"ns", 1e-9},
                                                                            {"min", 60.0},
                                                                            {"h", 3600.0}}};
  for (const auto& [word, seconds] : units) {
    if (words.back() == word) return seconds;
  }
  return std::nullopt;
}

}  // namespace noise
}  // namespace PLUMB_ABI
}  // namespace plumb
