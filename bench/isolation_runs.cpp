#include "isolation_runs.hpp"

#include "isolation_rivals.hpp"
#include "support/isolation_trials.hpp"

namespace plumb_bench {
namespace PLUMB_ABI {

using namespace plumb_test;

namespace {

constexpr int kStations = 8;
constexpr int kPool = 60;  ///< fitted tools that the trials share
constexpr int kFitStations = 60;

std::vector<TrialTool> tools_for(const SoundnessJob& job, TrialNoise& noise) {
  std::vector<TrialTool> tools;
  if (!job.fitted) {
    tools.push_back(exact_tool(job.n, 0));
    if (job.n > 4) tools.push_back(exact_tool(job.n, 1));
    return tools;
  }
  const int wanted = job.n <= 8 ? kPool : kPool / 10;
  for (int k = 0; k < 3 * wanted && static_cast<int>(tools.size()) < wanted; ++k) {
    TrialTool tool = fitted_tool(job.n, k % 2, kFitStations, noise);
    if (tool.array.size() == job.n) tools.push_back(tool);
  }
  return tools;
}

Count plain(const TrialCount& c) { return {c.trials, c.correct, c.undecided, c.wrong}; }

TrialEpisode episode_of(const TrialTool& tool, const RatesJob& job, TrialNoise& noise) {
  constexpr FaultLaw kLaw[] = {FaultLaw::bias, FaultLaw::stuck, FaultLaw::colluding, FaultLaw::mirrored};
  return TrialEpisode(tool, job.faults, kLaw[static_cast<std::size_t>(job.lie)], job.least * kTrialSigma_mps2,
                      job.most * kTrialSigma_mps2, noise);
}

/// The samples of one block, and their mean.
StationSamples sampled(const TrialTool& tool, TrialEpisode& episode, const plumb::Vec3& g, TrialNoise& noise) {
  StationSamples out;
  const int n = tool.array.size();
  const plumb::Readings still = episode.readings(g, noise);
  out.sample.assign(static_cast<std::size_t>(kTrialSamples), still);
  for (plumb::Readings& y : out.sample) {
    for (int i = 0; i < n; ++i) {
      y[slot(i)] += tool.array.sigma_mps2(i) * noise.normal();
      out.block.mean_mps2[slot(i)] += y[slot(i)] / kTrialSamples;
    }
  }
  out.block.usable = tool.array.all();
  out.block.samples = kTrialSamples;
  return out;
}

}  // namespace

SoundCount soundness(const SoundnessJob& job) {
  TrialNoise noise(job.seed);
  const std::vector<TrialTool> tools = tools_for(job, noise);
  Soundness sum;
  for (std::uint64_t t = 0; t < job.trials && !tools.empty(); ++t) {
    const TrialTool& tool = tools[t % tools.size()];
    const double error = noise.sign() * noise.between(job.least_gravity, job.most_gravity);
    soundness_trial(tool, error, job.healthy, job.stations > 0 ? job.stations : 1 + noise.below(4), noise, sum);
  }
  return {sum.trials, sum.votes,        sum.strict,   sum.strict_right,
          sum.parity, sum.parity_asked, sum.asserted, sum.asserted_asked};
}

RuleCounts eight_attitudes(const RatesJob& job) {
  TrialNoise noise(job.seed);
  const TrialTool tool = exact_tool(job.n);
  Rivals rivals(tool.array, tool.gravity.g_mps2, kStations, static_cast<int>(kTrialSamples));
  std::array<TrialCount, kRules> count;
  for (std::uint64_t t = 0; t < job.trials; ++t) {
    TrialEpisode episode = episode_of(tool, job, noise);
    plumb::Isolation isolation = tool.monitored;
    plumb::IsolationAnswer answer;
    bool blamed = false;
    rivals.clear();
    for (int k = 0; k < kStations; ++k) {
      const double length = tool.gravity.g_mps2 + job.gravity_error * tool.gravity.sigma_mps2;
      const plumb::Vec3 g = plumb::scaled(noise.direction(), length);
      const StationSamples station = sampled(tool, episode, g, noise);
      rivals.add(station);
      answer = isolation.vote({tool.array, tool.gravity, tool.limits, station.block});
      blamed = blamed || !episode.faulty().contains(answer.strict);
    }
    for (int r = 0; r < kRules; ++r) {
      const auto rule = static_cast<Rule>(r);
      const plumb::SensorSet named = rule == Rule::strict ? answer.strict : rivals.answer(rule);
      count[slot(r)].add(episode.faulty(), named, rule == Rule::strict && blamed);
    }
  }
  RuleCounts out;
  for (int r = 0; r < kRules; ++r) out[slot(r)] = plain(count[slot(r)]);
  return out;
}

Count parity_at_one_station(const RatesJob& job) {
  TrialNoise noise(job.seed);
  const TrialTool tool = exact_tool(job.n);
  TrialCount count;
  for (std::uint64_t t = 0; t < job.trials; ++t) {
    TrialEpisode episode = episode_of(tool, job, noise);
    plumb::Isolation isolation = tool.monitored;
    const plumb::Vec3 g = plumb::scaled(noise.direction(), tool.gravity.g_mps2);
    const plumb::IsolationAnswer answer =
        isolation.vote({tool.array, tool.gravity, tool.limits, episode.block(g, noise)});
    count.add(episode.faulty(), answer.parity, false);
  }
  return plain(count);
}

Count asserted_at_one_block(const RatesJob& job) {
  TrialNoise noise(job.seed);
  const TrialTool tool = exact_tool(job.n);
  TrialCount count;
  for (std::uint64_t t = 0; t < job.trials; ++t) {
    TrialEpisode episode = episode_of(tool, job, noise);
    plumb::Isolation isolation = tool.monitored;
    const plumb::Vec3 g = plumb::scaled(noise.direction(), tool.gravity.g_mps2);
    const plumb::BlockEvidence block = episode.block(g, noise);
    isolation.vote({tool.array, tool.gravity, tool.limits, block});
    const plumb::FaultSetScan scan = isolation.scan({tool.array, tool.gravity, tool.limits, block}, tool.array.all(),
                                                    job.faults, job.faults, {1, 4.9});
    count.add(episode.faulty(), scan.asserted, false);
  }
  return plain(count);
}

}  // namespace PLUMB_ABI
}  // namespace plumb_bench
