// Arbitrary bytes as samples and requests of a host, from power-on or from trust: `step` takes any bit pattern, and
// what holds after every step holds; the same input gives the same verdicts; `failed` ends by the key alone.
#include "monitor.hpp"

namespace {

using namespace plumb;

/// One sample: as the truth has it, scaled by the input, or arbitrary bits.
Sample next_sample(fuzz::Bytes& in, const MonitorSetup& setup, double& time_s, std::uint8_t kind) {
  const double step_s = (kind & 4U) != 0 ? in.take<double>() : 0.01;
  time_s += step_s;
  const double tilt = 0.02 * in.take<std::uint8_t>(), turn = 0.025 * in.take<std::uint8_t>();
  Sample s = fuzz::sample_at(
      setup, time_s,
      {9.80665 * std::sin(tilt) * std::cos(turn), 9.80665 * std::sin(tilt) * std::sin(turn), 9.80665 * std::cos(tilt)});
  if ((kind & 8U) != 0) {
    const std::size_t i = in.take<std::uint8_t>() % 4U;
    s.raw[i] = (kind & 16U) != 0 ? in.take<double>() : s.raw[i] + 0.05 * in.take<std::int8_t>();
  }
  if ((kind & 32U) != 0) s.delivered = SensorSet(in.take<std::uint32_t>());
  if ((kind & 64U) != 0) s.temperature_degc = in.take<double>();
  if ((kind & 128U) != 0) s.station = in.take<std::uint8_t>();
  return s;
}

void ask(fuzz::Bytes& in, HealthMonitor& monitor, bool& key_was_given) {
  const auto what = in.take<std::uint8_t>();
  switch (what % 6U) {
    case 0: {
      const bool bit = (in.take<std::uint8_t>() & 1U) != 0;
      if (what < 192U) {
        monitor.inhibit(bit);
      } else {
        monitor.set_motion({bit, SensorSet(in.take<std::uint32_t>())});
      }
      break;
    }
    case 1: (void)monitor.set_gravity({in.take<double>(), in.take<double>(), GravityModel::value}); break;
    case 2: {
      const bool turning = (in.take<std::uint8_t>() & 1U) != 0;
      (void)monitor.set_rotation({turning, true, {in.take<double>(), in.take<double>(), in.take<double>()}});
      break;
    }
    case 3: (void)monitor.request_recalibration(); break;
    case 4: (void)monitor.offer_calibration(monitor.model(), monitor.array()); break;
    default: {
      const std::uint64_t key = (in.take<std::uint8_t>() & 1U) != 0 ? monitor.config().reset_key : 1U;
      key_was_given = monitor.reset(key, SensorSet(in.take<std::uint32_t>())).has_value() || key_was_given;
    }
  }
}

/// Plays the input; what came out of it, as one number.
std::uint64_t play(fuzz::Bytes in, HealthMonitor& monitor) {
  static const MonitorSetup setup = fuzz::four_sensors();
  const auto start = in.take<std::uint8_t>();
  monitor = fuzz::trusted_monitor();
  if ((start & 1U) != 0) fuzz::demand(monitor.configure(setup).has_value(), "the setup is taken");
  double time_s = monitor.verdict().time_s;
  std::uint64_t seen = 0;
  for (int k = 0; k < 200 && !in.empty(); ++k) {
    const auto kind = in.take<std::uint8_t>();
    bool key_was_given = false;
    if ((kind & 3U) == 3U) ask(in, monitor, key_was_given);
    const bool was_failed = monitor.verdict().state == HealthState::failed;
    Sample s = next_sample(in, setup, time_s, kind);
    const int times = (kind & 3U) == 2U ? 8 : 1;  // stands still for two blocks
    for (int n = 0; n < times; ++n) {
      if (n > 0) s.time_s = time_s += 0.01;
      const Verdict& v = monitor.step(s);
      fuzz::demand_sound(v);
      std::uint64_t bits = 0;
      std::memcpy(&bits, &v.statistic, sizeof bits);
      seen = seen * 1099511628211ULL + bits + static_cast<std::uint64_t>(v.state) + v.excluded.bits;
    }
    if (was_failed && !key_was_given) fuzz::demand(monitor.verdict().state == HealthState::failed, "failed is latched");
  }
  return seen;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static auto monitor = std::make_unique<HealthMonitor>();
  const std::uint64_t once = play({data, size}, *monitor);
  fuzz::demand(play({data, size}, *monitor) == once, "the same input, the same verdicts");
  return 0;
}
