#include "plumb/verification/criterion.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace verification {

std::optional<CriterionId> criterion_of(std::string_view key) noexcept {
  for (const CriterionEntry& row : kCriterionTable) {
    if (key == row.key) return row.id;
  }
  return std::nullopt;
}

std::optional<Result> result_of(std::string_view word) noexcept {
  for (std::size_t k = 0; k < kResultWords.size(); ++k) {
    if (word == kResultWords[k]) return static_cast<Result>(k);
  }
  return std::nullopt;
}

}  // namespace verification
}  // namespace PLUMB_ABI
}  // namespace plumb
