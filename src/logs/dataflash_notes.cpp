#include "dataflash_notes.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace logs {
namespace {

constexpr std::uint64_t kToldOfAKind = 5;

const char* name_of(std::size_t trouble) noexcept {
  switch (static_cast<Trouble>(trouble)) {
    case Trouble::passed_over: return "places without a message were passed over";
    case Trouble::unknown_type: return "messages that no FMT describes were passed over";
    case Trouble::bad_format: return "FMT messages contradict themselves";
    case Trouble::redefined: return "FMT messages contradict earlier ones";
    case Trouble::unit: return "columns have an unusual unit or multiplier";
    case Trouble::clock: return "times go back";
    case Trouble::no_number: return "records have a specific force that is no finite number";
    case Trouble::bad_instance: return "messages name an instance that cannot be, and were left out";
    case Trouble::bad_parameter: return "parameters have no name that can be one, and were left out";
    case Trouble::count: break;
  }
  return "";
}

}  // namespace

bool DataflashNotes::wants(Trouble trouble, std::uint64_t offset) noexcept {
  Tally& tally = tallies_[static_cast<std::size_t>(trouble)];
  ++tally.seen;
  if (tally.seen == kToldOfAKind + 1) tally.first_untold = offset;
  return tally.seen <= kToldOfAKind;
}

void DataflashNotes::sum_up() {
  for (std::size_t k = 0; k < tallies_.size(); ++k) {
    if (tallies_[k].seen <= kToldOfAKind) continue;
    const std::uint64_t untold = tallies_[k].seen - kToldOfAKind;
    sink_.note(tallies_[k].first_untold, "from here on " + std::to_string(untold) + " more " + name_of(k));
  }
}

}  // namespace logs
}  // namespace PLUMB_ABI
}  // namespace plumb
