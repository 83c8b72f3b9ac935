#include "coverage.hpp"

#include <fmt/format.h>

namespace plumb_replay {

void Coverage::end_case() {
  for (const Key& key : now_) ++cases_[key];
  now_.clear();
}

std::vector<std::string> Coverage::missing() const {
  std::vector<std::string> out;
  for (const Key& key : wanted_) {
    if (cases_.find(key) == cases_.end()) out.push_back(key.first + " " + key.second);
  }
  return out;
}

void Coverage::print(std::FILE* out) const {
  constexpr std::size_t kWidth = 120;
  std::string group, line;
  const auto end_line = [&] {
    if (!line.empty()) fmt::print(out, "{}\n", line);
    line.clear();
  };
  for (const auto& [key, count] : cases_) {
    const std::string item = fmt::format(" {} {},", key.second, count);
    if (key.first != group || line.size() + item.size() > kWidth) {
      end_line();
      line = "# " + (key.first == group ? std::string(key.first.size() + 1, ' ') : key.first + ":");
      group = key.first;
    }
    line += item;
  }
  end_line();
  for (const std::string& what : missing()) fmt::print(out, "# not met: {}\n", what);
}

}  // namespace plumb_replay
