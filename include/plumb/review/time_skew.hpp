/// How much later one chip reads than another, from what both saw of the same motion.
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <vector>

#include "plumb/review/log_review.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace review {

/// Readings of one chip over some seconds, in order of time.
struct Course {
  std::vector<double> time_s;
  std::vector<Axes> force_mps2;
};

/// `lag_s` above zero: the second one shows later what the first one shows. 95 % uncertainty.
struct Skew {
  double lag_s = 0.0, uncertainty_s = 0.0;
};

/// The shift within +-`most_s` for which the two differ least, a constant difference apart: least squares, with the
/// uncertainty from the curvature of the sum and what is left (Kay, Estimation Theory, 3.11: delay of a known signal).
/// Nothing where they share too little motion: less than half of the scatter is explained.
std::optional<Skew> skew_of(const Course& first, const Course& second, double most_s = 0.3);

/// The seconds of the log with most motion, where two chips or more are fast enough to tell a skew.
struct SkewWindow {
  double from_s = 0.0, to_s = 0.0;
  std::vector<std::size_t> chips;
};
std::optional<SkewWindow> skew_window(const LogDigest& digest, const LogReview& found);

/// Collects the courses of the window from a second reading of the log.
class CourseCollector final : public logs::LogSink {
 public:
  static constexpr std::size_t kMostReadings = 200000;  ///< of one chip
  CourseCollector(const SkewWindow& window, const LogReview& found);
  void source(std::size_t, const logs::ImuSource&) override {}
  void record(std::size_t number, const logs::ImuRecord& record) override;
  void parameter(const std::string&, double) override {}
  void note(std::uint64_t, const std::string&) override {}
  const Course& course(std::size_t source) const { return courses_.at(source); }

 private:
  double from_s_, to_s_;
  std::map<std::size_t, Course> courses_;  ///< by source of the digest
};

/// Adds to the review what the courses say of each chip against the first one of the window.
void judge_skew(const SkewWindow& window, const CourseCollector& courses, LogReview& out);

/// All of it: the digest, the review, and where it pays a second reading for the skew. Refused where the log cannot be
/// read.
io::FileExpected<LogReview> review_file(const std::string& path, const ReviewSettings& settings = {});

}  // namespace review
}  // namespace PLUMB_ABI
}  // namespace plumb
