// From files to verdicts: an array file, a calibration and a log, as the tool reads them.
#include <cstdio>

#include "plumb/health/health_monitor.hpp"
#include "plumb/io/calibration_file.hpp"
#include "plumb/io/log_reader.hpp"

int main(int argc, char** argv) {
  if (argc != 4) return std::printf("usage: read_files ARRAY.toml CALIBRATION.json LOG.csv\n"), 2;
  const auto array = plumb::io::read_array_file(argv[1]);
  if (!array) return std::printf("%s\n", array.error().text().c_str()), 3;
  const auto file = plumb::io::read_calibration(argv[2], *array);
  const auto log = plumb::io::read_log(argv[3], *array, plumb::io::BadRowPolicy::skip);
  if (!file || !log) return std::printf("%s\n", (file ? log.error() : file.error()).text().c_str()), 3;
  plumb::MonitorSetup setup;
  setup.model = file->calibration.model;
  setup.array = file->calibration.array;
  setup.gravity = array->gravity;
  setup.config = array->monitor;
  static plumb::HealthMonitor monitor;
  if (!monitor.configure(setup)) return 3;
  for (const plumb::Sample& sample : log->samples) monitor.step(sample);
  std::printf("%zu rows, %s, %s\n", log->samples.size(), plumb::to_string(monitor.verdict().state),
              plumb::to_string(monitor.verdict().validity));
}
