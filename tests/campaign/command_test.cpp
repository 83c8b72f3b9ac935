// plumb campaign as a user sees it.
#include "cli/tool_runner.hpp"

namespace command_test {
namespace {

using namespace plumb_test;

std::string small() { return read_text(PLUMB_SOURCE_DIR "/tests/campaign/small.toml"); }

/// Runs the tool in the directory; what it printed is in out and err there.
int tool(const Directory& where, const std::string& arguments) {
  const std::string shell =
      "cd '" + where.path().string() + "' && '" PLUMB_TOOL_PATH "' " + arguments + " > out 2> err";
  const int status = std::system(shell.c_str());
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

TEST(CampaignCommand, PrintsATableAndKeepsAResultThatEndsTheSameHoweverItWasInterrupted) {
  const Directory where;
  write_text(where / "c.toml", small());
  ASSERT_EQ(tool(where, "campaign c.toml --scenarios 2000 --out whole.json"), 0) << read_text(where / "err");
  const std::string table = read_text(where / "out");
  for (const char* word : {"small: 2000 of 2000 scenarios", "wrong_exclusion", "misleading", "Clopper-Pearson*",
                           "97.5 %", "time to detect: median 1"}) {
    EXPECT_NE(table.find(word), std::string::npos) << word << " is not in\n" << table;
  }
  EXPECT_NE(tool(where, "campaign c.toml --scenarios 2000 --out whole.json"), 0) << "would overwrite a result";
  EXPECT_NE(read_text(where / "err").find("--resume"), std::string::npos);
  // Going on from what is complete changes nothing.
  const std::string whole = read_text(where / "whole.json");
  ASSERT_EQ(tool(where, "campaign c.toml --scenarios 2000 --out whole.json --resume --threads 2"), 0);
  EXPECT_EQ(read_text(where / "whole.json"), whole);
}

TEST(CampaignCommand, AfterCtrlCItSaysHowFarItIsAndGoesOn) {
  const Directory where;
  write_text(where / "c.toml", small());
  // Far more than can be played; the signal comes once something has been counted.
  write_text(where / "script", "'" PLUMB_TOOL_PATH
                               "' campaign c.toml --scenarios 100000000 --every 0 --out part.json > out 2> err &\n"
                               "job=$!\n"
                               "until grep -q '\"done\": [1-9]' part.json 2> /dev/null; do sleep 0.1; done\n"
                               "kill -INT $job\nwait $job\n");
  const int status = std::system(("cd '" + where.path().string() + "' && bash script").c_str());
  EXPECT_EQ(WIFEXITED(status) ? WEXITSTATUS(status) : -1, 1);
  const std::string part = read_text(where / "part.json");
  EXPECT_NE(part.find("\"complete\": false"), std::string::npos);
  EXPECT_NE(read_text(where / "err").find("interrupted after"), std::string::npos) << read_text(where / "err");
  EXPECT_NE(read_text(where / "err").find("--resume"), std::string::npos);
  EXPECT_EQ(tool(where, "campaign c.toml --scenarios 2000 --out part.json --resume"), 3)
      << "another number of scenarios is another campaign";
}

TEST(CampaignCommand, MistakesAreAnsweredWithAWayOut) {
  const Directory where;
  write_text(where / "c.toml", small());
  EXPECT_EQ(tool(where, "campaign"), 2);
  EXPECT_EQ(tool(where, "campaign nowhere.toml"), 3);
  EXPECT_EQ(tool(where, "campaign c.toml --resume"), 2);
  EXPECT_NE(read_text(where / "err").find("--out"), std::string::npos);
  EXPECT_EQ(tool(where, "campaign c.toml --threads 0"), 2);
  EXPECT_EQ(tool(where, "campaign c.toml --out c.toml"), 2);
  EXPECT_EQ(read_text(where / "c.toml"), small());
  // Before anything is played, not after hours.
  EXPECT_NE(tool(where, "campaign c.toml --out missing/r.json"), 0);
  EXPECT_NE(read_text(where / "err").find("missing/r.json"), std::string::npos) << read_text(where / "err");
}

TEST(CampaignCommand, AFailingScenarioIsSavedAndItsCommandFailsAgain) {
  const Directory where;
  write_text(where / "claim.toml",
             "scenarios = 3000\nseed = 3\n[monitor]\nassumed_faults = 1\n[[tool]]\ngeometry = \"cone\"\nsensors = 5\n"
             "noise = \"0.2 mg0\"\n[[fault]]\nbias_mdb = {from = 5, to = 300}\nsensors = [2, 3]\n"
             "[expect]\nwrong_exclusion = 0\n");
  EXPECT_EQ(tool(where, "campaign claim.toml --out r.json"), 6);
  EXPECT_NE(read_text(where / "err").find("[expect] is not met: wrong_exclusion"), std::string::npos);
  const std::string out = read_text(where / "out");
  const std::string command = "plumb campaign claim.toml --replay ";
  const std::size_t at = out.find(command);
  ASSERT_NE(at, std::string::npos) << out;
  const std::size_t name = at + command.size();
  const std::string saved = out.substr(name, out.find('\n', name) - name);
  EXPECT_EQ(tool(where, "campaign claim.toml --replay " + saved), 0) << read_text(where / "err");
  EXPECT_NE(read_text(where / "out").find("wrong_exclusion: "), std::string::npos) << read_text(where / "out");
  // By its number the same happens, in the scenario as it was drawn.
  const std::size_t dash = saved.find("-case-") + 6;
  EXPECT_EQ(tool(where, "campaign claim.toml --replay " + saved.substr(dash, saved.find('.') - dash)), 0);
  EXPECT_NE(read_text(where / "out").find("wrong_exclusion: "), std::string::npos) << read_text(where / "out");
  // And simulate plays it for whoever wants the log.
  EXPECT_EQ(tool(where, "simulate " + saved + " --out log.csv"), 0) << read_text(where / "err");
}

}  // namespace
}  // namespace command_test
