#include "options.hpp"

#include <CLI/CLI.hpp>
#include <sstream>

namespace plumb {
inline namespace PLUMB_ABI {
namespace command {
Option Option::several() const {
  option_->expected(1, CLI::detail::expected_max_vector_size);
  return *this;
}

Option Option::required() const { return Option(*option_->required()); }
Option Option::type_name(const std::string& name) const { return Option(*option_->type_name(name)); }
Option Option::check(const TextReader& wrong) const { return Option(*option_->check(wrong)); }
Option Option::range(int least, int most) const {
  return Option(*option_->check(CLI::Range(least, most).description("")));
}
Option Option::range(double least, double most) const {
  return Option(*option_->check(CLI::Range(least, most).description("")));
}
Option Option::told_range(int least, int most) const { return Option(*option_->check(CLI::Range(least, most))); }

std::string Option::name() const { return option_->get_name(); }
const std::vector<std::string>& Option::short_names() const { return option_->get_snames(); }
const std::vector<std::string>& Option::long_names() const { return option_->get_lnames(); }
std::string Option::type_name() const { return option_->get_type_name(); }
const std::string& Option::description() const { return option_->get_description(); }
bool Option::is_required() const { return option_->get_required(); }
bool Option::is_listed() const { return !option_->get_group().empty(); }
int Option::most_values() const { return option_->get_expected_max(); }

Option Options::add_option(const std::string& name, std::string& value, const std::string& description) const {
  return Option(*app_->add_option(name, value, description));
}
Option Options::add_option(const std::string& name, int& value, const std::string& description) const {
  return Option(*app_->add_option(name, value, description));
}
Option Options::add_option(const std::string& name, double& value, const std::string& description) const {
  return Option(*app_->add_option(name, value, description));
}
Option Options::add_option(const std::string& name, std::uint64_t& value, const std::string& description) const {
  return Option(*app_->add_option(name, value, description));
}
Option Options::add_option(const std::string& name, std::optional<std::uint64_t>& value,
                           const std::string& description) const {
  return Option(*app_->add_option(name, value, description));
}
Option Options::add_option(const std::string& name, std::vector<std::string>& values,
                           const std::string& description) const {
  return Option(*app_->add_option(name, values, description)->expected(1)->take_all());
}

Option Options::add_option(const std::string& name, const TextReader& read, const std::string& description) const {
  const auto refuse = [name, read](const std::string& text) {
    const std::string wrong = read(text);
    if (!wrong.empty()) throw CLI::ValidationError(name, wrong);
  };
  return Option(*app_->add_option_function<std::string>(name, refuse, description));
}

Option Options::add_words(const std::string& name, const std::vector<std::string>& words,
                          const std::function<void(std::size_t)>& take, const std::string& description) const {
  const auto read = [name, words, take](const std::string& text) {
    std::string known;
    for (std::size_t k = 0; k < words.size(); ++k) {
      if (words[k] == text) return take(k);
      known += (k == 0 ? "" : " or ") + words[k];
    }
    throw CLI::ValidationError(name, "\"" + text + "\" is not " + known);
  };
  return Option(*app_->add_option_function<std::string>(name, read, description));
}

Option Options::add_flag(const std::string& name, bool& value, const std::string& description) const {
  return Option(*app_->add_flag(name, value, description));
}
Option Options::add_flag(const std::string& name, const std::function<void()>& given,
                         const std::string& description) const {
  return Option(*app_->add_flag_callback(name, given, description));
}

Options Options::add_command(const std::string& name, const std::string& description) const {
  return Options(*app_->add_subcommand(name, description));
}

void Options::describe(const std::string& description) const { app_->description(description); }
void Options::footer(const std::string& text) const { app_->footer(text); }
std::string Options::name() const { return app_->get_name(); }
std::string Options::description() const { return app_->get_description(); }
std::string Options::footer() const { return app_->get_footer(); }
std::string Options::help() const { return app_->help(); }

std::vector<Option> Options::list() const {
  std::vector<Option> out;
  for (CLI::Option* option : app_->get_options()) out.emplace_back(*option);
  return out;
}

bool Options::given() const { return app_->parsed(); }

std::vector<Options> Options::given_commands() const {
  std::vector<Options> out;
  for (CLI::App* command : app_->get_subcommands()) out.emplace_back(*command);
  return out;
}

std::vector<std::string> Options::left_over() const { return app_->remaining(); }

CommandLine::CommandLine(const std::string& about, const std::string& name, const std::string& version)
    : app_(std::make_unique<CLI::App>(about, name)) {
  app_->set_version_flag("--version", version);
}

CommandLine::~CommandLine() = default;

void CommandLine::column_width(std::size_t width) const { app_->get_formatter()->column_width(width); }

Reading CommandLine::read(int argc, const char* const* argv) const {
  try {
    app_->parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() != 0) return {Reading::End::refused, error.what()};
    std::ostringstream answer;
    app_->exit(error, answer, answer);
    return {Reading::End::answered, answer.str()};
  }
  return {};
}

}  // namespace command
}  // namespace PLUMB_ABI
}  // namespace plumb
