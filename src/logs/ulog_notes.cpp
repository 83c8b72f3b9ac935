#include "ulog_notes.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace logs {

const char* words_of(UlogTrouble trouble) noexcept {
  switch (trouble) {
    case UlogTrouble::header: return "the header";
    case UlogTrouble::flags: return "flag bits";
    case UlogTrouble::appended: return "appended data";
    case UlogTrouble::message: return "messages that could not be read";
    case UlogTrouble::format: return "formats";
    case UlogTrouble::subscription: return "subscriptions";
    case UlogTrouble::unknown_id: return "data without a subscription";
    case UlogTrouble::data_size: return "data of another size than their format";
    case UlogTrouble::lacking: return "topics that lack a field";
    case UlogTrouble::value: return "readings that are not numbers, or are marked as invalid";
    case UlogTrouble::time: return "times that go back";
    case UlogTrouble::device: return "records of another device";
    case UlogTrouble::parameter: return "parameters";
    case UlogTrouble::count: break;
  }
  return "";
}

}  // namespace logs
}  // namespace PLUMB_ABI
}  // namespace plumb
