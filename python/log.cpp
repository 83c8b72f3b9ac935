// Logs: samples as numpy columns, from arrays, from a CSV file, or played from a scenario.
#include <pybind11/stl.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "module.hpp"
#include "plumb/io/log_reader.hpp"
#include "plumb/io/records.hpp"
#include "plumb/io/scenario_file.hpp"
#include "plumb/session/played_log.hpp"
#include "plumb/session/station_mean.hpp"

namespace plumb_python {
namespace {

/// The values of a masked array without its mask would count as measured.
void refuse_mask(const py::handle& from, const char* name) {
  if (py::isinstance<py::array>(from) && py::hasattr(from, "mask"))
    refuse(std::string(name) + ": is a masked array, which plumb does not support",
           "give numpy.ma.filled(column, numpy.nan), and mark missing values in `delivered`");
}

[[noreturn]] void refuse_type(const char* name) {
  PyErr_Clear();
  refuse(std::string(name) + ": is not an array of numbers", "give a numpy array");
}

/// Columns of `samples`, allocated once and written in place.
Log columns(const std::vector<plumb::Sample>& samples, int sensors) {
  const auto rows = static_cast<py::ssize_t>(samples.size());
  Log log;
  py::array_t<double> time(rows), raw({rows, py::ssize_t{sensors}}), temperature(rows);
  py::array_t<bool> delivered({rows, py::ssize_t{sensors}});
  py::array_t<std::uint32_t> station(rows), count(rows), roll_group(rows);
  auto raw_to = raw.mutable_unchecked<2>();
  auto delivered_to = delivered.mutable_unchecked<2>();
  for (py::ssize_t r = 0; r < rows; ++r) {
    const plumb::Sample& s = samples[static_cast<std::size_t>(r)];
    time.mutable_at(r) = s.time_s;
    temperature.mutable_at(r) = s.temperature_degc;
    station.mutable_at(r) = s.station;
    count.mutable_at(r) = s.count;
    roll_group.mutable_at(r) = s.roll_group;
    for (int i = 0; i < sensors; ++i) {
      raw_to(r, i) = s.raw[static_cast<std::size_t>(i)];
      delivered_to(r, i) = s.delivered.has(i);
    }
  }
  log.time_s = std::move(time);
  log.raw = std::move(raw);
  log.temperature_degc = std::move(temperature);
  log.delivered = std::move(delivered);
  log.station = std::move(station);
  log.count = std::move(count);
  log.roll_group = std::move(roll_group);
  log.truth = py::none();
  log.rate_radps.fill(py::none());
  return log;
}

/// Of chips with clocks of their own: as many a row as the array file states.
py::array_t<double> clock_times(const std::vector<double>& clock_s, std::size_t clocks) {
  const auto wide = static_cast<py::ssize_t>(clocks);
  py::array_t<double> out({static_cast<py::ssize_t>(clock_s.size()) / wide, wide});
  std::copy(clock_s.begin(), clock_s.end(), out.mutable_data());
  return out;
}

/// Of one gyro; NaN where the rate is not known.
py::array_t<double> rates(const std::vector<plumb::Rotation>& turn) {
  const auto rows = static_cast<py::ssize_t>(turn.size());
  py::array_t<double> out({rows, py::ssize_t{3}});
  auto to = out.mutable_unchecked<2>();
  for (py::ssize_t r = 0; r < rows; ++r) {
    const plumb::Rotation& now = turn[static_cast<std::size_t>(r)];
    for (std::size_t c = 0; c < 3; ++c)
      to(r, static_cast<py::ssize_t>(c)) =
          now.rate_known ? now.rate_radps[c] : std::numeric_limits<double>::quiet_NaN();
  }
  return out;
}

Log read_log(const Array& array, const std::string& path) {
  using plumb::io::LogReader;
  LogReader reader = taken(LogReader::open(path, *array, plumb::io::BadRowPolicy::stop));
  std::vector<plumb::Sample> samples;
  std::array<std::vector<plumb::Rotation>, plumb::kGyros> turn;
  std::vector<double> clock_s;
  plumb::Sample sample;
  LogReader::Next status = reader.next(sample);
  for (; status == LogReader::Next::row; status = reader.next(sample)) {
    samples.push_back(sample);
    clock_s.insert(clock_s.end(), reader.clock_s().begin(), reader.clock_s().end());
    if (!array->input.rotation_columns.empty()) turn[0].push_back(reader.rotation());
    if (!array->input.second_rotation_columns.empty()) turn[1].push_back(reader.second_rotation());
  }
  if (status == LogReader::Next::error) throw Refused(reader.error().text());
  Log log = columns(samples, array->array.size());
  for (std::size_t g = 0; g < turn.size(); ++g) {
    if (!turn[g].empty()) log.rate_radps[g] = rates(turn[g]);
  }
  if (!clock_s.empty()) log.clock_s = clock_times(clock_s, array->input.clock_columns.size());
  return log;
}

/// Gravity of every row in the frame in which plumb answers, and who was in fault.
py::dict truth_arrays(const plumb::io::ScenarioFile& file, std::vector<plumb::scenario::Truth>& truth) {
  plumb::session::into_frame_of_nominal_axes(file.scenario.tool, truth);
  const auto rows = static_cast<py::ssize_t>(truth.size());
  const int n = file.array.array.size();
  py::array_t<double> gravity({rows, py::ssize_t{3}});
  py::array_t<bool> faulty({rows, py::ssize_t{n}}), moving(rows);
  auto gravity_to = gravity.mutable_unchecked<2>();
  auto faulty_to = faulty.mutable_unchecked<2>();
  for (py::ssize_t r = 0; r < rows; ++r) {
    const plumb::scenario::Truth& now = truth[static_cast<std::size_t>(r)];
    const plumb::Vec3 g = plumb::io::in_frame(file.array.output_frame, now.gravity_mps2);
    for (py::ssize_t c = 0; c < 3; ++c) gravity_to(r, c) = g[static_cast<std::size_t>(c)];
    for (int i = 0; i < n; ++i) faulty_to(r, i) = now.faulty.has(i);
    moving.mutable_at(r) = now.moving;
  }
  py::dict out;
  out["gravity_mps2"] = std::move(gravity);
  out["faulty"] = std::move(faulty);
  out["moving"] = std::move(moving);
  return out;
}

/// As `plumb simulate`: one row per sample, or per station where the array file says so.
py::tuple simulate(const std::string& text_or_path, std::optional<std::uint64_t> seed, bool is_text) {
  plumb::io::ScenarioFile file =
      taken(is_text ? plumb::io::parse_scenario_text(text_or_path, "<text>") : plumb::io::read_scenario(text_or_path));
  if (seed) file.scenario.seed = *seed;
  auto simulator = plumb::scenario::Simulator::make(file.scenario);
  if (!simulator)
    throw Refused(plumb::io::FileError{is_text ? "<text>" : text_or_path, 0, "", simulator.error(), ""}.text());
  const bool means = file.array.input.rows == plumb::io::RowKind::stations;
  const int n = file.array.array.size();
  std::vector<plumb::Sample> samples;
  std::vector<plumb::scenario::Truth> truth;
  plumb::session::StationMean station(n);
  const auto put_station = [&] {
    if (station.empty()) return;
    samples.push_back(station.mean());
    truth.push_back(station.truth());
    station = plumb::session::StationMean(n);
  };
  plumb::Sample sample;
  while (simulator->next(sample)) {
    const plumb::scenario::Truth& now = simulator->truth();
    if (!means) {
      samples.push_back(sample);
      truth.push_back(now);
      continue;
    }
    if (now.moving) continue;
    if (!station.empty() && station.truth().station != now.station) put_station();
    station.add(sample, now);
  }
  put_station();
  Log log = columns(samples, n);
  log.truth = truth_arrays(file, truth);
  return py::make_tuple(std::make_shared<plumb::io::ArrayFile>(std::move(file.array)), std::move(log));
}

std::string shape_text(const std::vector<py::ssize_t>& shape, bool one_sample) {
  std::string out = "(";
  for (std::size_t k = one_sample ? 1 : 0; k < shape.size(); ++k)
    out += (out.size() > 1 ? ", " : "") + std::to_string(shape[k]);
  return out + ")";
}

}  // namespace

Doubles doubles(const py::object& from, const char* name) {
  refuse_mask(from, name);
  if (from.is_none()) refuse_type(name);
  Doubles out = Doubles::ensure(from);
  if (!out) refuse_type(name);
  return out;
}

template <class T>
Log::View::Column<T> Log::View::column(const py::object& from, const char* name, int width, const char* across) const {
  if (from.is_none()) return {};
  Column<T> out;
  refuse_mask(from, name);
  auto array = py::array_t<T, py::array::forcecast>::ensure(from);
  if (!array) refuse_type(name);
  const bool fits = width == 0 ? array.ndim() == 1 : array.ndim() == 2 && array.shape(1) == width;
  if (!fits || array.shape(0) != rows_) {
    std::vector<py::ssize_t> wanted{rows_};
    if (width != 0) wanted.push_back(width);
    const std::vector<py::ssize_t> given(array.shape(), array.shape() + array.ndim());
    std::string remedy = one_sample_ ? "give one value" : "give one row per sample";
    if (width != 0) remedy += std::string(one_sample_ ? " per " : " and one column per ") + across;
    refuse(std::string(name) + ": has the shape " + shape_text(given, one_sample_) + ", must have " +
               shape_text(wanted, one_sample_),
           remedy);
  }
  out.data = reinterpret_cast<const char*>(array.data());
  out.stride = array.strides(0);
  out.across = width == 0 ? 0 : array.strides(1);
  out.kept = std::move(array);
  return out;
}

Log::View::Column<std::uint32_t> Log::View::whole_numbers(const py::object& from, const char* name) const {
  constexpr double kMost = std::numeric_limits<std::uint32_t>::max();
  if (!from.is_none() && !py::isinstance<Tags>(from)) {
    const Column<double> given = column<double>(from, name, 0);
    for (py::ssize_t r = 0; r < rows_; ++r) {
      const double value = given.at(r);
      if (value >= 0.0 && value <= kMost && value == std::floor(value)) continue;
      refuse(std::string(name) + ": row " + std::to_string(r) + " is " +
                 py::str(py::float_(value)).cast<std::string>() + ", must be a whole number from 0 to 4294967295",
             "give 0 where there is none");
    }
  }
  return column<std::uint32_t>(from, name, 0);
}

Log::View::View(const Log& log, const plumb::io::ArrayFile& array)
    : one_sample_(log.one_sample),
      rows_(log.raw.ndim() > 0 ? log.raw.shape(0) : 0),
      sensors_(array.array.size()),
      clocks_(static_cast<int>(array.input.clock_columns.size())),
      default_temperature_degc_(array.input.default_temperature_degc) {
  raw_ = column<double>(log.raw, "raw", sensors_);
  time_ = column<double>(log.time_s, "time_s", 0);
  delivered_ = column<bool>(log.delivered, "delivered", sensors_);
  station_ = whole_numbers(log.station, "station");
  count_ = whole_numbers(log.count, "count");
  roll_group_ = whole_numbers(log.roll_group, "roll_group");
  if (py::isinstance<py::float_>(log.temperature_degc) || py::isinstance<py::int_>(log.temperature_degc)) {
    default_temperature_degc_ = log.temperature_degc.cast<double>();
  } else {
    temperature_ = column<double>(log.temperature_degc, "temperature_degc", 0);
  }
  for (std::size_t g = 0; g < rate_.size(); ++g) rate_[g] = column<double>(log.rate_radps[g], kRateNames[g], 3, "axis");
  if (clocks_ > 0) clock_ = column<double>(log.clock_s, "clock_s", clocks_, "[[clock]] of the array file");
}

plumb::Rotation Log::View::rotation(std::size_t gyro, py::ssize_t row) const {
  if (!turns(gyro)) return {};
  plumb::Rotation out{false, true, {}};
  for (std::size_t c = 0; c < 3; ++c) {
    const double rate = rate_[gyro].at(row, static_cast<py::ssize_t>(c));
    if (!std::isfinite(rate)) return {true, false, {}};
    out.rate_radps[c] = rate;
    out.turning = out.turning || rate != 0.0;
  }
  return out;
}

plumb::io::ClockTimes Log::View::clock_s(py::ssize_t row) const {
  plumb::io::ClockTimes out = plumb::io::kNoClockTimes;
  for (int c = 0; c < clocks_ && has_clocks(); ++c) out[static_cast<std::size_t>(c)] = clock_.at(row, c);
  return out;
}

plumb::Sample Log::View::at(py::ssize_t row) const {
  plumb::Sample sample;
  sample.time_s = time_.at(row);
  for (int i = 0; i < sensors_; ++i) {
    sample.raw[static_cast<std::size_t>(i)] = raw_.at(row, i);
    if (delivered_.data == nullptr || delivered_.at(row, i)) sample.delivered = sample.delivered.with(i);
  }
  sample.temperature_degc = temperature_.data != nullptr ? temperature_.at(row) : default_temperature_degc_;
  if (station_.data != nullptr) sample.station = station_.at(row);
  if (count_.data != nullptr) sample.count = count_.at(row);
  if (roll_group_.data != nullptr) sample.roll_group = roll_group_.at(row);
  return sample;
}

void bind_log(py::module_& module) {
  py::class_<Log>(
      module, "Log",
      "Samples as columns. `raw` is (rows, sensors), in the unit of the array file's log; float64 is used\n"
      "where it lies, without a copy, whatever its strides. NaN is a value that is not finite; `delivered`\n"
      "(rows, sensors) is False where a channel did not deliver. `station` is a tag, 0 = none (a label in a\n"
      "CSV file is its tag minus 1). `temperature_degc` is a column or one number. `rate_radps` and\n"
      "`second_rate_radps` (rows, 3), tool frame, are the rates of up to two gyros; NaN = not known.\n"
      "`clock_s` (rows, clocks) has what the clocks of chips say that have their own, in the order of [[clock]] in "
      "the\n"
      "array file; NaN or the time of the row before = the chip has delivered no new sample.")
      .def(py::init([](const py::object& time_s, const py::object& raw, py::object temperature_degc,
                       py::object delivered, py::object station, py::object count, py::object roll_group,
                       py::object rate_radps, py::object second_rate_radps, py::object clock_s) {
             return Log{doubles(time_s, "time_s"),   doubles(raw, "raw"),
                        std::move(temperature_degc), std::move(delivered),
                        std::move(station),          std::move(count),
                        std::move(roll_group),       py::none(),
                        std::move(clock_s),          {std::move(rate_radps), std::move(second_rate_radps)}};
           }),
           py::arg("time_s"), py::arg("raw"), py::arg("temperature_degc") = py::none(),
           py::arg("delivered") = py::none(), py::arg("station") = py::none(), py::arg("count") = py::none(),
           py::arg("roll_group") = py::none(), py::arg("rate_radps") = py::none(),
           py::arg("second_rate_radps") = py::none(), py::arg("clock_s") = py::none())
      .def_property(
          "time_s", [](const Log& log) { return log.time_s; },
          [](Log& log, const py::object& from) { log.time_s = doubles(from, "time_s"); },
          "(rows), s, strictly increasing")
      .def_property(
          "raw", [](const Log& log) { return log.raw; },
          [](Log& log, const py::object& from) { log.raw = doubles(from, "raw"); }, "(rows, sensors)")
      .def_readwrite("temperature_degc", &Log::temperature_degc)
      .def_readwrite("delivered", &Log::delivered)
      .def_readwrite("station", &Log::station)
      .def_readwrite("count", &Log::count, "raw samples behind a row")
      .def_readwrite("roll_group", &Log::roll_group)
      .def_readwrite("clock_s", &Log::clock_s,
                     "(rows, clocks), s, by the clock of each [[clock]] of the array file; None: there are none")
      .def_property(
          "rate_radps", [](const Log& log) { return log.rate_radps[0]; },
          [](Log& log, py::object from) { log.rate_radps[0] = std::move(from); },
          "(rows, 3), tool frame [rad/s]; None: no gyro, the tool does not turn where it is judged at rest")
      .def_property(
          "second_rate_radps", [](const Log& log) { return log.rate_radps[1]; },
          [](Log& log, py::object from) { log.rate_radps[1] = std::move(from); },
          "the same by the second gyro, which counts in motion only")
      .def_readonly("truth", &Log::truth,
                    "Of a simulation: a dict with gravity_mps2 (rows, 3) in the frame in which plumb answers, faulty\n"
                    "(rows, sensors) and moving (rows). Else None.")
      .def("__len__", &Log::rows)
      .def("__repr__", [](const Log& log) { return "<plumb.Log: " + std::to_string(log.rows()) + " rows>"; });

  module.def("read_log", &read_log, array_argument(), py::arg("path"),
             "Read a CSV log as the array file says that it looks. Raises Error with the line and the column.");
  module.def(
      "simulate",
      [](const std::string& path, std::optional<std::uint64_t> seed) { return simulate(path, seed, false); },
      py::arg("path"), py::arg("seed") = py::none(),
      "Play a scenario file (TOML or JSON): returns the array and its log, as `plumb simulate` writes it. The same\n"
      "scenario and seed give the same numbers; log.truth holds the true values.");
  module.def(
      "simulate_text",
      [](const std::string& text, std::optional<std::uint64_t> seed) { return simulate(text, seed, true); },
      py::arg("text"), py::arg("seed") = py::none(), "The same from the text of a scenario file.");
}

}  // namespace plumb_python
