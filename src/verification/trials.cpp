#include "plumb/verification/trials.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <regex>
#include <thread>

#include "plumb/array/geometry.hpp"
#include "plumb/campaign/kernel.hpp"
#include "plumb/core/units.hpp"
#include "plumb/io/units.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace verification {
namespace {

using io::shortest;
using std::size_t;

constexpr int kFaultStations = 8;
constexpr int kHealthyStations = 16;
/// Scenarios that a thread takes at once, and between two looks at the clock.
constexpr std::uint64_t kSlice = 64, kBatch = 4096;

/// The text as a TOML string.
std::string toml_text(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') out += '\\';
    if (static_cast<unsigned char>(c) < 0x20) {
      out += fmt::format("\\u{:04x}", static_cast<unsigned>(c));
    } else {
      out += c;
    }
  }
  return out + "\"";
}

/// A length or an error of the vector as the campaign file takes it; no digit is lost.
std::string vector_toml(double inside, io::FieldKind field) {
  const io::FieldUnits& units = io::units_of(field);
  return "\"" + shortest(units.coarse_per_inside * inside) + " " + units.coarse + "\"";
}

/// The sizes of faults of accelerometers; of magnetometers the same parts of their field: 50mg0 is a twentieth of it.
std::string in_parts_of_field(const std::string& faults, const io::ArrayFile& array) {
  if (array.field == io::FieldKind::gravity) return faults;
  static const std::regex size("([0-9]+(?:[.][0-9]+)?)(m?)g0");
  const double field_ut = io::units_of(array.field).coarse_per_inside * array.gravity.g_mps2;
  std::string out;
  auto at = faults.cbegin();
  for (std::sregex_iterator it(faults.begin(), faults.end(), size), end; it != end; ++it) {
    out.append(at, faults.cbegin() + it->position());
    const double parts = std::stod((*it)[1].str()) * ((*it)[2].length() > 0 ? 1e-3 : 1.0);
    out += fmt::format("{:.7g}uT", parts * field_ut);
    at = faults.cbegin() + it->position() + it->length();
  }
  return out.append(at, faults.cend());
}

/// The monitor of the array file, its alert limit apart: what differs from the defaults.
std::string monitor_toml(const MonitorConfig& config, double alert_limit_rad, io::FieldKind field) {
  const MonitorConfig usual;
  std::string out = "\n[monitor]\n";
  const auto number = [&out](const char* key, auto value, auto standard) {
    if (value != standard) out += fmt::format("{} = {}\n", key, value);
  };
  const auto ratio = [&out](const char* key, double value, double standard) {
    if (value != standard) out += std::string(key) + " = \"" + shortest(value) + "\"\n";
  };
  const auto quantity = [&out](const char* key, double value, double standard, const char* unit) {
    if (value != standard) out += std::string(key) + " = \"" + shortest(value) + " " + unit + "\"\n";
  };
  const auto vector = [&out, field](const char* key, double value, double standard) {
    if (value != standard) out += std::string(key) + " = " + vector_toml(value, field) + "\n";
  };
  out += "alert_limit = \"" + shortest(alert_limit_rad) + " rad\"\n";
  number("window", config.window, usual.window);
  vector("delta_f", config.delta_f_mps2, usual.delta_f_mps2);
  ratio("false_alarm_rate", config.false_alarm_rate, usual.false_alarm_rate);
  ratio("rejection_rate", config.rejection_rate, usual.rejection_rate);
  number("assumed_faults", config.assumed_faults, usual.assumed_faults);
  number("isolation_stations", config.isolation_stations, usual.isolation_stations);
  number("isolation_timeout", config.isolation_timeout, usual.isolation_timeout);
  number("passed_blocks", config.passed_blocks, usual.passed_blocks);
  number("forget_blocks", config.forget_blocks, usual.forget_blocks);
  number("probation_stations", config.probation_stations, usual.probation_stations);
  number("missing_confirm", config.missing_confirm, usual.missing_confirm);
  quantity("max_gap", config.max_gap_s, usual.max_gap_s, "s");
  quantity("max_age", config.max_age_s, usual.max_age_s, "s");
  number("max_age_samples", config.max_age_samples, usual.max_age_samples);
  quantity("station_angle", config.station_angle_rad, usual.station_angle_rad, "rad");
  quantity("distinct_attitude_angle", config.distinct_attitude_angle_rad, usual.distinct_attitude_angle_rad, "rad");
  ratio("clear_fraction", config.clear_fraction, usual.clear_fraction);
  ratio("integrity_risk", config.integrity_risk, usual.integrity_risk);
  ratio("fault_prior", config.fault_prior, usual.fault_prior);
  number("reset_key", config.reset_key, usual.reset_key);
  quantity("temperature_min", config.temperature_min_degc, usual.temperature_min_degc, "degC");
  quantity("temperature_max", config.temperature_max_degc, usual.temperature_max_degc, "degC");
  if (config.recalibrate_after_exclusion) out += "recalibrate = \"after-exclusion\"\n";
  number("isolation_timeout_blocks", config.isolation_timeout_blocks, usual.isolation_timeout_blocks);
  vector(field == io::FieldKind::magnetic ? "disturbance_bound" : "acceleration_bound", config.acceleration_bound_mps2,
         usual.acceleration_bound_mps2);
  out += "alert_frame = \"calibrated-axes\"  # that in which a scenario knows the truth\n";
  if (config.alarm_form == AlarmForm::average_tool) out += "alarm_form = \"average-tool\"\n";
  ratio("triple_false_alarm_rate", config.triple_false_alarm_rate, usual.triple_false_alarm_rate);
  return out;
}

/// The coarsest resolution of any sensor.
double resolution_mps2(const io::ArrayFile& array) {
  double out = 0.0;
  for (int i = 0; i < array.datasheet.size; ++i) {
    const DatasheetSensor& sensor = array.datasheet.sensor[static_cast<size_t>(i)];
    out = std::fmax(out, sensor.resolution_raw / std::fabs(sensor.coefficients.scale[0]));
  }
  return out;
}

/// Everything but the faults.
std::string common_part(const io::ArrayFile& array, const std::string& array_path, const TrialSettings& settings,
                        const std::string& what, int stations) {
  const MonitorConfig& monitor = array.monitor;
  const bool promised = confirmed_grade(array.array, array.array.all()) > 0;
  std::string out = "# Written by plumb verify. Play it again in this directory: plumb campaign " + what + ".toml\n";
  out += "name = " + toml_text(array.name + ": " + what) + "\n";
  if (array.field == io::FieldKind::magnetic) out += "field = \"magnetic\"\n";
  out += fmt::format("scenarios = {}\nseed = {}\nwithin_grade = \"{}\"\n", settings.scenarios, settings.seed,
                     promised ? "yes" : "no");
  out += "\n[[tool]]\narray = " + toml_text(array_path) + "\n";
  const double resolution = resolution_mps2(array);
  if (resolution > 0.0) out += "resolution = " + vector_toml(resolution, array.field) + "\n";
  if (settings.samples_per_row > 1)
    out += fmt::format("samples_per_row = {}  # a row is a mean\n", settings.samples_per_row);
  const double rate_hz = array.input.rate_hz > 0.0 ? array.input.rate_hz : 100.0;
  out += fmt::format("\n[run]\nstations = {}\nsamples = {}\nrate = \"{} Hz\"\nmove = \"{} s\"\nonset = [1, 3]\n",
                     stations, monitor.window, shortest(rate_hz), shortest(std::fmin(1.0, 0.5 * monitor.max_gap_s)));
  const bool magnetic = array.field == io::FieldKind::magnetic;
  out += std::string(magnetic ? "\n[reference]" : "\n[gravity]") +
         "\nvalue = " + vector_toml(array.gravity.g_mps2, array.field) +
         "\nsigma = " + vector_toml(array.gravity.sigma_mps2, array.field) + "\n";
  out += !(array.gravity.sigma_mps2 > 0.0) ? "errors = [0]\n"
         : magnetic                        ? "errors = [0, 3]  # true field minus the configured value, in sigmas\n"
                                           : "errors = [0, 3]  # true gravity minus the configured value, in sigmas\n";
  // `left` is of the bias; with scale and axis, twice as large each, a reading is off by sqrt(5) of it.
  if (settings.e_cal_mps2 > 0.0 || settings.days_since_calibration > 0.0) out += "\n[calibration]\n";
  if (settings.e_cal_mps2 > 0.0)
    out += "left = " + vector_toml(settings.e_cal_mps2 / std::sqrt(5.0), array.field) + "\n";
  if (settings.days_since_calibration > 0.0) out += "days = " + shortest(settings.days_since_calibration) + "\n";
  out += monitor_toml(monitor, settings.alert_limit_rad, array.field);
  out +=
      "\n[[attitude]]\nlaw = \"random\"\n[[attitude]]\nlaw = \"roll-test\"\ninclination = \"60 deg\"\n[[attitude]]\n"
      "law = \"drilling-path\"\n";
  return out;
}

void note_blocks(const campaign::Outcome& outcome, Trial& trial) {
  for (int k = 0; k < outcome.blocks; ++k) {
    const campaign::BlockOutcome& b = outcome.block[static_cast<size_t>(k)];
    if (outcome.first_fault_block >= 0 && k >= outcome.first_fault_block && !b.alarmed)
      trial.tilt_before_alarm_rad = std::fmax(trial.tilt_before_alarm_rad, b.tilt_rad);
    if (b.usable && !b.alert) trial.tilt_usable_rad = std::fmax(trial.tilt_usable_rad, b.tilt_rad);
    if (b.usable && b.bounded) trial.excess_rad = std::fmax(trial.excess_rad, b.tilt_rad - b.protection_rad);
  }
}

Trial trial_of(const campaign::Plan& plan, const campaign::Spec& spec, const campaign::Outcome& outcome) {
  Trial out;
  out.number = spec.number;
  out.cell = spec.cell;
  out.faulty = outcome.faulty;
  out.excluded = outcome.excluded;
  out.ever_excluded = outcome.ever_excluded;
  out.ever_provisionally_excluded = outcome.ever_provisionally_excluded;
  out.blocks = outcome.blocks;
  out.first_fault_block = outcome.first_fault_block;
  out.alarm_block = outcome.alarm_block;
  out.isolated_block = outcome.isolated_block;
  out.failed = outcome.failed;
  out.misleading = outcome.misleading(plan.alert_limit_rad);
  out.beyond_protection = outcome.beyond_protection();
  out.largest_mdb = spec.largest_mdb;
  note_blocks(outcome, out);
  return out;
}

/// A thread's own monitors and its own counts.
struct Worker {
  std::unique_ptr<campaign::Kernel> kernel;
  campaign::Tally tally;
};

void play_slices(const campaign::Plan& plan, Worker& worker, std::atomic<std::uint64_t>& next, std::uint64_t end,
                 std::vector<Trial>& out) {
  const auto outcome = std::make_unique<campaign::Outcome>();
  for (;;) {
    const std::uint64_t first = next.fetch_add(kSlice);
    if (first >= end) return;
    for (std::uint64_t number = first; number < std::min(first + kSlice, end); ++number) {
      const campaign::Spec spec = campaign::spec_of(plan, number);
      worker.kernel->play(spec, *outcome);
      worker.tally.add(plan, spec, *outcome);
      out[static_cast<size_t>(number)] = trial_of(plan, spec, *outcome);
    }
  }
}

}  // namespace

std::string fault_campaign(const io::ArrayFile& array, const std::string& array_path, const TrialSettings& settings) {
  std::string out;
  const int grade = confirmed_grade(array.array, array.array.all());
  const int most = std::min(std::max(grade, 1), std::max(settings.faults, 1));
  std::string sensors;
  for (int m = 1; m <= std::min(most, campaign::kMostFaults); ++m) sensors += (m > 1 ? ", " : "") + std::to_string(m);
  // White vibration of 20 mg0 in every sample, of which a row that is a mean of several keeps less.
  out += fmt::format("\n[[fault]]\nspec = [\"none\", \"shake={:.4g}mg0\"]\n",
                     20.0 / std::sqrt(static_cast<double>(settings.samples_per_row)));
  out +=
      "[[fault]]  # the output is stuck, random, or very noisy\n"
      "spec = [\"stuck=0g0\", \"stuck=1g0\", \"stuck=-1g0\", \"last\", \"held=-1g0..1g0\", \"random=-1g0..1g0\", "
      "\"noise=5mg0\", \"noise=50mg0\", \"missing\", \"missing+station2\"]\n"
      "sensors = [" +
      sensors + "]\n";
  out +=
      "[[fault]]  # the sensor measures, but wrongly\n"
      "spec = [\"drift=1mg0/s\", \"drift=10mg0/s\", \"scale=1.01\", \"scale=1.1\", \"scale=-1\", \"turned=2deg\", "
      "\"turned=10deg\", \"spikes=0.5g0*1%\", \"bias=50mg0+station2\"]\nsensors = [" +
      sensors + "]\n";
  if (array.array.size() > 3)
    out +=
        "[[fault]]  # in multiples of the minimum detectable bias\n"
        "bias_mdb = [0.5, 1, 2, 10, 100, {from = 0.25, to = 64}]\n"
        "sensors = [" +
        sensors + "]\n";
  out += "[[fault]]  # correlated faults: all faulty sensors show the same rotated " +
         std::string(array.field == io::FieldKind::magnetic ? "field" : "gravity") +
         "\n"
         "spec = [\"ghost=20deg*0deg\"]\n"
         "sensors = [" +
         sensors + "]\n";
  return common_part(array, array_path, settings, "faults", kFaultStations) + in_parts_of_field(out, array);
}

std::string healthy_campaign(const io::ArrayFile& array, const std::string& array_path, const TrialSettings& settings) {
  return common_part(array, array_path, settings, "healthy", kHealthyStations) + "\n[[fault]]\nspec = \"none\"\n";
}

tl::expected<Trials, std::string> play_trials(const campaign::CampaignFile& file, int threads,
                                              const std::function<bool(std::uint64_t)>& progress) {
  const campaign::Plan& plan = file.plan;
  Trials out;
  out.file = file;
  out.counted.tally = campaign::Tally(plan);
  out.trial.resize(static_cast<size_t>(plan.scenarios));
  std::vector<Worker> workers;
  for (int k = 0; k < std::max(threads, 1); ++k) {
    auto kernel = campaign::make_kernel(plan);
    if (!kernel) return tl::unexpected<std::string>(kernel.error());
    workers.push_back({std::move(*kernel), campaign::Tally(plan)});
  }
  while (out.counted.done < plan.scenarios) {
    if (!progress(out.counted.done)) return tl::unexpected<std::string>("interrupted");
    std::atomic<std::uint64_t> next{out.counted.done};
    const std::uint64_t end = std::min(out.counted.done + kBatch, plan.scenarios);
    std::vector<std::thread> others;
    for (size_t k = 1; k < workers.size(); ++k)
      others.emplace_back([&, k] { play_slices(plan, workers[k], next, end, out.trial); });
    play_slices(plan, workers.front(), next, end, out.trial);
    for (std::thread& other : others) other.join();
    out.counted.done = end;
  }
  for (const Worker& worker : workers) out.counted.tally.merge(worker.tally);
  return out;
}

std::string trials_csv(const Trials& trials) {
  const campaign::Plan& plan = trials.file.plan;
  std::string out =
      std::string("number,attitude,fault,faulty_sensors,") + (plan.magnetic ? "field" : "gravity") +
      "_sigmas,size_mdb,faulty_bits,excluded_bits,ever_excluded_bits,"
      "ever_provisionally_excluded_bits,blocks,first_fault_block,alarm_block,isolated_block,failed,misleading,beyond_"
      "protection,"
      "tilt_before_alarm_deg,tilt_usable_deg\n";
  for (const Trial& t : trials.trial) {
    const campaign::Cell& cell = plan.cells[static_cast<size_t>(t.cell)];
    out += fmt::format("{},{},\"{}\",{},{},{:.6g},{},{},{},{},{},{},{},{},{:d},{:d},{:d},{:.6g},{:.6g}\n", t.number,
                       plan.attitudes[static_cast<size_t>(cell.attitude)].name,
                       plan.faults[static_cast<size_t>(cell.fault)].name, cell.faulty, cell.gravity_sigmas,
                       t.largest_mdb, t.faulty, t.excluded, t.ever_excluded, t.ever_provisionally_excluded, t.blocks,
                       t.first_fault_block, t.alarm_block, t.isolated_block, t.failed, t.misleading,
                       t.beyond_protection, deg_from_rad(t.tilt_before_alarm_rad), deg_from_rad(t.tilt_usable_rad));
  }
  return out;
}

}  // namespace verification
}  // namespace PLUMB_ABI
}  // namespace plumb
