#include "calibrate_motion.hpp"
#include "read_array.hpp"

#include "plumb/render/motion_fit_report.hpp"
#include "plumb/session/days_since.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace cli {

io::ExitCode run_calibrate_motion(const CalibrateMotionOptions& options) {
  const std::vector<NamedFile> to_write = {{"--out", options.out}};
  const std::vector<NamedFile> to_read = {
      {"--array", options.array}, {"--calibration", options.calibration}, {"--motion", options.log.path}};
  if (const std::optional<io::FileError> clash = overwritten(to_write, to_read)) return report(*clash);
  const io::FileExpected<io::ArrayFile> array = read_array(options.array, "plumb calibrate --motion", Serves::gravity);
  if (!array) return report(array.error());
  const io::FileExpected<io::CalibrationFile> calibration = io::read_calibration(options.calibration, *array);
  if (!calibration) return report(calibration.error());
  const io::FileExpected<double> days = session::days_since(*calibration, options.calibration, options.date);
  if (!days) return report(days.error());
  watch_interrupts();
  io::FileExpected<session::MotionCommissioning> run =
      session::run_motion_commissioning(*array, *calibration, *days, options.log);
  if (!run) return report(run.error());
  print(options.json ? render::motion_fit_json(*run, *array).dump(1) + "\n" : render::motion_fit_text(*run, *array));
  if (run->refusal != session::MotionRefusal::none) {
    const render::Refusal refusal = render::refusal_of(*run, *array);
    print_error("plumb: the calibration in motion was not accepted: " + refusal.reason + ". " + options.out +
                " was not written. Remedy: " + refusal.next + ".\n");
    return interrupted() ? io::ExitCode::other : io::ExitCode::not_accepted;
  }
  run->found.date = options.date;
  const io::FileExpected<void> saved = io::add_motion(options.calibration, options.out, run->found, *array);
  if (!saved) return report(saved.error());
  if (!options.json && options.out != "-")
    print("written: " + options.out + "\nnext: plumb monitor --array " + options.array + " --calibration " +
          options.out + " --log LOG.csv\n");
  if (!interrupted()) return io::ExitCode::done;
  print_error("plumb: interrupted; the fit uses the rows read before the interruption.\n");
  return io::ExitCode::other;
}

}  // namespace cli
}  // namespace PLUMB_ABI
}  // namespace plumb
