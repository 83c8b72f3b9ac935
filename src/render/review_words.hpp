/// The findings of a review in sentences (private to src/render).
#pragma once

#include <string>
#include <vector>

#include "plumb/review/log_review.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace render {

struct ReviewSentence {
  std::string what;    ///< with figure and limit
  std::string where;   ///< place in the log
  std::string remedy;  ///< what to do
};

ReviewSentence sentence_of(const review::Finding& finding, const review::LogReview& in);
std::string code_word(review::FindingCode code);
std::string sentence_of(review::OpenQuestion question);
std::string code_word(review::OpenQuestion question);
const char* grade_word(review::Grade grade) noexcept;
/// "0 green ...": in one sentence, what the log says of its chips.
std::string answer_of(const review::LogReview& in);
/// The name of a chip as it may be shown.
std::string chip_name(const review::LogReview& in, std::size_t chip);
/// "3670050"; "-" without one.
std::string device_words(const review::ChipSummary& chip);
/// "installed, up to 0.16 m/s^2 and 1.4 %", "none in this log".
std::string calibration_words(const review::ChipSummary& chip);
std::string temperature_words(const review::ChipSummary& chip);
/// "12.3 to 45.6 s"
std::string place_words(double from_s, double to_s);

/// The devices of several logs, each with what it read in every log, in the order of the logs.
struct DeviceTrend {
  std::uint64_t device_id = 0;
  std::vector<std::size_t> logs;
  std::vector<double> off_gravity_mps2;  ///< at rest, the mean over the stretches by their length; NaN without one
  std::vector<double> warmest_degc;
};
std::vector<DeviceTrend> trends_of(const std::vector<review::LogReview>& logs);
/// Of the lengths at rest: mean over the stretches, weighted by their durations, minus the gravity that was judged by;
/// NaN without one.
double off_gravity_mps2(const review::LogReview& in, std::size_t chip);

}  // namespace render
}  // namespace PLUMB_ABI
}  // namespace plumb
