#include "options.hpp"

#include <charconv>
#include <cstring>

#include "family.hpp"

namespace plumb_bench {
namespace {

/// What --quick plays: under 40 s of one core.
constexpr std::uint64_t kQuickEpisodes = 5000;
constexpr double kQuickAdaptiveShare = 0.05;

template <class T>
bool number(const char* text, T& out) {
  const char* end = text + std::strlen(text);
  const auto read = std::from_chars(text, end, out);
  return read.ec == std::errc() && read.ptr == end;
}

/// An option that takes a value; false where there is none of that name or the value is no such thing.
bool take(const std::string& option, const char* value, Options& out) {
  if (option == "--seed") return number(value, out.seed);
  if (option == "--first") return number(value, out.first);
  if (option == "--episodes") return number(value, out.episodes) && out.episodes > 0;
  if (option == "--episode") {
    out.one = true;
    return number(value, out.first);
  }
  if (option == "--adaptive-share") {
    return number(value, out.adaptive_share) && out.adaptive_share >= 0.0 && out.adaptive_share <= 1.0;
  }
  if (option == "--family") {
    const std::vector<int> named = families_like(value);
    out.chosen.insert(out.chosen.end(), named.begin(), named.end());
    return !named.empty();
  }
  if (option == "--state") out.state = value;
  if (option == "--json") out.json = value;
  if (option == "--before") out.before = value;
  return option == "--state" || option == "--json" || option == "--before";
}

/// Numbered as before there were families: five sizes, eight situations, fourteen lies.
void take_old_number(Options& out) {
  const std::uint64_t number = out.first;
  const std::uint64_t situation = number / 5 % 8;
  for (int k = 0; k < static_cast<int>(families().size()); ++k) {
    const Family& family = families()[static_cast<std::size_t>(k)];
    if (family.play == Play::lies && family.number == static_cast<double>(situation)) out.chosen = {k};
  }
  out.first = number % 5 + 5 * (number / 40);
}

}  // namespace

tl::expected<Options, std::string> options_of(int argc, const char* const* argv) {
  Options out;
  for (int i = 1; i < argc; ++i) {
    const std::string option = argv[i];
    if (option == "--quick") {
      out.quick = true;
      out.episodes = kQuickEpisodes;
      out.adaptive_share = kQuickAdaptiveShare;
    } else if (option == "--by-n") {
      out.every_n = true;
    } else if (option == "--list") {
      out.list = true;
    } else if (i + 1 >= argc) {
      return tl::unexpected<std::string>(option + " is no option, or lacks its value");
    } else if (!take(option, argv[i + 1], out)) {
      return tl::unexpected<std::string>(option + " " + argv[i + 1] + " is not understood");
    } else {
      ++i;
    }
  }
  if (out.one && out.chosen.empty()) take_old_number(out);
  if (out.one && out.chosen.size() != 1) {
    return tl::unexpected<std::string>("--episode needs one family: --family NAME, as --list prints it");
  }
  if (!out.state.empty() && (out.first != 0 || out.one)) {
    return tl::unexpected<std::string>("--state counts from the first episode: leave --first and --episode out");
  }
  if (out.chosen.empty()) {
    for (int k = 0; k < static_cast<int>(families().size()); ++k) out.chosen.push_back(k);
  }
  return out;
}

const char* usage() {
  return "usage: plumb_monitor_attacks [--quick] [--episodes N] [--adaptive-share X] [--family NAME]... [--seed S]\n"
         "         [--state FILE] [--json FILE] [--before FILE] [--by-n] [--first K] [--episode K] [--list]\n";
}

}  // namespace plumb_bench
