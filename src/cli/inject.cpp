// plumb inject: faults into a recorded log, to see what the monitor makes of them.
#include <fmt/format.h>

#include <memory>

#include "fault_options.hpp"
#include "plumb/io/array_file.hpp"
#include "plumb/io/log_reader.hpp"
#include "plumb/io/log_writer.hpp"
#include "plumb/io/scenario_file.hpp"
#include "plumb/scenario/count_text.hpp"
#include "plumb/scenario/delivery.hpp"
#include "plumb/scenario/fault_text.hpp"
#include "plumb/scenario/injector.hpp"
#include "read_array.hpp"
#include "tool.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace cli {
namespace {

struct InjectOptions {
  std::string array;
  std::string log;
  std::string out;
  std::vector<std::string> faults;
  std::uint64_t seed = 1;
  io::BadRowPolicy on_bad_row = io::BadRowPolicy::stop;
};

constexpr const char* kInjectAbout =
    "Put faults into a recorded log and write the log anew: how would the monitor have answered, had this sensor\n"
    "failed at that moment? Rows and times stay as they are but for faults of the whole log (`log:`).";
constexpr const char* kInjectNotes =
    "A fault is SENSOR:KIND[=SIZE]@ONSET[+DURATION]:\n"
    "  a2:stuck=0V@12s          stays at 0 V from t = 12 s on (also 3V, FS, -FS, 12count, 1g0)\n"
    "  a3:last@5s               stays at its last value; last=0.5LSB dithers about it\n"
    "  a1:random=-3V..3V@20s    a new random value every row; held= draws one value and keeps it\n"
    "  a2:bias=50mg0@30s+10s    reads 50 mg0 too high for ten seconds\n"
    "  a1:drift=1mg0/s@10s      the error grows; also per min, per h\n"
    "  a4:scale=1.1@10s         scale factor times 1.1; scale=-1 is a reversed wire\n"
    "  noise=5mg0, spikes=0.5g0*1%, chatter=50mg0*10s, warmup=2mg0*5min, clip=-1V..4V, coarse=16LSB, bit=12,\n"
    "  pattern=nan, missing=30%, late=5, slow=10, exchange=a3, cross=a3*1%, turned=2deg, ghost=5deg, mirror=a1*a3\n"
    "  imu2:stuck=0g0@12s       all sensors of a chip (their `package`), where no sensor is called so\n"
    "  log:shake=0.1g0@10s      the whole log: gravity=3mg0, temperature=20degC, drop=10%, repeat, swap, late=5,\n"
    "                           back=2s\n"
    "  a2:F04@12s               an entry of the fault catalogue (docs/fault-catalogue.md) by id or name, or one of\n"
    "                           PX4's: off, garbage, wrong, slow, delayed, intermittent, and stuck without a size\n"
    "ONSET: a time on the log's own time axis (12s, 2min), a row (#5), a station (station6, needs station tags).\n\n"
    "Example (inject, then watch):\n"
    "  plumb inject --array tool.toml --log run.csv --fault \"a2:stuck=0V@12s\" --out - |\n"
    "    plumb monitor --array tool.toml --calibration cal.json --log -\n\n"
    "The same seed gives the same bytes. With --out - nothing else is written to standard output.\n\n";

/// Copies the log row by row through the injector.
io::FileExpected<io::LogStatistics> copy(const InjectOptions& options, const io::ArrayFile& array,
                                         scenario::Injector& injector, scenario::Delivery& delivery) {
  io::FileExpected<io::LogReader> reader = io::LogReader::open(options.log, array, options.on_bad_row);
  if (!reader) return tl::unexpected<io::FileError>(reader.error());
  reader->stop_when(interrupt_flag());
  io::FileExpected<io::LogWriter> writer = io::LogWriter::create(options.out, array, io::LogWriter::Columns::all);
  if (!writer) return tl::unexpected<io::FileError>(writer.error());
  Sample sample;
  io::LogReader::Next status = reader->next(sample);
  std::uint64_t rows = 0;
  const auto deliver = [&delivery, &writer, &rows]() -> io::FileExpected<void> {
    scenario::Delivery::Parcel parcel;
    while (delivery.pop(parcel)) {
      const io::FileExpected<void> written = writer->write(
          parcel.sample,
          {false, parcel.beside.rotation, parcel.beside.depth_m, parcel.beside.second_rotation, parcel.beside.clock_s});
      if (!written) return written;
      ++rows;
    }
    return {};
  };
  for (; status == io::LogReader::Next::row; status = reader->next(sample)) {
    injector.apply(sample);
    delivery.push(
        sample, injector.now(),
        {reader->depth_m(), reader->rotation(), reader->second_rotation(), io::clock_times(reader->clock_s())});
    const io::FileExpected<void> written = deliver();
    if (!written) return tl::unexpected<io::FileError>(written.error());
  }
  delivery.finish();
  const io::FileExpected<void> rest = deliver();
  if (!rest) return tl::unexpected<io::FileError>(rest.error());
  const io::FileExpected<void> kept = writer->commit();
  if (!kept) return tl::unexpected<io::FileError>(kept.error());
  if (status == io::LogReader::Next::error) return tl::unexpected<io::FileError>(reader->error());
  io::LogStatistics done = reader->statistics();
  done.rows = rows;  // some were lost or doubled on their way
  return done;
}

io::ExitCode run_inject(const InjectOptions& options) {
  const std::vector<NamedFile> to_write = {{"--out", options.out}};
  const std::vector<NamedFile> to_read = {{"--array", array_file_of(options.array)}, {"--log", options.log}};
  if (const std::optional<io::FileError> clash = overwritten(to_write, to_read)) return report(*clash);
  const io::FileExpected<io::ArrayFile> array = read_array(options.array, "plumb inject", Serves::all);
  if (!array) return report(array.error());
  const scenario::FaultContext context = io::fault_context(*array);
  const io::FileExpected<std::vector<scenario::Fault>> named = faults_of(options.faults, *array);
  if (!named) return report(named.error());
  const std::vector<scenario::Fault>& faults = *named;
  tl::expected<scenario::Injector, std::string> injector =
      scenario::Injector::make(array->datasheet, array->datasheet.model(), faults, options.seed);
  if (!injector) return report(fault_error(injector.error()));
  scenario::Delivery delivery(faults, options.seed);
  watch_interrupts();
  const io::FileExpected<io::LogStatistics> done = copy(options, *array, *injector, delivery);
  if (!done) return report(done.error());
  const bool to_pipe = options.out == "-";
  if (!to_pipe) {
    for (const scenario::Fault& fault : faults) print(scenario::describe(fault, context) + "\n");
    print(fmt::format("written: {} ({})\n", options.out, count_text(done->rows, "row")));
  }
  print_error(columns_left_out(*array, options.out));
  for (const int k : injector->without_effect()) {
    print_error(fmt::format(
        "plumb: --fault \"{}\" changed nothing: the log (t = {:.3f} to {:.3f} s) has no such time or station, or the "
        "channel did not deliver.\n",
        scenario::to_text(faults[static_cast<std::size_t>(k)], context), done->first_time_s, done->last_time_s));
  }
  for (const scenario::Fault& fault : faults) {
    if (fault.kind != scenario::FaultKind::temperature || !array->input.temperature_column.empty()) continue;
    print_error(fmt::format(
        "plumb: --fault \"{}\" changed nothing: the log has no temperature column (`temperature` in [input] of {}).\n",
        scenario::to_text(fault, context), options.array));
  }
  if (!interrupted()) return io::ExitCode::done;
  print_error(fmt::format("plumb: interrupted; the rows up to t = {:.3f} s are written.\n", done->last_time_s));
  return io::ExitCode::other;
}

}  // namespace

Command add_inject(const Options& tool) {
  auto options = std::make_shared<InjectOptions>();
  const Options command = tool.add_command("inject", "put faults into a recorded log, to see how the monitor answers");
  command.add_option("--array", options->array, "the array file: what the sensors are, how the log looks")
      .required()
      .type_name("ARRAY.toml");
  command.add_option("--log", options->log, "the log to read; `-` = standard input").required().type_name("LOG.csv|-");
  command.add_option("--fault", options->faults, "a fault, as below; may be given several times")
      .required()
      .type_name("FAULT");
  command.add_option("--seed", options->seed, "seed of the random kinds of fault, 1 by default")
      .check(seed_refusal)
      .type_name("N");
  command.add_option("--out", options->out, "the log to write; `-` = standard output")
      .required()
      .type_name("OUT.csv|-");
  add_bad_row_option(command, options->on_bad_row);
  command.footer(kInjectNotes + exit_codes_help());
  return {command, kInjectAbout, [options] { return run_inject(*options); }};
}

}  // namespace cli
}  // namespace PLUMB_ABI
}  // namespace plumb
