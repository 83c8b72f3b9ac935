// Logs of flight controllers: bytes a second of one processor, for the readers alone and for what a review keeps.
#include <benchmark/benchmark.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <string>

#include "../tests/logs/dataflash_bytes.hpp"
#include "../tests/logs/ulog_bytes.hpp"
#include "plumb/review/log_digest.hpp"

namespace {

using namespace plumb;

constexpr int kInstants = 200000;  ///< 200 s at 1 kHz, three accelerometers and another message: some 50 MB

std::string ulog() {
  using namespace ulog_bytes;
  std::string out = header(0) + flags() +
                    format(
                        "sensor_accel:uint64_t timestamp;uint64_t timestamp_sample;uint32_t device_id;float x;float "
                        "y;float z;float temperature;uint32_t error_count;uint8_t[3] clip_counter;uint8_t samples;") +
                    format("other:uint64_t timestamp;float[20] x;");
  for (int chip = 0; chip < 3; ++chip) out += subscription(chip, chip, "sensor_accel");
  out += subscription(0, 9, "other");
  const std::string rest = f32(30.0F) + u32(0) + u8(0) + u8(0) + u8(0) + u8(1);
  const std::string other(80, '\x01');
  for (int k = 0; k < kInstants; ++k) {
    const std::string time = u64(static_cast<std::uint64_t>(k) * 1000U);
    for (int chip = 0; chip < 3; ++chip) {
      const float x = 0.01F * static_cast<float>((k + chip) % 7);
      out += data(chip, time + time + u32(static_cast<std::uint64_t>(500 + chip)) + f32(x, -x, -9.81F + x) + rest);
    }
    out += data(9, time + other);
  }
  return out;
}

std::string dataflash() {
  dataflash_bytes::Log log;
  log.fmt(129, "IMU", "QBffffffIIfBBHH", "TimeUS,I,GyrX,GyrY,GyrZ,AccX,AccY,AccZ,EG,EA,T,GH,AH,GHz,AHz");
  log.fmt(130, "ATT", "Qffff", "TimeUS,Roll,Pitch,Yaw,ErrRP");
  for (int k = 0; k < kInstants; ++k) {
    const double time_us = 1000.0 * k;
    for (int chip = 0; chip < 3; ++chip) {
      const double x = 0.01 * ((k + chip) % 7);
      log.message(129, {time_us, static_cast<double>(chip), 0.1, 0.2, 0.3, x, -x, -9.81 + x, 0.0, 0.0, 30.0, 1.0, 1.0,
                        1000.0, 1000.0});
    }
    log.message(130, {time_us, 1.0, 2.0, 3.0, 4.0});
  }
  return log.bytes();
}

/// In the directory of temporary files, and gone with it.
class File {
 public:
  explicit File(const std::string& bytes)
      : path_("/tmp/plumb-flight-log-" + std::to_string(::getpid())), size_(bytes.size()) {
    std::ofstream(path_, std::ios::binary) << bytes;
  }
  File(const File&) = delete;
  File& operator=(const File&) = delete;
  ~File() { std::remove(path_.c_str()); }
  const std::string& path() const { return path_; }
  std::size_t size() const { return size_; }

 private:
  std::string path_;
  std::size_t size_;
};

struct Ignored final : logs::LogSink {
  void source(std::size_t, const logs::ImuSource&) override {}
  void record(std::size_t, const logs::ImuRecord& record) override { sum += record.specific_force_mps2[2]; }
  void parameter(const std::string&, double) override {}
  void note(std::uint64_t, const std::string&) override {}
  double sum = 0.0;
};

void read(benchmark::State& state, const std::string& bytes) {
  const File file(bytes);
  for (auto _ : state) {
    Ignored sink;
    const auto extent = logs::read_log(file.path(), sink);
    if (!extent || extent->records != 3U * kInstants) state.SkipWithError("the log was not read to its end");
    benchmark::DoNotOptimize(sink.sum);
  }
  state.SetBytesProcessed(static_cast<std::int64_t>(state.iterations() * file.size()));
}

void BM_ReadUlog(benchmark::State& state) { read(state, ulog()); }
void BM_ReadDataflash(benchmark::State& state) { read(state, dataflash()); }

void BM_DigestUlog(benchmark::State& state) {
  const File file(ulog());
  for (auto _ : state) benchmark::DoNotOptimize(review::digest_log(file.path()));
  state.SetBytesProcessed(static_cast<std::int64_t>(state.iterations() * file.size()));
}

BENCHMARK(BM_ReadUlog)->Unit(benchmark::kMillisecond);
BENCHMARK(BM_ReadDataflash)->Unit(benchmark::kMillisecond);
BENCHMARK(BM_DigestUlog)->Unit(benchmark::kMillisecond);

}  // namespace
