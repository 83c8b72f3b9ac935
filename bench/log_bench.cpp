// Logs: reading a ULog against the same as CSV, and the monitor on the way; the start of the tool.
#include <benchmark/benchmark.h>
#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "pairs.hpp"
#include "plumb/core/units.hpp"
#include "plumb/io/log_reader.hpp"
#include "plumb/io/log_writer.hpp"
#ifdef PLUMB_TOOL_PATH
#include "plumb/session/monitor_pipeline.hpp"
#endif

extern char** environ;

namespace {

using namespace plumb;

constexpr std::size_t kRows = 100000;

/// The paper's tool, a new attitude every 32 rows, six digits behind the point as a recorder prints them; as CSV and
/// ULog. Removed at the end.
class Logs {
 public:
  Logs() {
    array_ = io::read_array_file(PLUMB_SOURCE_DIR "/examples/paper_tool.toml");
    char name[] = "/tmp/plumb-bench-XXXXXX";
    if (!array_ || mkdtemp(name) == nullptr) return;
    directory_ = name;
    sound_ = write(csv()) && write(ulog());
  }
  ~Logs() {
    for (const std::string& path : {csv(), ulog()}) (void)std::remove(path.c_str());
    (void)rmdir(directory_.c_str());
  }
  Logs(const Logs&) = delete;
  Logs& operator=(const Logs&) = delete;

  bool sound() const { return sound_; }
  const io::ArrayFile& array() const { return *array_; }
  std::string csv() const { return directory_ + "/log.csv"; }
  std::string ulog() const { return directory_ + "/log.ulg"; }

 private:
  bool write(const std::string& path) const {
    auto writer = io::LogWriter::create(path, *array_);
    if (!writer) return false;
    std::mt19937_64 engine(1);
    std::normal_distribution<double> noise;
    for (std::size_t k = 0; k < kRows; ++k) {
      const double a = 0.7 * std::floor(static_cast<double>(k) / 32.0);
      const Vec3 g = {std::sin(a) * kG0_mps2 * 0.6, std::sin(a) * kG0_mps2 * 0.8, std::cos(a) * kG0_mps2};
      Sample s;
      s.time_s = 0.01 * static_cast<double>(k);
      s.temperature_degc = 25.0;
      s.delivered = array_->array.all();
      for (int i = 0; i < array_->array.size(); ++i) {
        const double volts = 3.0 / kG0_mps2 * (dot(array_->array.axis(i), g) + 2e-3 * noise(engine));
        s.raw[static_cast<std::size_t>(i)] = std::round(volts * 1e6) * 1e-6;
      }
      if (!writer->write(s)) return false;
    }
    return writer->commit().has_value();
  }

  io::FileExpected<io::ArrayFile> array_;
  std::string directory_;
  bool sound_ = false;
};

const std::shared_ptr<Logs>& logs() {
  static const std::shared_ptr<Logs> both = std::make_shared<Logs>();
  return both;
}

/// The whole log so many times.
plumb_bench::Runs reading(bool ulog) {
  const std::shared_ptr<Logs> both = logs();
  if (!both->sound()) return {};
  return [both, ulog](std::size_t count) {
    for (std::size_t k = 0; k < count; ++k) {
      auto reader = io::LogReader::open(ulog ? both->ulog() : both->csv(), both->array(), io::BadRowPolicy::stop);
      Sample sample;
      double sum = 0.0;
      while (reader && reader->next(sample) == io::LogReader::Next::row) sum += sample.raw[0];
      benchmark::DoNotOptimize(sum);
    }
  };
}

const plumb_bench::Enrolled kReading{
    {"log: a ULog row, read", "the same as CSV", 5.0, [] {
       return plumb_bench::Contest{reading(true), reading(false), static_cast<double>(kRows)};
     }}};

#ifdef PLUMB_TOOL_PATH
/// The same as `plumb monitor` does it, for whom nothing but a change would be printed.
plumb_bench::Runs monitoring(bool ulog) {
  const std::shared_ptr<Logs> both = logs();
  if (!both->sound()) return {};
  const auto calibration = std::make_shared<Calibration>();
  calibration->array = both->array().array;
  calibration->model = both->array().datasheet.model();
  calibration->report.temperature_min_degc = MonitorConfig{}.temperature_min_degc;  // of any temperature
  calibration->report.temperature_max_degc = MonitorConfig{}.temperature_max_degc;
  return [both, calibration, ulog](std::size_t count) {
    for (std::size_t k = 0; k < count; ++k) {
      const auto stepper = session::make_stepper(both->array(), calibration.get());
      const auto run = session::run_stepper(*stepper, both->array(), {ulog ? both->ulog() : both->csv()}, {});
      if (!run || run->samples != kRows) std::abort();
    }
  };
}

plumb_bench::Contest monitored(bool ulog, plumb_bench::Runs rival) {
  return {monitoring(ulog), std::move(rival), static_cast<double>(kRows)};
}
const plumb_bench::Enrolled kMonitored{{"log: a CSV row, read and monitored, processor time", "reading alone",
                                        1.0 / 1.6, [] { return monitored(false, reading(false)); },
                                        plumb_bench::Clock::program}};
const plumb_bench::Enrolled kMonitoredByTheClock{{"log: a CSV row, read and monitored, by the clock", "reading alone",
                                                  1.0 / 1.6, [] { return monitored(false, reading(false)); },
                                                  plumb_bench::Clock::wall}};
const plumb_bench::Enrolled kMonitoredUlog{{"log: a ULog row, read and monitored, processor time", "the same as CSV",
                                            0.0, [] { return monitored(true, monitoring(false)); },
                                            plumb_bench::Clock::program}};
const plumb_bench::Enrolled kMonitoredUlogByTheClock{
    {"log: a ULog row, read and monitored, by the clock", "the same as CSV", 0.0,
     [] { return monitored(true, monitoring(false)); }, plumb_bench::Clock::wall}};
#endif

void BM_LogRead(benchmark::State& state) {
  const plumb_bench::Runs runs = reading(state.range(0) != 0);
  if (!runs) return state.SkipWithError("no log");
  for (auto _ : state) runs(1);
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(kRows));
}
BENCHMARK(BM_LogRead)->ArgName("ulog")->Arg(0)->Arg(1)->Unit(benchmark::kMillisecond);

#ifdef PLUMB_TOOL_PATH
/// Least and median wall time of `plumb --version`, in ms: the whole start, with loading and libraries.
std::vector<plumb_bench::Figure> startup() {
  std::vector<double> times;
  for (int k = 0; k < 31; ++k) {
    std::string words[] = {PLUMB_TOOL_PATH, "--version"};
    char* argv[] = {words[0].data(), words[1].data(), nullptr};
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
    const auto begin = std::chrono::steady_clock::now();
    pid_t id = 0;
    int status = 0;
    const bool ran = posix_spawn(&id, argv[0], &actions, nullptr, argv, environ) == 0 && waitpid(id, &status, 0) == id;
    times.push_back(std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count());
    posix_spawn_file_actions_destroy(&actions);
    if (!ran || status != 0) return {};
  }
  std::sort(times.begin(), times.end());
  return {{"start of the tool (plumb --version), least of 31", times.front(), 30.0, "ms"},
          {"start of the tool, median of 31", times[times.size() / 2], 30.0, "ms"}};
}
const plumb_bench::Enrolled kStartup{plumb_bench::Figures(startup)};
#endif

}  // namespace
