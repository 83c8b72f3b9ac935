#include "ulog_notes.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace logs {
namespace {

const char* words_of(UlogTrouble trouble) {
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
    case UlogTrouble::value: return "readings that are none";
    case UlogTrouble::time: return "times that go back";
    case UlogTrouble::device: return "records of another device";
    case UlogTrouble::parameter: return "parameters";
    case UlogTrouble::count_of_these: break;
  }
  return "";
}

}  // namespace

bool UlogNotes::wanted(UlogTrouble trouble, std::uint64_t offset) {
  Tally& tally = tallies_[static_cast<std::size_t>(trouble)];
  ++tally.seen;
  tally.last_offset = offset;
  return tally.seen <= kMost;
}

void UlogNotes::sum_up() {
  for (std::size_t k = 0; k < tallies_.size(); ++k) {
    const Tally& tally = tallies_[k];
    if (tally.seen <= kMost) continue;
    sink_.note(tally.last_offset, std::to_string(tally.seen - kMost) + " more notes on " +
                                      words_of(static_cast<UlogTrouble>(k)) + " are left out; the last is on this one");
  }
}

}  // namespace logs
}  // namespace PLUMB_ABI
}  // namespace plumb
