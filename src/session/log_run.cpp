#include "plumb/session/log_run.hpp"

#include <memory>
#include <utility>

#include "plumb/session/interrupt.hpp"
#include "plumb/session/progress.hpp"
#include "row_pump.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace session {
namespace {

/// A share with its reader, while that has rows.
class Source {
 public:
  Source(io::LogReader reader, LogShare& share, bool live)
      : reader_(std::make_unique<io::LogReader>(std::move(reader))), share_(share) {
    pump_ = std::make_unique<RowPump>(*reader_, *share.array, live);
    advance();
  }
  bool has_rows() const noexcept { return rows_ != nullptr; }
  double time_s() const noexcept { return rows_->row.front().time_s; }
  io::FileExpected<void> take() { return share_.taker->take(*rows_); }
  const stepping::Rows& rows() const noexcept { return *rows_; }
  void advance() {
    rows_ = pump_->next();
    if (rows_ != nullptr) return;
    LogEnd& end = share_.end;
    end.log = reader_->statistics();
    end.interrupted = interrupted();
    end.stopped = pump_->ended() == io::LogReader::Next::error;
    if (end.stopped) end.stop = reader_->error();
    pump_.reset();
    reader_.reset();  // nothing is kept for it any longer
  }

 private:
  std::unique_ptr<io::LogReader> reader_;
  std::unique_ptr<RowPump> pump_;
  LogShare& share_;
  const stepping::Rows* rows_ = nullptr;
};

/// The earliest time that a row waits for; false where none does.
bool earliest(const std::vector<Source>& sources, double& time_s) {
  bool any = false;
  for (const Source& source : sources) {
    if (!source.has_rows() || (any && source.time_s() >= time_s)) continue;
    time_s = source.time_s();
    any = true;
  }
  return any;
}

}  // namespace

io::FileExpected<void> run_log(const LogSpec& log, std::vector<LogShare>& shares) {
  std::vector<const io::ArrayFile*> arrays;
  for (const LogShare& share : shares) arrays.push_back(share.array);
  io::FileExpected<std::vector<io::LogReader>> readers = io::LogReader::open(log.path, arrays, log.on_bad_row);
  if (!readers) return tl::unexpected<io::FileError>(readers.error());
  const bool row_by_row = shares.size() > 1 || is_live(log);
  std::vector<Source> sources;
  for (io::LogReader& reader : *readers) {
    reader.stop_when(interrupt_flag());
    if (log.follow) reader.follow();
    if (log.hash) reader.hash_bytes();
  }
  for (std::size_t k = 0; k < shares.size(); ++k) sources.emplace_back(std::move((*readers)[k]), shares[k], row_by_row);
  Progress progress("monitoring " + log.path);
  std::uint64_t rows = 0;
  for (double time_s = 0.0; earliest(sources, time_s);) {
    for (Source& source : sources) {
      if (!source.has_rows() || source.time_s() > time_s) continue;
      if (&source == &sources.front()) rows += source.rows().row.size();
      const io::FileExpected<void> taken = source.take();
      if (!taken) return taken;
    }
    progress.at(rows, time_s);
    for (Source& source : sources) {
      if (source.has_rows() && source.time_s() <= time_s) source.advance();
    }
  }
  return {};
}

}  // namespace session
}  // namespace PLUMB_ABI
}  // namespace plumb
