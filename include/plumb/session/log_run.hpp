/// The rows of a log to the arrays of one tool, in one pass.
#pragma once

#include <vector>

#include "plumb/io/array_file.hpp"
#include "plumb/io/log_reader.hpp"
#include "plumb/session/log_spec.hpp"
#include "plumb/session/stepper.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace session {

/// Takes the rows of one array.
class RowTaker {
 public:
  RowTaker() = default;
  RowTaker(const RowTaker&) = delete;
  RowTaker& operator=(const RowTaker&) = delete;
  virtual ~RowTaker() = default;
  virtual io::FileExpected<void> take(const stepping::Rows& rows) = 0;
};

/// How a log ended for one array.
struct LogEnd {
  io::LogStatistics log;
  bool interrupted = false;
  bool stopped = false;  ///< in an error; what came before counts
  io::FileError stop;
};

/// One array of a tool and who takes its rows.
struct LogShare {
  const io::ArrayFile* array = nullptr;
  RowTaker* taker = nullptr;
  LogEnd end;
};

/// Reads the log once. One array gets its rows in batches of a file, one by one of a stream. Several get them in step,
/// one by one: those of one time in the order of `shares`. An error of the log ends the share whose reader it stops;
/// the others go on. Errors: the log cannot be opened, or lacks a column of an array; those of a taker.
io::FileExpected<void> run_log(const LogSpec& log, std::vector<LogShare>& shares);

}  // namespace session
}  // namespace PLUMB_ABI
}  // namespace plumb
