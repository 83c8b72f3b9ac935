// ULogs that plumb writes: what a CSV holds they hold, bit for bit, and other tools see what the contract says.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <future>
#include <limits>
#include <string>
#include <vector>

#include "log_ulog_support.hpp"
#include "plumb/io/mapped_file.hpp"
#include "plumb/io/units.hpp"

namespace log_ulog_test {
namespace {

using namespace log_ulog_support;

const std::string kAllColumns =
    "time = \"t_ms\"\ntime_unit = \"ms\"\nstation = \"att\"\nroll_group = \"ring\"\ncount = \"n\"\ntemperature = "
    "\"T\"\n"
    "rotation_radps = [\"wx\", \"wy\", \"wz\"]\nwhere = {exp = 2, kind = \"still\"}";

/// An array file that names every kind of column there is.
ArrayFile everything() {
  ArrayFile out = array_of(changed("time = \"t_s\"", kAllColumns));
  out.input.second_rotation_columns = {"ux", "uy", "uz"};
  out.input.clock_columns = {"t1_ms", "t_ms", "t1_ms"};
  out.input.depth_column = "md_ft";
  out.input.depth_unit_m = 0.3048;
  return out;
}

const std::string kEverythingHead = "t_ms,att,ring,n,T,md_ft,exp,kind,wx,wy,wz,ux,uy,uz,t1_ms,a1_v,a2_v,a3_v,a4_v\n";

TEST(LogUlog, HoldsWhatACsvHolds) {
  const ArrayFile array = everything();
  const std::string rows =
      "0.1,0,-1,3,20.5,100.1,2,still,0,0,0,0,0,0,4.5,1,nan,0.30000000000000004,\n"
      "0.3,4294967294,7,1,,,2,still,0.1,0.2,0,,,,,-0,inf,,-1e-300\n"
      "0.7,-1,-1,1,,3000.7,2,still,0.1,-0.2,1e-09,0.1,0.2,0.3,4.7,,,,\n"
      "1000,5,7,1,21,-3,2,still,,,,0,0,1,1e+09,1,2,3,5e-324\n";
  const std::string csv = written("in.csv", kEverythingHead + rows);
  const std::string ulog = written("log.ulg", "");
  const std::string again = written("again.csv", "");
  convert(csv, ulog, array);
  expect_same(csv, ulog, array);
  convert(ulog, again, array);
  expect_same(csv, again, array);
  EXPECT_EQ(bytes_of(again), kEverythingHead + rows) << "to the letter";
  // The second name of the form, and the form that does not go by the name.
  const std::string other = written("log.ulog", "");
  convert(csv, other, array);
  EXPECT_EQ(bytes_of(other), bytes_of(ulog));
  const std::string unnamed = written("log.bin", "");
  auto writer = LogWriter::create(unnamed, array, LogWriter::Columns::all, LogWriter::Form::ulog);
  ASSERT_TRUE(writer.has_value() && writer->commit().has_value());
  EXPECT_EQ(bytes_of(unnamed).substr(0, 7), std::string("ULog\x01\x12\x35"));
}

TEST(LogUlog, IsReadTheSameFromAPipeAndAsAFile) {
  const ArrayFile array = array_of();
  const std::string path = written_ulog(array, some_samples(3000));
  const auto file = read_log(path, array, BadRowPolicy::stop);
  ASSERT_TRUE(file.has_value()) << file.error().text();
  const int keep = dup(STDIN_FILENO);
  ASSERT_NE(std::freopen(path.c_str(), "r", stdin), nullptr);
  const auto piped = read_log("-", array, BadRowPolicy::stop);
  ASSERT_EQ(dup2(keep, STDIN_FILENO), STDIN_FILENO);
  close(keep);
  ASSERT_TRUE(piped.has_value()) << piped.error().text();
  ASSERT_EQ(file->samples.size(), 3000U);
  ASSERT_EQ(piped->samples.size(), 3000U);
  for (std::size_t k = 0; k < 3000; ++k) ASSERT_TRUE(same(file->samples[k], piped->samples[k])) << k;
  EXPECT_EQ(file->statistics.bytes, bytes_of(path).size());
  EXPECT_EQ(piped->statistics.bytes, file->statistics.bytes);
  EXPECT_EQ(piped->statistics.hash, file->statistics.hash);
}

/// A named pipe that is opened twice waits for a second writer, who never comes.
TEST(LogUlog, APipeIsNotMapped) {
  const std::string path = written("pipe.ulg", "");
  ASSERT_EQ(::unlink(path.c_str()), 0);
  ASSERT_EQ(::mkfifo(path.c_str(), 0600), 0);
  std::future<bool> mapped = std::async(std::launch::async, [&path] { return MappedFile().open(path); });
  const bool answered = mapped.wait_for(std::chrono::seconds(5)) == std::future_status::ready;
  const int release = answered ? -1 : ::open(path.c_str(), O_RDWR);  // NOLINT(*-vararg)
  EXPECT_FALSE(mapped.get());
  EXPECT_TRUE(answered) << "it waited for a writer";
  if (release >= 0) ::close(release);
  ASSERT_EQ(::unlink(path.c_str()), 0);
}

TEST(LogUlog, BytesAreAsTheContractSays) {
  std::vector<Sample> samples(1);
  samples[0].time_s = 1.0;
  samples[0].raw = {2.0, 0.0, 0.0, 0.0};
  samples[0].delivered = SensorSet::first(1);
  const std::string log = bytes_of(written_ulog(array_of(), samples));
  EXPECT_EQ(log.substr(0, 16), std::string("ULog\x01\x12\x35\x01\0\0\0\0\0\0\0\0", 16));
  EXPECT_EQ(log.substr(16, 43), "\x28" + std::string(1, '\0') + "B" + std::string(40, '\0'));
  EXPECT_EQ(log.substr(59, 25), std::string("\x16\0I\x10", 4) + "char[5] sys_nameplumb");
  for (const char* one :
       {"uint32_t plumb_log_version\x01", "uint32_t plumb_block_rows", "char[4] plumb_column_a1_va1_v",
        "char[1] plumb_unit_a1_vV", "char[3] plumb_column_time_st_s", "char[1] plumb_unit_time_ss",
        "plumb_row:uint64_t timestamp;uint64_t present;double time_s;double a1_v;double a2_v;double "
        "a3_v;double a4_v;",
        "plumb_block:uint64_t timestamp;uint64_t first_row;uint32_t rows;uint32_t crc32;"})
    EXPECT_NE(log.find(one), std::string::npos) << one;
  const std::size_t at = header_size(log);
  // One block of one row at 1 s; the time and a1 are there.
  EXPECT_EQ(log.substr(at, 25), std::string("\x1A\0D\x01\0"
                                            "\x40\x42\x0F\0\0\0\0\0"
                                            "\0\0\0\0\0\0\0\0"
                                            "\x01\0\0\0",
                                            25));
  EXPECT_EQ(log.substr(at + 29, 37), std::string("\x3A\0D\0\0"
                                                 "\x40\x42\x0F\0\0\0\0\0"
                                                 "\x03\0\0\0\0\0\0\0"
                                                 "\0\0\0\0\0\0\xF0\x3F"
                                                 "\0\0\0\0\0\0\0\x40",
                                                 37));
  EXPECT_TRUE(std::isnan(double_at(raw(log) + at + 29 + 37))) << "what is absent is a gap in a plot";
  EXPECT_EQ(log.size(), at + 29 + kRow + 29);
  EXPECT_EQ(log.substr(log.size() - 16, 12), std::string("\x01\0\0\0\0\0\0\0\0\0\0\0", 12));
  EXPECT_EQ(crc32_of("123456789", 9), 0xCBF43926U) << "the check value of CRC-32";
  EXPECT_EQ(crc32_of("6789", 4, crc32_of("12345", 5)), 0xCBF43926U);
}

TEST(LogUlog, StampsAreWholeMicrosecondsThatNeverGoBack) {
  const double far = 1e300;
  const std::vector<double> times_s = {-2.5, -0.4e-6, 1.4e-6, 1.6e-6, 1.7e-6, 3.0, 1.6e9 + 0.25, far};
  std::vector<Sample> samples = some_samples(times_s.size());
  for (std::size_t k = 0; k < times_s.size(); ++k) samples[k].time_s = times_s[k];
  const std::string path = written_ulog(array_of(), samples);
  const std::string log = bytes_of(path);
  const std::vector<std::uint64_t> wanted = {
      0, 0, 1, 2, 2, 3000000, 1600000000250000, std::numeric_limits<std::int64_t>::max()};
  for (std::size_t k = 0; k < wanted.size(); ++k)
    EXPECT_EQ(u64_at(raw(log) + header_size(log) + kUlogBlockSize + k * kRow + kUlogRowStamp), wanted[k]) << k;
  const auto read = read_log(path, array_of(), BadRowPolicy::stop);
  ASSERT_TRUE(read.has_value()) << read.error().text();
  for (std::size_t k = 0; k < times_s.size(); ++k) EXPECT_EQ(read->samples[k].time_s, times_s[k]);
}

TEST(LogUlog, NamesThatAULogCannotHaveAreKeptBesideThoseThatItCan) {
  ArrayFile array = array_of();
  array.input.sensor_columns = {"acc x [V]", "acc_x__V_", "1\xC3\xBC", "timestamp"};
  const std::string path = written_ulog(array, some_samples(40));
  const std::string log = bytes_of(path);
  EXPECT_NE(log.find("double time_s;double acc_x__V_;double acc_x__V__2;double c1__;double timestamp_2;"),
            std::string::npos);
  EXPECT_NE(log.find("char[9] plumb_column_acc_x__V_acc x [V]"), std::string::npos);
  const auto read = read_log(path, array, BadRowPolicy::stop);
  ASSERT_TRUE(read.has_value()) << read.error().text();
  for (std::size_t k = 0; k < 40; ++k) EXPECT_TRUE(same(read->samples[k], some_samples(40)[k])) << k;
}

TEST(LogUlog, UnitsAndRateMustBeThoseOfTheArrayFile) {
  const std::string log = bytes_of(written_ulog(array_of(), some_samples(3)));
  expect_refused_log(log, "a1_v",
                     {"is in \"V\" according to the log and in \"mV\" according to the array file", "[input] unit"},
                     array_of(changed("unit = \"V\"", "unit = \"mV\"")));
  const std::string paced =
      bytes_of(written_ulog(array_of(changed("time = \"t_s\"", "rate = \"100 Hz\"")), some_samples(3)));
  expect_refused_log(paced, "rate", {"100 Hz according to the log and 50 Hz"},
                     array_of(changed("time = \"t_s\"", "rate = \"50 Hz\"")));
  expect_refused_log(log, "t_s", {"holds numbers", "without quotes"},
                     array_of(changed("time = \"t_s\"", "time = \"t_s\"\nwhere = {t_s = \"one\"}")));
  expect_refused_log(log, "a1_v", {"is in \"V\" according to the log and in \"s\" according to the array file"},
                     array_of(changed("time = \"t_s\"", "time = \"a1_v\"")));
  // Two names of one unit.
  ArrayFile mg = array_of();
  mg.input.unit = *parse_raw_unit("mg");
  ArrayFile mg0 = mg;
  mg0.input.unit = *parse_raw_unit("mg0");
  const std::string path = written_ulog(mg, some_samples(3), "mg.ulg");
  EXPECT_TRUE(read_log(path, mg0, BadRowPolicy::stop).has_value());
  EXPECT_FALSE(read_log(path, array_of(), BadRowPolicy::stop).has_value());
  // A ULog has seconds, whatever unit a CSV beside it has.
  const auto seconds =
      read_log(written("s.ulg", log), array_of(changed("time = \"t_s\"", "time = \"t_s\"\ntime_unit = \"ms\"")),
               BadRowPolicy::stop);
  ASSERT_TRUE(seconds.has_value()) << seconds.error().text();
  EXPECT_EQ(seconds->samples[2].time_s, 0.03);
}

TEST(LogUlog, ALogOfAnotherArrayIsRefusedWithTheColumnsThatDiffer) {
  const std::string log = bytes_of(written_ulog(array_of(), some_samples(3)));
  expect_refused_log(log, "b1_v",
                     {"the column is missing in the log; sensor[1].column in the array file names it", "a1_v, a2_v"},
                     array_of(changed("a1_v", "b1_v")));
}

TEST(LogUlog, RowsOfATimeAreSelectedInTheUnitOfTheArrayFile) {
  ArrayFile array = everything();
  const std::string csv = written("in.csv", kEverythingHead +
                                                "0.1,0,-1,3,20.5,1,2,still,0,0,0,0,0,0,4.5,1,2,3,4\n"
                                                "0.3,0,-1,3,20.5,2,2,still,0,0,0,0,0,0,4.7,1,2,3,4\n");
  const std::string ulog = written("log.ulg", "");
  convert(csv, ulog, array);
  for (const ColumnFilter& one : {ColumnFilter{"t_ms", "0.3", 0.3, true}, ColumnFilter{"t1_ms", "4.7", 4.7, true},
                                  ColumnFilter{"md_ft", "2", 2.0, true}, ColumnFilter{"kind", "still", 0.0, false}}) {
    array.input.where = {one};
    const auto text = read_log(csv, array, BadRowPolicy::stop);
    const auto binary = read_log(ulog, array, BadRowPolicy::stop);
    ASSERT_TRUE(text.has_value() && binary.has_value()) << one.column;
    EXPECT_EQ(binary->samples.size(), one.numeric ? 1U : 2U) << one.column;
    EXPECT_EQ(binary->samples.size(), text->samples.size()) << one.column;
    EXPECT_EQ(binary->samples.back().time_s, text->samples.back().time_s) << one.column;
  }
}

TEST(LogUlog, ColumnsThatDoNotFitAreLeftToCsv) {
  ArrayFile array = array_of();
  for (int k = 0; k < 64; ++k) array.input.where.push_back({"c" + std::to_string(k), "1", 1.0, true});
  const auto writer = LogWriter::create(written("wide.ulg", ""), array);
  ASSERT_FALSE(writer.has_value());
  EXPECT_NE(writer.error().text().find("at most 64 columns, but the array file needs 69"), std::string::npos);
  ArrayFile wordy = array_of();
  wordy.input.sensor_columns[2] = std::string(70000, 'x');
  const auto long_names = LogWriter::create(written("long.ulg", ""), wordy);
  ASSERT_FALSE(long_names.has_value());
  EXPECT_NE(long_names.error().text().find("too long for the header of a ULog"), std::string::npos);
}

double any_double() {
  static const std::vector<double> kEdges = {
      0.0, -0.0, 4.9e-324, -2.2250738585072014e-308, 1e300, HUGE_VAL, -HUGE_VAL, std::nan(""), 1.0 / 3, 9.80665};
  if (*rc::gen::inRange(0, 3) == 0) return kEdges[*rc::gen::inRange<std::size_t>(0, kEdges.size())];
  const std::uint64_t bits = *rc::gen::arbitrary<std::uint64_t>();
  double value = 0.0;
  std::memcpy(&value, &bits, sizeof value);
  return value;
}

/// At most `count`, increasing, finite, from any double to any other.
std::vector<double> any_times(std::size_t count) {
  std::vector<double> out = {*rc::gen::element(-1e300, -2.5, 0.0, 5e-324, 1.6e9)};
  for (std::size_t k = 1; k < count; ++k) {
    const double time_s = any_double();
    if (std::isfinite(time_s) && std::find(out.begin(), out.end(), time_s) == out.end()) out.push_back(time_s);
  }
  std::sort(out.begin(), out.end());
  return out;
}

Rotation any_rotation() {
  Rotation out{true, true, {any_double(), any_double(), any_double()}};
  for (const double rate : out.rate_radps) out.rate_known = out.rate_known && std::isfinite(rate);
  if (!out.rate_known) return {true, false, {}};
  out.turning = out.rate_radps != std::decay_t<decltype(out.rate_radps)>{};
  return out;
}

struct Row {
  Sample sample;
  LogWriter::Notes notes;
};

std::vector<Row> any_rows() {
  const std::vector<double> times_s = any_times(*rc::gen::inRange<std::size_t>(1, 20));
  std::vector<Row> rows(times_s.size());
  double temperature_degc = 25.0;
  for (std::size_t k = 0; k < rows.size(); ++k) {
    Sample& sample = rows[k].sample;
    LogWriter::Notes& notes = rows[k].notes;
    sample.time_s = times_s[k];
    sample.station = *rc::gen::inRange<std::uint32_t>(0U, 4294967295U);
    sample.roll_group = *rc::gen::inRange<std::uint32_t>(0U, 4294967295U);
    sample.count = *rc::gen::inRange<std::uint32_t>(1U, 4294967295U);
    const double drawn = any_double();
    notes.temperature_held = k > 0 && !std::isfinite(drawn);
    if (std::isfinite(drawn)) temperature_degc = drawn;
    sample.temperature_degc = temperature_degc;
    notes.rotation = any_rotation();
    notes.second_rotation = any_rotation();
    notes.depth_m = any_double();
    const double chip_s = any_double();
    if (!std::isinf(chip_s)) notes.clock_s[0] = notes.clock_s[2] = chip_s;
    notes.clock_s[1] = sample.time_s;
    sample.delivered = SensorSet(*rc::gen::inRange<std::uint32_t>(0U, 16U));
    for (std::size_t i = 0; i < 4; ++i) {
      if (sample.delivered.has(static_cast<int>(i))) sample.raw[i] = any_double();
    }
  }
  return rows;
}

/// Bit for bit, NaN with their bits.
bool same_bits(const Sample& a, const Sample& b) {
  return same(a, b) && std::memcmp(a.raw.data(), b.raw.data(), 4 * sizeof(double)) == 0;
}

RC_GTEST_PROP(LogUlogLaw, EveryRowComesBackBitForBit, ()) {
  static const ArrayFile array = everything();
  const std::vector<Row> rows = any_rows();
  const std::string path = written("law.ulg", "");
  auto writer = LogWriter::create(path, array, LogWriter::Columns::all);
  RC_ASSERT(writer.has_value());
  std::uint64_t held = 0;
  for (const Row& row : rows) {
    RC_ASSERT(writer->write(row.sample, row.notes).has_value());
    held += row.notes.temperature_held ? 1U : 0U;
  }
  RC_ASSERT(writer->commit().has_value());
  auto reader = LogReader::open(path, array, BadRowPolicy::stop);
  RC_ASSERT(reader.has_value());
  Sample sample;
  for (const Row& row : rows) {
    RC_ASSERT(reader->next(sample) == LogReader::Next::row);
    RC_ASSERT(same_bits(row.sample, sample));
    RC_ASSERT(same(row.notes.rotation, reader->rotation()));
    RC_ASSERT(same(row.notes.second_rotation, reader->second_rotation()));
    RC_ASSERT(same(std::isfinite(row.notes.depth_m) ? row.notes.depth_m : std::nan(""), reader->depth_m()));
    for (std::size_t c = 0; c < 3; ++c) RC_ASSERT(same(row.notes.clock_s[c], reader->clock_s()[c]));
  }
  RC_ASSERT(reader->next(sample) == LogReader::Next::end);
  RC_ASSERT(reader->statistics().temperature_held == held);
}

}  // namespace
}  // namespace log_ulog_test
