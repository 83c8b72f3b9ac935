// The dip of the Earth's field beside a monitor that has three accelerometers left.
#include <pybind11/stl.h>

#include "monitor.hpp"
#include "plumb/health/dip_watch.hpp"

namespace plumb_python {
namespace {

plumb::FieldReference reference_of(const plumb::io::ArrayFile& magnetic) {
  const plumb::io::MagneticReference& m = magnetic.magnetic;
  if (magnetic.field != plumb::io::FieldKind::magnetic)
    refuse("magnetic: its sensors measure " + std::string(to_string(magnetic.field)) + ", and the dip is the field's",
           "name a group with field = \"magnetic\": Array.read('tool.toml#mag')");
  if (!m.dip_known)
    refuse("magnetic: its [group.reference] states no dip", "add dip, or model = \"wmm\" with a place and a date");
  return {1e3 * m.total_ut, {1e3 * m.total_sigma_ut, 0.0}, m.dip_rad, {m.dip_sigma_rad, 0.0}};
}

plumb::DipAssumption assumption_of(const std::string& text) {
  if (text == "any fault") return plumb::DipAssumption::any_fault;
  if (text != "constant bias") refuse("assumption: is \"" + text + "\"", "give \"any fault\" or \"constant bias\"");
  return plumb::DipAssumption::constant_bias;
}

/// What a block says, with the names of its array.
struct Report {
  Array array;
  plumb::DipReport found;

  std::vector<std::string> ids(plumb::SensorSet set) const {
    std::vector<std::string> out;
    for (int i = 0; i < array->array.size(); ++i) {
      if (set.has(i)) out.emplace_back(array->array.row(i).id.data());
    }
    return out;
  }
  py::object named() const {
    const int i = found.answer.named;
    return i < 0 ? py::none() : py::object(py::str(array->array.row(i).id.data()));
  }
  py::array_t<double> gravity_mps2() const {
    const plumb::Vec3 turned = plumb::times(array->output_frame, found.gravity_mps2);
    return py::array_t<double>(3, turned.data());
  }
};

/// Holds its monitor by reference: Python keeps that alive.
class DipWatch {
 public:
  DipWatch(Monitor& monitor, const Array& magnetic, const std::string& assumption)
      : monitor_(monitor), reference_(reference_of(*magnetic)), watch_(assumption_of(assumption)) {}

  Report add(const py::object& field_nt, double axis_sigma_nt, double axis_bound_nt, double interference_nt,
             double turn_rad) {
    const Doubles given = doubles(field_nt, "field_nt");
    if (given.ndim() != 1 || given.shape(0) != 3)
      refuse("field_nt: is not three numbers", "give the mean of the magnetometers in the tool frame");
    plumb::FieldReading field;
    for (std::size_t k = 0; k < 3; ++k) field.field_nt[k] = given.at(static_cast<py::ssize_t>(k));
    field.axis_error_nt = {axis_sigma_nt, axis_bound_nt};
    field.vector_nt = interference_nt;
    field.turn_rad = turn_rad;
    return {monitor_.array(), watch_.add(monitor_.idle(), monitor_.setup(), field, reference_)};
  }
  void forget() { watch_.forget(); }

 private:
  Monitor& monitor_;
  plumb::FieldReference reference_;
  plumb::DipWatch watch_;
};

}  // namespace

void bind_dip(py::module_& module) {
  py::class_<Report>(module, "DipReport", "What the dip says of one block; sensors by their ids.")
      .def_property_readonly(
          "verdict", [](const Report& r) { return std::string(to_string(r.found.answer.verdict)); },
          "\"not_judged\", \"consistent\", \"unseen\", \"fault\" or \"unexplained\".")
      .def_property_readonly(
          "refusal", [](const Report& r) { return std::string(to_string(r.found.answer.refusal)); },
          "Why it is not judged.")
      .def_property_readonly("named", &Report::named, "The faulty sensor; None where no single one is left.")
      .def_property_readonly(
          "suspects", [](const Report& r) { return r.ids(r.found.answer.suspects); }, "One of these may be faulty.")
      .def_property_readonly(
          "mirrors", [](const Report& r) { return r.ids(r.found.answer.mirrors); },
          "Those with a possible fault that would not show.")
      .def_property_readonly("gravity_mps2", &Report::gravity_mps2,
                             "(3), output frame; without a sensor that is named, the verdict's [m/s^2].")
      .def_property_readonly(
          "protected_by_dip", [](const Report& r) { return r.found.protected_by_dip; },
          "Whether the bounds below are made with the dip; else those of the verdict stand.")
      .def_property_readonly(
          "protection_level_calibrated_axes_rad",
          [](const Report& r) { return r.found.protection_level_calibrated_axes_rad; }, "As in the verdict [rad].")
      .def_property_readonly(
          "protection_level_housing_rad", [](const Report& r) { return r.found.protection_level_housing_rad; },
          "As in the verdict [rad].");
  py::class_<DipWatch>(
      module, "DipWatch",
      "The dip of the Earth's field as a second reference beside a Monitor that has three sensors left: is one of "
      "them\n"
      "faulty, which, and how far may the direction be off? The monitor does not hear of it. magnetic: a group with\n"
      "field = \"magnetic\" and a dip, read by Array.read('tool.toml#mag'): its [group.reference] is the field at the\n"
      "place. assumption: \"any fault\", or \"constant bias\", of the fault from block to block.")
      .def(py::init<Monitor&, Array, const std::string&>(), py::arg("monitor"), py::arg("magnetic").none(false),
           py::arg("assumption") = "any fault", py::keep_alive<1, 2>())
      .def("add", &DipWatch::add, py::arg("field_nt"), py::arg("axis_sigma_nt"), py::arg("axis_bound_nt") = 0.0,
           py::arg("interference_nt") = 0.0, py::arg("turn_rad") = 0.0,
           "After a run whose last row is a tick: a block at rest is complete. field_nt: (3), mean of healthy "
           "magnetometers over that block,\n"
           "tool frame. axis_sigma_nt and axis_bound_nt: noise and calibration of each component; interference_nt: "
           "bound\n"
           "on what is added to the vector; turn_rad: bound on the turn of the magnetometers against the "
           "accelerometers.\n"
           "Returns a DipReport.")
      .def("forget", &DipWatch::forget, "Begin anew: after an exclusion or a repair.");
}

}  // namespace plumb_python
