#include "plumb/io/csv_columns.hpp"

#include <algorithm>
#include <cerrno>
#include <limits>

#include "csv.hpp"
#include "plumb/scenario/count_text.hpp"
#include "text_tools.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace io {
namespace {

constexpr std::size_t kMostColumns = 4096;
constexpr double kNoNumber = std::numeric_limits<double>::quiet_NaN();

class ColumnFile {
 public:
  ColumnFile(const std::string& path, BadRowPolicy policy, std::size_t most_values)
      : path_(path == "-" ? "standard input" : path), policy_(policy), most_values_(most_values) {}

  FileExpected<CsvColumns> read(const std::string& path, const volatile std::sig_atomic_t* stop) {
    if (const int error_number = source_.open(path); error_number != 0) return refuse(io_failure(error_number));
    source_.stop_when(stop);
    if (FileExpected<void> header = read_header(); !header) return refuse(header.error());
    std::string_view text;
    LineSource::Status status = source_.next(text);
    for (; status == LineSource::Status::line && out_.complete; status = source_.next(text)) {
      ++line_;
      if (trimmed(text).empty()) continue;
      if (take_row(text)) continue;
      ++out_.rows_bad;
      if (policy_ == BadRowPolicy::stop) return refuse(bad_);
    }
    if (status == LineSource::Status::failed) return refuse(io_failure(source_.error_number()));
    return finished();
  }

 private:
  static tl::unexpected<FileError> refuse(FileError error) { return tl::unexpected<FileError>(std::move(error)); }

  FileError io_failure(int error_number) const {
    FileError out{path_, 0, "", std::string("cannot be read: ") + system_message(error_number),
                  "check the path and the permissions"};
    if (error_number == EISDIR) out.remedy = "name a file, not a directory";
    if (error_number != EMSGSIZE) return out;
    return {path_, line_ + 1, "", "a line is longer than 16 MB", "give a CSV file: text with one row a line"};
  }

  FileExpected<void> read_header() {
    std::string_view text;
    do {
      const LineSource::Status status = source_.next(text);
      if (status == LineSource::Status::failed) return refuse(io_failure(source_.error_number()));
      if (status == LineSource::Status::end)
        return refuse({path_, 0, "", "the log is empty", "give a CSV file with a header row that names the columns"});
      ++line_;
      if (line_ == 1 && text.substr(0, 3) == "\xEF\xBB\xBF") text.remove_prefix(3);
    } while (trimmed(text).empty());
    const auto count = static_cast<std::size_t>(std::count(text.begin(), text.end(), ',')) + 1;
    if (count > kMostColumns)
      return refuse({path_, line_, "", "the first row has " + std::to_string(count) + " cells, more than any log",
                     "give a CSV file with a header row of at most " + std::to_string(kMostColumns) + " names"});
    cells_.resize(count);
    cells_.resize(split_cells(text, cells_));
    bool numbers = true;
    for (const std::string_view cell : cells_) {
      double value = 0.0;
      numbers = numbers && parse_cell(cell, value) == CellKind::number;
      header_.emplace_back(bare_cell(cell));
    }
    if (numbers)
      return refuse({path_, line_, "", "the first row holds numbers; it must hold the column names",
                     "add a header row, for example: t_s,a1,a2,a3"});
    all_.resize(header_.size());
    is_text_.assign(header_.size(), false);
    row_.resize(header_.size());
    return {};
  }

  /// False: a bad row, in `bad_`.
  bool take_row(std::string_view text) {
    const std::size_t found = split_cells(text, cells_);
    if (found != header_.size()) {
      bad_ = {path_, line_, "",
              "the row has " + count_text(found, "cell") + ", but the header has " + std::to_string(header_.size()),
              "correct the row, or run with --on-bad-row skip"};
      return false;
    }
    for (std::size_t c = 0; c < header_.size(); ++c) {
      row_[c] = kNoNumber;
      if (is_text_[c]) continue;
      double value = 0.0;
      const CellKind kind = parse_cell(cells_[c], value);
      if (kind == CellKind::number) row_[c] = value;
      if (kind != CellKind::text) continue;
      if (rows_ > 0) {
        bad_ = {path_, line_, header_[c] + " (column " + std::to_string(c + 1) + ")",
                in_quotes(cells_[c]) + " is not a number", "correct the row, or run with --on-bad-row skip"};
        return false;
      }
      is_text_[c] = true;
    }
    if (rows_ == 0) {
      for (std::size_t c = 0; c < header_.size(); ++c) kept_ += is_text_[c] ? 0U : 1U;
    }
    if ((rows_ + 1) * kept_ > most_values_) {
      out_.complete = false;
      return true;
    }
    for (std::size_t c = 0; c < header_.size(); ++c) {
      if (!is_text_[c]) all_[c].push_back(row_[c]);
    }
    ++rows_;
    return true;
  }

  FileExpected<CsvColumns> finished() {
    for (std::size_t c = 0; c < header_.size(); ++c) {
      const bool numbers = std::any_of(all_[c].begin(), all_[c].end(), [](double v) { return v == v; });
      if (!numbers) {
        out_.left_out.push_back(header_[c]);
        continue;
      }
      out_.names.push_back(header_[c]);
      out_.values.push_back(std::move(all_[c]));
    }
    if (!out_.names.empty()) return std::move(out_);
    if (header_.size() == 1 && header_[0].find_first_of(";\t") != std::string::npos)
      return refuse(
          {path_, line_, "", "the header is one cell with semicolons or tabs in it", "separate the cells by commas"});
    return refuse({path_, line_, "", rows_ == 0 ? "the log has a header but no usable row" : "no column holds numbers",
                   "give a log with rows of numbers below the names of its columns"});
  }

  std::string path_;
  BadRowPolicy policy_;
  std::size_t most_values_;
  LineSource source_;
  int line_ = 0;
  std::uint64_t rows_ = 0;
  std::size_t kept_ = 0;
  std::vector<std::string> header_;
  std::vector<std::string_view> cells_;
  std::vector<bool> is_text_;
  std::vector<double> row_;
  std::vector<std::vector<double>> all_;
  FileError bad_;
  CsvColumns out_;
};

}  // namespace

FileExpected<CsvColumns> read_csv_columns(const std::string& path, BadRowPolicy policy,
                                          const volatile std::sig_atomic_t* stop, std::size_t most_values) {
  return ColumnFile(path, policy, most_values).read(path, stop);
}

}  // namespace io
}  // namespace PLUMB_ABI
}  // namespace plumb
