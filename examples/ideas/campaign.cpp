// A campaign: a thousand scenarios by number, what became of them, and which may not happen at all.
#include <cstdio>

#include "plumb/campaign/campaign_file.hpp"
#include "plumb/campaign/engine.hpp"

int main() {
  using namespace plumb::campaign;
  const auto file = parse_campaign_text(R"(
    scenarios = 1000
    tool = [{geometry = "cone", sensors = 5, noise = "0.2 mg0"}]
    attitude = [{law = "random"}]
    fault = [{spec = ["none", "stuck=0V", "bias=50mg0"], sensors = [1, 2]}])",
                                        "here");
  if (!file) return std::printf("%s\n", file.error().text().c_str()), 1;
  Progress progress;
  progress.tally = Tally(file->plan);
  Ranks alone;
  const auto stop = [] { return false; };
  const auto report = [](const Progress&) { return std::string(); };
  if (!run(file->plan, {}, alone, progress, stop, report)) return 1;
  for (const Count what : {Count::scenarios, Count::isolated, Count::wrong_exclusion, Count::misleading})
    std::printf("%-16s %llu\n", to_string(what), static_cast<unsigned long long>(progress.tally.total(what)));
}
