// Which format a log has, and the reader that it goes to.
#include <cstddef>
#include <string>
#include <string_view>
#include <utility>

#include "log_magic.hpp"
#include "plumb/io/mapped_file.hpp"
#include "plumb/logs/csv_log.hpp"
#include "plumb/logs/flight_log.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace logs {
namespace {

constexpr const char* kGiveLog = "give a log: ULog (.ulg), DataFlash (.bin), MCAP, rosbag2 (.db3) or CSV";

/// A DataFlash log may begin anywhere: chips that wrap around, and torn copies, begin within a message.
constexpr std::size_t kLookedInto = 1U << 16U;
constexpr std::string_view kDataflashFormat = "\xA3\x95\x80";

}  // namespace

const char* to_string(LogFormat format) noexcept {
  switch (format) {
    case LogFormat::ulog: return "ULog";
    case LogFormat::dataflash: return "DataFlash";
    case LogFormat::mcap: return "MCAP";
    case LogFormat::rosbag2: return "rosbag2";
    case LogFormat::csv: return "CSV";
  }
  return "";
}

io::FileExpected<LogFormat> log_format(const std::string& path) {
  const auto refuse = [&path](std::string what, std::string remedy) {
    return tl::make_unexpected(io::FileError{path, 0, "", std::move(what), std::move(remedy)});
  };
  io::MappedFile file;
  if (const auto opened = open_log(path, kGiveLog, file); !opened) return tl::make_unexpected(opened.error());
  const std::string_view begin = first_bytes(file, kLookedInto);
  if (const KnownFile* known = known_file(begin); known != nullptr) {
    switch (known->kind) {
      case FileKind::ulog: return LogFormat::ulog;
      case FileKind::dataflash: return LogFormat::dataflash;
      case FileKind::mcap: return LogFormat::mcap;
      case FileKind::sqlite: return LogFormat::rosbag2;
      case FileKind::own: return refuse(std::string(known->what) + ", and is read with its array file", known->remedy);
      case FileKind::foreign: return refuse(std::string(known->what) + ", no log that can be read", known->remedy);
    }
  }
  if (is_text(begin)) return LogFormat::csv;
  if (begin.find(kDataflashFormat) != std::string_view::npos) return LogFormat::dataflash;
  return refuse("is binary data of no known format", kGiveLog);
}

io::FileExpected<LogExtent> read_log(const std::string& path, LogSink& sink) {
  return read_log(path, CsvHints{}, sink);
}

io::FileExpected<LogExtent> read_log(const std::string& path, const CsvHints& table, LogSink& sink) {
  const auto format = log_format(path);
  if (!format) return tl::make_unexpected(format.error());
  switch (*format) {
    case LogFormat::ulog: return read_ulog(path, sink);
    case LogFormat::dataflash: return read_dataflash(path, sink);
    case LogFormat::mcap: return read_mcap(path, sink);
    case LogFormat::rosbag2: return read_rosbag2(path, sink);
    case LogFormat::csv: break;
  }
  return read_csv_log(path, table, sink);
}

}  // namespace logs
}  // namespace PLUMB_ABI
}  // namespace plumb
