// Logs of flight controllers: bytes a second of one processor, for the readers alone and for what a review keeps.
#include <benchmark/benchmark.h>
#include <sqlite3.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <memory>
#include <string>

#include "../tests/logs/dataflash_bytes.hpp"
#include "../tests/logs/mcap_bytes.hpp"
#include "../tests/logs/ulog_bytes.hpp"
#include "plumb/review/log_digest.hpp"
#include "plumb/review/time_skew.hpp"

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

/// Chunks of 1 MB, as `ros2 bag record` writes them. Figures that change as a sensor's do: noise packs badly.
std::string mcap(const std::string& compression) {
  using namespace mcap_bytes;
  std::string out = header() + described(1, "/imu0") + described(2, "/imu1") + described(3, "/imu2");
  std::string records;
  std::uint64_t noise = 1;
  for (int k = 0; k < kInstants; ++k) {
    for (unsigned chip = 1; chip <= 3; ++chip) {
      ros_bytes::Imu imu = ros_bytes::imu_at(k);
      for (double* x : {imu.force.data(), imu.force.data() + 1, imu.force.data() + 2, imu.rate.data()}) {
        noise = noise * 6364136223846793005U + 1442695040888963407U;
        *x += 1e-3 * static_cast<double>(noise >> 48U);
      }
      records += imu_message(chip, imu);
    }
    if (records.size() < (1U << 20U) && k + 1 < kInstants) continue;
    const std::string packed = compression == "zstd" ? zstd(records) : compression == "lz4" ? lz4(records) : records;
    out += raw_chunk(records.size(), 0, compression, packed);
    records.clear();
  }
  return out + data_end() + footer();
}

/// A bag as `ros2 bag record` leaves it: one table of messages with an index of their times.
std::string rosbag2() {
  sqlite3* made = nullptr;
  sqlite3_open(":memory:", &made);
  const std::unique_ptr<sqlite3, int (*)(sqlite3*)> open(made, &sqlite3_close);
  sqlite3_exec(made,
               "CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT NOT NULL, type TEXT NOT NULL, "
               "serialization_format TEXT NOT NULL, offered_qos_profiles TEXT NOT NULL);"
               "CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER NOT NULL, timestamp INTEGER NOT NULL, "
               "data BLOB NOT NULL);CREATE INDEX timestamp_idx ON messages (timestamp ASC);"
               "INSERT INTO topics VALUES(1,'/imu0','sensor_msgs/msg/Imu','cdr',''),"
               "(2,'/imu1','sensor_msgs/msg/Imu','cdr',''),(3,'/imu2','sensor_msgs/msg/Imu','cdr','');BEGIN;",
               nullptr, nullptr, nullptr);
  sqlite3_stmt* row = nullptr;
  sqlite3_prepare_v2(made, "INSERT INTO messages(topic_id, timestamp, data) VALUES(?, ?, ?)", -1, &row, nullptr);
  for (int k = 0; k < kInstants; ++k) {
    const std::string message = ros_bytes::imu(ros_bytes::imu_at(k));
    for (int chip = 1; chip <= 3; ++chip) {
      sqlite3_bind_int(row, 1, chip);
      sqlite3_bind_int64(row, 2, 1700000000500000000 + 1000000LL * k + chip);
      sqlite3_bind_blob(row, 3, message.data(), static_cast<int>(message.size()), nullptr);
      sqlite3_step(row);
      sqlite3_reset(row);
    }
  }
  sqlite3_finalize(row);
  sqlite3_exec(made, "COMMIT;", nullptr, nullptr, nullptr);
  sqlite3_int64 size = 0;
  unsigned char* bytes = sqlite3_serialize(made, "main", &size, 0);
  std::string out(reinterpret_cast<const char*>(bytes), static_cast<std::size_t>(size));
  sqlite3_free(bytes);
  return out;
}

std::string csv() {
  std::string out = "time_s";
  for (const char* chip : {"imu0", "imu1", "imu2"}) {
    for (const char* column : {"_ax_mps2", "_ay_mps2", "_az_mps2", "_gx_degps", "_gy_degps", "_gz_degps"})
      out += std::string(",") + chip + column;
  }
  out += '\n';
  for (int k = 0; k < kInstants; ++k) {
    out += std::to_string(0.001 * k);
    for (int c = 0; c < 18; ++c) out += "," + std::to_string(0.01 * ((k + c) % 977));
    out += '\n';
  }
  return out;
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
  state.SetBytesProcessed(state.iterations() * static_cast<std::int64_t>(file.size()));
}

void BM_ReadUlog(benchmark::State& state) { read(state, ulog()); }
void BM_ReadDataflash(benchmark::State& state) { read(state, dataflash()); }
void BM_ReadMcap(benchmark::State& state) { read(state, mcap("")); }
void BM_ReadMcapZstd(benchmark::State& state) { read(state, mcap("zstd")); }
void BM_ReadMcapLz4(benchmark::State& state) { read(state, mcap("lz4")); }
void BM_ReadRosbag2(benchmark::State& state) { read(state, rosbag2()); }
void BM_ReadCsv(benchmark::State& state) { read(state, csv()); }

void BM_DigestUlog(benchmark::State& state) {
  const File file(ulog());
  for (auto _ : state) benchmark::DoNotOptimize(review::digest_log(file.path()));
  state.SetBytesProcessed(state.iterations() * static_cast<std::int64_t>(file.size()));
}

/// All that `plumb review` does with a log but its words. Nothing moves in these logs: they are not read a second time
/// for the shifts between chips.
void review_whole(benchmark::State& state, const std::string& bytes) {
  const File file(bytes);
  for (auto _ : state) {
    const auto found = review::review_file(file.path(), {});
    if (!found || found->chips.size() != 3U) state.SkipWithError("the log was not reviewed");
    benchmark::DoNotOptimize(found);
  }
  state.SetBytesProcessed(state.iterations() * static_cast<std::int64_t>(file.size()));
}

void BM_ReviewUlog(benchmark::State& state) { review_whole(state, ulog()); }
void BM_ReviewDataflash(benchmark::State& state) { review_whole(state, dataflash()); }
void BM_ReviewRosbag2(benchmark::State& state) { review_whole(state, rosbag2()); }

BENCHMARK(BM_ReadUlog)->Unit(benchmark::kMillisecond);
BENCHMARK(BM_ReadDataflash)->Unit(benchmark::kMillisecond);
BENCHMARK(BM_ReadMcap)->Unit(benchmark::kMillisecond);
BENCHMARK(BM_ReadMcapZstd)->Unit(benchmark::kMillisecond);
BENCHMARK(BM_ReadMcapLz4)->Unit(benchmark::kMillisecond);
BENCHMARK(BM_ReadRosbag2)->Unit(benchmark::kMillisecond);
BENCHMARK(BM_ReadCsv)->Unit(benchmark::kMillisecond);
BENCHMARK(BM_DigestUlog)->Unit(benchmark::kMillisecond);
BENCHMARK(BM_ReviewUlog)->Unit(benchmark::kMillisecond);
BENCHMARK(BM_ReviewDataflash)->Unit(benchmark::kMillisecond);
BENCHMARK(BM_ReviewRosbag2)->Unit(benchmark::kMillisecond);

}  // namespace
