// The Python module `plumb`: array files and errors; the other parts have a file each.
#include "module.hpp"

#include <pybind11/stl.h>

#include "motion_row.hpp"
#include "plumb/geomagnetic/field_reference.hpp"

namespace plumb_python {

void refuse(const std::string& what, const std::string& remedy) {
  throw Refused(plumb::io::FileError{"", 0, "", what, remedy}.text());
}

namespace {

std::vector<std::string> ids(const Array& array) {
  std::vector<std::string> out;
  for (int i = 0; i < array->array.size(); ++i) out.emplace_back(array->array.row(i).id.data());
  return out;
}

py::array_t<double> axes(const Array& array) {
  py::array_t<double> out({array->array.size(), 3});
  auto to = out.mutable_unchecked<2>();
  for (int i = 0; i < array->array.size(); ++i) {
    for (py::ssize_t c = 0; c < 3; ++c) to(i, c) = array->array.axis(i)[static_cast<std::size_t>(c)];
  }
  return out;
}

Array shared(plumb::io::ArrayFile file) { return std::make_shared<plumb::io::ArrayFile>(std::move(file)); }

}  // namespace
}  // namespace plumb_python

PYBIND11_MODULE(plumb, module) {
  using namespace plumb_python;
  module.doc() =
      "plumb calibrates and monitors redundant accelerometers: which sensors are valid, and which way is\n"
      "down. The same library as the C++ one and the tool, with numpy arrays.\n\n"
      "    array = plumb.Array.read('tool.toml')\n"
      "    calibration = plumb.calibrate(array, plumb.read_log(array, 'stations.csv'))\n"
      "    verdicts = plumb.Monitor(array, calibration).run(plumb.read_log(array, 'run.csv'))\n\n"
      "Units are SI: m/s^2, s, rad, degC. Gravity is positive down. Raw values are those of the log.\n"
      "A refusal raises plumb.Error with the message that the tool prints.";
  module.attr("__version__") = PLUMB_VERSION;
  py::register_exception<Refused>(module, "Error", PyExc_ValueError);

  py::class_<plumb::io::ArrayFile, Array>(module, "Array",
                                          "An array of sensors, its place and its log: what an array file (TOML) says.")
      .def_static(
          "read",
          [](const std::string& path) {
            return shared(taken(plumb::io::read_array_file(path, plumb::geomagnetic::lookup)));
          },
          py::arg("path"),
          "Read an array file, or a group of it: 'tool.toml#mag'. Raises Error with file, line, field and remedy.")
      .def_static(
          "parse", [](const std::string& text) { return shared(taken(plumb::io::parse_array_text(text, "<text>"))); },
          py::arg("text"), "The same from the text of one.")
      .def_property_readonly("sensors", &ids, "Ids, in order.")
      .def_property_readonly("axes", &axes, "Nominal unit axes, (n, 3), tool frame.")
      .def_readonly("name", &plumb::io::ArrayFile::name)
      .def_property_readonly(
          "field", [](const plumb::io::ArrayFile& a) { return std::string(to_string(a.field)); },
          "What the sensors measure: 'gravity', 'magnetic' or 'rate'. What is called m/s^2 here is 4 uT of a magnetic "
          "field and rad/s of a rate.")
      .def_property_readonly(
          "gravity_mps2", [](const plumb::io::ArrayFile& a) { return a.gravity.g_mps2; },
          "Length of gravity at the place that the file names [m/s^2].")
      .def("__len__", [](const plumb::io::ArrayFile& a) { return a.array.size(); })
      .def("__repr__", [](const plumb::io::ArrayFile& a) {
        return "<plumb.Array " + a.name + ": " + std::to_string(a.array.size()) + " sensors>";
      });
  bind_log(module);
  bind_calibration(module);
  bind_motion_verdict(module);
  bind_monitor(module);
  bind_motion(module);
  bind_rates(module);
  bind_dip(module);
}
