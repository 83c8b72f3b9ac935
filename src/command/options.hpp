/// The command line: what the commands use of the library CLI11, and nothing else of it.
///
/// The library is a header that takes 5 s to compile wherever it is included, and every command needs options. So only
/// options.cpp includes it; all others see these handles. They forward: what an option accepts, how --help lists it and
/// how a mistake is put into words is the library's.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

#include "plumb/core/config.hpp"

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace plumb {
inline namespace PLUMB_ABI {
namespace command {

/// Is given the text after an option; returns what is wrong with it, "" where nothing is.
using TextReader = std::function<std::string(const std::string& text)>;

/// An option of a command. A handle: copies are the same option, and each call returns it for the next.
class Option {
 public:
  explicit Option(CLI::Option& option) : option_(&option) {}

  Option required() const;
  /// One value or more after it: for files without an option of their own.
  Option several() const;
  /// What --help shows in the place of the value: "CAL.json".
  Option type_name(const std::string& name) const;
  Option check(const TextReader& wrong) const;
  /// Both ends are allowed.
  Option range(int least, int most) const;
  Option range(double least, double most) const;
  /// And --help tells the range.
  Option told_range(int least, int most) const;

  /// What the manual page and the completions tell of it.
  std::string name() const;
  const std::vector<std::string>& short_names() const;
  const std::vector<std::string>& long_names() const;
  std::string type_name() const;
  const std::string& description() const;
  bool is_required() const;
  bool is_listed() const;  ///< in --help
  /// 0 for a flag, above 1 for what may be given several times.
  int most_values() const;

 private:
  CLI::Option* option_;
};

/// The options of a command, or of the tool before any command. A handle: the CommandLine has to outlive it.
class Options {
 public:
  explicit Options(CLI::App& app) : app_(&app) {}

  /// `value` is written when the option is read, and left alone where it is not given.
  Option add_option(const std::string& name, std::string& value, const std::string& description) const;
  Option add_option(const std::string& name, int& value, const std::string& description) const;
  Option add_option(const std::string& name, double& value, const std::string& description) const;
  Option add_option(const std::string& name, std::uint64_t& value, const std::string& description) const;
  Option add_option(const std::string& name, std::optional<std::uint64_t>& value, const std::string& description) const;
  /// May be given several times, with one value each.
  Option add_option(const std::string& name, std::vector<std::string>& values, const std::string& description) const;
  /// For a value with rules of its own.
  Option add_option(const std::string& name, const TextReader& read, const std::string& description) const;
  /// One of a few words.
  template <class Enum>
  Option add_option(const std::string& name, Enum& value, const std::map<std::string, Enum>& words,
                    const std::string& description) const {
    std::vector<std::string> texts;
    std::vector<Enum> values;
    for (const auto& [text, meant] : words) {
      texts.push_back(text);
      values.push_back(meant);
    }
    return add_words(
        name, texts, [&value, values](std::size_t k) { value = values[k]; }, description);
  }
  Option add_flag(const std::string& name, bool& value, const std::string& description) const;
  Option add_flag(const std::string& name, const std::function<void()>& given, const std::string& description) const;
  /// A command of the tool; the description is its line in the tool's --help.
  Options add_command(const std::string& name, const std::string& description) const;

  void describe(const std::string& description) const;
  /// What --help says below the options. A command that is added later begins with the tool's.
  void footer(const std::string& text) const;

  std::string name() const;
  std::string description() const;
  std::string footer() const;
  std::string help() const;
  std::vector<Option> list() const;

  /// Of a command, once the line has been read: whether it stood there.
  bool given() const;
  /// The commands that stood there.
  std::vector<Options> given_commands() const;
  /// What is on the line and no option knows.
  std::vector<std::string> left_over() const;

 private:
  Option add_words(const std::string& name, const std::vector<std::string>& words,
                   const std::function<void(std::size_t)>& take, const std::string& description) const;

  CLI::App* app_;
};

/// What reading a command line came to.
struct Reading {
  enum class End {
    understood,
    answered,  ///< by --help or --version: the text is the answer
    refused    ///< the text is what is wrong, without a full stop
  };
  End end = End::understood;
  std::string text;
};

/// The command line of a program: owns all its options. Has --help and --version from the start.
class CommandLine {
 public:
  CommandLine(const std::string& about, const std::string& name, const std::string& version);
  ~CommandLine();
  CommandLine(const CommandLine&) = delete;
  CommandLine& operator=(const CommandLine&) = delete;

  Options options() const { return Options(*app_); }
  /// The column of --help at which descriptions begin.
  void column_width(std::size_t width) const;
  Reading read(int argc, const char* const* argv) const;

 private:
  std::unique_ptr<CLI::App> app_;
};

}  // namespace command
}  // namespace PLUMB_ABI
}  // namespace plumb
