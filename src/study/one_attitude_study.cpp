#include "plumb/study/one_attitude_study.hpp"

#include <algorithm>
#include <cmath>
#include <memory>

namespace plumb {
inline namespace PLUMB_ABI {
namespace study {
namespace {

/// What a rule said of a block, in the terms that both rules share.
struct Finding {
  bool alarm = false;
  SensorSet named;
};

Answer answer_of(const Finding& said, SensorSet faulty, double displacement_mps2) noexcept {
  if (!(said.named - faulty).empty()) return Answer::names_healthy;
  if (faulty.empty()) return said.alarm ? Answer::alarm_only : Answer::right;
  if (!said.alarm) return displacement_mps2 < kPaperDeltaF_mps2 ? Answer::silent_small : Answer::silent_large;
  if (faulty.size() == 1) return said.named == faulty ? Answer::right : Answer::alarm_only;
  return said.named.empty() || said.named == faulty ? Answer::right : Answer::keeps_faulty;
}

/// Mean raw values of a block.
std::array<double, kCapacity> mean_raw(const std::vector<Sample>& samples) {
  std::array<double, kCapacity> out{};
  for (const Sample& s : samples) {
    for (std::size_t i = 0; i < out.size(); ++i) out[i] += s.raw[i] / static_cast<double>(samples.size());
  }
  return out;
}

/// Largest mean error of a faulty sensor over the block [m/s^2].
double displacement_of(const Fits& fits, SensorSet faulty, const std::vector<Sample>& healthy,
                       const std::vector<Sample>& samples) {
  double most = 0.0;
  for (int i = 0; i < fits.datasheet.size; ++i) {
    if (!faulty.has(i)) continue;
    double sum = 0.0;
    const auto s = static_cast<std::size_t>(i);
    for (std::size_t k = 0; k < samples.size(); ++k) sum += std::abs(samples[k].raw[s] - healthy[k].raw[s]);
    most = std::max(most, sum / static_cast<double>(samples.size()) / std::abs(fits.own->model.sensor[s].scale[0]));
  }
  return most;
}

/// The vector that the paper's method publishes of these means with the sensors in use: the fit of all, or that of the
/// triple that remains.
Vec3 paper_estimate(const Fits& fits, SensorSet in_use, const std::array<double, kCapacity>& raw, double degc) {
  return paper_vector(fits.nominal, fits.paper_fit(in_use), raw, degc);
}

Vec3 own_estimate(const Fits& fits, SensorSet in_use, const std::array<double, kCapacity>& raw, double degc) {
  const Readings y = fits.own->model.apply(raw, degc, fits.own->array.all());
  return least_squares(fits.own->array, in_use).estimate(y);
}

using Estimate = Vec3 (*)(const Fits&, SensorSet, const std::array<double, kCapacity>&, double);

/// One block before and after the fault.
struct Block {
  const Fits& fits;
  const Table2Row& experiment;
  const std::vector<Sample>& healthy;
  const std::vector<Sample>& samples;
};

bool is_error(Answer answer) noexcept {
  return answer == Answer::silent_large || answer == Answer::names_healthy || answer == Answer::keeps_faulty;
}

/// Counts the answer; true where it was an error.
bool enter(const Block& block, const Finding& said, Estimate estimate, RuleRecord& record) {
  const double displacement = displacement_of(block.fits, block.experiment.faulty, block.healthy, block.samples);
  const Answer answer = answer_of(said, block.experiment.faulty, displacement);
  ++record.group[static_cast<std::size_t>(group_of(block.experiment))].of[static_cast<std::size_t>(answer)];
  const bool silent = answer == Answer::silent_small || answer == Answer::silent_large;
  const bool misled = answer == Answer::names_healthy || answer == Answer::keeps_faulty;
  if (!silent && !misled) return false;
  // By the same sensors without the fault, so that only the fault shows and no frame has to be matched.
  const SensorSet in_use = block.fits.nominal.all() - said.named;
  const double degc = block.samples.front().temperature_degc;
  const double tilt = angle_between_rad(estimate(block.fits, in_use, mean_raw(block.samples), degc),
                                        estimate(block.fits, in_use, mean_raw(block.healthy), degc));
  double& largest = silent ? record.largest_silent_tilt_rad : record.largest_misled_tilt_rad;
  largest = std::max(largest, tilt);
  if (silent) record.largest_silent_mps2 = std::max(record.largest_silent_mps2, displacement);
  return is_error(answer);
}

Finding ask_paper(const Fits& fits, const std::vector<Sample>& samples) {
  const PaperFit no_rest;
  const PaperFits read_by{fits.nominal, *fits.paper, no_rest};
  PaperRule rule;
  for (const Sample& s : samples)
    rule.add(read_by, study_gravity().g_mps2, s.raw, s.temperature_degc, fits.nominal.all());
  const PaperFinding finding = rule.finding(read_by, kPaperDeltaF_mps2, fits.nominal.all());
  return {finding.detected, finding.isolated};
}

/// An alarm is whatever keeps the monitor from calling all sensors healthy.
Finding ask_monitor(HealthMonitor& monitor, const std::vector<Sample>& samples) {
  Finding out;
  for (const Sample& s : samples) {
    const Verdict& verdict = monitor.step(s);
    out.named = out.named | verdict.excluded | verdict.provisionally_excluded;
  }
  out.alarm = monitor.verdict().state != HealthState::nominal || monitor.verdict().validity != Validity::valid;
  return out;
}

}  // namespace

FaultGroup group_of(const Table2Row& experiment) noexcept {
  if (experiment.faulty.empty()) return FaultGroup::none;
  if (experiment.faulty.size() > 1) return FaultGroup::two_random;
  return experiment.level == Level::random ? FaultGroup::one_random : FaultGroup::one_fixed;
}

const char* to_string(FaultGroup group) noexcept {
  switch (group) {
    case FaultGroup::none: return "no fault";
    case FaultGroup::one_fixed: return "one sensor at 0, -3, +3 V";
    case FaultGroup::one_random: return "one sensor random";
    case FaultGroup::two_random: return "two sensors random";
  }
  return "unknown";
}

std::uint64_t AnswerCount::trials() const noexcept {
  std::uint64_t sum = 0;
  for (const std::uint64_t n : of) sum += n;
  return sum;
}

AnswerCount RuleRecord::faulty() const noexcept {
  AnswerCount sum;
  for (std::size_t g = 0; g < group.size(); ++g) {
    if (static_cast<FaultGroup>(g) == FaultGroup::none) continue;
    for (std::size_t a = 0; a < sum.of.size(); ++a) sum.of[a] += group[g].of[a];
  }
  return sum;
}

StudyExpected<OneAttitudeStudy> one_attitude_study(const Fits& fits, const scenario::Tool& tool, std::uint64_t seed,
                                                   RandomLaw law, int attitudes) {
  const StudyExpected<Survey> healthy = record(survey_run(tool, seed, Part::one_attitude, attitudes, kBlock));
  if (!healthy) return tl::unexpected<std::string>(healthy.error());
  const StudyExpected<ProvenMonitor> proven = proven_monitor(fits, tool, seed);
  if (!proven) return tl::unexpected<std::string>(proven.error());
  const std::uint64_t levels = scenario::derive_seed(seed, static_cast<std::uint64_t>(Part::one_attitude));
  auto monitor = std::make_unique<HealthMonitor>();
  OneAttitudeStudy out;
  out.law = law;
  out.attitudes = attitudes;
  for (std::size_t a = 0; a < healthy->attitude.size(); ++a) {
    const std::vector<Sample> clean = proven->continued(healthy->attitude[a], 0);
    bool paper_errs = false;
    bool own_errs = false;
    for (std::size_t e = 0; e < kTable2.size(); ++e) {
      if (law == RandomLaw::anew && kTable2[e].level != Level::random) continue;
      const std::uint64_t draw = scenario::derive_seed(levels, a * kTable2.size() + e);
      const StudyExpected<std::vector<Sample>> samples = with_fault(tool, kTable2[e], law, draw, clean);
      if (!samples) return tl::unexpected<std::string>(samples.error());
      const Block block = {fits, kTable2[e], clean, *samples};
      const bool counts = group_of(kTable2[e]) == FaultGroup::one_fixed;
      paper_errs |= enter(block, ask_paper(fits, *samples), paper_estimate, out.paper) && counts;
      *monitor = *proven->monitor;
      own_errs |= enter(block, ask_monitor(*monitor, *samples), own_estimate, out.own) && counts;
    }
    if (paper_errs) ++out.paper.attitudes_in_error;
    if (own_errs) ++out.own.attitudes_in_error;
  }
  return out;
}

}  // namespace study
}  // namespace PLUMB_ABI
}  // namespace plumb
