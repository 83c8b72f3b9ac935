/// The Python module `plumb`: what its parts share. Arrays are numpy's: float64 is read where it lies, whatever its
/// strides, and results are written into the array that is returned.
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <array>
#include <cstring>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <vector>

#include "plumb/health/rotation.hpp"
#include "plumb/io/array_file.hpp"
#include "plumb/io/log_writer.hpp"
#include "plumb/motion/motion_setup.hpp"
#include "plumb/session/monitor_pipeline.hpp"

namespace plumb_python {

namespace py = pybind11;

/// Becomes plumb.Error, with the words that the tool prints after "plumb: ".
struct Refused : std::runtime_error {
  using std::runtime_error::runtime_error;
};
[[noreturn]] void refuse(const std::string& what, const std::string& remedy);
template <class T>
T taken(plumb::io::FileExpected<T> result) {
  if (!result) throw Refused(result.error().text());
  return *std::move(result);
}
/// The argument that names an array file: None would be a null pointer.
inline py::arg array_argument() { return std::move(py::arg("array").none(false)); }

using Doubles = py::array_t<double, py::array::forcecast>;
using Flags = py::array_t<bool, py::array::forcecast>;
using Tags = py::array_t<std::uint32_t, py::array::forcecast>;

/// Numbers, where they lie if they are float64 already; refuses what is none, by the name of the argument.
Doubles doubles(const py::object& from, const char* name);

/// The names of the arguments and columns with the rates of the gyros.
inline constexpr std::array<const char*, plumb::kGyros> kRateNames = {"rate_radps", "second_rate_radps"};

/// An array file.
using Array = std::shared_ptr<plumb::io::ArrayFile>;

/// Samples as columns. What is None has its default.
struct Log {
  Doubles time_s, raw;
  py::object temperature_degc, delivered, station, count, roll_group, truth;
  py::object clock_s = py::none();  ///< (rows, clocks), of chips with clocks of their own
  std::array<py::object, plumb::kGyros> rate_radps;
  bool one_sample = false;  ///< made of the arguments of a step: shapes are told without the rows

  py::ssize_t rows() const { return raw.shape(0); }
  /// Reads the columns in place; refuses shapes that do not fit `sensors`. Keeps what it reads from alive.
  class View;
};

class Log::View {
 public:
  View(const Log& log, const plumb::io::ArrayFile& array);
  py::ssize_t rows() const { return rows_; }
  bool one_sample() const { return one_sample_; }
  plumb::Sample at(py::ssize_t row) const;  // touches no Python object
  double time_s(py::ssize_t row) const { return time_.at(row); }
  bool has_clocks() const { return clock_.data != nullptr; }
  /// One a [[clock]]; touches no Python object.
  plumb::io::ClockTimes clock_s(py::ssize_t row) const;
  bool turns(std::size_t gyro) const { return rate_[gyro].data != nullptr; }
  /// Touches no Python object. A rate that is not finite is not known; without a column the tool does not turn.
  plumb::Rotation rotation(std::size_t gyro, py::ssize_t row) const;

 private:
  template <class T>
  struct Column {
    py::array kept;
    const char* data = nullptr;
    py::ssize_t stride = 0, across = 0;
    /// By bytes: a field of a packed record is not aligned, and a byte that numpy looks at as bool may be any.
    T at(py::ssize_t row, py::ssize_t column = 0) const {
      const char* const from = data + row * stride + column * across;
      if constexpr (std::is_same_v<T, bool>) {
        return *from != 0;
      } else {
        T value;
        std::memcpy(&value, from, sizeof value);
        return value;
      }
    }
  };
  template <class T>
  Column<T> column(const py::object& from, const char* name, int width,
                   const char* across = "sensor of the array") const;
  /// Tags and counts: a cast alone would make a station of -1 or of NaN.
  Column<std::uint32_t> whole_numbers(const py::object& from, const char* name) const;

  bool one_sample_ = false;
  py::ssize_t rows_ = 0;
  int sensors_ = 0;
  int clocks_ = 0;
  Column<double> time_, raw_, temperature_, clock_;
  Column<bool> delivered_;
  Column<std::uint32_t> station_, count_, roll_group_;
  std::array<Column<double>, plumb::kGyros> rate_;
  double default_temperature_degc_ = 25.0;
};

struct Calibration {
  Array array;
  std::shared_ptr<const plumb::Calibration> fit;
  plumb::io::CalibrationContext context;
  std::shared_ptr<const plumb::io::MotionCalibration> motion;  ///< null where no log in motion was fitted
  std::string report;                                          ///< JSON; empty where it was read from a file
};

void bind_log(py::module_& module);
void bind_calibration(py::module_& module);
void bind_monitor(py::module_& module);
void bind_motion(py::module_& module);
void bind_rates(py::module_& module);
void bind_dip(py::module_& module);

}  // namespace plumb_python
