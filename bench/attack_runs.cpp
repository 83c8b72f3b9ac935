#include "attack_runs.hpp"

#include "attack_episode.hpp"

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

void AttackCount::add(const AttackCount& other) {
  constexpr std::uint64_t AttackCount::*kFields[] = {&AttackCount::episodes,
                                                     &AttackCount::ticks,
                                                     &AttackCount::usable_ticks,
                                                     &AttackCount::excluded_healthy,
                                                     &AttackCount::set_aside_healthy,
                                                     &AttackCount::beyond_level,
                                                     &AttackCount::beyond_alert,
                                                     &AttackCount::failed_healthy,
                                                     &AttackCount::broken,
                                                     &AttackCount::crowd_beyond_level,
                                                     &AttackCount::crowd_beyond_alert,
                                                     &AttackCount::beyond_bounds,
                                                     &AttackCount::failed,
                                                     &AttackCount::all_out,
                                                     &AttackCount::liars};
  for (std::uint64_t AttackCount::*field : kFields) this->*field += other.*field;
}

namespace PLUMB_ABI {
namespace {

/// New random arrays, calibrated anew, for so many episodes.
constexpr std::uint64_t kBatch = 20000;

/// The tools of n sensors that the laws are put to, and behind them some with axes that this batch alone has.
std::vector<AttackTool> tools_of(int n, std::uint64_t seed, std::uint64_t batch) {
  std::vector<AttackTool> out;
  const auto keep = [&out](plumb_test::LawTool tool) {
    const bool names = plumb::strict_grade(tool.tool.array, tool.tool.array.all()) > 0;
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

}  // namespace
}  // namespace PLUMB_ABI

AttackSum attack(const AttackJob& job) {
  using namespace PLUMB_ABI;
  AttackSum sum;
  std::array<std::vector<AttackTool>, 5> tools;
  std::uint64_t batch = ~std::uint64_t{0};
  for (std::uint64_t number = job.first; number < job.first + job.episodes; ++number) {
    if (number / kBatch != batch) {
      batch = number / kBatch;
      for (int n = 4; n <= 8; ++n) tools[plumb_test::slot(n - 4)] = tools_of(n, job.seed, batch);
    }
    plumb_test::Strata strata(number);
    const auto n = plumb_test::slot(strata.digit(5));
    const auto situation = plumb_test::slot(strata.digit(kSituations));
    const auto lie = plumb_test::slot(strata.digit(kAttackLies));
    if (job.only >= 0 && situation != plumb_test::slot(job.only)) continue;
    plumb_test::TrialNoise noise = plumb_test::stream_of(static_cast<int>(job.seed % 1000000), number);
    const AttackTool& tool = tools[n][plumb_test::slot(noise.below(static_cast<int>(tools[n].size())))];
    AttackEpisode episode(tool, static_cast<Situation>(situation), static_cast<int>(lie), job.seed, number, job.tell);
    sum.count[n][situation][lie].add(episode.play(sum.finds));
  }
  return sum;
}

}  // namespace plumb_bench
