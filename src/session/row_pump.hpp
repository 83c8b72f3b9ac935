/// Rows of a log in batches. Of a file, a thread of its own reads ahead of who works on them, a few batches and no
/// more; where no thread can be had, the batch is read when it is asked for. Of a live stream every row is handed on as
/// it comes.
#pragma once

#include <array>
#include <condition_variable>
#include <cstdint>
#include <exception>
#include <mutex>
#include <thread>

#include "plumb/io/log_reader.hpp"
#include "plumb/session/log_spec.hpp"
#include "plumb/session/stepper.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace session {

/// True of pipes, terminals and files that are followed: somebody may be waiting for what follows from the last row.
bool is_live(const LogSpec& log);

class RowPump {
 public:
  /// The reader is the pump's until `next` has returned null, or the pump is gone.
  RowPump(io::LogReader& reader, const io::ArrayFile& array, bool live);
  ~RowPump();
  RowPump(const RowPump&) = delete;
  RowPump& operator=(const RowPump&) = delete;

  /// The next rows, at least one, valid until the next call; null where there are none left.
  const stepping::Rows* next();
  /// After null: `end`, or `error` where the log ended in one.
  io::LogReader::Next ended() const noexcept { return status_; }

 private:
  static constexpr std::size_t kBatchRows = 1024;  ///< some 64 kB of four sensors: they stay in the cache
  static constexpr std::uint64_t kBatches = 16;
  static constexpr std::size_t kApart = 128;  ///< two lines of a cache, for a neighbour may be fetched along

  void fill(stepping::Rows& rows, std::size_t most);
  void read_ahead() noexcept;

  io::LogReader& reader_;
  const io::ArrayFile& array_;
  std::array<stepping::Rows, kBatches> batches_;
  alignas(kApart) Sample sample_;  ///< written for every row: no line with what the other thread reads
  io::LogReader::Next status_ = io::LogReader::Next::row;  ///< of the last row that was asked for

  alignas(kApart) std::mutex mutex_;  ///< over what follows, and over handing on a batch
  std::condition_variable moved_;
  std::array<stepping::Rows*, kBatches> free_{};    ///< the one that came back last is filled next: it is in a cache
  std::array<stepping::Rows*, kBatches> filled_{};  ///< one after the other, round and round
  std::size_t free_count_ = 0;
  std::uint64_t filled_count_ = 0, taken_ = 0;  ///< batches
  stepping::Rows* handed_out_ = nullptr;
  bool at_end_ = false, unwanted_ = false;
  std::exception_ptr failure_;
  std::size_t at_a_time_ = 1;  ///< rows, where there is no thread
  std::thread thread_;         ///< none of a live stream
};

}  // namespace session
}  // namespace PLUMB_ABI
}  // namespace plumb
