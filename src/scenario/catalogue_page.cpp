// The catalogue in print.
#include "plumb/scenario/catalogue.hpp"

#include "quantity_text.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace scenario {
namespace {

std::string states_text(StateMask states) {
  std::string text;
  for (int k = 0; k < kStateCount; ++k) {
    const auto state = static_cast<HealthState>(k);
    if ((states & state_bit(state)) != 0) text += (text.empty() ? "" : ", ") + std::string(to_string(state));
  }
  return text;
}

std::string when_text(const Outcome& outcome) {
  if (outcome.latest_block == 0) return "may stay undetected";
  return "block " + std::to_string(outcome.earliest_block) + " to " + std::to_string(outcome.latest_block);
}

const char* mask_text(AllowedMask mask) {
  switch (mask) {
    case AllowedMask::nobody: return "no sensor";
    case AllowedMask::only_faulty: return "only faulty ones";
    case AllowedMask::the_faulty: break;
  }
  return "exactly the faulty ones";
}

std::string outcome_row(const char* sensors, const Outcome& outcome) {
  return std::string("| ") + sensors + " | " + when_text(outcome) + " | " + states_text(outcome.states) + " | " +
         mask_text(outcome.mask) + " | " + shortest_text(deg_from_rad(outcome.tilt_bound_rad)) + " deg |\n";
}

std::string parts_text(const CatalogueEntry& entry) {
  static constexpr const char* kWhom[] = {"a1", "a2", "every sensor", "log"};
  std::string text;
  for (const CataloguePart& part : entry.parts) {
    std::string body = part.body;
    const std::size_t at = body.find("$1");
    if (at != std::string::npos) body.replace(at, 2, "a2");
    const bool every = part.victim == Victim::every;
    const std::string whom = kWhom[static_cast<std::size_t>(part.victim)];
    text += (text.empty() ? "" : ", ") + (every ? whom + " `" + body + "`" : "`" + whom + ":" + body + "`");
    if (part.later) text += " (6 stations, 20 s or 2000 rows later)";
  }
  return text;
}

std::string entry_text(const CatalogueEntry& entry) {
  std::string text = std::string("\n## ") + entry.id + " " + entry.title + "\n\n";
  text += std::string("`") + entry.name + "`. Comes from: " + entry.source + ". Is: " + parts_text(entry) + ".\n\n";
  text += "| parameter | unit | default | worth trying |\n|---|---|---|---|\n";
  for (const CatalogueParameter& p : entry.parameters) {
    text += std::string("| ") + p.name + " | " + p.unit + " | " + p.standard + " | " + p.sweep + " |\n";
  }
  text +=
      "\n"
      "| sensors | detected | state at the end | may be excluded | tilt error while valid |\n"
      "|---|---|---|---|---|\n";
  text += outcome_row("4", entry.four) + outcome_row("6", entry.six);
  if (*entry.known_limit != '\0') text += std::string("\nLimit: ") + entry.known_limit + "\n";
  return text;
}

constexpr const char* kHead =
    R"(# The fault catalogue

What can go wrong with redundant accelerometers, its physical cause, how to inject it, and how the monitor is expected to
respond. This page is printed from the table that the tests run (`plumb/scenario/catalogue.hpp`): every entry, on every
sensor of the paper's four and of the six of the dodecahedron.

```
plumb inject --array tool.toml --log run.csv --fault "a2:F04@12s" --out faulty.csv
plumb inject --array tool.toml --log run.csv --fault "a2:bias-step=20mg0@station6" --out faulty.csv
plumb inject --array tool.toml --log run.csv --fault "a2:garbage@12s" --out faulty.csv
```

Select an entry by its id, its name, or the word of PX4's failure injection where there is one. A size behind `=` replaces
the first default. Entries that act on more than one sensor take the sensors behind the named one. In C++:
`find_entry("F04")` and `faults_of(entry, options, context)`. The parts of an entry are written as faults of
[`plumb inject`](guide.md#8-test-your-own-log), which take every parameter.

**The course.** Expectations hold on one standard run: exact calibration, noise 0.2 mg0, 28 random attitudes of four
blocks of 32 samples, the fault from station 8 on (F28 from power-on), default configuration. "Detected" is the block,
counted from the onset, from which the output was no longer valid with all sensors in use. "May be excluded" includes
provisional exclusions. A channel that stops delivering becomes absent; it is not excluded.

)";

}  // namespace

std::string catalogue_page() {
  std::string text = kHead;
  text += "| word of PX4 | is | as |\n|---|---|---|\n";
  for (const Px4Alias& alias : px4_aliases()) {
    text += std::string("| `") + alias.word + "` | " + alias.id + " | `" + alias.body + "` |\n";
  }
  for (const CatalogueEntry& entry : catalogue()) text += entry_text(entry);
  return text;
}

}  // namespace scenario
}  // namespace PLUMB_ABI
}  // namespace plumb
