// Any text as a calibration file of the paper's tool. Its checksum is made true first: what it guards against is an
// accident, and an accident is not what a fuzzer makes.
#include "../src/io/calibration_json.hpp"
#include "files.hpp"
#include "plumb/io/calibration_file.hpp"

namespace {

std::string with_true_checksum(std::string text) {
  const nlohmann::json probe = nlohmann::json::parse(text, nullptr, false);
  if (probe.is_discarded() || !probe.is_object()) return text;
  plumb::io::Json root = plumb::io::Json::parse(text, nullptr, false);
  root["checksum"] = plumb::io::checksum_of(root);
  return root.dump();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace plumb;
  const std::string text = with_true_checksum(std::string(reinterpret_cast<const char*>(data), size));
  const fuzz::MemoryFile file(reinterpret_cast<const std::uint8_t*>(text.data()), text.size());
  const auto read = io::read_calibration(file.path(), fuzz::paper_tool());
  if (!read) {
    fuzz::demand_told(read.error());
    return 0;
  }
  auto setup = std::make_unique<MonitorSetup>();
  setup->model = read->calibration.model;
  setup->array = read->calibration.array;
  setup->gravity = fuzz::paper_tool().gravity;
  auto monitor = std::make_unique<HealthMonitor>();
  if (!monitor->configure(*setup)) return 0;
  Sample s;
  s.delivered = setup->array.all();
  for (int k = 0; k < 64; ++k) {
    s.time_s = 0.01 * k;
    for (std::size_t i = 0; i < 4; ++i) s.raw[i] = 1.0 + 1e-4 * k;
    fuzz::demand_sound(monitor->step(s));
  }
  return 0;
}
