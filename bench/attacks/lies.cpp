#include "lies.hpp"

#include "lies_episode.hpp"

namespace plumb_bench {

const char* name(Situation situation) {
  switch (situation) {
    case Situation::plain: return "plain";
    case Situation::motion: return "motion";
    case Situation::recalibrate: return "recalibration";
    case Situation::offer: return "offers";
    case Situation::reset: return "reset";
    case Situation::reinstate: return "reinstatement";
    case Situation::timing: return "timing";
    case Situation::host: return "host";
  }
  return "?";
}

const char* name_of_lie(int lie) {
  constexpr const char* kNames[kAttackLies] = {"constant",  "stuck",    "random", "intermittent", "moving",
                                               "drifting",  "scale",    "sign",   "swap",         "remount",
                                               "colluding", "mirrored", "mixed",  "nobody"};
  return lie >= 0 && lie < kAttackLies ? kNames[lie] : "?";
}

std::uint64_t old_number(Situation situation, std::uint64_t episode) {
  return episode % 5 + 5 * static_cast<std::uint64_t>(situation) + 40 * (episode / 5);
}

inline namespace PLUMB_ABI {
namespace {

/// New random arrays, calibrated anew, for so many episodes.
constexpr std::uint64_t kBatch = 20000;

/// The tools of n sensors that the laws are put to, and behind them some with axes that this batch alone has.
std::vector<AttackTool> tools_of(int n, std::uint64_t seed, std::uint64_t batch) {
  std::vector<AttackTool> out;
  const auto keep = [&out](plumb_test::LawTool tool) {
    const bool names = plumb::confirmed_grade(tool.tool.array, tool.tool.array.all()) > 0;
    if (names && worst_error(tool) <= 1.0) out.push_back(attack_tool(std::move(tool)));
  };
  for (plumb_test::LawTool& tool : plumb_test::law_tools(n)) keep(std::move(tool));
  plumb_test::TrialNoise noise = plumb_test::stream_of(n + 100 * static_cast<int>(seed % 1000000), batch);
  for (const auto knowledge :
       {plumb_test::Knowledge::exact, plumb_test::Knowledge::drawn, plumb_test::Knowledge::fitted}) {
    for (int k = 0; k < 4; ++k) {
      keep(plumb_test::law_tool(plumb_test::random_axes(n, noise), n, plumb_test::Geometry::random, knowledge, noise));
    }
  }
  return out;
}

/// Kept for the batch and size last asked for.
const std::vector<AttackTool>& tools_for(int n, std::uint64_t seed, std::uint64_t batch) {
  struct Kept {
    std::uint64_t seed = 0, batch = ~std::uint64_t{0};
    std::vector<AttackTool> tools;
  };
  static std::array<Kept, 9> kept;
  Kept& own = kept[plumb_test::slot(n)];
  if (own.tools.empty() || own.seed != seed || own.batch != batch) own = {seed, batch, tools_of(n, seed, batch)};
  return own.tools;
}

}  // namespace

LiesCount play_lies(const LiesRequest& request, std::vector<std::string>& finds) {
  const std::uint64_t number = old_number(request.situation, request.episode);
  plumb_test::Strata strata(number);
  const int n = 4 + strata.digit(5);
  strata.digit(kSituations);
  const int lie = strata.digit(kAttackLies);
  const std::vector<AttackTool>& tools = tools_for(n, request.seed, number / kBatch);
  plumb_test::TrialNoise noise = plumb_test::stream_of(static_cast<int>(request.seed % 1000000), number);
  const AttackTool& tool = tools[plumb_test::slot(noise.below(static_cast<int>(tools.size())))];
  LiesEpisode episode(tool, request.situation, lie, request.seed, number, request.tell);
  return episode.play(finds);
}

}  // namespace PLUMB_ABI
}  // namespace plumb_bench
