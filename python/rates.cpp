// Redundant gyros: a group of rates of an array file over a log.
#include <pybind11/stl.h>

#include <cmath>
#include <cstring>
#include <limits>

#include "monitor.hpp"
#include "plumb/session/rate_run.hpp"
#include "row_parts.hpp"

namespace plumb_python {
namespace {

// COLUMN(type, name, extent, what it is). Sets of axes are bits, of axis i bit i; vectors are in the tool frame.
// clang-format off
#define PLUMB_RATE_ROW(RATE_COLUMN) \
  RATE_COLUMN(std::uint8_t, validity, , "index into FORCE_VALIDITIES: whether the bound holds; read it before anything else") \
  RATE_COLUMN(std::uint32_t, used, , "axes that are in it") \
  RATE_COLUMN(double, time_s, , "the instant that it belongs to [s]; NaN: no rate") \
  RATE_COLUMN(double, span_s, , "length of each of the two blocks behind it [s]") \
  RATE_COLUMN(double, rate_radps, [3], "angular rate, tool frame [rad/s]; NaN: no rate") \
  RATE_COLUMN(double, covariance_rad2ps2, [3][3], "of its noise alone [(rad/s)^2]; NaN: no rate") \
  RATE_COLUMN(double, bound_radps, , "of the length of its error [rad/s]; infinite: none")

#define PLUMB_RATES_ROW(RATES_COLUMN) \
  RATES_COLUMN(double, time_s, , "time of the sample [s]") \
  RATES_COLUMN(std::uint8_t, cause, , "index into MOTION_CAUSES: why no axis is isolated, or nothing is judged") \
  RATES_COLUMN(bool, alarm, , "readings contradict each other") \
  RATES_COLUMN(bool, turned_at_rest, , "axes read a rate at rest and nobody is suspected: the tool turned, or a small fault") \
  RATES_COLUMN(bool, block_ended, , "`block` is new with this sample") \
  RATES_COLUMN(std::uint32_t, suspects, , "axes in some of the smallest explanations") \
  RATES_COLUMN(std::uint32_t, isolated, , "axes in every explanation, or off zero at rest") \
  RATES_COLUMN(std::uint32_t, excluded, , "axes that are excluded, provisionally") \
  RATES_COLUMN(std::uint32_t, off_at_rest, , "axes that parity suspects and that read at rest what no healthy axis does") \
  RATES_COLUMN(RateRow, sample, , "angular rate of the last two samples, a record (RATE_FIELDS)") \
  RATES_COLUMN(RateRow, block, , "of the last two blocks of block_samples[2] samples, a record (RATE_FIELDS)")
// clang-format on

#define PLUMB_MEMBER(type, name, extent, what) type name extent;
struct RateRow {
  PLUMB_RATE_ROW(PLUMB_MEMBER)
};
struct RatesRow {
  PLUMB_RATES_ROW(PLUMB_MEMBER)
};
#undef PLUMB_MEMBER

void write_rate(const plumb::AngularRate& rate, RateRow& row) {
  const bool known = rate.validity != plumb::ForceValidity::none;
  const auto figure = [known](double value) { return known ? value : std::numeric_limits<double>::quiet_NaN(); };
  row.validity = number(rate.validity);
  row.used = rate.used.bits;
  row.time_s = figure(rate.time_s);
  row.span_s = rate.span_s;
  for (std::size_t a = 0; a < 3; ++a) {
    row.rate_radps[a] = figure(rate.rate_radps[a]);
    for (std::size_t b = 0; b < 3; ++b) row.covariance_rad2ps2[a][b] = figure(rate.covariance_rad2ps2[3 * a + b]);
  }
  row.bound_radps = rate.bound_radps;
}

/// Every byte of it, padding too: equal verdicts are equal bytes.
void write_row(double time_s, const plumb::RateVerdict& v, RatesRow& row) {
  std::memset(&row, 0, sizeof row);
  row.time_s = time_s;
  row.cause = number(v.cause);
  row.alarm = v.alarm;
  row.turned_at_rest = v.turned_at_rest;
  row.block_ended = v.block_ended;
  row.suspects = v.suspects.bits;
  row.isolated = v.isolated.bits;
  row.excluded = v.excluded.bits;
  row.off_at_rest = v.off_at_rest.bits;
  write_rate(v.sample, row.sample);
  write_rate(v.block, row.block);
}

class RateMonitor {
 public:
  explicit RateMonitor(Array array) : array_(std::move(array)), model_(array_->datasheet.model()) {
    if (array_->field != plumb::io::FieldKind::rate)
      refuse("array: its sensors measure " + std::string(to_string(array_->field)) + ", and a RateMonitor judges gyros",
             "name a group with field = \"rate\": Array.read('tool.toml#gyros')");
    if (const auto configured = monitor_->configure(array_->array, array_->rate); !configured)
      throw Refused(plumb::io::from_error(configured.error()).text());
  }
  py::array_t<RatesRow> run(const Log& log, const py::object& at_rest, const py::object& force_mps2);
  void forget() {
    turnstile_.must_be_free();
    monitor_->forget();
  }

 private:
  Turnstile turnstile_;
  Array array_;
  plumb::SensorModel model_;
  std::unique_ptr<plumb::RateMonitor> monitor_ = std::make_unique<plumb::RateMonitor>();
};

/// One value a row, contiguous; refuses another shape.
std::vector<double> per_row(const py::object& from, const char* name, py::ssize_t rows, double otherwise) {
  if (from.is_none()) return std::vector<double>(static_cast<std::size_t>(rows), otherwise);
  const Doubles given = doubles(from, name);
  if (given.ndim() != 1 || given.shape(0) != rows)
    refuse(std::string(name) + ": is not one value per row of the log, " + std::to_string(rows),
           "give an array of that shape, or leave it out");
  std::vector<double> out;
  for (py::ssize_t r = 0; r < rows; ++r) out.push_back(given.at(r));
  return out;
}

py::array_t<RatesRow> RateMonitor::run(const Log& log, const py::object& at_rest, const py::object& force_mps2) {
  const Log::View view(log, *array_);
  const auto rest = per_row(at_rest, "at_rest", view.rows(), 0.0);
  const auto force = per_row(force_mps2, "force_mps2", view.rows(), -1.0);
  py::array_t<RatesRow> out(view.rows());
  RatesRow* to = out.mutable_data();
  turnstile_.must_be_free();
  const Turnstile::Inside inside(turnstile_);
  const py::gil_scoped_release others_may_run;
  for (py::ssize_t r = 0; r < view.rows(); ++r) {
    plumb::RateSample sample = plumb::session::rate_sample(*array_, model_, view.at(r));
    sample.at_rest = rest[static_cast<std::size_t>(r)] > 0.0;  // NaN: not known
    sample.force_mps2 = force[static_cast<std::size_t>(r)];
    write_row(sample.time_s, monitor_->step(sample), *to++);
  }
  return out;
}

void bind_rows(py::module_& module) {
  py::dict rate, rates;
#define PLUMB_DESCRIPTOR(type, name, extent, what) PYBIND11_FIELD_DESCRIPTOR(RateRow, name),
  py::detail::npy_format_descriptor<RateRow>::register_dtype(
      std::vector<py::detail::field_descriptor>{PLUMB_RATE_ROW(PLUMB_DESCRIPTOR)});
#undef PLUMB_DESCRIPTOR
#define PLUMB_DESCRIPTOR(type, name, extent, what) PYBIND11_FIELD_DESCRIPTOR(RatesRow, name),
  py::detail::npy_format_descriptor<RatesRow>::register_dtype(
      std::vector<py::detail::field_descriptor>{PLUMB_RATES_ROW(PLUMB_DESCRIPTOR)});
#undef PLUMB_DESCRIPTOR
#define PLUMB_TEXT(type, name, extent, what) rate[#name] = py::str(what);
  PLUMB_RATE_ROW(PLUMB_TEXT)
#undef PLUMB_TEXT
#define PLUMB_TEXT(type, name, extent, what) rates[#name] = py::str(what);
  PLUMB_RATES_ROW(PLUMB_TEXT)
#undef PLUMB_TEXT
  module.attr("rates_dtype") = py::dtype::of<RatesRow>();
  module.attr("RATE_FIELDS") = rate;
  module.attr("RATES_FIELDS") = rates;
}

}  // namespace

void bind_rates(py::module_& module) {
  bind_rows(module);
  py::class_<RateMonitor>(
      module, "RateMonitor",
      "Judges redundant gyro axes in motion and at rest by [group.rate] of their group in the array file, and "
      "publishes\n"
      "the rate of those that may be trusted with a bound on its error. array: a group with field = \"rate\", read by\n"
      "Array.read('tool.toml#gyros'); bias and scale are those of the array file. For one thread at a time.")
      .def(py::init<Array>(), array_argument())
      .def(
          "run", &RateMonitor::run, py::arg("log"), py::arg("at_rest") = py::none(), py::arg("force_mps2") = py::none(),
          "Step all samples of a Log, and go on where the last run ended. Returns a structured array (rates_dtype), "
          "one\n"
          "row per sample: RATES_FIELDS and RATE_FIELDS say what each figure is. at_rest: (rows), above 0 where the "
          "tool\n"
          "is known to stand, by its accelerometers above all; None: not known. force_mps2: (rows), length of the\n"
          "specific force, for g-sensitivity; NaN, below 0 or None: the bound of the array file. Raises Error where a\n"
          "shape does not fit; then nothing was judged.")
      .def("forget", &RateMonitor::forget, "Take back exclusions and evidence.");
}

}  // namespace plumb_python
