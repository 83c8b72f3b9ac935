// The state machine, as the table that runs: what each event does while the monitor is suspect.
#include <cstdio>

#include "plumb/health/transition_table.hpp"

int main() {
  for (int e = 0; e < plumb::kEventCount; ++e) {
    const auto event = static_cast<plumb::HealthEvent>(e);
    const plumb::Cell& cell = plumb::cell_of(plumb::Mode::suspect, event);
    if (cell.kind != plumb::CellKind::taken) continue;
    std::printf("%-24s -> %s", plumb::to_string(event), plumb::to_string(cell.target));
    for (int a = 0; a < plumb::Action::kinds; ++a) {
      const auto one = static_cast<plumb::Action::Bits>(1U << static_cast<unsigned>(a));
      if ((cell.actions & one) != 0) std::printf(", %s", plumb::action_name(one));
    }
    std::printf("\n");
  }
}
