#include "row_pump.hpp"

#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <system_error>

namespace plumb {
inline namespace PLUMB_ABI {
namespace session {

bool is_live(const LogSpec& log) {
  if (log.follow) return true;
  struct stat facts {};
  const bool known = (log.path == "-" ? ::fstat(STDIN_FILENO, &facts) : ::stat(log.path.c_str(), &facts)) == 0;
  return !known || !S_ISREG(facts.st_mode);
}

RowPump::RowPump(io::LogReader& reader, const io::ArrayFile& array, bool live) : reader_(reader), array_(array) {
  for (stepping::Rows& rows : batches_) {
    rows.sensors = array.array.size();
    rows.clocks = static_cast<int>(array.input.clock_columns.size());
    free_[free_count_++] = &rows;
  }
  if (live) return;
  at_a_time_ = kBatchRows;
  try {
    thread_ = std::thread([this] { read_ahead(); });
  } catch (const std::system_error&) {
    // There is no thread to be had, in a page for one: who works on the rows reads them.
  }
}

RowPump::~RowPump() {
  if (!thread_.joinable()) return;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    unwanted_ = true;
  }
  moved_.notify_all();
  thread_.join();
}

/// At most so many rows, fewer where the log ends. The vectors keep their length from
/// batch to batch, so that a row is written where it stands; only the last batch is cut.
void RowPump::fill(stepping::Rows& rows, std::size_t most) {
  const auto sensors = static_cast<std::size_t>(rows.sensors), clocks = static_cast<std::size_t>(rows.clocks);
  const bool turns = !array_.input.rotation_columns.empty(), has_depth = !array_.input.depth_column.empty();
  const bool turns_twice = !array_.input.second_rotation_columns.empty();
  const auto turn_of = [](const Rotation& r) { return stepping::Turn{r.turning, r.rate_known, r.rate_radps}; };
  rows.resize(most, turns, has_depth, turns_twice);
  std::size_t k = 0;
  for (; k < most; ++k) {
    status_ = reader_.next(sample_);
    if (status_ != io::LogReader::Next::row) break;
    rows.row[k] = {sample_.time_s, sample_.temperature_degc, sample_.delivered.bits, sample_.station,
                   sample_.count,  sample_.roll_group};
    std::copy_n(sample_.raw.data(), sensors, rows.raw.data() + k * sensors);
    if (has_depth) rows.depth_m[k] = reader_.depth_m();
    if (clocks > 0) std::copy_n(reader_.clock_s().begin(), clocks, rows.clock_s.data() + k * clocks);
    if (turns) rows.turn[k] = turn_of(reader_.rotation());
    if (turns_twice) rows.second_turn[k] = turn_of(reader_.second_rotation());
  }
  if (k < most) rows.resize(k, turns, has_depth, turns_twice);
}

void RowPump::read_ahead() noexcept {
  for (;;) {
    stepping::Rows* rows = nullptr;
    {
      std::unique_lock<std::mutex> lock(mutex_);
      moved_.wait(lock, [this] { return unwanted_ || free_count_ > 0; });
      if (unwanted_) return;
      rows = free_[--free_count_];
    }
    std::exception_ptr failure;
    try {
      fill(*rows, kBatchRows);
    } catch (...) {  // out of memory: reported by the thread that asks for the rows
      failure = std::current_exception();
    }
    const bool last = failure != nullptr || status_ != io::LogReader::Next::row;
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      failure_ = failure;
      if (!failure && !rows->row.empty()) filled_[filled_count_++ % kBatches] = rows;
      at_end_ = last;
    }
    moved_.notify_all();
    if (last) return;
  }
}

const stepping::Rows* RowPump::next() {
  if (!thread_.joinable()) {
    if (status_ != io::LogReader::Next::row) return nullptr;
    fill(batches_.front(), at_a_time_);
    return batches_.front().row.empty() ? nullptr : &batches_.front();
  }
  std::unique_lock<std::mutex> lock(mutex_);
  if (handed_out_ != nullptr) {
    free_[free_count_++] = handed_out_;
    handed_out_ = nullptr;
    moved_.notify_all();
  }
  moved_.wait(lock, [this] { return at_end_ || filled_count_ > taken_; });
  if (filled_count_ > taken_) {
    handed_out_ = filled_[taken_++ % kBatches];
    return handed_out_;
  }
  if (failure_) std::rethrow_exception(failure_);
  return nullptr;
}

}  // namespace session
}  // namespace PLUMB_ABI
}  // namespace plumb
