// A table of text, row by row. How it is laid out is found in csv_layout, what a line of ArduPilot is in csv_long.
#include "plumb/logs/csv_log.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "csv_cells.hpp"
#include "csv_layout.hpp"
#include "csv_long.hpp"
#include "csv_records.hpp"
#include "log_magic.hpp"
#include "plumb/io/mapped_file.hpp"
#include "plumb/io/printable.hpp"
#include "text_lines.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace logs {
namespace {

constexpr const char* kGiveTable = "give a table of text with a row of names (CSV)";
constexpr std::size_t kSampledLines = 400;
constexpr std::uint64_t kSampledBytes = 1U << 18U;
constexpr int kMostInstances = 64;

std::string stem_of(const std::string& path) {
  const std::size_t slash = path.find_last_of('/');
  const std::string name = path.substr(slash == std::string::npos ? 0 : slash + 1);
  return name.substr(0, std::min(name.find_last_of('.'), name.size()));
}

CsvSample sample_of(io::MappedFile& file, const std::string& path) {
  CsvSample out;
  out.stem = stem_of(path);
  TextLines lines(file);
  std::string_view line;
  while (out.lines.size() < kSampledLines && lines.offset() < kSampledBytes && lines.next(line)) {
    const bool is_row = !lines.is_too_long() && (lines.has_end() || out.lines.size() < 2);
    out.lines.emplace_back(is_row ? line : std::string_view());
  }
  return out;
}

const char* words_of(TextLines::Encoding encoding) noexcept {
  switch (encoding) {
    case TextLines::Encoding::utf8: return "text";
    case TextLines::Encoding::utf16_le: return "text in UTF-16 (little-endian)";
    case TextLines::Encoding::utf16_be: return "text in UTF-16 (big-endian)";
  }
  return "";
}

/// A table with a row a time.
class CsvWide {
 public:
  CsvWide(CsvLayout layout, double rate_hz, CsvNotes& notes, CsvRecords& records)
      : layout_(std::move(layout)), rate_hz_(rate_hz), notes_(notes), records_(records) {
    for (const CsvSource& source : layout_.sources) {
      for (const CsvColumns* columns : {&source.force, &source.rate})
        for (const std::size_t c : *columns) last_ = c == kNoColumn ? last_ : std::max(last_, c);
    }
    for (const std::size_t c : {layout_.time, layout_.nanoseconds}) last_ = c == kNoColumn ? last_ : std::max(last_, c);
  }

  void take(std::string_view line, bool is_whole, std::uint64_t offset, std::uint64_t number);

 private:
  using Cells = std::vector<std::string_view>;

  bool refuse(CsvTroubleKind trouble, std::uint64_t offset, std::uint64_t line, const std::string& what);
  bool time_of(std::uint64_t offset, std::uint64_t line, std::int64_t& out_ns);
  /// False where it has none at this time, or one that is no number.
  bool force_of(const CsvSource& source, std::uint64_t offset, std::uint64_t line, Axes& out);
  double number_in(std::size_t column) const;
  bool name_of(const CsvSource& source, std::uint64_t offset, std::uint64_t line, ImuSource& out);

  CsvLayout layout_;
  double rate_hz_;
  CsvNotes& notes_;
  CsvRecords& records_;
  Cells cells_;
  std::size_t last_ = 0;  ///< of the columns that are read
  std::uint64_t rows_ = 0;
};

bool CsvWide::refuse(CsvTroubleKind trouble, std::uint64_t offset, std::uint64_t line, const std::string& what) {
  if (notes_.wanted(trouble, offset))
    notes_.say(offset, "line " + std::to_string(line) + ": " + what + ", the row is left out");
  return false;
}

double CsvWide::number_in(std::size_t column) const {
  double value = kAbsent;
  if (column == kNoColumn || parse_number(cells_[column], layout_.dialect.decimal, value) != CellKind::number)
    return kAbsent;
  return value;
}

bool CsvWide::time_of(std::uint64_t offset, std::uint64_t line, std::int64_t& out_ns) {
  if (layout_.time == kNoColumn) {
    out_ns = static_cast<std::int64_t>(static_cast<double>(rows_) / rate_hz_ * 1e9);
    return true;
  }
  std::int64_t rest_ns = 0;
  const bool has_rest =
      layout_.nanoseconds == kNoColumn || parse_time(cells_[layout_.nanoseconds], '.', TimeForm::nanoseconds, rest_ns);
  if (has_rest && parse_time(cells_[layout_.time], layout_.dialect.decimal, layout_.time_form, out_ns)) {
    constexpr std::int64_t kLatest_ns = 9000000000000000000;
    out_ns += std::abs(out_ns) < kLatest_ns && std::abs(rest_ns) < 1000000000 ? rest_ns : 0;
    return true;
  }
  return refuse(CsvTroubleKind::time, offset, line,
                "\"" + io::printable_line(bare(cells_[layout_.time]).substr(0, 40)) + "\" is no time");
}

bool CsvWide::force_of(const CsvSource& source, std::uint64_t offset, std::uint64_t line, Axes& out) {
  std::size_t empty = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::string_view cell = cells_[source.force[axis]];
    const CellKind kind = parse_number(cell, layout_.dialect.decimal, out[axis]);
    if (kind == CellKind::text)
      return refuse(CsvTroubleKind::cell, offset, line,
                    "\"" + io::printable_line(bare(cell).substr(0, 40)) + "\" is no number");
    empty += kind == CellKind::empty ? 1U : 0U;
    out[axis] *= source.force_factor;
  }
  if (empty == 3) return false;  // other columns have their rows at other times
  return empty == 0 || refuse(CsvTroubleKind::cell, offset, line, "an axis is empty");
}

bool CsvWide::name_of(const CsvSource& source, std::uint64_t offset, std::uint64_t line, ImuSource& out) {
  out.name = source.name;
  out.instance = source.instance;
  out.uncalibrated = source.uncalibrated;
  if (source.name.find("mean") != std::string::npos) out.kind = RecordKind::mean;
  if (layout_.device != kNoColumn) {
    const std::string_view cell = bare(cells_[layout_.device]);
    (void)std::from_chars(cell.data(), cell.data() + cell.size(), out.device_id);
  }
  if (layout_.instance == kNoColumn) return true;
  const double instance = number_in(layout_.instance);
  if (!(instance >= 0.0 && instance < kMostInstances))
    return refuse(CsvTroubleKind::source, offset, line, "no chip has this instance");
  out.instance = static_cast<int>(instance);
  out.name += "[" + std::to_string(out.instance) + "]";
  return true;
}

void CsvWide::take(std::string_view line, bool is_whole, std::uint64_t offset, std::uint64_t number) {
  const std::string_view begin = bare(line);
  if (begin.empty() || begin[0] == '#' || begin[0] == '%' || begin.substr(0, 2) == "//") return;
  split(line, layout_.dialect.separator, cells_);
  const std::size_t columns = layout_.header.size();
  while (cells_.size() > columns && bare(cells_.back()).empty()) cells_.pop_back();
  if (!is_whole && cells_.size() <= last_ + 1)
    return (void)refuse(CsvTroubleKind::line, offset, number, "the last line has no end and may be cut");
  if (cells_.size() + 1 == columns && last_ + 1 < columns) cells_.emplace_back();
  if (cells_.size() != columns)
    return (void)refuse(CsvTroubleKind::line, offset, number,
                        std::to_string(cells_.size()) + " cells, the header has " + std::to_string(columns));
  std::int64_t time_ns = 0;
  if (!time_of(offset, number, time_ns)) return;
  ++rows_;
  for (const CsvSource& source : layout_.sources) {
    ImuRecord record;
    ImuSource told;
    if (!force_of(source, offset, number, record.specific_force_mps2) || !name_of(source, offset, number, told))
      continue;
    for (std::size_t axis = 0; axis < 3 && source.rate_factor > 0.0; ++axis)
      record.rate_radps[axis] = source.rate_factor * number_in(source.rate[axis]);
    record.temperature_degc = number_in(source.temperature);
    records_.take(told, time_ns, record, offset, number);
  }
}

class CsvReader {
 public:
  CsvReader(std::string path, const CsvHints& hints, LogSink& sink)
      : path_(std::move(path)), hints_(hints), sink_(sink), notes_(sink), records_(sink, notes_) {}

  io::FileExpected<LogExtent> read();

 private:
  io::FileExpected<void> open();
  template <class Rows>
  void read_rows(Rows& rows, std::uint64_t first_line);

  std::string path_;
  const CsvHints& hints_;
  LogSink& sink_;
  CsvNotes notes_;
  CsvRecords records_;
  io::MappedFile file_;
  std::uint64_t read_ = 0;
};

io::FileExpected<void> CsvReader::open() {
  if (auto opened = open_log(path_, kGiveTable, file_); !opened) return opened;
  const std::string_view begin = first_bytes(file_, kMagicBytes);
  const KnownFile* known = known_file(begin);
  if (known != nullptr)
    return tl::make_unexpected(
        io::FileError{path_, 0, "", std::string(known->what) + ", no table of text", known->remedy});
  if (!is_text(begin))
    return tl::make_unexpected(io::FileError{path_, 0, "", "is binary data, no table of text", kGiveTable});
  return {};
}

template <class Rows>
void CsvReader::read_rows(Rows& rows, std::uint64_t first_line) {
  TextLines lines(file_);
  std::string_view line;
  while (lines.next(line)) {
    read_ = lines.end();
    if (lines.number() < first_line) continue;
    if (!lines.is_too_long()) {
      rows.take(line, lines.has_end(), lines.offset(), lines.number());
    } else if (notes_.wanted(CsvTroubleKind::line, lines.offset())) {
      notes_.say(lines.offset(), "line " + std::to_string(lines.number()) + " is longer than 1 MiB, it is left out");
    }
  }
}

io::FileExpected<LogExtent> CsvReader::read() {
  const auto refuse = [this](const CsvTrouble& trouble) {
    return tl::make_unexpected(io::FileError{path_, static_cast<int>(trouble.line), "", trouble.what, trouble.remedy});
  };
  if (const auto sound = check(hints_); !sound) return refuse(sound.error());
  if (const auto opened = open(); !opened) return tl::make_unexpected(opened.error());
  const CsvSample sample = sample_of(file_, path_);
  const std::string text = words_of(TextLines(file_).encoding());
  if (is_long_form(sample.lines)) {
    sink_.detected(text + ", a line a message of ArduPilot");
    CsvLong rows(sink_, notes_, records_);
    read_rows(rows, 1);
  } else {
    auto layout = csv_layout(sample, hints_);
    if (!layout) return refuse(layout.error());
    sink_.detected(text + ", " + text_of(*layout));
    for (const std::string& guess : layout->guesses) {
      if (notes_.wanted(CsvTroubleKind::guess, 0)) notes_.say(0, guess);
    }
    const std::uint64_t first_line = layout->data_line;
    CsvWide rows(std::move(*layout), hints_.rate_hz, notes_, records_);
    read_rows(rows, first_line);
  }
  if (records_.records() == 0) notes_.say(0, "the table has no reading of an accelerometer that could be read");
  notes_.sum_up();
  LogExtent out;
  out.bytes = file_.size();
  out.read_bytes = std::min<std::uint64_t>(read_, out.bytes);
  out.records = records_.records();
  return out;
}

}  // namespace

io::FileExpected<LogExtent> read_csv_log(const std::string& path, const CsvHints& hints, LogSink& sink) {
  return CsvReader(path, hints, sink).read();
}

io::FileExpected<LogExtent> read_csv_log(const std::string& path, LogSink& sink) {
  return read_csv_log(path, CsvHints{}, sink);
}

}  // namespace logs
}  // namespace PLUMB_ABI
}  // namespace plumb
