/// What several commands ask for and say alike: seeds, bad rows, exit codes, files that would overwrite others.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "options.hpp"
#include "plumb/io/file_error.hpp"
#include "plumb/io/log_reader.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace command {

/// The exit codes for the end of every --help.
std::string exit_codes_help();
/// For `check` of a --seed: empty where the text is a whole number that fits. The library alone takes -1, and 2^64, for
/// 2^64 - 1.
std::string seed_refusal(const std::string& text);
/// --on-bad-row skip|stop
void add_bad_row_option(const Options& command, io::BadRowPolicy& policy);

/// A file named on the command line, with the option that named it. "" and "-" stand for no file.
struct NamedFile {
  const char* option;
  std::string path;
};
/// The first output that is one of the inputs, or another output: writing it would destroy what the user has.
std::optional<io::FileError> overwritten(const std::vector<NamedFile>& outputs, const std::vector<NamedFile>& inputs);

}  // namespace command
}  // namespace PLUMB_ABI
}  // namespace plumb
