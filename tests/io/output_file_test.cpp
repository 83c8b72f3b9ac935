#include "plumb/io/output_file.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <string>

#include "io_test_support.hpp"
#include "plumb/io/file_error.hpp"

namespace output_file_test {
namespace {

using namespace plumb::io;
using io_test::written;

bool exists(const std::string& path) {
  struct stat status {};
  return ::stat(path.c_str(), &status) == 0;
}

std::string content(const std::string& path) {
  const auto text = read_file(path);
  return text ? *text : "unreadable";
}

TEST(OutputFile, WholeFilesAppearOnCommitOnly) {
  const std::string path = written("result.json", "old");
  {
    auto file = OutputFile::create(path, OutputFile::Mode::whole);
    ASSERT_TRUE(file.has_value());
    ASSERT_TRUE(file->write("half of it").has_value());
    ASSERT_TRUE(file->flush().has_value());
  }
  EXPECT_EQ(content(path), "old") << "an abandoned result leaves the old one alone";
  EXPECT_FALSE(exists(path + ".part" + std::to_string(::getpid())));
  ASSERT_TRUE(write_file(path, "new").has_value());
  EXPECT_EQ(content(path), "new");
  EXPECT_FALSE(exists(path + ".part" + std::to_string(::getpid())));
}

TEST(OutputFile, ALinkStaysALinkAndPermissionsStayAsTheyWere) {
  const std::string path = written("kept.toml", "old"), link = path + ".link";
  ASSERT_EQ(::chmod(path.c_str(), 0600), 0);
  (void)::unlink(link.c_str());
  ASSERT_EQ(::symlink(path.c_str(), link.c_str()), 0);
  ASSERT_TRUE(write_file(link, "new").has_value());
  struct stat status {};
  ASSERT_EQ(::lstat(link.c_str(), &status), 0);
  EXPECT_TRUE(S_ISLNK(status.st_mode));
  EXPECT_EQ(content(path), "new");
  ASSERT_EQ(::stat(path.c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 0777U, 0600U);
}

TEST(OutputFile, ALinkUnderTheTemporaryNameIsNotFollowed) {
  const std::string victim = written("victim", "untouched"), path = written("result.json", "old");
  const std::string beside = path + ".part" + std::to_string(::getpid());
  ASSERT_EQ(::symlink(victim.c_str(), beside.c_str()), 0);
  ASSERT_TRUE(write_file(path, "new").has_value());
  EXPECT_EQ(content(victim), "untouched");
  EXPECT_EQ(content(path), "new");
}

TEST(OutputFile, StreamsKeepWhatWasWritten) {
  const std::string path = written("events.jsonl", "");
  {
    auto file = OutputFile::create(path, OutputFile::Mode::stream);
    ASSERT_TRUE(file.has_value());
    ASSERT_TRUE(file->write("{\"sequence\":1}\n").has_value());
    OutputFile moved = *std::move(file);
    ASSERT_TRUE(moved.write("{\"sequence\":2}\n").has_value());
  }
  EXPECT_EQ(content(path), "{\"sequence\":1}\n{\"sequence\":2}\n") << "an interrupted run keeps its lines";
}

TEST(OutputFile, SaysWhyItCannotWrite) {
  const auto missing = OutputFile::create("/nonexistent/result.json", OutputFile::Mode::whole);
  ASSERT_FALSE(missing.has_value());
  EXPECT_EQ(missing.error().text(),
            "/nonexistent/result.json: cannot write: No such file or directory. Remedy: create the directory first, or "
            "choose another path.");
  EXPECT_EQ(missing.error().code, ExitCode::other);
  const auto directory = OutputFile::create(testing::TempDir(), OutputFile::Mode::stream);
  ASSERT_FALSE(directory.has_value());
  EXPECT_NE(directory.error().text().find("Is a directory"), std::string::npos);
  const auto below = OutputFile::create(written("file", "") + "/result.json", OutputFile::Mode::whole);
  ASSERT_FALSE(below.has_value());
  EXPECT_NE(below.error().text().find("Not a directory"), std::string::npos);
}

TEST(OutputFile, AFullDiskIsReported) {
  if (!exists("/dev/full")) GTEST_SKIP() << "no /dev/full here";
  auto file = OutputFile::create("/dev/full", OutputFile::Mode::whole);
  ASSERT_TRUE(file.has_value());
  const auto done = file->write("x");
  const auto result = done ? file->commit() : done;
  ASSERT_FALSE(result.has_value());
  EXPECT_NE(result.error().text().find("No space left on device"), std::string::npos);
  EXPECT_NE(result.error().text().find("free space"), std::string::npos);
}

TEST(ReadFile, AFileWithoutEndIsRefusedBeforeMemoryRunsOut) {
  if (!exists("/dev/zero")) GTEST_SKIP() << "no /dev/zero here";
  const auto text = read_file("/dev/zero");
  ASSERT_FALSE(text.has_value());
  EXPECT_NE(text.error().text().find("larger than 256 MiB"), std::string::npos) << text.error().text();
}

TEST(FileErrorText, ShellWordQuotesWhatAShellWouldSplitOrExpand) {
  EXPECT_EQ(shell_word("tools/my-tool_1.toml"), "tools/my-tool_1.toml");
  EXPECT_EQ(shell_word("my tool.toml"), "'my tool.toml'");
  EXPECT_EQ(shell_word("it's $HOME"), "'it'\\''s $HOME'");
  EXPECT_EQ(shell_word(""), "''");
  EXPECT_EQ(shell_word("a\nb"), "$'a\\012b'");
  EXPECT_EQ(shell_word("it's\x1b[2J\\"), "$'it\\'s\\033[2J\\\\'");
  EXPECT_EQ(shell_word("gr\xc3\xbcn"), "'gr\xc3\xbcn'") << "letters of any language stay";
  EXPECT_EQ(shell_word("\xc2\x9b"), "$'\\302\\233'") << "a control character in UTF-8";
}

/// What bash makes of a word; the word is all that it gets.
std::string by_bash(const std::string& word) {
  const std::string script = written("word.sh", "printf %s " + word + "\n");
  FILE* pipe = ::popen(("bash '" + script + "' 2>&1").c_str(), "r");
  if (pipe == nullptr) return "no bash";
  std::string out;
  for (int c = std::fgetc(pipe); c != EOF; c = std::fgetc(pipe)) out += static_cast<char>(c);
  return ::pclose(pipe) == 0 ? out : "failed: " + out;
}

RC_GTEST_PROP(FileErrorLaw, AShellReadsAWordAsItsText, ()) {
  const auto text = *rc::gen::container<std::string>(rc::gen::oneOf(
      rc::gen::inRange<char>(1, 127), rc::gen::element('\n', '\'', '"', '\\', '$', '`', ' ', '\x1b', '\t', '!', '7')));
  const std::string word = shell_word(text);
  RC_ASSERT(word.find_first_of("\n\r\t\x1b") == std::string::npos);
  RC_ASSERT(by_bash(word) == text);
}

TEST(FileErrorText, LeavesOutWhatDoesNotApply) {
  EXPECT_EQ((FileError{"a.toml", 12, "sensor[2].axis", "is 1.02 long", "divide it"}).text(),
            "a.toml:12: sensor[2].axis: is 1.02 long. Remedy: divide it.");
  EXPECT_EQ((FileError{"a.toml", 0, "", "is empty", "fill it."}).text(), "a.toml: is empty. Remedy: fill it.");
  EXPECT_EQ((FileError{"", 0, "", "x", ""}).text(), "x.");
  EXPECT_EQ(to_int(ExitCode::invalid_input), 3);
}

}  // namespace
}  // namespace output_file_test
