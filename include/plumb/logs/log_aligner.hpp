/// Several sources of a log as rows: the instants of one source, the readings of the others interpolated to them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <vector>

#include "plumb/logs/flight_log.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace logs {

enum class Alignment : std::uint8_t {
  linear,   ///< between the records before and after
  nearest,  ///< the record that is nearest: values stay as they were logged
};

/// What is aligned, and how far a record may be away.
struct AlignedSource {
  std::size_t number = 0;      ///< of the log
  double longest_gap_s = 0.0;  ///< between two records: across a longer one nothing is interpolated
};

/// A row: what each source reads at `time_s`, absent across a gap and before and after a source's records.
struct AlignedRow {
  double time_s = 0.0;
  std::vector<ImuRecord> readings;  ///< in the order of the sources
};

/// Takes a log in any order of sources, as a reader hands it on, and gives rows in order of time. It waits for the
/// sources that come later, for kMostWaiting records at most: what a source that stopped would have said is absent
/// then. Records that are not newer than the last one of their source are left out and counted.
class LogAligner final : public LogSink {
 public:
  static constexpr std::size_t kMostWaiting = 65536;
  /// Rows are at the instants of `sources[reference]`. `take` false: no more rows are wanted.
  LogAligner(std::vector<AlignedSource> sources, std::size_t reference, Alignment how,
             std::function<bool(const AlignedRow&)> take);

  void source(std::size_t, const ImuSource&) override {}
  void record(std::size_t number, const ImuRecord& record) override;
  void parameter(const std::string&, double) override {}
  void note(std::uint64_t, const std::string&) override {}
  /// The log has ended: gives the rows that still wait.
  void finish();

  std::uint64_t rows() const noexcept { return rows_; }
  std::uint64_t left_out() const noexcept { return left_out_; }
  bool stopped() const noexcept { return stopped_; }
  /// Mean distance from the instants to the nearest record of a source: the skew that is interpolated away.
  double mean_distance_s(std::size_t source) const noexcept;

 private:
  struct Waiting {
    AlignedSource source;
    std::deque<ImuRecord> records;
    double distances_s = 0.0;
    std::uint64_t distances = 0;
  };
  bool ready(double time_s) const noexcept;
  void give();
  ImuRecord reading_at(Waiting& waiting, double time_s);

  std::vector<Waiting> waiting_;
  std::size_t reference_;
  Alignment how_;
  std::function<bool(const AlignedRow&)> take_;
  std::uint64_t rows_ = 0, left_out_ = 0;
  bool stopped_ = false;
};

}  // namespace logs
}  // namespace PLUMB_ABI
}  // namespace plumb
