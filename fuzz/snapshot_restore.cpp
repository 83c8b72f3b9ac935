// Arbitrary bytes for a snapshot, and a true snapshot with arbitrary places overwritten whose check sum is made true
// again: refused with a cause and not yet validated, or a monitor that goes on soundly.
#include "monitor.hpp"
#include "plumb/core/detail/archive.hpp"

namespace {

using namespace plumb;

void seal(std::vector<std::uint8_t>& bytes) {
  Crc64 crc;
  crc.add(bytes.data(), bytes.size() - 8);
  for (std::size_t k = 0; k < 8; ++k) bytes[bytes.size() - 8 + k] = static_cast<std::uint8_t>(crc.value() >> (8 * k));
}

void offer(const std::vector<std::uint8_t>& bytes) {
  static const MonitorSetup setup = fuzz::four_sensors();
  static auto monitor = std::make_unique<HealthMonitor>();
  const Expected<void> taken = monitor->restore(setup, bytes.data(), bytes.size());
  if (!taken) {
    fuzz::demand(taken.error().code != Errc::ok, "a refusal has a cause");
    fuzz::demand((monitor->verdict().qualifiers & Qualifier::not_yet_validated) != 0, "refused: not yet validated");
  }
  double time_s = monitor->verdict().time_s;
  if (!(time_s - time_s == 0.0)) time_s = 0.0;
  for (int k = 0; k < 16; ++k) {
    time_s += 0.01;
    fuzz::demand_sound(monitor->step(fuzz::sample_at(setup, time_s, {0.0, 0.0, 9.80665})));
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const std::vector<std::uint8_t> whole = [] {
    const HealthMonitor& trusted = fuzz::trusted_monitor();
    std::vector<std::uint8_t> bytes(trusted.snapshot_size());
    fuzz::demand(trusted.snapshot(bytes.data(), bytes.size()).has_value(), "a snapshot is written");
    return bytes;
  }();
  if (size == 0) return 0;
  if ((data[0] & 1U) != 0) {  // as they come
    offer({data + 1, data + size});
    return 0;
  }
  std::vector<std::uint8_t> bytes = whole;
  fuzz::Bytes in(data + 1, size - 1);
  while (!in.empty()) {
    const auto at = in.take<std::uint16_t>();
    const auto length = static_cast<std::size_t>(in.take<std::uint8_t>() % 9U);
    for (std::size_t k = 0; k < length && !in.empty(); ++k)
      bytes[(28U + at + k) % (bytes.size() - 8)] = in.take<std::uint8_t>();
  }
  seal(bytes);
  offer(bytes);
  return 0;
}
