// Every cell of the transition table as one line of numbers: scripts/mutate compares those of a changed table with the
// specification, as the model's tests do with what `plumb model` prints.
#include <cstdio>

#include "plumb/health/transition_table.hpp"

namespace {

using namespace plumb;

const char* kind_name(CellKind kind) {
  switch (kind) {
    case CellKind::taken: return "TAKEN";
    case CellKind::ignored: return "IGNORED";
    case CellKind::held: return "HELD";
    case CellKind::impossible: return "IMPOSSIBLE";
  }
  return "?";
}

}  // namespace

int main() {
  for (int m = 0; m < kModeCount; ++m) {
    for (int e = 0; e + 1 < kEventCount; ++e) {
      const Cell& cell = cell_of(static_cast<Mode>(m), static_cast<HealthEvent>(e));
      std::printf("%d %d %s %d %d\n", m, e, kind_name(cell.kind), static_cast<int>(cell.target), cell.actions);
    }
  }
}
