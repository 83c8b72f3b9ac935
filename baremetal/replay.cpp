#include "replay.hpp"

#include <type_traits>

#include "plumb/core/detail/archive.hpp"

namespace metal {
inline namespace PLUMB_ABI {
namespace {

#ifndef METAL_PLAIN
#define METAL_PLAIN 0
#endif
/// Nothing is written down and read back: for a recording that asks for no power cycle, and an image without that code.
constexpr bool kPlain = METAL_PLAIN != 0;

constexpr std::size_t kSnapshotRoom = plumb::HealthMonitor::snapshot_size_max();

// Static, as an instrument would have them: none of this belongs on a stack.
plumb::MonitorSetup setup;
plumb::HealthMonitor monitor;
std::uint8_t bytes[kSnapshotRoom];

/// Reads the recording's head into `setup`; rows that follow are left to the reader.
bool read_setup(WordReader& in, std::size_t& n, std::uint64_t& rows) noexcept {
  std::uint64_t magic = 0, sensors = 0;
  in.word(magic);
  in.word(sensors);
  in.word(rows);
  if (magic != kMagic || sensors < 3 || sensors > plumb::kCapacity) return false;
  n = static_cast<std::size_t>(sensors);
  plumb::SensorRow row[plumb::kCapacity];
  for (std::size_t i = 0; i < n; ++i) {
    const char id[] = {'a', static_cast<char>('1' + i), '\0'};
    row[i].id = plumb::make_id(id);
    for (double& v : row[i].axis) in.number(v);
    in.number(row[i].sigma_mps2);
  }
  static plumb::RowUncertainty uncertainty;
  setup.model.size = static_cast<int>(n);
  transfer_setup(in, setup, uncertainty, n);
  const plumb::Expected<plumb::SensorArray> array = plumb::SensorArray::make(row, static_cast<int>(n));
  if (!array) return false;
  setup.array = *array;
  setup.array.set_uncertainty(uncertainty);
  return !in.ran_short();
}

void read_row(WordReader& in, std::size_t n, Row& row) noexcept {
  std::uint64_t delivered = 0, request = 0;
  in.number(row.sample.time_s);
  in.number(row.sample.temperature_degc);
  in.word(delivered);
  in.word(request);
  in.word(row.argument);
  for (std::size_t i = 0; i < n; ++i) in.number(row.sample.raw[i]);
  row.sample.delivered = plumb::SensorSet(static_cast<std::uint32_t>(delivered));
  row.request = static_cast<Request>(request);
}

/// An archive that takes a state apart: what counts, names or classifies goes to one side, numbers to the other.
class Apart {
 public:
  Apart(WordWriter& exact, WordWriter& figures) noexcept : exact_(exact), figures_(figures) {}
  int sensors() const noexcept { return plumb::kCapacity; }
  void fail() noexcept {}
  template <class T>
  void done(const T&) noexcept {}
  template <class T, class Check>
  void scalar(const T& value, const Check&) noexcept {
    if constexpr (std::is_floating_point_v<T>) {
      figures_.number(static_cast<double>(value));
    } else {
      exact_.word(plumb::archive_detail::bits_of(value));
    }
  }

 private:
  WordWriter& exact_;
  WordWriter& figures_;
};

/// The whole verdict. Times, sums, vectors and bounds are asked for bit for bit; limits come out of the C library's
/// functions, which differ by the last digit from one library to the next.
void put_verdict(Answers& out, const plumb::Verdict& v) noexcept {
  Apart apart(out.exact, out.figures);
  plumb::transfer(apart, v, plumb::AnyBits{});
  for (const double x : v.gravity_mps2) out.exact.number(x);
  for (const double x : v.covariance) out.exact.number(x);
  const double sums[] = {v.time_s,
                         v.mae_all_mps2,
                         v.mae_worst_mps2,
                         v.parity,
                         v.norm_error_mps2,
                         v.temperature_degc,
                         v.protection_level_calibrated_axes_rad,
                         v.toolface_protection_housing_rad};
  for (const double x : sums) out.exact.number(x);
}

/// Snapshot and restore: the size of what was written is part of the answers, and all that comes after it.
bool power_cycle(Answers& out, bool forged) noexcept {
  const plumb::Expected<std::size_t> size = monitor.snapshot(bytes, sizeof bytes);
  if (!size) return false;
  out.exact.word(*size);
  monitor = plumb::HealthMonitor{};
  if (forged) {
    bytes[*size / 2] ^= 1U;
    const plumb::Expected<void> taken = monitor.restore(setup, bytes, *size);
    if (taken || taken.error().code != plumb::Errc::snapshot_damaged) return false;
    put_verdict(out, monitor.verdict());
    bytes[*size / 2] ^= 1U;
  }
  return monitor.restore(setup, bytes, *size).has_value();
}

void put_answer(Answers& out, const plumb::Expected<void>& answer) noexcept {
  out.exact.word(answer ? 0 : static_cast<std::uint64_t>(answer.error().code));
}

/// A request that is refused is an answer like any other; false where the replay itself is broken.
bool serve(const Row& row, Answers& out) noexcept {
  switch (row.request) {
    case Request::none: return true;
    case Request::recalibrate: put_answer(out, monitor.request_recalibration()); return true;
    case Request::reset: {
      const plumb::SensorSet sensors(static_cast<std::uint32_t>(row.argument));
      put_answer(out, monitor.reset(setup.config.reset_key, sensors));
      return true;
    }
    case Request::power_cycle: return !kPlain && power_cycle(out, false);
    case Request::forged: return !kPlain && power_cycle(out, true);
    case Request::offer: put_answer(out, monitor.offer_calibration(monitor.model(), monitor.array())); return true;
  }
  return false;
}

Work work_of(const plumb::Verdict& v, std::uint32_t iterations, plumb::RecalibrationPhase phase) noexcept {
  if (monitor.recalibration().iterations() != iterations) return Work::iteration;
  if (phase == plumb::RecalibrationPhase::fitting) return Work::judgement;
  if (v.transition.sequence != 0) return Work::event;
  return v.tick ? Work::block : Work::sample;
}

plumb::RecalibrationPhase phase_of(const plumb::HealthMonitor& m) noexcept {
  return m.recalibration().progress(m.array()).phase;
}

void play_row(const Row& row, Answers& answers, WordWriter* costs, Clock clock) noexcept {
  const auto state = static_cast<std::uint64_t>(monitor.verdict().state);
  const std::uint32_t iterations = monitor.recalibration().iterations();
  const plumb::RecalibrationPhase phase = phase_of(monitor);
  std::uint32_t ticks = 0, overhead = 0;
  if (clock != nullptr) {
    const std::uint32_t a = clock(), b = clock();
    monitor.step(row.sample);
    ticks = clock() - b;
    overhead = b - a;
  } else {
    monitor.step(row.sample);
  }
  const plumb::Verdict& v = monitor.verdict();
  if (v.tick || v.transition.sequence != 0) put_verdict(answers, v);
  answers.exact.word(static_cast<std::uint64_t>(v.state) << 16U | static_cast<std::uint64_t>(v.cause));
  for (const double x : v.latest_mps2) answers.exact.number(x);
  if (costs == nullptr) return;
  costs->word(state << 8U | static_cast<std::uint64_t>(work_of(v, iterations, phase)));
  costs->word(ticks);
  costs->word(overhead);
}

}  // namespace

int replay(const std::uint64_t* recording, std::size_t size, Answers& answers, WordWriter* costs,
           Clock clock) noexcept {
  WordReader in(recording, size);
  std::size_t n = 0;
  std::uint64_t rows = 0;
  if (!read_setup(in, n, rows)) return 1;
  if (!monitor.configure(setup)) return 2;
  put_verdict(answers, monitor.verdict());
  Row row;
  for (std::uint64_t k = 0; k < rows; ++k) {
    read_row(in, n, row);
    if (in.ran_short()) return 3;
    if (!serve(row, answers)) return 4;
    play_row(row, answers, costs, clock);
  }
  // What a recalibration has left: coefficients, bit for bit.
  for (std::size_t i = 0; i < n; ++i) {
    answers.exact.number(monitor.model().sensor[i].scale[0]);
    answers.exact.number(monitor.model().sensor[i].bias[0]);
  }
  if (!kPlain && !power_cycle(answers, true)) return 5;
  return answers.exact.full() || answers.figures.full() ? 6 : 0;
}

std::size_t monitor_size() noexcept { return sizeof monitor; }

}  // namespace PLUMB_ABI
}  // namespace metal
