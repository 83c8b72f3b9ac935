// From the path of a log to its review.
#include "plumb/review/time_skew.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace review {

io::FileExpected<LogDigest> digest_log(const std::string& path, const logs::CsvHints& table) {
  LogDigester digester;
  const io::FileExpected<logs::LogExtent> extent = logs::read_log(path, table, digester);
  if (!extent) return tl::unexpected<io::FileError>(extent.error());
  return digester.take(path, *extent);
}

io::FileExpected<LogReview> review_file(const std::string& path, const ReviewSettings& settings) {
  const io::FileExpected<LogDigest> digest = digest_log(path, settings.table);
  if (!digest) return tl::unexpected<io::FileError>(digest.error());
  LogReview out = review_log(*digest, settings);
  const std::optional<SkewWindow> window = skew_window(*digest, out);
  if (!window) return out;
  CourseCollector courses(*window, out);
  // The second reading adds to the first: a log that has gone in between leaves the skew open.
  if (logs::read_log(path, settings.table, courses)) judge_skew(*window, courses, out);
  return out;
}

}  // namespace review
}  // namespace PLUMB_ABI
}  // namespace plumb
