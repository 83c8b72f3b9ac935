#include "motion_row.hpp"

#include <pybind11/stl.h>

#include <cmath>
#include <cstring>
#include <limits>

#include "plumb/io/records.hpp"
#include "row_parts.hpp"

namespace plumb_python {
namespace {

/// What `MotionVerdict.sample` and `.block` return.
struct Force {
  Array array;
  plumb::SpecificForce force;
  ForceRow row;
};

void write_force(const plumb::SpecificForce& force, const plumb::Mat3& frame, ForceRow& row) {
  const bool known = force.validity != plumb::ForceValidity::none;
  const double nothing = std::numeric_limits<double>::quiet_NaN();
  row.validity = number(force.validity);
  row.dominant = number(force.dominant);
  row.gyro_assumed = force.gyro_assumed;
  row.used = force.used.bits;
  row.time_s = known ? force.time_s : nothing;
  row.span_s = force.span_s;
  const plumb::Vec3 vector = plumb::io::in_frame(frame, force.force_mps2);
  const plumb::Mat3 covariance = plumb::io::covariance_in_frame(frame, force.covariance_m2ps4);
  for (std::size_t a = 0; a < 3; ++a) {
    row.force_mps2[a] = known ? vector[a] : nothing;
    for (std::size_t b = 0; b < 3; ++b) row.covariance_m2ps4[a][b] = known ? covariance[3 * a + b] : nothing;
  }
  row.bound_mps2 = force.bound_mps2;
}

Force force_of(const MotionVerdict& of, const plumb::SpecificForce& force) {
  Force out{of.array, force, {}};
  write_force(force, of.array->output_frame, out.row);
  return out;
}

/// What `MotionVerdict.inclination` returns.
struct Inclination {
  plumb::InclinationInterval interval;
  InclinationRow row{};
};

void write_interval(const plumb::InclinationInterval& interval, InclinationRow& row) {
  const bool known = interval.status == plumb::InclinationStatus::known;
  const auto figure = [known](double value) { return known ? value : std::numeric_limits<double>::quiet_NaN(); };
  row.status = number(interval.status);
  row.widest = known ? number(interval.widest) : std::uint8_t{0};
  row.gyro_assumed = known && interval.gyro_assumed;
  const bool full = known || interval.status == plumb::InclinationStatus::contradicts_gravity;
  row.time_s = full ? interval.time_s : std::numeric_limits<double>::quiet_NaN();
  row.span_s = full ? interval.span_s : std::numeric_limits<double>::quiet_NaN();
  row.inclination_rad = figure(interval.inclination_rad);
  row.low_rad = figure(interval.low_rad);
  row.high_rad = figure(interval.high_rad);
}

py::object inclination_of(const MotionVerdict& of) {
  if (!of.inclination) return py::none();
  Inclination out{*of.inclination, {}};
  write_interval(out.interval, out.row);
  return py::cast(out);
}

std::vector<std::string> ids(const Array& array, plumb::SensorSet set) {
  std::vector<std::string> out;
  for (int i = 0; i < array->array.size(); ++i) {
    if (set.has(i)) out.emplace_back(array->array.row(i).id.data());
  }
  return out;
}

py::str word_list(const Array& array, plumb::SensorSet set) {
  return py::str(", ").attr("join")(py::cast(ids(array, set)));
}

void bind_force(py::module_& module) {
  py::class_<Force>(
      module, "SpecificForce",
      "Specific force at the reference point in motion, in the output frame: a mean over two blocks, with\n"
      "a bound on its error. At rest it is as long as gravity and upwards. Read validity first.")
      .def_property_readonly(
          "validity", [](const Force& f) { return to_string(f.force.validity); },
          "'none', 'unchecked' (the bound holds while no further unit fails) or 'bounded'.")
      .def_property_readonly(
          "time_s", [](const Force& f) { return f.row.time_s; }, "The instant that it belongs to [s]; NaN: no force.")
      .def_property_readonly(
          "span_s", [](const Force& f) { return f.row.span_s; }, "Length of each of the two blocks behind it [s].")
      .def_property_readonly(
          "force_mps2", [](const Force& f) { return py::array_t<double>(3, f.row.force_mps2); },
          "(3,) [m/s^2]; NaN: no force.")
      .def_property_readonly(
          "covariance_m2ps4",
          [](const Force& f) {
            return py::array_t<double>({3, 3}, &f.row.covariance_m2ps4[0][0]);
          },
          "Of its noise alone, (3, 3) [(m/s^2)^2]; NaN: no force.")
      .def_property_readonly(
          "bound_mps2", [](const Force& f) { return f.row.bound_mps2; },
          "Of the length of its error [m/s^2]; infinite: none.")
      .def_property_readonly(
          "dominant",
          [](const Force& f) -> py::object {
            if (f.force.validity == plumb::ForceValidity::none) return py::none();
            return py::str(to_string(f.force.dominant));
          },
          "The largest part of the bound, one of FORCE_TERMS; None: no force.")
      .def_property_readonly(
          "gyro_assumed", [](const Force& f) { return f.force.gyro_assumed; },
          "The bound holds while the only gyro is healthy.")
      .def_property_readonly(
          "used", [](const Force& f) { return ids(f.array, f.force.used); }, "Ids of the sensors that are in it.")
      .def("__repr__", [](const Force& f) {
        return py::str("<plumb.SpecificForce {}: {} m/s^2 at {} s, bound {} m/s^2>")
            .format(to_string(f.force.validity), py::array_t<double>(3, f.row.force_mps2), f.row.time_s,
                    f.row.bound_mps2);
      });
}

void bind_inclination(py::module_& module) {
  const auto figure = [](double InclinationRow::*which) {
    return [which](const Inclination& i) { return i.row.*which; };
  };
  py::class_<Inclination>(module, "Inclination",
                          "Inclination of the z axis of [output] over the last full window in motion: an interval.\n"
                          "Its figures are NaN but with status 'known'.")
      .def_property_readonly(
          "status", [](const Inclination& i) { return to_string(i.interval.status); },
          "'known', or why there is none: one of INCLINATION_STATUSES.")
      .def_property_readonly("time_s", figure(&InclinationRow::time_s), "The middle of the window [s].")
      .def_property_readonly("span_s", figure(&InclinationRow::span_s), "Its length [s].")
      .def_property_readonly("inclination_rad", figure(&InclinationRow::inclination_rad),
                             "Against gravity; its cosine is the mean cosine over the window [rad].")
      .def_property_readonly("low_rad", figure(&InclinationRow::low_rad), "It lies between this [rad]")
      .def_property_readonly("high_rad", figure(&InclinationRow::high_rad), "and this [rad].")
      .def_property_readonly(
          "gyro_assumed", [](const Inclination& i) { return i.row.gyro_assumed; },
          "It holds while the only gyro is healthy.")
      .def_property_readonly(
          "widest",
          [](const Inclination& i) -> py::object {
            if (i.interval.status != plumb::InclinationStatus::known) return py::none();
            return py::str(to_string(i.interval.widest));
          },
          "The largest part of the interval, one of INCLINATION_TERMS; None: there is no interval.")
      .def("__repr__", [](const Inclination& i) {
        return py::str("<plumb.Inclination {}: {} rad, from {} to {}, at {} s>")
            .format(to_string(i.interval.status), i.row.inclination_rad, i.row.low_rad, i.row.high_rad, i.row.time_s);
      });
}

void bind_object(py::module_& module) {
  const auto set = [](plumb::SensorSet plumb::MotionVerdict::*which) {
    return [which](const MotionVerdict& v) { return ids(v.array, v.verdict.*which); };
  };
  py::class_<MotionVerdict>(module, "MotionVerdict",
                            "What MotionMonitor says of a sample. Sets of sensors are lists of ids.")
      .def_property_readonly(
          "time_s", [](const MotionVerdict& v) { return v.time_s; }, "Time of the sample [s].")
      .def_property_readonly(
          "alarm", [](const MotionVerdict& v) { return v.verdict.alarm; }, "Readings contradict each other.")
      .def_property_readonly(
          "cause", [](const MotionVerdict& v) { return to_string(v.verdict.cause); },
          "Why no sensor is isolated, or nothing is judged: one of MOTION_CAUSES.")
      .def_property_readonly(
          "gyros_disagree", [](const MotionVerdict& v) { return v.verdict.gyros_disagree; },
          "The two gyros read more apart than their bounds allow: one of them is faulty, and no sensor is blamed.")
      .def_property_readonly("rejected", set(&plumb::MotionVerdict::rejected),
                             "Members of the sets that the last blocks rejected.")
      .def_property_readonly("suspects", set(&plumb::MotionVerdict::suspects), "In some of the smallest explanations.")
      .def_property_readonly("isolated", set(&plumb::MotionVerdict::isolated), "In every explanation.")
      .def_property_readonly("excluded", set(&plumb::MotionVerdict::excluded), "Excluded here, provisionally.")
      .def_property_readonly(
          "least_faults", [](const MotionVerdict& v) { return v.verdict.least_faults; },
          "Units that it takes at least to explain what is on record.")
      .def_property_readonly(
          "block_ended", [](const MotionVerdict& v) { return v.verdict.block_ended; },
          "`block` is new with this sample.")
      .def_property_readonly(
          "sample", [](const MotionVerdict& v) { return force_of(v, v.verdict.sample); },
          "SpecificForce of the last two samples.")
      .def_property_readonly(
          "block", [](const MotionVerdict& v) { return force_of(v, v.verdict.block); },
          "SpecificForce of the last two blocks of block_samples[2] samples, as a rule 32: tighter and later.")
      .def_property_readonly(
          "inclination_ended", [](const MotionVerdict& v) { return v.inclination_ended; },
          "`inclination` is new with this sample: a window has ended, or why there is none.")
      .def_property_readonly("inclination", &inclination_of,
                             "Inclination over the last window; None: [motion] states no velocity_bound_mps.")
      .def("__repr__", [](const MotionVerdict& v) {
        return py::str("<plumb.MotionVerdict at {} s: alarm {}, cause {}, isolated [{}], excluded [{}]>")
            .format(v.time_s, v.verdict.alarm, to_string(v.verdict.cause), word_list(v.array, v.verdict.isolated),
                    word_list(v.array, v.verdict.excluded));
      });
}

}  // namespace

void write_row(double time_s, const plumb::MotionVerdict& v, const plumb::Mat3& frame, MotionRow& row) {
  std::memset(&row, 0, sizeof row);
  row.time_s = time_s;
  row.cause = number(v.cause);
  row.alarm = v.alarm;
  row.gyros_disagree = v.gyros_disagree;
  row.block_ended = v.block_ended;
  row.rejected = v.rejected.bits;
  row.suspects = v.suspects.bits;
  row.isolated = v.isolated.bits;
  row.excluded = v.excluded.bits;
  row.least_faults = v.least_faults;
  write_force(v.sample, frame, row.sample);
  write_force(v.block, frame, row.block);
}

void write_inclination(bool ended, const plumb::InclinationInterval* interval, MotionRow& to) {
  to.inclination_ended = ended;
  write_interval(interval != nullptr ? *interval : plumb::InclinationInterval{}, to.inclination);
}

void bind_motion_verdict(py::module_& module) {
#define PLUMB_DESCRIPTOR(type, name, extent, what) PYBIND11_FIELD_DESCRIPTOR(ForceRow, name),
  py::detail::npy_format_descriptor<ForceRow>::register_dtype(
      std::vector<py::detail::field_descriptor>{PLUMB_FORCE_ROW(PLUMB_DESCRIPTOR)});
#undef PLUMB_DESCRIPTOR
#define PLUMB_DESCRIPTOR(type, name, extent, what) PYBIND11_FIELD_DESCRIPTOR(InclinationRow, name),
  py::detail::npy_format_descriptor<InclinationRow>::register_dtype(
      std::vector<py::detail::field_descriptor>{PLUMB_INCLINATION_ROW(PLUMB_DESCRIPTOR)});
#undef PLUMB_DESCRIPTOR
#define PLUMB_DESCRIPTOR(type, name, extent, what) PYBIND11_FIELD_DESCRIPTOR(MotionRow, name),
  py::detail::npy_format_descriptor<MotionRow>::register_dtype(
      std::vector<py::detail::field_descriptor>{PLUMB_MOTION_ROW(PLUMB_DESCRIPTOR)});
#undef PLUMB_DESCRIPTOR
  module.attr("motion_dtype") = py::dtype::of<MotionRow>();
  py::dict force, inclination, motion;
#define PLUMB_TEXT(type, name, extent, what) force[#name] = py::str(what);
  PLUMB_FORCE_ROW(PLUMB_TEXT)
#undef PLUMB_TEXT
#define PLUMB_TEXT(type, name, extent, what) inclination[#name] = py::str(what);
  PLUMB_INCLINATION_ROW(PLUMB_TEXT)
#undef PLUMB_TEXT
#define PLUMB_TEXT(type, name, extent, what) motion[#name] = py::str(what);
  PLUMB_MOTION_ROW(PLUMB_TEXT)
#undef PLUMB_TEXT
  module.attr("MOTION_FIELDS") = motion;
  module.attr("FORCE_FIELDS") = force;
  module.attr("INCLINATION_FIELDS") = inclination;
  module.attr("MOTION_CAUSES") = names(plumb::MotionCause::irregular_time);
  module.attr("FORCE_VALIDITIES") = names(plumb::ForceValidity::bounded);
  module.attr("FORCE_TERMS") = names(plumb::ForceTerm::fault);
  module.attr("INCLINATION_STATUSES") = names(plumb::InclinationStatus::contradicts_gravity);
  module.attr("INCLINATION_TERMS") = names(plumb::InclinationTerm::alignment);
  bind_force(module);
  bind_inclination(module);
  bind_object(module);
}

}  // namespace plumb_python
