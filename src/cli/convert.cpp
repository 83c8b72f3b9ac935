// plumb convert: a log from CSV to ULog, or back.
#include <fmt/format.h>

#include <memory>
#include <optional>

#include "plumb/io/log_reader.hpp"
#include "plumb/io/log_writer.hpp"
#include "plumb/scenario/count_text.hpp"
#include "read_array.hpp"
#include "tool.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace cli {
namespace {

struct ConvertOptions {
  std::string array;
  std::string log;
  std::string out;
  io::LogWriter::Form form = io::LogWriter::Form::by_name;
  io::BadRowPolicy on_bad_row = io::BadRowPolicy::stop;
};

constexpr const char* kConvertAbout =
    "Write a log again in the other form: CSV, or ULog, the log of PX4, which is read several times faster, finds "
    "damage\n"
    "by check sums, and opens in other tools (PlotJuggler, pyulog). What is written is what the array file names; "
    "every\n"
    "command gives the same results on both.";
constexpr const char* kConvertNotes =
    "The name of the output decides: one that ends in .ulg or .ulog becomes a ULog, any other a CSV; --to says it\n"
    "otherwise. Every command knows by itself which of the two it reads. docs/array-file.md holds the layout of the "
    "ULog.\n"
    "A ULog that plumb did not write goes through plumb import first.\n\n"
    "Examples:\n"
    "  plumb convert --array tool.toml --log run.csv --out run.ulg\n"
    "  plumb convert --array tool.toml --log run.ulg --out -                # as CSV, to look at\n"
    "  plumb convert --array tool.toml --log - --to ulog --out - <run.csv   # in a pipe\n\n"
    "Cells come back as the same numbers, written the shortest way. Rows that [input] where does not select, and rows\n"
    "skipped as bad, are left out.\n\n";

io::FileExpected<io::LogStatistics> convert(const ConvertOptions& options, const io::ArrayFile& array) {
  io::FileExpected<io::LogReader> reader = io::LogReader::open(options.log, array, options.on_bad_row);
  if (!reader) return tl::unexpected<io::FileError>(reader.error());
  reader->stop_when(interrupt_flag());
  io::FileExpected<io::LogWriter> writer =
      io::LogWriter::create(options.out, array, io::LogWriter::Columns::all, options.form);
  if (!writer) return tl::unexpected<io::FileError>(writer.error());
  Progress progress("converting " + options.log);
  Sample sample;
  std::uint64_t held = 0;
  io::LogReader::Next status = reader->next(sample);
  for (; status == io::LogReader::Next::row; status = reader->next(sample)) {
    const std::uint64_t now = reader->statistics().temperature_held;
    const io::FileExpected<void> written =
        writer->write(sample, {now != held, reader->rotation(), reader->depth_m(), reader->second_rotation(),
                               io::clock_times(reader->clock_s())});
    if (!written) return tl::unexpected<io::FileError>(written.error());
    held = now;
    progress.at(reader->statistics().rows, sample.time_s);
  }
  const io::FileExpected<void> kept = writer->commit();
  if (!kept) return tl::unexpected<io::FileError>(kept.error());
  if (status == io::LogReader::Next::error) return tl::unexpected<io::FileError>(reader->error());
  return reader->statistics();
}

io::ExitCode run_convert(const ConvertOptions& options) {
  const std::vector<NamedFile> to_write = {{"--out", options.out}};
  const std::vector<NamedFile> to_read = {{"--array", array_file_of(options.array)}, {"--log", options.log}};
  if (const std::optional<io::FileError> clash = overwritten(to_write, to_read)) return report(*clash);
  const io::FileExpected<io::ArrayFile> array = read_array(options.array, "plumb convert", Serves::all);
  if (!array) return report(array.error());
  watch_interrupts();
  const io::FileExpected<io::LogStatistics> done = convert(options, *array);
  if (!done) return report(done.error());
  if (options.out != "-") {
    print(fmt::format("written: {} ({}, {} skipped)\n", options.out, count_text(done->rows, "row"),
                      count_text(done->rows_bad, "bad row")));
  }
  if (done->rows_bad > 0 && array->input.time_column.empty()) {
    print_error(
        "plumb: warning: the log has no time column, so the rows after a skipped row now have earlier times.\n");
  }
  print_error(columns_left_out(*array, options.out));
  if (!interrupted()) return io::ExitCode::done;
  print_error(fmt::format("plumb: interrupted; the rows up to t = {:.3f} s are written.\n", done->last_time_s));
  return io::ExitCode::other;
}

}  // namespace

Command add_convert(const Options& tool) {
  auto options = std::make_shared<ConvertOptions>();
  const Options command = tool.add_command("convert", "write a log again: from CSV to ULog, or back");
  command.add_option("--array", options->array, "the array file: how the log looks").required().type_name("ARRAY.toml");
  command.add_option("--log", options->log, "the log to read; `-` = standard input").required().type_name("LOG|-");
  command
      .add_option("--out", options->out,
                  "the log to write: OUT.ulg a ULog, any other name CSV; `-` = standard output, CSV without --to")
      .required()
      .type_name("OUT|-");
  command
      .add_option<io::LogWriter::Form>("--to", options->form,
                                       {{"csv", io::LogWriter::Form::csv}, {"ulog", io::LogWriter::Form::ulog}},
                                       "what to write, whatever the name of the output")
      .type_name("csv|ulog");
  add_bad_row_option(command, options->on_bad_row);
  command.footer(kConvertNotes + exit_codes_help());
  return {command, kConvertAbout, [options] { return run_convert(*options); }};
}

}  // namespace cli
}  // namespace PLUMB_ABI
}  // namespace plumb
