#include "usual_options.hpp"

#include <charconv>
#include <filesystem>
#include <map>

namespace plumb {
inline namespace PLUMB_ABI {
namespace command {

std::string exit_codes_help() {
  return "Exit codes:\n"
         "  0  done\n"
         "  1  anything else: interrupted, output that cannot be written\n"
         "  2  the command line is not understood\n"
         "  3  a file is unreadable or invalid (the message names file, line, field and remedy)\n"
         "  4  the calibration was not accepted (the report says why and what to record next)\n"
         "  5  the monitor ended in the state `failed`\n"
         "  6  a verification did not pass\n"
         "  7  nothing was judged: no block of the log was at rest\n"
         "  8  plumb review: the worst finding is orange\n"
         "  9  plumb review: the worst finding is red\n";
}

std::string seed_refusal(const std::string& text) {
  std::uint64_t seed = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), seed);
  const bool whole = error == std::errc() && end == text.data() + text.size();
  return whole ? "" : "must be a whole number from 0 to 2^64 - 1";
}

void add_bad_row_option(const Options& command, io::BadRowPolicy& policy) {
  const std::map<std::string, io::BadRowPolicy> names{{"skip", io::BadRowPolicy::skip},
                                                      {"stop", io::BadRowPolicy::stop}};
  command
      .add_option("--on-bad-row", policy, names,
                  "what to do at a row that cannot be read: `stop` (default) or `skip` and count it")
      .type_name("skip|stop");
}

std::optional<io::FileError> overwritten(const std::vector<NamedFile>& outputs, const std::vector<NamedFile>& inputs) {
  const auto same = [](const NamedFile& a, const NamedFile& b) {
    if (a.path.empty() || a.path == "-" || b.path.empty() || b.path == "-") return false;
    std::error_code absent;  // a file that is not there yet can only be the same by its name
    if (std::filesystem::equivalent(a.path, b.path, absent) && !absent) return true;
    return std::filesystem::path(a.path).lexically_normal() == std::filesystem::path(b.path).lexically_normal();
  };
  const auto refusal = [](const NamedFile& output, const NamedFile& other) {
    return io::FileError{
        output.path,         0,
        output.option,       std::string("is the same file as ") + other.option + ", which would be overwritten",
        "give another name", io::ExitCode::usage};
  };
  for (std::size_t k = 0; k < outputs.size(); ++k) {
    for (const NamedFile& input : inputs) {
      if (same(outputs[k], input)) return refusal(outputs[k], input);
    }
    for (std::size_t j = 0; j < k; ++j) {
      if (same(outputs[k], outputs[j])) return refusal(outputs[k], outputs[j]);
    }
  }
  return std::nullopt;
}

}  // namespace command
}  // namespace PLUMB_ABI
}  // namespace plumb
