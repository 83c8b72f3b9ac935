#include "plumb/review/log_digest.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace review {

io::FileExpected<LogDigest> digest_log(const std::string& path) {
  LogDigester digester;
  const io::FileExpected<logs::LogExtent> extent = logs::read_log(path, digester);
  if (!extent) return tl::unexpected<io::FileError>(extent.error());
  return digester.take(path, *extent);
}

}  // namespace review
}  // namespace PLUMB_ABI
}  // namespace plumb
