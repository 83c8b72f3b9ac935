// Any text as an array file: refused in words, or an array that a monitor can be made of.
#include "files.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace plumb;
  const auto read = io::parse_array_text(std::string(reinterpret_cast<const char*>(data), size), "array.toml");
  if (!read) {
    fuzz::demand_told(read.error());
    return 0;
  }
  const SensorArray& array = read->array;
  fuzz::demand(array.size() >= 3 && array.size() <= kCapacity, "a number of sensors that plumb takes");
  for (int i = 0; i < array.size(); ++i) {
    fuzz::demand(std::fabs(norm(array.axis(i)) - 1.0) < 1e-3, "axes of unit length");
    fuzz::demand(array.sigma_mps2(i) > 0.0, "noise above zero");
  }
  fuzz::demand(read->input.sensor_columns.size() == static_cast<std::size_t>(array.size()), "a column for each sensor");
  if (array.size() > 4) return 0;  // a monitor of many sensors takes milliseconds to set up
  auto setup = std::make_unique<MonitorSetup>();
  setup->gravity = read->gravity;
  setup->config = read->monitor;
  setup->stability = read->stability;
  if (!set_datasheet(read->datasheet, *setup)) return 0;
  auto monitor = std::make_unique<HealthMonitor>();
  if (!monitor->configure(*setup)) return 0;
  Sample s;
  s.delivered = array.all();
  for (int k = 0; k < 8; ++k) {
    s.time_s = 0.01 * k;
    fuzz::demand_sound(monitor->step(s));
  }
  return 0;
}
