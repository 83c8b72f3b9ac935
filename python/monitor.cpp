// The monitor: a log in, one row of figures per sample out, as a structured numpy array.
#include <pybind11/stl.h>

#include "monitor.hpp"
#include "motion_row.hpp"
#include "plumb/findings/alignment.hpp"
#include "plumb/health/motion_link.hpp"
#include "plumb/io/records.hpp"

namespace plumb_python {

plumb::io::ArrayFile aligned(const plumb::io::ArrayFile& array, const Calibration* calibration) {
  if (calibration == nullptr) return plumb::findings::with_alignment(array, nullptr);
  plumb::io::CalibrationFile file;
  file.calibration = *calibration->fit;
  file.context = calibration->context;
  return plumb::findings::with_alignment(array, &file);
}

const plumb::Calibration* made_for(const plumb::io::ArrayFile& array, const Calibration& calibration) {
  if (calibration.array->fingerprint != array.fingerprint)
    refuse("the calibration was made for another array (\"" + calibration.array->name + "\", this one is \"" +
               array.name + "\")",
           "give the array that was calibrated, or calibrate this one");
  return &*calibration.fit;
}

Monitor::Monitor(Array array, const Calibration& calibration, const std::optional<py::bytes>& snapshot, double days)
    : array_(std::move(array)),
      monitor_(taken(
          snapshot
              ? plumb::session::restore_monitor(aligned(*array_, &calibration), made_for(*array_, calibration),
                                                *snapshot, "snapshot", days)
              : plumb::session::make_monitor(aligned(*array_, &calibration), made_for(*array_, calibration), days))),
      setup_(
          taken(plumb::session::monitor_setup(aligned(*array_, &calibration), made_for(*array_, calibration), days))) {}

py::array_t<VerdictRow> Monitor::run(const Log& log) {
  const Log::View view(log, *array_);
  py::array_t<VerdictRow> out(view.rows());
  VerdictRow* to = out.mutable_data();
  plumb::HealthMonitor& monitor = idle();
  const Turnstile::Inside inside(turnstile_);
  const py::gil_scoped_release others_may_run;
  for (py::ssize_t r = 0; r < view.rows(); ++r) write_row(step(monitor, view, r), array_->output_frame, *to++);
  return out;
}

/// The rate of a log before must not count for one that has none.
const plumb::Verdict& Monitor::step(plumb::HealthMonitor& monitor, const Log::View& view, py::ssize_t row) {
  if (view.turns(0) || row == 0) (void)monitor.set_rotation(view.rotation(0, row));
  return monitor.step(view.at(row));
}

py::bytes Monitor::snapshot() const {
  std::string bytes(idle().snapshot_size(), '\0');
  const auto size = monitor_->snapshot(reinterpret_cast<std::uint8_t*>(bytes.data()), bytes.size());
  if (!size) throw Refused(plumb::io::from_error(size.error()).text());
  return py::bytes(bytes);
}

std::string Monitor::verdict_json() const {
  return plumb::io::verdict_json(idle().verdict(), monitor_->array(), array_->output_frame);
}

void Monitor::done(const plumb::Expected<void>& result) const {
  if (!result) throw Refused(plumb::io::from_error(result.error()).text());
}

plumb::SensorSet set_of(const Array& array, const std::vector<std::string>& ids) {
  plumb::SensorSet out;
  for (const std::string& id : ids) {
    int found = -1;
    for (int i = 0; i < array->array.size(); ++i) {
      if (id == array->array.row(i).id.data()) found = i;
    }
    if (found < 0) refuse("\"" + id + "\" is not a sensor of this array", "give ids as in Array.sensors");
    out = out.with(found);
  }
  return out;
}

void bind_monitor(py::module_& module) {
  bind_verdict_row(module);
  py::class_<Monitor>(
      module, "Monitor",
      "Monitors an array. Feed it logs, whole or in parts; it continues where it was. Starts as suspect until the\n"
      "sensors are validated. snapshot: bytes of Monitor.snapshot, under the same array and calibration.\n"
      "days_since_calibration: for the drift per day of the array file. For one thread at a time.")
      .def(py::init<Array, const Calibration&, const std::optional<py::bytes>&, double>(), array_argument(),
           py::arg("calibration"), py::arg("snapshot") = py::none(), py::arg("days_since_calibration") = 0.0)
      .def(
          "run", &Monitor::run, py::arg("log"),
          "Step all samples; returns a structured array (verdict_dtype), one row per sample, with every figure of a\n"
          "verdict: VERDICT_FIELDS says what each is and in which unit. state, validity and cause are indices into\n"
          "STATES, VALIDITIES and CAUSES; sets of sensors are bits, as are qualifiers and usable (named in QUALIFIERS\n"
          "and USABLE). Read validity before anything else. Evidence rests while rate_radps of the log says that the "
          "tool\n"
          "turns; without it the tool is taken not to turn.")
      .def_property_readonly(
          "verdict", [](const Monitor& m) { return py::module_::import("json").attr("loads")(m.verdict_json()); },
          "The last verdict in full, as a dict with the keys of `plumb monitor --verdicts`.")
      .def("snapshot", &Monitor::snapshot, "The complete state of the monitor, as bytes.")
      .def(
          "reset",
          [](Monitor& m, std::uint64_t key, const std::vector<std::string>& sensors) {
            m.done(m.idle().reset(key, set_of(m.array(), sensors)));
          },
          py::arg("key"), py::arg("sensors"), "Leave `failed` at the next sample, with these sensors.")
      .def(
          "request_recalibration", [](Monitor& m) { m.done(m.idle().request_recalibration()); },
          "Ask for new biases and scales of the sensors in service.")
      .def(
          "set_gravity",
          [](Monitor& m, double g_mps2, double sigma_mps2) {
            const auto gravity = plumb::given_gravity(g_mps2, sigma_mps2);
            if (!gravity) throw Refused(plumb::io::from_error(gravity.error()).text());
            m.done(m.idle().set_gravity(*gravity));
          },
          py::arg("g_mps2"), py::arg("sigma_mps2"), "Another length of gravity: the depth has changed.")
      .def(
          "set_motion",
          [](Monitor& m, const MotionVerdict* found) {
            if (found != nullptr && found->array->fingerprint != m.array()->fingerprint)
              refuse("found: is of another array (\"" + found->array->name + "\", this one is \"" + m.array()->name +
                         "\")",
                     "give what a MotionMonitor of this array found");
            m.idle().set_motion(found != nullptr ? plumb::motion_finding(found->verdict) : plumb::MotionFinding{});
          },
          py::arg("found"),
          "The MotionVerdict of a MotionMonitor that runs beside, before the next sample; it holds until set again.\n"
          "While the tool moves, an alarm leads to suspect, and sensors that are excluded in motion are provisionally\n"
          "excluded here. None: nothing was found. run_both does all this.")
      .def_property_readonly(
          "settles_motion", [](const Monitor& m) { return plumb::settles_motion(m.idle().verdict()); },
          "Whether rest has just confirmed or refuted what motion found: then call MotionMonitor.forget.")
      .def(
          "begin_time_base", [](Monitor& m) { m.idle().begin_time_base(); },
          "The next sample may have any time: a recorded roll test has been run, and the log begins. Nothing is valid\n"
          "before its first block at rest; validation, exclusions and suspicions are kept.")
      .def(
          "inhibit", [](Monitor& m, bool frozen) { m.idle().inhibit(frozen); }, py::arg("frozen"),
          "Inhibit exclusion and recalibration, or allow them again.");
}

}  // namespace plumb_python
