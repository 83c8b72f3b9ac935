// The monitor in motion: sample by sample, over a log, and beside the monitor at rest.
#include <pybind11/stl.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <variant>

#include "monitor.hpp"
#include "motion_row.hpp"
#include "plumb/health/motion_link.hpp"
#include "plumb/session/motion_feed.hpp"
#include "plumb/session/motion_plan.hpp"

namespace plumb_python {
namespace {

/// Refused here, although the plan names what else is missing: an array file without any key of motion is sound.
plumb::session::MotionPlan plan_of(const plumb::io::ArrayFile& array, const Calibration* calibration, double days) {
  if (!array.motion.mentioned)
    throw Refused(plumb::io::FileError{array.path, 0, "motion", "is missing, and a MotionMonitor goes by it",
                                       "add [motion] and the bounds of the sensors (docs/array-file.md, Motion)"}
                      .text());
  if (!(days >= 0.0 && std::isfinite(days)))
    refuse("days_since_calibration: must be 0 or more and finite",
           "give the days from the calibration to the run, 0 or more");
  return taken(plumb::session::plan_motion(aligned(array, calibration),
                                           calibration != nullptr ? made_for(array, *calibration) : nullptr, days,
                                           calibration != nullptr ? calibration->motion.get() : nullptr));
}

class MotionMonitor {
 public:
  MotionMonitor(Array array, const Calibration* calibration, double days)
      : array_(std::move(array)),
        plan_(plan_of(*array_, calibration, days)),
        sampler_(plan_),
        feed_(plan_),
        monitor_(std::make_unique<plumb::MotionMonitor>()) {
    if (const auto configured = monitor_->configure(plan_.array, plan_.setup); !configured)
      throw Refused(plumb::io::from_error(configured.error()).text());
    if (plan_.inclination)  // `plan_motion` has asked `check` of it already
      (void)inclination_.emplace().configure(plan_.array, plan_.setup, *plan_.inclination);
  }

  MotionVerdict step(double time_s, const py::object& raw, const std::array<py::object, plumb::kGyros>& rate_radps,
                     std::optional<double> temperature_degc, const py::object& delivered);
  py::array_t<MotionRow> run(const Log& log);
  /// Before the first row of a log is judged: rates as the array file says, and times that are numbers.
  void check(const Log::View& view) const;
  /// One row of a log, of a monitor that is `idle`, and what is judged by it: one row of verdicts, or, where chips have
  /// clocks of their own, as many as there are common instants. Touches no Python object.
  void step(const Log::View& view, py::ssize_t row, std::vector<MotionRow>& to);

  void set_in_service(const std::variant<std::uint32_t, std::vector<std::string>>& sensors);
  MotionVerdict verdict() {
    const plumb::MotionMonitor& monitor = idle();
    return told(monitor.verdict());
  }
  const Array& array() const { return array_; }
  Turnstile& turnstile() { return turnstile_; }
  plumb::MotionMonitor& idle() {
    turnstile_.must_be_free();
    return *monitor_;
  }

 private:
  void check_gyro(std::size_t gyro, bool given) const;
  void check_clocks(bool given) const;
  MotionVerdict told(const plumb::MotionVerdict& verdict) const {
    return {array_, time_s_, verdict, new_window_,
            inclination_ ? std::optional(inclination_->interval()) : std::nullopt};
  }
  void take(const Log::View& view, py::ssize_t row) noexcept;
  const plumb::MotionVerdict& judge(const plumb::MotionSample& sample) noexcept;

  Turnstile turnstile_;
  Array array_;
  plumb::session::MotionPlan plan_;
  plumb::session::MotionSampler sampler_;
  plumb::session::MotionFeed feed_;
  std::unique_ptr<plumb::MotionMonitor> monitor_;
  std::optional<plumb::ContinuousInclination> inclination_;  ///< where the array file bounds the velocity
  bool new_window_ = false;
  double time_s_ = std::numeric_limits<double>::quiet_NaN();
};

/// Without the rates of a gyro that is stated nearly nothing would be judged, and those of another one would be
/// ignored.
void MotionMonitor::check_gyro(std::size_t gyro, bool given) const {
  const bool stated = static_cast<int>(gyro) < plan_.setup.gyros;
  const std::string key = std::string(gyro == 0 ? "" : "second_") + "rotation_radps";
  if (stated && !given)
    refuse(std::string(kRateNames[gyro]) + ": is missing, and the array file names a gyro in input." + key,
           "give its rates, NaN where it delivered none");
  if (!stated && given)
    refuse(std::string(kRateNames[gyro]) + ": is given, and the array file names no such gyro",
           "name its columns in [input] " + key + " and its bounds in [gyro], or leave the rates out");
}

/// Without their times no chip would be known to have delivered anything.
void MotionMonitor::check_clocks(bool given) const {
  if (feed_.stated() > 0 && !given)
    refuse("clock_s: is missing, and the array file states clocks of chips",
           "give what these clocks say, (rows, " + std::to_string(feed_.stated()) +
               "), NaN where a chip has delivered nothing");
}

void MotionMonitor::check(const Log::View& view) const {
  for (std::size_t g = 0; g < kRateNames.size(); ++g) check_gyro(g, view.turns(g));
  check_clocks(view.has_clocks());
  for (py::ssize_t r = 0; r < view.rows(); ++r) {
    const double time_s = view.time_s(r);
    if (std::isfinite(time_s)) continue;
    const std::string row = view.one_sample() ? "" : "row " + std::to_string(r) + " ";
    refuse("time_s: " + row + "is " + py::str(py::float_(time_s)).cast<std::string>() + ", must be finite",
           "leave out what has no time");
  }
}

void MotionMonitor::take(const Log::View& view, py::ssize_t row) noexcept {
  plumb::MotionSample sample = sampler_.sample(view.at(row));
  for (std::size_t g = 0; g < kRateNames.size(); ++g) {
    const plumb::Rotation turn = view.rotation(g, row);
    sample.rate_given[g] = turn.rate_known;
    sample.rate_radps[g] = turn.rate_radps;
  }
  feed_.take(sample, view.clock_s(row).data());
}

const plumb::MotionVerdict& MotionMonitor::judge(const plumb::MotionSample& sample) noexcept {
  time_s_ = sample.time_s;
  const plumb::MotionVerdict& verdict = monitor_->step(sample);
  new_window_ = inclination_ && inclination_->step(sample, verdict);
  return verdict;
}

void MotionMonitor::step(const Log::View& view, py::ssize_t row, std::vector<MotionRow>& to) {
  take(view, row);
  plumb::MotionSample sample;
  while (feed_.next(sample)) {
    const plumb::MotionVerdict& verdict = judge(sample);
    MotionRow& out = to.emplace_back();
    write_row(time_s_, verdict, array_->output_frame, out);
    write_inclination(new_window_, inclination_ ? &inclination_->interval() : nullptr, out);
  }
}

py::array_t<MotionRow> as_array(const std::vector<MotionRow>& rows) {
  py::array_t<MotionRow> out(static_cast<py::ssize_t>(rows.size()));
  if (!rows.empty()) std::memcpy(out.mutable_data(), rows.data(), rows.size() * sizeof(MotionRow));
  return out;
}

/// A log of one row, so that one and the same code reads and refuses.
Log one_row(double time_s, const py::object& raw, const std::array<py::object, plumb::kGyros>& rate_radps,
            std::optional<double> temperature_degc, const py::object& delivered) {
  const auto row = [](const py::object& of) -> py::object {
    return py::module_::import("numpy").attr("expand_dims")(of, 0);
  };
  Log log;
  log.one_sample = true;
  log.time_s = Doubles(1, &time_s);
  log.raw = row(doubles(raw, "raw"));
  log.temperature_degc = temperature_degc ? py::object(py::float_(*temperature_degc)) : py::none();
  log.delivered = delivered.is_none() ? delivered : row(delivered);
  log.station = log.count = log.roll_group = log.truth = py::none();
  for (std::size_t g = 0; g < log.rate_radps.size(); ++g) {
    const py::object& rate = rate_radps[g];
    log.rate_radps[g] = rate.is_none() ? rate : row(doubles(rate, kRateNames[g]));
  }
  return log;
}

MotionVerdict MotionMonitor::step(double time_s, const py::object& raw,
                                  const std::array<py::object, plumb::kGyros>& rate_radps,
                                  std::optional<double> temperature_degc, const py::object& delivered) {
  if (feed_.has_clocks())
    refuse("step: the array file states clocks of chips, and a row then gives no verdict, one or several",
           "give the rows that have come to run, which goes on where it was");
  const Log::View view(one_row(time_s, raw, rate_radps, temperature_degc, delivered), *array_);
  check(view);
  (void)idle();
  take(view, 0);
  plumb::MotionSample sample;
  (void)feed_.next(sample);
  return told(judge(sample));
}

py::array_t<MotionRow> MotionMonitor::run(const Log& log) {
  const Log::View view(log, *array_);
  check(view);
  std::vector<MotionRow> out;
  out.reserve(static_cast<std::size_t>(view.rows()));
  (void)idle();
  {
    const Turnstile::Inside inside(turnstile_);
    const py::gil_scoped_release others_may_run;
    for (py::ssize_t r = 0; r < view.rows(); ++r) step(view, r, out);
  }
  return as_array(out);
}

void MotionMonitor::set_in_service(const std::variant<std::uint32_t, std::vector<std::string>>& sensors) {
  plumb::SensorSet set;
  if (const auto* ids = std::get_if<std::vector<std::string>>(&sensors)) {
    set = set_of(array_, *ids);
  } else {
    set = plumb::SensorSet(std::get<std::uint32_t>(sensors));
    if (!array_->array.all().contains(set))
      refuse("sensors: bits beyond the " + std::to_string(array_->array.size()) + " sensors of this array are set",
             "give in_service of a row of Monitor.run, or ids as in Array.sensors");
  }
  idle().set_in_service(set);
}

/// Row by row in the order of `plumb monitor`: what motion finds reaches rest one row later.
py::tuple run_both(Monitor& rest, MotionMonitor& motion, const Log& log) {
  if (rest.array()->fingerprint != motion.array()->fingerprint)
    refuse("the two monitors are of different arrays (\"" + rest.array()->name + "\" and \"" + motion.array()->name +
               "\")",
           "make both from one array and calibration");
  const Log::View view(log, *rest.array());
  motion.check(view);
  py::array_t<VerdictRow> at_rest(view.rows());
  std::vector<MotionRow> in_motion;
  in_motion.reserve(static_cast<std::size_t>(view.rows()));
  VerdictRow* to_rest = at_rest.mutable_data();
  plumb::HealthMonitor& health = rest.idle();
  plumb::MotionMonitor& fast = motion.idle();
  {
    const Turnstile::Inside with_rest(rest.turnstile()), with_motion(motion.turnstile());
    const py::gil_scoped_release others_may_run;
    for (py::ssize_t r = 0; r < view.rows(); ++r) {
      health.set_motion(plumb::motion_finding(fast.verdict()));
      const plumb::Verdict& verdict = Monitor::step(health, view, r);
      write_row(verdict, rest.array()->output_frame, *to_rest++);
      if (plumb::settles_motion(verdict)) fast.forget();
      fast.set_in_service(verdict.in_service);
      motion.step(view, r, in_motion);
    }
  }
  return py::make_tuple(std::move(at_rest), as_array(in_motion));
}

}  // namespace

void bind_motion(py::module_& module) {
  py::class_<MotionMonitor>(
      module, "MotionMonitor",
      "Judges an array while it moves, by [motion], [gyro] and the bounds of the sensors in its array file, and\n"
      "publishes the specific force with a bound on its error. calibration: of that array; None: the nominal\n"
      "coefficients count, as of chips that come calibrated. days_since_calibration: for the drift per day of the\n"
      "array file. Where [motion] states velocity_bound_mps, it gives the inclination of the z axis of [output] too. "
      "Raises Error where a key is missing, with its name. For one thread at a time.")
      .def(py::init<Array, const Calibration*, double>(), array_argument(), py::arg("calibration") = py::none(),
           py::arg("days_since_calibration") = 0.0)
      .def(
          "step",
          [](MotionMonitor& m, double time_s, const py::object& raw, py::object rate_radps,
             py::object second_rate_radps, std::optional<double> temperature_degc, const py::object& delivered) {
            return m.step(time_s, raw, {std::move(rate_radps), std::move(second_rate_radps)}, temperature_degc,
                          delivered);
          },
          py::arg("time_s"), py::arg("raw"), py::arg("rate_radps") = py::none(),
          py::arg("second_rate_radps") = py::none(), py::arg("temperature_degc") = py::none(),
          py::arg("delivered") = py::none(),
          "One sample; returns a MotionVerdict. raw: (sensors), in the unit of the array file's log, NaN = no number.\n"
          "rate_radps and second_rate_radps: (3), tool frame [rad/s], for each gyro that the array file names; NaN =\n"
          "it delivered none. temperature_degc: else default_temperature of the array file. delivered: (sensors),\n"
          "bool. Raises Error where a shape does not fit, a rate is missing or the time is not finite; then nothing\n"
          "was judged. A sample that does not follow the last one by the stated period has cause irregular_time. Not\n"
          "where the array file states clocks of chips: give the rows to run as they come.")
      .def("run", &MotionMonitor::run, py::arg("log"),
           "Step all samples of a Log, which needs rate_radps for each gyro that the array file names. Returns a\n"
           "structured array (motion_dtype), one row per sample, or per common instant where the array file states "
           "clocks of\n"
           "chips (the Log then needs clock_s): MOTION_FIELDS, FORCE_FIELDS and INCLINATION_FIELDS "
           "say\n"
           "what each figure is and in which unit. cause, validity, dominant, status and widest are indices into\n"
           "MOTION_CAUSES, FORCE_VALIDITIES, FORCE_TERMS, INCLINATION_STATUSES and INCLINATION_TERMS; sets of sensors\n"
           "are bits; forces are in the output frame. Errors as of step.")
      .def_property_readonly("verdict", &MotionMonitor::verdict, "The last MotionVerdict.")
      .def("set_in_service", &MotionMonitor::set_in_service, py::arg("sensors"),
           "The sensors that others, a Monitor above all, leave in service: ids, or in_service of a row of "
           "Monitor.run.\n"
           "Evidence about sensors that leave is dropped; what is excluded here stays out.")
      .def(
          "forget", [](MotionMonitor& m) { m.idle().forget(); },
          "Take back exclusions and evidence, after rest has confirmed or refuted them (Monitor.settles_motion).");

  module.def(
      "run_both", &run_both, py::arg("monitor"), py::arg("motion"), py::arg("log"),
      "A Monitor and a MotionMonitor over one log, as `plumb monitor` runs them: what motion finds reaches the\n"
      "monitor at rest one row later, sensors that rest takes out of service leave motion at once, and what motion\n"
      "excluded is taken back where rest has judged. Returns the rows of both: (Monitor.run, MotionMonitor.run).");
}

}  // namespace plumb_python
