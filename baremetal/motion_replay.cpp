// The replay of a flight, in the place of that of a tool: a monitor of motion, sample by sample.
#include "motion_recording.hpp"
#include "replay.hpp"

namespace metal {
inline namespace PLUMB_ABI {
namespace {

/// Behind the states of a monitor at rest (judge.cpp).
constexpr std::uint64_t kInMotion = 6;

// Static, as an instrument would have them.
plumb::MotionSetup setup;
plumb::MotionMonitor monitor;

bool configure(WordReader& in, std::size_t& n, std::uint64_t& rows) noexcept {
  std::uint64_t magic = 0, sensors = 0;
  in.word(magic);
  in.word(sensors);
  in.word(rows);
  if (magic != kMotionMagic || sensors < 3 || sensors > plumb::kCapacity) return false;
  n = static_cast<std::size_t>(sensors);
  double sigma_mps2 = 0.0;
  in.number(sigma_mps2);
  plumb::SensorRow row[plumb::kCapacity];
  for (std::size_t i = 0; i < n; ++i) {
    const char id[] = {'a', static_cast<char>('1' + i), '\0'};
    row[i].id = plumb::make_id(id);
    for (double& part : row[i].axis) in.number(part);
    row[i].sigma_mps2 = sigma_mps2;
  }
  transfer_motion_setup(in, setup, n);
  setup.gyros = plumb::kGyros;
  const plumb::Expected<plumb::SensorArray> array = plumb::SensorArray::make(row, static_cast<int>(n));
  return array && monitor.configure(*array, setup) && !in.ran_short();
}

/// The force is asked for bit for bit; its bound rests on a quantile, which the C library's functions give.
void put_force(Answers& out, const plumb::SpecificForce& force) noexcept {
  out.exact.word(static_cast<std::uint64_t>(force.validity) << 32U | force.used.bits);
  for (const double part : force.force_mps2) out.exact.number(part);
  out.figures.number(force.bound_mps2);
}

void put_verdict(Answers& out, const plumb::MotionVerdict& v) noexcept {
  out.exact.word(static_cast<std::uint64_t>(v.cause) << 32U | (v.alarm ? 2U : 0U) | (v.gyros_disagree ? 1U : 0U));
  out.exact.word(static_cast<std::uint64_t>(v.suspects.bits) << 32U | v.rejected.bits);
  out.exact.word(static_cast<std::uint64_t>(v.isolated.bits) << 32U | v.excluded.bits);
  put_force(out, v.sample);
  if (v.block_ended) put_force(out, v.block);
}

/// The longest blocks that end with the sample before the last of so many.
Work work_of(std::uint64_t samples) noexcept {
  if (samples % 256U == 1U) return Work::longest_block;
  if (samples % 32U == 1U) return Work::block;
  return samples % 4U == 1U ? Work::short_block : Work::sample;
}

}  // namespace

int replay(const std::uint64_t* recording, std::size_t size, Answers& answers, WordWriter* costs,
           Clock clock) noexcept {
  WordReader in(recording, size);
  std::size_t n = 0;
  std::uint64_t rows = 0;
  if (!configure(in, n, rows)) return 1;
  plumb::MotionSample sample;
  sample.delivered = plumb::SensorSet::first(static_cast<int>(n));
  sample.rate_given = {true, true};
  for (std::uint64_t k = 0; k < rows; ++k) {
    transfer_motion_row(in, sample, n);
    if (in.ran_short()) return 3;
    const std::uint32_t a = clock != nullptr ? clock() : 0, b = clock != nullptr ? clock() : 0;
    monitor.step(sample);
    const std::uint32_t ticks = clock != nullptr ? clock() - b : 0;
    put_verdict(answers, monitor.verdict());
    if (costs == nullptr) continue;
    costs->word(kInMotion << 8U | static_cast<std::uint64_t>(work_of(k + 1)));
    costs->word(ticks);
    costs->word(b - a);
  }
  return answers.exact.full() || answers.figures.full() ? 6 : 0;
}

std::size_t monitor_size() noexcept { return sizeof monitor; }

}  // namespace PLUMB_ABI
}  // namespace metal
