/// Runs the built tool in a directory of its own and looks at what a user would see.
#pragma once

#include <fcntl.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

extern char** environ;

namespace plumb_test {

inline std::string read_text(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  std::ostringstream out;
  out << in.rdbuf();
  return out.str();
}

inline void write_text(const std::filesystem::path& path, const std::string& text) {
  std::ofstream(path, std::ios::binary) << text;
}

/// With the first occurrence of `from` replaced; fails the test where there is none.
inline std::string with(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

inline std::string line_of(const std::string& text, int number) {
  std::istringstream in(text);
  std::string line;
  for (int k = 0; k < number; ++k) std::getline(in, line);
  return line;
}

/// A new empty directory, removed with all that is in it.
class Directory {
 public:
  Directory() {
    std::string name = (std::filesystem::temp_directory_path() / "plumb-cli-XXXXXX").string();
    EXPECT_NE(::mkdtemp(name.data()), nullptr);
    path_ = name;
  }
  ~Directory() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  Directory(const Directory&) = delete;
  Directory& operator=(const Directory&) = delete;
  const std::filesystem::path& path() const { return path_; }
  std::filesystem::path operator/(const char* name) const { return path_ / name; }

 private:
  std::filesystem::path path_;
};

struct Outcome {
  int code = -1;
  std::string out;
  std::string err;
};

/// A running tool; its output goes to files, so that it never waits for a reader.
class Process {
 public:
  Process(const Directory& where, std::vector<std::string> arguments, int stdin_fd,
          const std::vector<std::string>& environment)
      : out_(where / ".stdout"), err_(where / ".stderr") {
    arguments.insert(arguments.begin(), PLUMB_TOOL_PATH);
    std::vector<char*> argv;
    for (std::string& argument : arguments) argv.push_back(argument.data());
    argv.push_back(nullptr);
    std::vector<std::string> variables = environment;
    std::vector<char*> envp;
    for (std::string& variable : variables) envp.push_back(variable.data());
    envp.push_back(nullptr);
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_addchdir_np(&actions, where.path().c_str());
    if (stdin_fd >= 0) {
      posix_spawn_file_actions_adddup2(&actions, stdin_fd, STDIN_FILENO);
    } else {
      posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    }
    posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, out_.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
    posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, err_.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
    const int error =
        posix_spawn(&id_, PLUMB_TOOL_PATH, &actions, nullptr, argv.data(), variables.empty() ? environ : envp.data());
    posix_spawn_file_actions_destroy(&actions);
    EXPECT_EQ(error, 0) << PLUMB_TOOL_PATH;
  }

  /// Waits (up to 20 s) until standard output holds the text.
  bool says(const std::string& text) const {
    for (int k = 0; k < 2000; ++k) {
      if (read_text(out_).find(text) != std::string::npos) return true;
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    return false;
  }
  void interrupt() const { ::kill(id_, SIGINT); }
  Outcome wait() const {
    int status = 0;
    EXPECT_EQ(::waitpid(id_, &status, 0), id_);
    Outcome outcome;
    outcome.code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    outcome.out = read_text(out_);
    outcome.err = read_text(err_);
    return outcome;
  }

 private:
  std::filesystem::path out_, err_;
  pid_t id_ = 0;
};

inline Outcome run(const Directory& where, const std::vector<std::string>& arguments,
                   const std::string& stdin_file = "", const std::vector<std::string>& environment = {}) {
  const int input = stdin_file.empty() ? -1 : ::open((where.path() / stdin_file).c_str(), O_RDONLY | O_CLOEXEC);
  const Outcome outcome = Process(where, arguments, input, environment).wait();
  if (input >= 0) ::close(input);
  return outcome;
}

/// Array file, logs and calibration of the examples, made once per test process: a stand and a drilling run in which a2
/// dies at the sixth station. Takes a quarter of a second.
inline const Directory& example_files() {
  static const Directory directory;
  static const bool made = [] {
    const std::string examples = PLUMB_SOURCE_DIR "/examples/";
    std::filesystem::copy_file(examples + "paper_tool.toml", directory / "array.toml");
    const std::vector<std::vector<std::string>> steps = {
        {"simulate", examples + "stand.toml", "--out", "calibration.csv"},
        {"calibrate", "--array", "array.toml", "--log", "calibration.csv", "--out", "calibration.json"},
        {"simulate", examples + "drilling.toml", "--out", "drilling.csv"}};
    for (const std::vector<std::string>& step : steps) {
      const Outcome outcome = run(directory, step);
      EXPECT_EQ(outcome.code, 0) << outcome.err;
    }
    return true;
  }();
  EXPECT_TRUE(made);
  return directory;
}

/// A directory with copies of these files in it.
class Workshop : public Directory {
 public:
  Workshop() {
    for (const char* name : {"array.toml", "calibration.csv", "drilling.csv", "calibration.json"}) {
      std::filesystem::copy_file(example_files() / name, *this / name);
    }
  }
  std::string text(const char* name) const { return read_text(*this / name); }
  void put(const char* name, const std::string& text) const { write_text(*this / name, text); }
};

/// Each of the words, in this order.
inline ::testing::AssertionResult says(const std::string& text, const std::vector<std::string>& words) {
  std::size_t at = 0;
  for (const std::string& word : words) {
    at = text.find(word, at);
    if (at == std::string::npos)
      return ::testing::AssertionFailure() << "no \"" << word << "\" (in this order) in:\n" << text;
  }
  return ::testing::AssertionSuccess();
}

/// The commands in the comment at the head of an example, joined where a line goes on.
inline std::string commands_of(const std::string& example) {
  std::istringstream in(example);
  std::string line, out;
  while (std::getline(in, line) && line[0] == '#') {
    if (line.substr(0, 4) == "#   ") out += line.substr(4) + "\n";
  }
  return out;
}

/// Runs those of files in examples/, one after the other, in a directory in which examples/ lies; returns what they
/// printed. What they said to standard error is in `err`.
inline std::string play_examples(const Directory& where, const std::vector<std::string>& files) {
  const std::string examples = PLUMB_SOURCE_DIR "/examples/";
  std::filesystem::create_directory_symlink(examples, where / "examples");
  std::string script = "set -e\nplumb() { '" PLUMB_TOOL_PATH "' \"$@\"; }\n";
  for (const std::string& file : files) script += commands_of(read_text(examples + file));
  write_text(where / "script", script);
  const std::string shell = "cd '" + where.path().string() + "' && sh script > out 2> err";
  EXPECT_EQ(std::system(shell.c_str()), 0) << script << read_text(where / "err");
  return read_text(where / "out");
}

}  // namespace plumb_test
