// Public recordings (../shared/data beside the project, or PLUMB_DATA_DIR): as recorded, with a channel that stands
// still, and before any calibration. None of them is part of the project, and what is not there is left out.
#include <fmt/format.h>

#include <filesystem>
#include <memory>

#include "fixed_cases.hpp"
#include "player.hpp"
#include "plumb/calibration/calibration.hpp"
#include "plumb/detection/stationarity.hpp"
#include "plumb/io/array_file.hpp"
#include "plumb/io/log_reader.hpp"

namespace plumb_replay {
inline namespace PLUMB_ABI {

using namespace plumb;

namespace {

constexpr std::size_t kMostRows = 8000;
constexpr int kStuckSensors = 3;

/// A log, and the array file that reads it.
struct Recording {
  const char* name;
  const char* array;     ///< of examples/, and what differs from it is set below; empty: built here
  const char* stations;  ///< the log that calibrates it
  const char* log;       ///< the log that is monitored
};
constexpr Recording kRecordings[] = {
    {"mikoff5-z-means", "mikoff5_z.toml", "mikoff5_static_means.csv", "mikoff5_static_means.csv"},
    {"mikoff5-z-samples", "mikoff5_z.toml", "mikoff5_static_means.csv", "mikoff5_static_samples.csv"},
    {"mikoff5-15-means", "mikoff5_15.toml", "mikoff5_static_means.csv", "mikoff5_static_means.csv"},
    {"mikoff5-15-samples", "mikoff5_15.toml", "mikoff5_static_means.csv", "mikoff5_static_samples.csv"},
    {"carlsson-means", "carlsson.toml", "carlsson_static_means.csv", "carlsson_static_means.csv"},
    {"carlsson-motion-1", "carlsson.toml", "carlsson_static_means.csv", "carlsson_motion_1.csv"},
    {"carlsson-motion-2", "carlsson.toml", "carlsson_static_means.csv", "carlsson_motion_2.csv"},
    {"carlsson-motion-3", "carlsson.toml", "carlsson_static_means.csv", "carlsson_motion_3.csv"},
    {"xsens", "xsens.toml", "imutk_xsens_full.csv", "imutk_xsens_full.csv"},
    {"quadrotor-2", "", "", "quadrotor_flight2.csv"},
    {"quadrotor-3", "", "", "quadrotor_flight3.csv"},
    {"quadrotor-5", "", "", "quadrotor_flight5.csv"},
    {"sap5", "", "", "sap5_survey_shots.csv"},
};

/// Four triads taken for parallel, which they are not: alarms, contradictions, motion.
std::string quadrotor_text() {
  std::string out =
      "name = \"quadrotor\"\n[gravity]\nmodel = \"value\"\nvalue = \"9.795 m/s^2\"\nsigma = \"1 mg0\"\n"
      "[input]\nrows = \"samples\"\ntime = \"t_s\"\nunit = \"m/s^2\"\nreads = \"specific-force\"\n";
  for (int unit = 1; unit <= 4; ++unit) {
    for (int axis = 0; axis < 3; ++axis) {
      out += fmt::format(
          "[[sensor]]\nid = \"i{0}{1}\"\ncolumn = \"i{0}_a{1}_mps2\"\naxis = [{2}]\nnoise = \"0.05 m/s^2\"\n", unit,
          "xyz"[axis],
          axis == 0   ? "1, 0, 0"
          : axis == 1 ? "0, 1, 0"
                      : "0, 0, 1");
    }
  }
  return out;
}

std::string survey_text() {
  std::string out =
      "name = \"sap5\"\n[gravity]\nmodel = \"value\"\nvalue = \"1 g0\"\nsigma = \"1 mg0\"\n"
      "[input]\nrows = \"stations\"\nunit = \"g0\"\nreads = \"gravity\"\n[monitor]\nwindow = 1\n";
  for (int axis = 0; axis < 3; ++axis) {
    out += fmt::format("[[sensor]]\nid = \"{0}\"\ncolumn = \"g{0}_g\"\naxis = [{1}]\nnoise = \"5 mg0\"\n", "xyz"[axis],
                       axis == 0   ? "1, 0, 0"
                       : axis == 1 ? "0, 1, 0"
                                   : "0, 0, 1");
  }
  return out;
}

io::FileExpected<io::ArrayFile> array_of(const Recording& recording, const std::string& examples) {
  if (*recording.array != '\0') return io::read_array_file(examples + "/" + recording.array);
  const bool survey = std::string(recording.name) == "sap5";
  return io::parse_array_text(survey ? survey_text() : quadrotor_text(), "array.toml");
}

/// What the monitored log has otherwise than the one that calibrates.
void into_samples(const std::string& log, io::ArrayFile& file) {
  const bool motion = log.find("motion") != std::string::npos;
  if (!motion && log.find("samples") == std::string::npos) return;
  file.input.rows = io::RowKind::samples;
  file.input.time_column = motion ? "t_s" : "";
  file.input.rate_hz = motion ? 0.0 : 100.0;
  file.input.station_column = motion ? "" : "att";
  file.input.count_column.clear();
  file.input.where.clear();
  file.monitor.window = 32;
  file.monitor.max_gap_s = 5.0;
}

std::vector<Station> stations_of(const io::ArrayFile& file, const std::vector<Sample>& rows) {
  std::vector<Station> out;
  Station station;
  if (file.input.rows == io::RowKind::stations) {
    for (const Sample& row : rows) {
      station = Station{};
      station.mean = row.raw;
      station.delivered = row.delivered;
      station.temperature_degc = row.temperature_degc;
      station.count = row.count;
      out.push_back(station);
    }
    return out;
  }
  StationFinder::Settings settings;
  settings.block = file.monitor.window;
  const auto finder = std::make_unique<StationFinder>(file.array, file.gravity.g_mps2, settings);
  const SensorModel model = file.datasheet.model();
  for (const Sample& row : rows) {
    const Readings y = model.apply(row.raw, row.temperature_degc, row.delivered);
    if (finder->add(row, y, row.delivered, station)) out.push_back(station);
  }
  if (finder->finish(station)) out.push_back(station);
  return out;
}

/// By its calibration, or where there is none by the datasheet and what that leaves open.
void know(const io::ArrayFile& file, const std::vector<Sample>& rows, MonitorSetup& setup) {
  const std::vector<Station> stations = stations_of(file, rows);
  FitOptions lenient;
  lenient.max_sensor_excess = 10.0;
  if (const auto fit =
          calibrate(file.datasheet, file.gravity, stations.data(), static_cast<int>(stations.size()), lenient)) {
    setup.model = fit->model;
    setup.array = fit->array;
    return;
  }
  setup.model = file.datasheet.model();
  setup.array = file.array;
  setup.array.set_uncertainty(file.datasheet.uncertainty());
}

enum class Way : std::uint8_t { recorded, stuck, uncalibrated };

void play(const Recording& recording, Way way, int sensor, const std::string& folder, const std::string& examples,
          const Stage& stage) {
  auto file = array_of(recording, examples);
  if (!file) return stage.coverage.met("case", "not playable: " + file.error().text());
  const auto setup = std::make_unique<MonitorSetup>();
  if (*recording.stations != '\0') {
    const auto stand = io::read_log(folder + "/" + recording.stations, *file, io::BadRowPolicy::skip);
    if (!stand) return stage.coverage.met("case", "not playable: " + stand.error().text());
    know(*file, stand->samples, *setup);
  } else {
    know(*file, {}, *setup);
  }
  into_samples(recording.log, *file);
  const auto log = io::read_log(folder + "/" + recording.log, *file, io::BadRowPolicy::skip);
  if (!log) return stage.coverage.met("case", "not playable: " + log.error().text());
  setup->gravity = file->gravity;
  setup->config = file->monitor;
  for (std::size_t i = 0; i < static_cast<std::size_t>(file->datasheet.size); ++i) {
    setup->full_scale_raw[i] = file->datasheet.sensor[i].full_scale_raw;
    setup->resolution_raw[i] = file->datasheet.sensor[i].resolution_raw;
  }
  if (way == Way::uncalibrated) static_cast<void>(set_datasheet(file->datasheet, *setup));
  Player player(stage, *setup);
  stage.coverage.met("case", player.configure() ? "played" : "setup refused");
  const std::size_t rows = std::min(log->samples.size(), kMostRows);
  for (std::size_t row = 0; row < rows; ++row) {
    Sample sample = log->samples[row];
    const auto k = static_cast<std::size_t>(sensor);
    if (way == Way::stuck && row > rows / 4) sample.raw[k] = log->samples[rows / 4].raw[k];
    player.step(sample);
    if (row == rows / 2) player.power_cycle();
  }
  player.finish();
}

}  // namespace
}  // namespace PLUMB_ABI

std::vector<FixedCase> recording_cases(const std::string& folder, const std::string& examples,
                                       std::vector<std::string>& skipped) {
  std::vector<FixedCase> out;
  for (const Recording& recording : kRecordings) {
    if (!std::filesystem::exists(folder + "/" + recording.log)) {
      skipped.push_back(fmt::format("{}: no {} in {}", recording.name, recording.log, folder));
      continue;
    }
    const auto add = [&](const std::string& how, Way way, int sensor) {
      out.push_back({fmt::format("recording-{}-{}", recording.name, how),
                     [=](const Stage& stage) { play(recording, way, sensor, folder, examples, stage); }});
    };
    add("recorded", Way::recorded, 0);
    for (int i = 0; i < kStuckSensors; ++i) add(fmt::format("stuck{}", i + 1), Way::stuck, i);
    add("uncalibrated", Way::uncalibrated, 0);
  }
  return out;
}

}  // namespace plumb_replay
