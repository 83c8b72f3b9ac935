// Calibration: numpy columns in, coefficients out, or the refusal in the tool's words.
#include <pybind11/stl.h>

#include "module.hpp"
#include "plumb/render/calibration_notes.hpp"
#include "plumb/render/fit_report.hpp"
#include "plumb/session/calibration_pipeline.hpp"
#include "plumb/session/choice_texts.hpp"
#include "plumb/session/days_since.hpp"

namespace plumb_python {
namespace {

plumb::session::CalibrationChoice choice_of(const std::string& hold_out, const std::string& temperature_order,
                                            bool keep_outliers) {
  plumb::session::CalibrationChoice choice;
  if (!hold_out.empty()) {
    const std::string wrong = plumb::session::read_hold_out(hold_out, choice.hold_out);
    if (!wrong.empty()) throw Refused("hold_out: " + wrong);
  }
  const std::string wrong = plumb::session::read_temperature_order(temperature_order, choice.temperature.order);
  if (!wrong.empty()) throw Refused("temperature_order: " + wrong);
  choice.fit.reject_outliers = !keep_outliers;
  return choice;
}

Calibration calibrate(const Array& array, const Log& log, const std::string& hold_out,
                      const std::string& temperature_order, bool keep_outliers, const std::string& date,
                      const std::string& serial) {
  const std::string no_date = date.empty() ? "" : plumb::session::date_refusal(date);
  if (!no_date.empty()) throw Refused("date: " + no_date);
  const plumb::session::CalibrationChoice choice = choice_of(hold_out, temperature_order, keep_outliers);
  const Log::View view(log, *array);
  plumb::session::CalibrationRun run;
  {
    const py::gil_scoped_release others_may_run;
    std::vector<plumb::Sample> samples;
    samples.reserve(static_cast<std::size_t>(view.rows()));
    for (py::ssize_t r = 0; r < view.rows(); ++r) samples.push_back(view.at(r));
    run = plumb::session::run_calibration(*array, samples, choice);
  }
  if (!run.accepted) {
    const plumb::render::Refusal refusal = plumb::render::refusal_of(run, *array);
    throw Refused("the calibration was not accepted: " + refusal.reason + ". Remedy: " + refusal.next + ".");
  }
  Calibration out;
  out.array = array;
  out.report = plumb::render::fit_json(run, *array);
  out.context.log_file = "numpy arrays";
  out.context.date = date;
  out.context.serial = serial;
  out.context.stations = run.report.stations;
  out.context.plumb_version = PLUMB_VERSION;
  out.context.gravity = array->gravity;
  plumb::session::note_attitudes(run, out.context);
  out.fit = std::move(run.accepted);
  return out;
}

Calibration read(const Array& array, const std::string& path) {
  plumb::io::CalibrationFile file = taken(plumb::io::read_calibration(path, *array));
  const std::string exact = plumb::render::exact_words(file, path);
  if (!exact.empty() && PyErr_WarnEx(PyExc_UserWarning, exact.c_str(), 1) != 0) throw py::error_already_set();
  Calibration out;
  out.array = array;
  out.fit = std::make_shared<const plumb::Calibration>(file.calibration);
  out.context = file.context;
  out.motion = file.motion;
  return out;
}

/// One number per sensor, or `width` of them.
template <class Figure>
py::array_t<double> per_sensor(const Calibration& calibration, py::ssize_t width, Figure figure) {
  const py::ssize_t n = calibration.fit->model.size;
  py::array_t<double> out(width == 0 ? std::vector<py::ssize_t>{n} : std::vector<py::ssize_t>{n, width});
  double* to = out.mutable_data();
  for (py::ssize_t i = 0; i < n; ++i) {
    for (py::ssize_t c = 0; c < std::max<py::ssize_t>(width, 1); ++c) {
      *to++ = figure(static_cast<std::size_t>(i), static_cast<std::size_t>(c));
    }
  }
  return out;
}

py::array_t<double> apply(const Calibration& calibration, const Log& log) {
  const Log::View view(log, *calibration.array);
  const int n = calibration.fit->model.size;
  py::array_t<double> out({view.rows(), py::ssize_t{n}});
  double* to = out.mutable_data();
  const py::gil_scoped_release others_may_run;
  for (py::ssize_t r = 0; r < view.rows(); ++r) {
    const plumb::Sample sample = view.at(r);
    const plumb::Readings y = calibration.fit->model.apply(sample.raw, sample.temperature_degc, sample.delivered);
    for (int i = 0; i < n; ++i) {
      *to++ = sample.delivered.has(i) ? y[static_cast<std::size_t>(i)] : std::numeric_limits<double>::quiet_NaN();
    }
  }
  return out;
}

}  // namespace

void bind_calibration(py::module_& module) {
  py::class_<Calibration>(module, "Calibration", "An accepted calibration: bias, scale and axis of every sensor.")
      .def_static("read", &read, array_argument(), py::arg("path"),
                  "Read a calibration file. Refuses one that was edited, or made for another array.")
      .def(
          "save",
          [](const Calibration& c, const std::string& path) {
            const auto written = plumb::io::write_calibration(path, *c.fit, *c.array, c.context).and_then([&] {
              return c.motion ? plumb::io::add_motion(path, path, *c.motion, *c.array)
                              : plumb::io::FileExpected<void>();
            });
            taken(written.map([] { return true; }));
          },
          py::arg("path"), "Write the calibration file that `plumb monitor` reads.")
      .def_property_readonly(
          "axes",
          [](const Calibration& c) {
            return per_sensor(c, 3,
                              [&](std::size_t i, std::size_t k) { return c.fit->array.axis(static_cast<int>(i))[k]; });
          },
          "Calibrated unit axes, (n, 3), tool frame.")
      .def_property_readonly(
          "scale",
          [](const Calibration& c) {
            return per_sensor(c, 4, [&](std::size_t i, std::size_t k) { return c.fit->model.sensor[i].scale[k]; });
          },
          "Raw unit per m/s^2: coefficients of 1, t, t^2, t^3 with t = T - reference_degc, (n, 4).")
      .def_property_readonly(
          "bias_mps2",
          [](const Calibration& c) {
            return per_sensor(c, 4, [&](std::size_t i, std::size_t k) { return c.fit->model.sensor[i].bias[k]; });
          },
          "The same of the bias [m/s^2].")
      .def_property_readonly(
          "reference_degc",
          [](const Calibration& c) {
            return per_sensor(c, 0, [&](std::size_t i, std::size_t) { return c.fit->model.sensor[i].reference_degc; });
          })
      .def_property_readonly(
          "e_cal_mps2",
          [](const Calibration& c) {
            return per_sensor(c, 0, [&](std::size_t i, std::size_t) { return c.fit->report.e_cal_mps2[i]; });
          },
          "What calibration leaves in a reading of each sensor, 1 sigma [m/s^2].")
      .def_property_readonly(
          "report",
          [](const Calibration& c) -> py::object {
            if (c.report.empty()) return py::none();
            return py::module_::import("json").attr("loads")(c.report);
          },
          "The report of the fit as `plumb calibrate --json` prints it, as a dict; None where it was read from a file.")
      .def_property_readonly(
          "date", [](const Calibration& c) { return c.context.date; }, "Date of the log, '2026-03-31'; empty: unknown.")
      .def_property_readonly(
          "serial", [](const Calibration& c) { return c.context.serial; }, "Serial number of the tool; empty: unknown.")
      .def("apply", &apply, py::arg("log"),
           "Accelerations along the sensor axes [m/s^2], positive down, (rows, n); NaN where a channel did not "
           "deliver.");

  module.def(
      "calibrate", &calibrate, array_argument(), py::arg("log"), py::arg("hold_out") = "",
      py::arg("temperature_order") = "auto", py::arg("keep_outliers") = false, py::arg("date") = "",
      py::arg("serial") = "",
      "Estimate bias, scale and direction of every sensor from a log of attitudes held still, as `plumb calibrate` "
      "does:\n"
      "it finds the still stretches by itself, or takes rows as stations where the array file says so. Raises Error\n"
      "where the fit is not accepted, with what is wrong and what to do. hold_out: a number of folds, a fraction, "
      "'one'\n"
      "or 'none'; temperature_order: 'auto' or 0 to 3. date ('2026-03-31') and serial are kept with the calibration.");
}

}  // namespace plumb_python
