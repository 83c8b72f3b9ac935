/// What a review of logs found, as text for a terminal, as JSON and as a page.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "plumb/render/verification_page.hpp"
#include "plumb/review/log_review.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace render {

inline constexpr const char* kReviewSchema = "plumb-review";
inline constexpr int kReviewVersion = 1;

/// A log that could not be read at all.
struct UnreadLog {
  std::string name;
  std::string why;
};

/// "GREEN", "ORANGE", "RED", or "NOT JUDGED" where nothing was compared and nothing found.
const char* grade_word(const review::LogReview& one) noexcept;

/// One log at length. `notes`: with every note of the reader.
std::string review_text(const review::LogReview& one, bool notes);
/// Many logs: a line each, then the devices that are in more than one of them.
std::string fleet_text(const std::vector<review::LogReview>& logs, const std::vector<UnreadLog>& unread);
Json review_json(const std::vector<review::LogReview>& logs, const std::vector<UnreadLog>& unread);
std::string review_html(const std::vector<review::LogReview>& logs, const std::vector<UnreadLog>& unread);

}  // namespace render
}  // namespace PLUMB_ABI
}  // namespace plumb
