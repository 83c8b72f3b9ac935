// The monitor: a log in, one row of figures per sample out, as a structured numpy array.
#include <pybind11/stl.h>

#include <atomic>
#include <cstring>

#include "module.hpp"
#include "plumb/io/records.hpp"

namespace plumb_python {
namespace {

/// What of a verdict stands in a row. Sets of sensors are bits.
struct Row {
  double time_s;
  std::uint8_t state, validity, cause, decided_by;
  bool tick, accepted, alert, wants_rotation;
  std::uint16_t usable;
  std::uint16_t qualifiers;
  std::uint32_t in_service, set_aside, excluded, absent, suspects;
  double statistic, limit, margin;
  double mae_all_mps2, mae_worst_mps2, parity, parity_limit, norm_error_mps2;
  double gravity_mps2[3];
  double covariance[9];
  double age_s, latest_mps2[3];
  double protection_level_rad;
  std::uint32_t transition;
};

Row row_of(const plumb::Verdict& v, const plumb::Mat3& frame) {
  Row row{};
  row.time_s = v.time_s;
  row.state = static_cast<std::uint8_t>(v.state);
  row.validity = static_cast<std::uint8_t>(v.validity);
  row.cause = static_cast<std::uint8_t>(v.cause);
  row.decided_by = static_cast<std::uint8_t>(v.decided_by);
  row.tick = v.tick;
  row.accepted = v.accepted;
  row.alert = v.alert;
  row.wants_rotation = v.wants_rotation;
  row.usable = v.usable;
  row.qualifiers = v.qualifiers;
  row.in_service = v.in_service.bits;
  row.set_aside = v.set_aside.bits;
  row.excluded = v.excluded.bits;
  row.absent = v.absent.bits;
  row.suspects = v.suspects.bits;
  row.statistic = v.statistic;
  row.limit = v.limit;
  row.margin = v.margin;
  row.mae_all_mps2 = v.mae_all_mps2;
  row.mae_worst_mps2 = v.mae_worst_mps2;
  row.parity = v.parity;
  row.parity_limit = v.parity_limit;
  row.norm_error_mps2 = v.norm_error_mps2;
  const plumb::Vec3 gravity = plumb::io::in_frame(frame, v.gravity_mps2);
  const plumb::Vec3 latest = plumb::io::in_frame(frame, v.latest_mps2);
  const plumb::Mat3 covariance = plumb::io::covariance_in_frame(frame, v.covariance);
  std::memcpy(row.gravity_mps2, gravity.data(), sizeof row.gravity_mps2);
  std::memcpy(row.latest_mps2, latest.data(), sizeof row.latest_mps2);
  std::memcpy(row.covariance, covariance.data(), sizeof row.covariance);
  row.age_s = v.age_s;
  row.protection_level_rad = v.protection_available ? v.protection_level_rad : std::numeric_limits<double>::quiet_NaN();
  row.transition = v.transition.sequence;
  return row;
}

/// Of that array: else its axes and coefficients are those of other sensors, which may even be as many.
const plumb::Calibration* made_for(const plumb::io::ArrayFile& array, const Calibration& calibration) {
  if (calibration.array->fingerprint != array.fingerprint)
    refuse("the calibration was made for another array (\"" + calibration.array->name + "\", this one is \"" +
               array.name + "\")",
           "give the array that was calibrated, or calibrate this one");
  return &*calibration.fit;
}

class Monitor {
 public:
  Monitor(Array array, const Calibration& calibration, const std::optional<py::bytes>& snapshot, double days)
      : array_(std::move(array)),
        monitor_(taken(
            snapshot ? plumb::cli::restore_monitor(*array_, made_for(*array_, calibration), *snapshot, "snapshot", days)
                     : plumb::cli::make_monitor(*array_, made_for(*array_, calibration), days))) {}

  py::array_t<Row> run(const Log& log) {
    const Log::View view(log, *array_);
    py::array_t<Row> out(view.rows());
    Row* to = out.mutable_data();
    plumb::HealthMonitor& monitor = idle();
    const Running running(running_);
    const py::gil_scoped_release others_may_run;
    for (py::ssize_t r = 0; r < view.rows(); ++r) *to++ = row_of(monitor.step(view.at(r)), array_->output_frame);
    return out;
  }

  py::bytes snapshot() const {
    std::string bytes(idle().snapshot_size(), '\0');
    const auto size = monitor_->snapshot(reinterpret_cast<std::uint8_t*>(bytes.data()), bytes.size());
    if (!size) throw Refused(plumb::io::from_error(size.error()).text());
    return py::bytes(bytes);
  }

  std::string verdict_json() const {
    return plumb::io::verdict_json(idle().verdict(), monitor_->array(), array_->output_frame);
  }

  void done(const plumb::Expected<void>& result) const {
    if (!result) throw Refused(plumb::io::from_error(result.error()).text());
  }

  const Array& array() const { return array_; }
  /// The monitor, while no other thread is in `run`, which lets them all go on. Asked with the interpreter's lock held.
  plumb::HealthMonitor& idle() const {
    if (running_)
      refuse("the monitor runs in another thread", "wait until run returns, or give each thread a monitor of its own");
    return *monitor_;
  }

 private:
  struct Running {
    explicit Running(std::atomic<bool>& flag) : on(flag) { on = true; }
    ~Running() { on = false; }
    Running(const Running&) = delete;
    Running& operator=(const Running&) = delete;
    std::atomic<bool>& on;
  };

  std::atomic<bool> running_{false};
  Array array_;
  std::unique_ptr<plumb::HealthMonitor> monitor_;
};

plumb::SensorSet set_of(const Array& array, const std::vector<std::string>& ids) {
  plumb::SensorSet out;
  for (const std::string& id : ids) {
    int found = -1;
    for (int i = 0; i < array->array.size(); ++i) {
      if (id == array->array.row(i).id.data()) found = i;
    }
    if (found < 0) refuse("\"" + id + "\" is no sensor of this array", "give ids as in Array.sensors");
    out = out.with(found);
  }
  return out;
}

/// The names of an enumeration, in its order.
template <class Enum>
py::tuple names(Enum last) {
  py::tuple out(static_cast<std::size_t>(last) + 1);
  for (std::size_t k = 0; k < out.size(); ++k) out[k] = py::str(to_string(static_cast<Enum>(k)));
  return out;
}

}  // namespace

void bind_monitor(py::module_& module) {
  PYBIND11_NUMPY_DTYPE(Row, time_s, state, validity, cause, decided_by, tick, accepted, alert, wants_rotation, usable,
                       qualifiers, in_service, set_aside, excluded, absent, suspects, statistic, limit, margin,
                       mae_all_mps2, mae_worst_mps2, parity, parity_limit, norm_error_mps2, gravity_mps2, covariance,
                       age_s, latest_mps2, protection_level_rad, transition);
  module.attr("STATES") = names(plumb::HealthState::failed);
  module.attr("VALIDITIES") = names(plumb::Validity::valid);
  module.attr("CAUSES") = names(plumb::kLastCause);
  module.attr("verdict_dtype") = py::dtype::of<Row>();

  py::class_<Monitor>(
      module, "Monitor",
      "Watches an array. Feed it logs, whole or in parts; it goes on where it was. Starts as suspect: trust is\n"
      "earned. snapshot: bytes of Monitor.snapshot, under the same array and calibration.\n"
      "days_since_calibration: for what the array file states to drift per day. For one thread at a time.")
      .def(py::init<Array, const Calibration&, const std::optional<py::bytes>&, double>(), array_argument(),
           py::arg("calibration"), py::arg("snapshot") = py::none(), py::arg("days_since_calibration") = 0.0)
      .def("run", &Monitor::run, py::arg("log"),
           "Step all samples; returns a structured array (verdict_dtype), one row per sample. state, validity and "
           "cause\n"
           "are indices into STATES, VALIDITIES and CAUSES; sets of sensors are bits; covariance is row-major;\n"
           "protection_level_rad is NaN where there is no bound. Read validity before anything else.")
      .def_property_readonly(
          "verdict", [](const Monitor& m) { return py::module_::import("json").attr("loads")(m.verdict_json()); },
          "The last verdict in full, as a dict with the keys of `plumb monitor --verdicts`.")
      .def("snapshot", &Monitor::snapshot, "All that the monitor remembers, as bytes.")
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
          "inhibit", [](Monitor& m, bool frozen) { m.idle().inhibit(frozen); }, py::arg("frozen"),
          "Freeze exclusion and recalibration, or let them go.");
}

}  // namespace plumb_python
