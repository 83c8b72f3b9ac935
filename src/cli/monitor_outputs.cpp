#include "monitor_outputs.hpp"

#include "plumb/render/timeline.hpp"
#include "tool.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace cli {

io::FileExpected<void> TableSink::take(const Sample& sample, const Verdict& verdict) {
  if (!started_) {
    const bool fresh = past_.empty();
    print_now((label_.empty() ? render::table_header() : label_) +
              render::table_line(fresh ? render::power_on_row(sample.time_s, now_.state)
                                       : render::restored_row(sample.time_s, now_, frame_, past_)));
  }
  started_ = true;
  if (verdict.transition.sequence != 0) print_now(label_ + render::table_line(render::row_of(verdict, array_, frame_)));
  return {};
}

io::FileExpected<void> open_outputs(const MonitorOptions& options, const io::ArrayFile& array,
                                    const SensorArray& sensors, const Verdict& now, const std::string& past,
                                    double days, Outputs& out) {
  const bool live = options.log.path == "-" || options.log.follow;
  const bool taken =
      options.events == "-" || options.verdicts == "-" || options.motion == "-" || options.inclination == "-";
  if (!options.events.empty()) {
    io::FileExpected<io::OutputFile> file = io::OutputFile::create(options.events, io::OutputFile::Mode::stream);
    if (!file) return tl::unexpected<io::FileError>(file.error());
    out.sinks.push_back(&out.events.emplace(*std::move(file), sensors, live || options.events == "-"));
  }
  if (!options.verdicts.empty()) {
    io::FileExpected<io::OutputFile> file = io::OutputFile::create(options.verdicts, io::OutputFile::Mode::stream);
    if (!file) return tl::unexpected<io::FileError>(file.error());
    out.sinks.push_back(
        &out.verdicts.emplace(*std::move(file), sensors, array.output_frame, options.every_sample, live, array.field));
  }
  if (!options.report.empty()) {
    io::FileExpected<std::unique_ptr<HealthReport>> report = HealthReport::create(options, array, sensors, days);
    if (!report) return tl::unexpected<io::FileError>(report.error());
    out.report = *std::move(report);
    out.sinks.push_back(out.report.get());
  }
  // --events - writes there what --json would.
  const bool told = options.events == "-";
  if (options.json && told) return {};
  if (options.json) {
    io::FileExpected<io::OutputFile> file = io::OutputFile::create("-", io::OutputFile::Mode::stream);
    if (!file) return tl::unexpected<io::FileError>(file.error());
    out.sinks.push_back(&out.json.emplace(*std::move(file), sensors, true, options.label.empty() ? "" : array.group));
  } else if (!taken) {
    out.sinks.push_back(&out.table.emplace(sensors, array.output_frame, now, past, options.label));
  }
  return {};
}

io::FileExpected<void> commit(Outputs& out, const session::MonitorRun& run, const render::MotionTold& motion) {
  io::FileExpected<void> done;
  if (out.events) done = out.events->commit();
  if (done && out.verdicts) done = out.verdicts->commit();
  if (done && out.json) done = out.json->commit();
  if (done && out.report) done = out.report->write(run, motion);
  if (done && out.incidents) done = out.incidents->commit();
  return done;
}

}  // namespace cli
}  // namespace PLUMB_ABI
}  // namespace plumb
