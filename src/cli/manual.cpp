#include "manual.hpp"

#include <sstream>

namespace plumb {
inline namespace PLUMB_ABI {
namespace cli {
namespace {

/// Text that roff prints as it stands. A dash stays one that can be copied into a shell.
std::string in_roff(const std::string& text) {
  std::string out;
  bool fresh = true;  // at the beginning of a line, where a dot or a quote would be a request
  for (const char c : text) {
    if (fresh && (c == '.' || c == '\'')) out += "\\&";
    switch (c) {
      case '\\': out += "\\e"; break;
      case '-': out += "\\-"; break;
      case '^': out += "\\(ha"; break;
      case '~': out += "\\(ti"; break;
      case '`': out += "\\(ga"; break;
      case '\'': out += "\\(aq"; break;
      default: out += c;
    }
    fresh = c == '\n';
  }
  return out;
}

/// Lines kept as they are, without the blank ones at both ends.
std::string verbatim(std::string text) {
  while (!text.empty() && text.back() == '\n') text.pop_back();
  const std::size_t begin = text.find_first_not_of('\n');
  if (begin == std::string::npos) return "";
  return ".PP\n.nf\n" + in_roff(text.substr(begin)) + "\n.fi\n";
}

/// What stands below the options, without the exit codes, which have a section of their own.
std::string notes_of(const Options& command) {
  std::string text = command.footer();
  const std::string codes = exit_codes_help();
  const std::size_t at = text.find(codes);
  return at == std::string::npos ? text : text.erase(at, codes.size());
}

/// "--log LOG.csv|-", or the name of what stands without an option.
std::string form_of(const Option& option) {
  std::string names;
  for (const std::string& name : option.short_names()) names += (names.empty() ? "" : ", ") + ("-" + name);
  for (const std::string& name : option.long_names()) names += (names.empty() ? "" : ", ") + ("--" + name);
  if (names.empty()) return option.type_name().empty() ? option.name() : option.type_name();
  return option.most_values() == 0 ? names : names + " " + option.type_name();
}

std::string options_in_roff(const Options& command) {
  std::string out;
  for (const Option& option : command.list()) {
    if (!option.is_listed()) continue;
    out += ".TP\n.B \"" + in_roff(form_of(option)) + "\"\n" + in_roff(option.description());
    out += option.is_required() ? " (required)\n" : "\n";
  }
  return out;
}

/// "skip|stop": the words that an option takes; empty where it takes anything.
std::vector<std::string> choices_of(const Option& option) {
  std::vector<std::string> out;
  const std::string type = option.type_name();
  if (type.find('|') == std::string::npos ||
      type.find_first_not_of("abcdefghijklmnopqrstuvwxyz-|") != std::string::npos)
    return out;
  std::istringstream in(type);
  for (std::string word; std::getline(in, word, '|');) out.push_back(word);
  return out;
}

/// A number, a text with rules of its own: nothing that completion could know.
bool takes_file(const Option& option) {
  const std::string type = option.type_name();
  return type.find('.') != std::string::npos || type.find("DIR") != std::string::npos ||
         type.find("FILE") != std::string::npos;
}

std::string joined_words(const std::vector<std::string>& words, const char* between) {
  std::string out;
  for (const std::string& word : words) out += (out.empty() ? "" : between) + word;
  return out;
}

struct Completion {
  std::vector<std::string> flags, words, files, others;  ///< options; of those with a value: what it is
  std::vector<std::string> word_cases;
  bool positional = false;
};

Completion completion_of(const Options& command) {
  Completion out;
  for (const Option& option : command.list()) {
    if (!option.is_listed()) continue;
    std::vector<std::string> names;
    for (const std::string& name : option.long_names()) names.push_back("--" + name);
    for (const std::string& name : option.short_names()) names.push_back("-" + name);
    out.positional = out.positional || names.empty();
    out.flags.insert(out.flags.end(), names.begin(), names.end());
    if (names.empty() || option.most_values() == 0) continue;
    const std::vector<std::string> choices = choices_of(option);
    if (!choices.empty()) {
      out.word_cases.push_back(joined_words(names, "|") + ") COMPREPLY=($(compgen -W \"" + joined_words(choices, " ") +
                               "\" -- \"$cur\")); return ;;");
    } else {
      std::vector<std::string>& list = takes_file(option) ? out.files : out.others;
      list.insert(list.end(), names.begin(), names.end());
    }
  }
  return out;
}

std::string bash_case(const Command& command) {
  const Completion c = completion_of(command.options);
  std::string out = "    " + command.options.name() + ")\n      case \"$prev\" in\n";
  for (const std::string& line : c.word_cases) out += "        " + line + "\n";
  if (!c.files.empty()) out += "        " + joined_words(c.files, "|") + ") _plumb_files; return ;;\n";
  if (!c.others.empty()) out += "        " + joined_words(c.others, "|") + ") return ;;\n";
  out += "      esac\n      if [[ $cur == -* ]]; then\n        COMPREPLY=($(compgen -W \"" +
         joined_words(c.flags, " ") + "\" -- \"$cur\"))\n";
  if (c.positional) out += "      else\n        _plumb_files\n";
  return out + "      fi ;;\n";
}

/// One line, each of `marks` after a backslash, in the single quotes of a shell that ends them by '\\''.
std::string quoted(const std::string& text, const std::string& marks) {
  std::string out = "'";
  for (const char c : text) {
    if (marks.find(c) != std::string::npos) out += '\\';
    out += c == '\n' ? std::string(" ") : c == '\'' ? std::string("'\\''") : std::string(1, c);
  }
  return out + "'";
}

/// As _arguments of zsh wants it: --out[what it is]:value:_files.
void zsh_option(const Option& option, std::string& out) {
  const std::vector<std::string> choices = choices_of(option);
  std::string value;
  if (option.most_values() != 0) {
    value = ":value:";
    if (!choices.empty()) {
      value += "(" + joined_words(choices, " ") + ")";
    } else if (takes_file(option)) {
      value += "_files";
    }
  }
  const std::string about = quoted(option.description(), "[]:\\");
  const std::string many = option.most_values() > 1 ? "*" : "";
  const auto add = [&](const std::string& name) {
    out += " \\\n        '" + many + name + "['" + about + "']" + value + "'";
  };
  for (const std::string& name : option.long_names()) add("--" + name);
  for (const std::string& name : option.short_names()) add("-" + name);
  if (option.long_names().empty() && option.short_names().empty()) out += " \\\n        '*:file:_files'";
}

void fish_option(const std::string& begin, const Option& option, std::string& out) {
  std::string line = begin;
  for (const std::string& name : option.long_names()) line += " -l " + name;
  for (const std::string& name : option.short_names()) line += " -s " + name;
  const std::vector<std::string> choices = choices_of(option);
  if (option.long_names().empty() && option.short_names().empty()) {
    line += " -F";  // what stands without an option is a file
  } else if (option.most_values() != 0) {
    line += takes_file(option) && choices.empty() ? " -r -F" : " -x";
    if (!choices.empty()) line += " -a '" + joined_words(choices, " ") + "'";
  }
  out += line + " -d " + quoted(option.description(), "") + "\n";
}

}  // namespace

std::string man_page(const Manual& manual) {
  std::string out =
      ".\\\" Printed by plumb --man from the definitions of the command line.\n.TH PLUMB 1 \"\" \"plumb " +
      std::string(kVersion) + "\" \"User Commands\"\n.SH NAME\nplumb \\- calibrates and monitors redundant " +
      "accelerometers\n.SH SYNOPSIS\n.B plumb\n.I COMMAND\n[\n.I OPTIONS\n]\n.SH DESCRIPTION\n" +
      in_roff(manual.about) + "\n.SH COMMANDS\n";
  for (const Command& command : manual.commands) {
    out +=
        ".TP\n.B \"plumb " + in_roff(command.options.name()) + "\"\n" + in_roff(command.options.description()) + "\n";
  }
  for (const Command& command : manual.commands) {
    std::string name = command.options.name();
    for (char& c : name) c = c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
    out += ".SH \"PLUMB " + in_roff(name) + "\"\n" + in_roff(command.about) + "\n" + options_in_roff(command.options) +
           verbatim(notes_of(command.options));
  }
  out += ".SH \"EXIT STATUS\"\n" + verbatim(exit_codes_help());
  return out + ".SH \"SEE ALSO\"\nThe pages below docs/ of the source.\n";
}

std::string bash_completion(const Manual& manual) {
  std::vector<std::string> names;
  for (const Command& command : manual.commands) names.push_back(command.options.name());
  std::string out =
      "# bash completion for plumb. Printed by plumb --completion from the definitions of the command line.\n"
      "_plumb_files() {\n  compopt -o filenames 2>/dev/null\n  mapfile -t COMPREPLY < <(compgen -f -- \"$cur\")\n}\n"
      "_plumb() {\n  local cur=${COMP_WORDS[COMP_CWORD]} prev=${COMP_WORDS[COMP_CWORD-1]}\n  COMPREPLY=()\n"
      "  if ((COMP_CWORD == 1)); then\n    COMPREPLY=($(compgen -W \"" +
      joined_words(names, " ") + " --help --version\" -- \"$cur\"))\n    return\n  fi\n  case ${COMP_WORDS[1]} in\n";
  for (const Command& command : manual.commands) out += bash_case(command);
  return out + "  esac\n}\ncomplete -F _plumb plumb\n";
}

std::string zsh_completion(const Manual& manual) {
  std::string out =
      "#compdef plumb\n# zsh completion for plumb. Printed by plumb --completion-zsh from the definitions of the "
      "command line.\n_plumb() {\n  local -a commands\n  commands=(\n";
  for (const Command& command : manual.commands)
    out += "    " + quoted(command.options.name() + ":" + command.options.description(), "\\") + "\n";
  out +=
      "  )\n  if (( CURRENT == 2 )); then\n    _describe command commands\n    return\n  fi\n"
      "  local command=$words[2]\n  shift words\n  (( CURRENT-- ))\n  case $command in\n";
  for (const Command& command : manual.commands) {
    out += "    " + command.options.name() + ")\n      _arguments";
    for (const Option& option : command.options.list()) {
      if (option.is_listed()) zsh_option(option, out);
    }
    out += " ;;\n";
  }
  return out + "  esac\n}\nif [[ $funcstack[1] == _plumb ]]; then _plumb \"$@\"; else compdef _plumb plumb; fi\n";
}

std::string fish_completion(const Manual& manual) {
  std::string out =
      "# fish completion for plumb. Printed by plumb --completion-fish from the definitions of the command line.\n"
      "complete -c plumb -f\n";
  for (const Command& command : manual.commands) {
    const std::string name = command.options.name();
    out += "complete -c plumb -n __fish_use_subcommand -a " + name + " -d " +
           quoted(command.options.description(), "") + "\n";
    for (const Option& option : command.options.list()) {
      if (option.is_listed())
        fish_option("complete -c plumb -n '__fish_seen_subcommand_from " + name + "'", option, out);
    }
  }
  return out;
}

}  // namespace cli
}  // namespace PLUMB_ABI
}  // namespace plumb
