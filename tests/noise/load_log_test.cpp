// Logs at rest as files: any CSV with a time, and hostile bytes.
#include "plumb/noise/load_log.hpp"

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>
#include <unistd.h>

#include <cmath>
#include <cstddef>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "plumb/io/csv_columns.hpp"
#include "plumb/noise/axis_study.hpp"

namespace load_log_test {
namespace {

using namespace plumb;
using namespace plumb::noise;

/// A file that is gone at the end.
class TextFile {
 public:
  explicit TextFile(const std::string& text)
      : path_((std::filesystem::temp_directory_path() / ("plumb-still-" + std::to_string(::getpid()) + ".csv"))
                  .string()) {
    std::ofstream(path_, std::ios::binary) << text;
  }
  ~TextFile() { std::filesystem::remove(path_); }
  TextFile(const TextFile&) = delete;
  TextFile& operator=(const TextFile&) = delete;
  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

io::FileExpected<LoadedLog> loaded(const std::string& text, const LoadOptions& options = {}) {
  const TextFile file(text);
  return load_still_log(file.path(), options);
}

TEST(LoadStillLog, TakesEveryColumnOfNumbersButTheTime) {
  const auto log = loaded(
      "\xEF\xBB\xBFseq,time_us,ax_mps2,gx_radps,\"note, long\",ch\r\n"
      "1,1000000,9.5,0.1,ok,3\r\n2,1010000,,nan,ok,4\n\n3,1020000,9.75,0.2,ok,5\n");
  ASSERT_TRUE(log.has_value()) << log.error().text();
  EXPECT_EQ(log->time_column, "time_us");
  ASSERT_EQ(log->log.columns.size(), 4U);
  EXPECT_EQ(log->log.columns[1].name, "ax_mps2");
  ASSERT_EQ(log->log.time_s.size(), 3U);
  EXPECT_NEAR(log->log.time_s[2], 1.02, 1e-12);
  EXPECT_TRUE(std::isnan(log->log.columns[1].readings[1]));
  EXPECT_EQ(log->log.columns[1].readings[2], 9.75);
  EXPECT_TRUE(log->units[1].acceleration);
  EXPECT_FALSE(log->units[2].sensor);
  EXPECT_TRUE(log->units[3].name.empty());
  EXPECT_EQ(log->left_out, std::vector<std::string>{"note, long"});
}

TEST(LoadStillLog, GoesByWhatItIsTold) {
  LoadOptions options;
  options.rate_hz = 50.0;
  options.unit = "mg0";
  options.columns = {"b"};
  const auto log = loaded("a,b\n1,1000\n2,1001\n", options);
  ASSERT_TRUE(log.has_value()) << log.error().text();
  EXPECT_TRUE(log->log.time_s.empty());
  EXPECT_EQ(log->log.rate_hz, 50.0);
  ASSERT_EQ(log->log.columns.size(), 1U);
  EXPECT_NEAR(log->log.columns[0].readings[0], 9.80665, 1e-12);
  options = {};
  options.time_column = "a";
  const auto timed = loaded("a,b\n1,1000\n2,1001\n", options);
  ASSERT_TRUE(timed.has_value());
  EXPECT_EQ(timed->log.time_s, (std::vector<double>{1.0, 2.0}));
}

TEST(LoadStillLog, SaysWhatIsWrong) {
  const auto what = [](const std::string& text, const LoadOptions& options = {}) {
    const auto log = loaded(text, options);
    return log ? std::string("nothing") : log.error().what + "|" + log.error().remedy;
  };
  EXPECT_NE(what("").find("the log is empty"), std::string::npos);
  EXPECT_NE(what("t_s,a\n").find("no usable row"), std::string::npos);
  EXPECT_NE(what("1,2\n3,4\n").find("column names"), std::string::npos);
  EXPECT_NE(what("a,b\n1,2\n2,3\n").find("--rate"), std::string::npos);
  EXPECT_NE(what("t_s,a\n1,2\n1,3\n").find("row 2 below the header"), std::string::npos);
  EXPECT_NE(what("t_s,a\nnan,2\n1,3\n").find("does not increase"), std::string::npos);
  EXPECT_NE(what("t_s,a\n1,2\n2\n").find("1 cell, but the header has 2"), std::string::npos);
  EXPECT_NE(what("t_s,a\n1,2\n2,x\n").find("\"x\" is not a number"), std::string::npos);
  EXPECT_NE(what("t_s;a\n1;2\n").find("semicolons"), std::string::npos);
  EXPECT_NE(what("t_s\n1\n2\n").find("no column of numbers but the time"), std::string::npos);
  LoadOptions options;
  options.columns = {"c"};
  EXPECT_NE(what("t_s,a\n1,2\n2,3\n", options).find("name one of: a"), std::string::npos);
  options = {};
  options.time_column = "clock";
  EXPECT_NE(what("t_s,a\n1,2\n2,3\n", options).find("no such column"), std::string::npos);
  options = {};
  options.unit = "g";
  EXPECT_NE(what("t_s,a\n1,2\n2,3\n", options).find("ambiguous"), std::string::npos);
  EXPECT_FALSE(load_still_log("/nonexistent/still.csv", {}).has_value());
}

TEST(LoadStillLog, SkipsBadRowsWhereItMay) {
  LoadOptions options;
  options.on_bad_row = io::BadRowPolicy::skip;
  const auto log = loaded("t_s,a\n1,2\n2\n3,x\n4,5\n", options);
  ASSERT_TRUE(log.has_value()) << log.error().text();
  EXPECT_EQ(log->rows_bad, 2U);
  EXPECT_EQ(log->log.columns[0].readings, (std::vector<double>{2.0, 5.0}));
}

TEST(LoadStillLog, KnowsTimesAndUnitsByTheirNames) {
  EXPECT_EQ(time_unit_of_name("t"), 1.0);
  EXPECT_EQ(time_unit_of_name("Time [ms]"), 1e-3);
  EXPECT_EQ(time_unit_of_name("timestamp_us"), 1e-6);
  EXPECT_FALSE(time_unit_of_name("temperature").has_value());
  EXPECT_FALSE(time_unit_of_name("t_degc").has_value());
  EXPECT_FALSE(time_unit_of_name("").has_value());
  EXPECT_EQ(unit_of_name("a1_cnt").name, "count");
  EXPECT_EQ(unit_of_name("ax [m/s^2]").name, "m/s^2");
  EXPECT_TRUE(unit_of_name("v").name.empty());
}

TEST(CsvColumns, StopsAtWhatItMayKeep) {
  std::string text = "t_s,a,word\n";
  for (int k = 0; k < 100; ++k) text += std::to_string(k) + ",1,x\n";
  const TextFile file(text);
  const auto csv = io::read_csv_columns(file.path(), io::BadRowPolicy::stop, nullptr, 50);
  ASSERT_TRUE(csv.has_value());
  EXPECT_FALSE(csv->complete);
  ASSERT_EQ(csv->values.size(), 2U);
  EXPECT_EQ(csv->values[0].size(), 25U);
}

/// Rows of a log that somebody may hand in: numbers of any size, holes, text, other lengths.
rc::Gen<std::string> rows() {
  const auto cell = rc::gen::element<std::string>("0", "1", "-1", "1e308", "-1e308", "1e-320", "nan", "inf", "", "x",
                                                  "0.5", "\"", "\x1b[2J", "3", "4", "1e17");
  return rc::gen::map(rc::gen::container<std::vector<std::string>>(300, cell),
                      [](const std::vector<std::string>& cells) {
                        std::string text = "t_s,a,b\n";
                        for (std::size_t k = 0; k + 1 < cells.size(); k += 2)
                          text += std::to_string(k) + "," + cells[k] + "," + cells[k + 1] + "\n";
                        return text;
                      });
}

RC_GTEST_PROP(LoadStillLog, AnyRowsAreStudiedOrRefused, ()) {
  LoadOptions options;
  options.on_bad_row = io::BadRowPolicy::skip;
  std::string text = *rows();
  text += *rows();  // the second header is a bad row
  const auto log = loaded(text, options);
  if (!log) {
    RC_ASSERT(!log.error().what.empty() && !log.error().remedy.empty());
    return;
  }
  for (std::size_t c = 0; c < log->log.columns.size(); ++c) {
    const AxisStudy study = study_axis(log->log, c, {});
    if (study.stretch.refused != Refused::no) continue;
    for (const Term term : kAllTerms) {
      const TermEstimate& one = study.fit.of(term);
      RC_ASSERT(one.low <= one.value && one.value <= one.high);
    }
    RC_ASSERT(std::isfinite(study.whiteness.declare_sigma) && study.whiteness.declare_sigma > 0.0);
  }
}

RC_GTEST_PROP(LoadStillLog, AnyReadingsOfAnySizeAreStudied, ()) {
  const double size = *rc::gen::element(1e-130, 1e-49, 1e-30, 1.0, 1e30, 1e43, 1e138);
  const double level = *rc::gen::element(0.0, 1.0, -1e6);
  const auto codes = *rc::gen::container<std::vector<int>>(400, rc::gen::inRange(-3, 4));
  StillLog log;
  log.rate_hz = *rc::gen::element(1e-8, 1.0, 1e8);
  log.columns = {{"a", {}}};
  for (const int code : codes) log.columns[0].readings.push_back(size * (level + code));
  const AxisStudy study = study_axis(log, 0, {});
  if (study.stretch.refused != Refused::no) {
    RC_ASSERT(size < 1e-49 || size > 1e43 || study.stretch.refused == Refused::constant);
    return;
  }
  for (const Term term : kAllTerms) {
    const TermEstimate& one = study.fit.of(term);
    RC_ASSERT(one.low <= one.value && one.value <= one.high);
    RC_ASSERT(std::isfinite(one.low) && std::isfinite(one.high));
  }
  RC_ASSERT(std::isfinite(study.whiteness.declare_sigma) && study.whiteness.declare_sigma > 0.0);
}

}  // namespace
}  // namespace load_log_test
