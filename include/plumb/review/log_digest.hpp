/// What is kept of a log while it is read: moments of short blocks, so that a log of any length fits into memory that
/// is bounded beforehand.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "plumb/logs/csv_log.hpp"
#include "plumb/logs/flight_log.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace review {

using logs::Axes;

/// The readings of one source within one block of time. Sums of squares are of deviations from the mean, so that
/// gravity does not cost digits.
struct SourceBlock {
  std::int64_t index = 0;  ///< block k lasts from k to k + 1 block lengths of the log's clock
  std::uint32_t records = 0;
  std::uint32_t rates = 0;         ///< records with a rate
  std::uint32_t temperatures = 0;  ///< records with a temperature
  double weight = 0.0;             ///< readings behind: more than the records where those are means with a variance
  Axes mean_mps2{};
  Axes squares_m2ps4{};
  Axes least_mps2{}, most_mps2{};
  std::array<std::uint64_t, 3> clipped{};
  Axes rate_radps{};              ///< the mean of the records with a rate
  double rate_squares = 0.0;      ///< rad^2/s^2, the mean square of the length of the rate
  double temperature_degc = 0.0;  ///< the mean

  /// Standard deviation of single readings; 0 where fewer than two are there.
  double deviation_mps2(std::size_t axis) const noexcept;
  /// Takes in the readings of another block.
  void add(const SourceBlock& other) noexcept;
};

/// Intervals between records, eight bins to an octave: the usual one and what is lost in gaps, whatever the length.
class Intervals {
 public:
  void add(double interval_s) noexcept;
  /// The median, as the mean of the bin that it falls in; NaN without one.
  double usual_s() const noexcept;
  /// Of intervals above `times` the usual one: how many, and the time beyond the usual interval.
  struct Gaps {
    std::uint64_t count = 0;
    double lost_s = 0.0;
  };
  Gaps gaps(double times) const noexcept;

 private:
  static constexpr int kPerOctave = 8;
  static constexpr int kLeast = -20;  ///< octaves of a second: from a microsecond
  static constexpr int kMost = 24;    ///< to half a year
  struct Bin {
    std::uint64_t count = 0;
    double sum_s = 0.0;
  };
  std::array<Bin, static_cast<std::size_t>((kMost - kLeast) * kPerOctave)> bins_{};
  std::uint64_t count_ = 0;
};

/// A gap is longer than this many usual intervals.
constexpr double kGapIntervals = 5.0;

/// Records in a row in which an axis reads the same, but for the rounding of 32-bit numbers.
struct StillRun {
  std::uint64_t records = 0;
  double from_s = 0.0, to_s = 0.0;
  double value_mps2 = 0.0;
};

struct SourceDigest {
  logs::ImuSource source;
  std::vector<SourceBlock> blocks;  ///< in order of time, gaps left out
  std::uint64_t records = 0;
  std::uint64_t unreadable = 0;                            ///< without a time or an axis: left out
  std::uint64_t backwards = 0;                             ///< older than the record before
  double first_s = logs::kAbsent, last_s = logs::kAbsent;  ///< the least and the greatest time
  Intervals intervals;
  double longest_gap_s = 0.0, longest_gap_at_s = 0.0;
  std::array<StillRun, 4> longest_still{};  ///< of x, y, z, and of all three at once (with the value of x)
};

/// What the autopilot said of one of its accelerometers.
struct StatusDigest {
  std::uint64_t device_id = 0;  ///< 0: `instance` says which
  int instance = -1;
  StillRun failed;                            ///< the most reports in a row that call it failed
  std::map<std::int64_t, double> apart_mps2;  ///< by block: the least inconsistency within it
  double vibration_mps2 = 0.0;                ///< the most that three reports in a row reach
  double vibration_at_s = logs::kAbsent;
  int vibration_axis = -1;
};

struct Note {
  std::uint64_t offset = 0;
  std::string what;
};

struct LogDigest {
  std::string name;
  std::string understood;  ///< how, where a log does not say itself: the layout of a table; else empty
  double block_s = 1.0;
  std::vector<SourceDigest> sources;
  std::vector<StatusDigest> statuses;
  std::map<std::string, double> parameters;  ///< of accelerometers: CAL_ACC*, TC_A*, INS_ACC*, INS_USE*
  std::vector<Note> notes;
  logs::LogExtent extent;
};

/// Most blocks that are kept of one source: 2.3 MB.
constexpr std::size_t kMostBlocks = 16384;

/// Keeps what a reader tells, without its records. Where a log has more blocks than `most_blocks`, all of them become
/// twice as long, as often as it takes.
class LogDigester final : public logs::LogSink {
 public:
  explicit LogDigester(std::size_t most_blocks = kMostBlocks)
      : most_blocks_(most_blocks > 2 ? most_blocks : 2) {}  // one before the zero of time, one after it
  void source(std::size_t number, const logs::ImuSource& source) override;
  void record(std::size_t number, const logs::ImuRecord& record) override;
  /// The first value counts: it is the one that the log was taken with. Changes and what is no number are noted.
  void parameter(const std::string& name, double value) override;
  void note(std::uint64_t offset, const std::string& what) override;
  void detected(const std::string& what) override { digest_.understood = what; }
  void status(const logs::ChipStatus& status) override;
  LogDigest take(std::string name, const logs::LogExtent& extent);

 private:
  /// A source while it is read. A map: times that jump to and fro must not cost more than others.
  struct Reading {
    std::map<std::int64_t, SourceBlock> blocks;
    double last_s = logs::kAbsent;
    std::array<StillRun, 4> still{};  ///< that go on
    Axes still_at_mps2 = logs::kAbsentAxes;
  };
  /// What is being said of one while the log is read.
  struct Saying {
    StillRun failed;
    std::array<Axes, 2> last_vibration_mps2{};
  };
  static void follow_vibration(const logs::ChipStatus& status, Saying& now, StatusDigest& digest);
  static void follow_still(const logs::ImuRecord& record, Reading& reading, SourceDigest& digest);
  void double_blocks();

  std::size_t most_blocks_;
  LogDigest digest_;
  std::vector<Reading> readings_;
  std::vector<Saying> sayings_;  ///< as `LogDigest::statuses`
};

/// Reads any log that `logs::read_log` knows; `table` is what is known of a table beforehand. Refused where that
/// refuses it.
io::FileExpected<LogDigest> digest_log(const std::string& path, const logs::CsvHints& table = {});

}  // namespace review
}  // namespace PLUMB_ABI
}  // namespace plumb
