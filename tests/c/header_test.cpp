// The C headers explain themselves: every member of every struct says what it is.
#include <gtest/gtest.h>

#include <fstream>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

namespace header_test {
namespace {

/// Members that neither their own line nor a comment just above them explains.
std::vector<std::string> unexplained(std::istream& header) {
  std::vector<std::string> out;
  std::string line;
  bool in_struct = false, comment_above = false;
  while (std::getline(header, line)) {
    if (line.rfind("typedef struct ", 0) == 0 && line.back() == '{') {
      in_struct = true;
    } else if (line.rfind("}", 0) == 0) {
      in_struct = false;
    } else if (in_struct && line.find(';') != std::string::npos && line.rfind("  /*", 0) != 0 &&
               line.rfind("   *", 0) != 0) {
      if (line.find("/*") == std::string::npos && !comment_above) out.push_back(line);
    }
    comment_above = std::regex_search(line, std::regex("^ +(/\\*|\\*).*\\*/$"));
  }
  return out;
}

TEST(CHeader, EveryMemberOfEveryStructIsExplained) {
  for (const char* name : {"plumb.h", "plumb_dip.h", "plumb_motion.h", "plumb_rates.h"}) {
    std::ifstream header(std::string(PLUMB_SOURCE_DIR "/include/plumb/c/") + name);
    ASSERT_TRUE(header) << name;
    for (const std::string& line : unexplained(header)) ADD_FAILURE() << name << ": not explained: " << line;
  }
}

TEST(CHeader, AMemberWithoutAWordIsFound) {
  std::istringstream header(
      "typedef struct a {\n  int x; /* one */\n  /* two */\n  int y;\n  int z;\n} a;\nint f(void);\n");
  EXPECT_EQ(unexplained(header), std::vector<std::string>{"  int z;"});
}

}  // namespace
}  // namespace header_test
