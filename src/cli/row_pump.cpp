#include "row_pump.hpp"

#include <sys/stat.h>
#include <unistd.h>

namespace plumb {
inline namespace PLUMB_ABI {
namespace cli {

bool is_live(const LogSpec& log) {
  if (log.follow) return true;
  struct stat facts {};
  const bool known = (log.path == "-" ? ::fstat(STDIN_FILENO, &facts) : ::stat(log.path.c_str(), &facts)) == 0;
  return !known || !S_ISREG(facts.st_mode);
}

RowPump::RowPump(io::LogReader& reader, const io::ArrayFile& array, bool live) : reader_(reader), array_(array) {
  for (stepping::Rows& rows : batches_) rows.sensors = array.array.size();
  if (!live) thread_ = std::thread([this] { read_ahead(); });
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

/// At most so many rows, fewer where the log ends.
void RowPump::fill(stepping::Rows& rows, std::size_t most) {
  rows.clear();
  const bool turns = !array_.input.rotation_columns.empty(), has_depth = !array_.input.depth_column.empty();
  while (rows.row.size() < most) {
    status_ = reader_.next(sample_);
    if (status_ != io::LogReader::Next::row) return;
    rows.row.push_back({sample_.time_s, sample_.temperature_degc, sample_.delivered.bits, sample_.station,
                        sample_.count, sample_.roll_group});
    rows.raw.insert(rows.raw.end(), sample_.raw.begin(), sample_.raw.begin() + rows.sensors);
    if (has_depth) rows.depth_m.push_back(reader_.depth_m());
    if (!turns) continue;
    const Rotation& rotation = reader_.rotation();
    rows.turn.push_back({rotation.turning, rotation.rate_known, rotation.rate_radps});
  }
}

void RowPump::read_ahead() noexcept {
  for (;;) {
    {
      std::unique_lock<std::mutex> lock(mutex_);
      moved_.wait(lock, [this] { return unwanted_ || filled_ - taken_ < kBatches; });
      if (unwanted_) return;
    }
    std::exception_ptr failure;
    try {
      fill(batch(filled_), kBatchRows);
    } catch (...) {  // out of memory: told by the thread that asks for the rows
      failure = std::current_exception();
    }
    const bool last = failure != nullptr || status_ != io::LogReader::Next::row;
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      failure_ = failure;
      if (!failure && !batch(filled_).row.empty()) ++filled_;
      at_end_ = last;
    }
    moved_.notify_all();
    if (last) return;
  }
}

const stepping::Rows* RowPump::next() {
  if (!thread_.joinable()) {
    if (status_ == io::LogReader::Next::row) fill(batches_.front(), 1);
    return status_ == io::LogReader::Next::row ? &batches_.front() : nullptr;
  }
  std::unique_lock<std::mutex> lock(mutex_);
  if (handed_out_) {
    ++taken_;
    handed_out_ = false;
    moved_.notify_all();
  }
  moved_.wait(lock, [this] { return at_end_ || filled_ > taken_; });
  if (filled_ > taken_) {
    handed_out_ = true;
    return &batch(taken_);
  }
  if (failure_) std::rethrow_exception(failure_);
  return nullptr;
}

}  // namespace cli
}  // namespace PLUMB_ABI
}  // namespace plumb
