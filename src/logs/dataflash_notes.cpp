#include "dataflash_notes.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace logs {

const char* words_of(DataflashTrouble trouble) noexcept {
  switch (trouble) {
    case DataflashTrouble::passed_over: return "bytes that are no message";
    case DataflashTrouble::unknown_type: return "messages that no FMT describes";
    case DataflashTrouble::bad_format: return "FMT messages that contradict themselves";
    case DataflashTrouble::redefined: return "FMT messages that contradict earlier ones";
    case DataflashTrouble::unit: return "columns with an unusual unit or multiplier";
    case DataflashTrouble::clock: return "times that go back";
    case DataflashTrouble::no_number: return "records whose specific force is not a finite number";
    case DataflashTrouble::bad_instance: return "messages with an impossible instance";
    case DataflashTrouble::bad_parameter: return "parameters with an impossible name";
    case DataflashTrouble::count: break;
  }
  return "";
}

}  // namespace logs
}  // namespace PLUMB_ABI
}  // namespace plumb
