#include "plumb/render/report_parts.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "plumb/core/units.hpp"
#include "plumb/io/json_fields.hpp"
#include "plumb/render/alignment_words.hpp"
#include "plumb/render/figures.hpp"
#include "plumb/render/fit_report.hpp"
#include "plumb/render/geometry_report.hpp"
#include "plumb/render/machine_tables.hpp"
#include "plumb/render/trials_json.hpp"
#include "plumb/render/wiring_words.hpp"
#include "plumb/render/words.hpp"
#include "plumb/scenario/library.hpp"
#include "plumb/scenario/scenario.hpp"
#include "plumb/session/monitor_pipeline.hpp"
#include "plumb/study/paper_form.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace render {
namespace {

constexpr int kPlannedStations = 24;
constexpr double kPlannedDwell_s = 2.0;

double worst_of(const Calibration& calibration) {
  double out = 0.0;
  for (int i = 0; i < calibration.array.size(); ++i) out = std::fmax(out, calibration.report.e_cal_mps2[at(i)]);
  return out;
}

Json sensors_of(const Calibration& calibration) {
  Json out = Json::array();
  for (int i = 0; i < calibration.array.size(); ++i)
    out.push_back(io::object({{"id", calibration.array.row(i).id.data()},
                              {"e_cal_mps2", calibration.report.e_cal_mps2[at(i)]},
                              {"residual_rms_mps2", calibration.report.residual_rms_mps2[at(i)]}}));
  return out;
}

/// What the fit held for the case after every iteration, the datasheet first. Of a fit over temperature there is none.
Json trace_of(const session::CalibrationRun& run, const io::ArrayFile& array) {
  constexpr int kMostTraced = 1000;
  Json out = Json::array();
  if (!run.accepted || run.temperature.order > 0) return out;
  const auto add = [&out, &array](const study::CommonFrame& frame, const Json& cost) {
    Json sensors = Json::array();
    for (int i = 0; i < array.array.size(); ++i) {
      const SensorCoefficients& nominal = array.datasheet.sensor[at(i)].coefficients;
      const double along = dot(frame.axis[at(i)], array.array.axis(i));
      sensors.push_back(io::object({{"id", array.array.row(i).id.data()},
                                    {"bias_mps2", frame.bias_mps2[at(i)]},
                                    {"scale_change", frame.scale[at(i)] / nominal.scale[0] - 1.0},
                                    {"axis_shift_deg", deg_from_rad(std::acos(std::clamp(along, -1.0, 1.0)))}}));
    }
    out.push_back(io::object({{"iteration", out.size()}, {"cost", cost}, {"sensors", std::move(sensors)}}));
  };
  auto calibrator = std::make_unique<Calibrator>(array.datasheet, array.gravity, run.options);
  add(study::frame_of(array.datasheet, calibrator->parameters()), Json());
  const int stations = static_cast<int>(run.stations.size());
  for (int k = 0; k < kMostTraced && !calibrator->done(); ++k) {
    calibrator->iterate(run.stations.data(), stations);
    if (calibrator->iterations() == 0 || !std::isfinite(calibrator->cost())) continue;
    // The same point as the last iteration, turned onto the nominal axes: what the monitor is given.
    add(calibrator->done() ? study::frame_of(*run.accepted)
                           : study::frame_of(array.datasheet, calibrator->parameters()),
        calibrator->cost());
  }
  return out;
}

/// How many samples a row of this log stands for at least: what one row tells the monitor in the worst case.
std::uint32_t fewest_samples(const std::vector<Station>& stations) {
  const auto fewer = [](const Station& a, const Station& b) { return a.count < b.count; };
  const auto least = std::min_element(stations.begin(), stations.end(), fewer);
  return least == stations.end() ? 1 : std::max<std::uint32_t>(least->count, 1);
}

/// What is judged, and the section begun with it.
CalibrationPart part_with(verification::CalibrationFacts facts) {
  CalibrationPart out;
  out.section = io::object({{"mode", facts.mode}, {"accepted", facts.accepted}});
  if (!facts.accepted) out.section["reason"] = facts.reason;
  out.facts = std::move(facts);
  return out;
}

/// What is known of the wiring and of the alignment goes along. `calibration`: null where there is none.
void put_housing(const findings::WiringCheck& check, const io::ArrayFile& array, const Calibration* calibration,
                 CalibrationPart& out) {
  using State = verification::WiringFacts::State;
  const State state = check.status == findings::WiringStatus::confirmed ? State::confirmed
                      : check.status == findings::WiringStatus::open    ? State::open
                                                                        : State::contradicted;
  out.wiring = {state, wiring_found(check), wiring_text(check, array)};
  out.section["wiring"] = wiring_json(check, array);
  const findings::Alignment alignment = findings::alignment_of(array, calibration, check.measured);
  const bool known = alignment.bound_rad < kPi;
  out.alignment = {array.monitor.alert_frame == AlertFrame::housing,
                   known ? std::optional<double>(deg_from_rad(alignment.bound_rad)) : std::nullopt,
                   alignment_words(alignment), alignment_remedy()};
  out.section["alignment"] = alignment_json(array, alignment);
}

/// The least angle of the field to the horizon at which a mirror image of the magnetometers would not keep it.
constexpr double kLeastDip_rad = 0.1;

/// Of magnetometers. No attitude tells how the field lies in the tool; that the accelerometers, beside which they were
/// aligned by the dip, show the same turns excludes every wiring that turns or mirrors all axes.
void put_magnetic_housing(const io::ArrayFile& array, const Calibration* calibration, const io::CalibrationFile* file,
                          CalibrationPart& out) {
  using State = verification::WiringFacts::State;
  const findings::WiringCheck check = findings::check_wiring(array, nullptr, {});
  const bool aligned = file != nullptr && file->alignment.has_value();
  const bool steep = std::fabs(array.magnetic.dip_rad) > kLeastDip_rad;
  const std::string remedy = kAlignByAccelerometers;
  std::string text;
  if (aligned && steep) {
    out.wiring = {State::confirmed, "confirmed by the accelerometers, to which the axes are aligned", ""};
    text = "the axes are aligned to the accelerometers by the dip, which excludes the " +
           std::to_string(check.unseen.size()) +
           " other wirings that leave the same residuals, if the accelerometers are wired as stated";
  } else {
    text = wiring_reason(check, array) + "; " +
           (aligned ? "the field is so nearly level that the dip does not exclude a mirror image of the axes" : remedy);
    out.wiring = {State::open, wiring_found(check), text};
  }
  Json wiring = wiring_json(check, array);
  if (aligned && steep) {
    wiring["status"] = "confirmed";
    wiring["not_excluded"] = Json::array();
  }
  wiring["attitude_to_record"] = Json();
  wiring["text"] = text;
  out.section["wiring"] = std::move(wiring);
  const findings::Alignment alignment =
      file != nullptr ? findings::alignment_of(array, file) : findings::alignment_of(array, calibration, {});
  const bool known = alignment.bound_rad < kPi;
  out.alignment = {array.monitor.alert_frame == AlertFrame::housing,
                   known ? std::optional<double>(deg_from_rad(alignment.bound_rad)) : std::nullopt,
                   alignment_words(alignment),
                   "calibrate with --align-by, or state alignment_bound in [group.monitor]; alert_frame = "
                   "\"calibrated-axes\" asks for bounds without the housing"};
  out.section["alignment"] = alignment_json(array, alignment);
}

/// Of a fit that was made here.
CalibrationPart part_of(session::CalibrationRun run, const io::ArrayFile& array, const char* mode) {
  const Refusal refusal = run.accepted ? Refusal{} : render::refusal_of(run, array);
  CalibrationPart out = part_with({run.accepted != nullptr, mode, refusal.reason, ""});
  if (!run.accepted) out.section["remedy"] = refusal.next;
  if (array.field == io::FieldKind::magnetic) {
    put_magnetic_housing(array, run.study.shown.get(), nullptr, out);
  } else {
    put_housing(run.study.shown ? run.wiring : findings::check_wiring(array, nullptr, {}), array, run.study.shown.get(),
                out);
  }
  out.section["fit"] = io::parsed(fit_document(run, array));
  out.section["trace"] = trace_of(run, array);
  if (run.accepted) {
    out.section["sensors"] = sensors_of(*run.accepted);
    out.e_cal_mps2 = worst_of(*run.accepted);
    for (const auto& attitude : run.study.attitudes) out.visited.push_back(attitude.direction);
    out.calibration = std::move(run.accepted);
  }
  return out;
}

/// Where down points in the stations of the stand, as angles.
Json planned_attitudes(const session::CalibrationRun& run) {
  Json out = Json::array();
  for (std::size_t k = 0; k < run.stations.size(); ++k) {
    const auto& [x, y, z] = run.study.attitudes[k].direction;
    if (!(norm(run.study.attitudes[k].direction) > 0.0)) continue;
    const double turn = std::atan2(-x, -y);
    out.push_back(io::object({{"inclination_deg", deg_from_rad(std::acos(std::clamp(z, -1.0, 1.0)))},
                              {"toolface_deg", deg_from_rad(turn < 0.0 ? turn + 2.0 * kPi : turn)}}));
  }
  return out;
}

scenario::Scenario planned_stand(const io::ArrayFile& array, std::uint64_t seed) {
  scenario::Scenario out = scenario::calibration_run(
      scenario::draw_tool(array.datasheet, seed, smallest_priors(array.datasheet)), seed, kPlannedStations);
  out.gravity_mps2 = array.gravity.g_mps2;
  if (array.input.rate_hz > 0.0) out.rate_hz = array.input.rate_hz;
  // A row that is a station is one sample, with the noise that the array file states for it.
  const bool rows = array.input.rows == io::RowKind::stations;
  const double samples =
      rows ? 1.0 : std::fmax(static_cast<double>(array.monitor.window), kPlannedDwell_s * out.rate_hz);
  out.dwell_s = samples / out.rate_hz;
  return out;
}

}  // namespace

scenario::TruthSpans smallest_priors(const Datasheet& datasheet) {
  const Prior& first = datasheet.sensor[0].prior;
  scenario::TruthSpans out{first.bias_mps2, first.scale, first.axis_rad, scenario::TruthSpans::Shape::uniform};
  for (int i = 1; i < datasheet.size; ++i) {
    const Prior& prior = datasheet.sensor[at(i)].prior;
    out.bias_mps2 = std::fmin(out.bias_mps2, prior.bias_mps2);
    out.scale = std::fmin(out.scale, prior.scale);
    out.axis_rad = std::fmin(out.axis_rad, prior.axis_rad);
  }
  return out;
}

io::FileExpected<CalibrationPart> calibration_of_file(const std::string& path, const io::ArrayFile& array) {
  const io::FileExpected<io::CalibrationFile> file = io::read_calibration(path, array);
  if (!file) return tl::unexpected<io::FileError>(file.error());
  const io::FileExpected<findings::WiringCheck> wiring = wiring_of(*file, array);
  if (!wiring) return tl::unexpected<io::FileError>(wiring.error());
  const SensorArray& rows = file->calibration.array;
  const FitReport& report = file->calibration.report;
  const bool stated = !file->context.coefficients.empty();
  CalibrationPart out = part_with({true, stated ? "known coefficients" : "calibration file", "",
                                   rows.taken_for_exact().empty() ? "" : sensor_names(rows.taken_for_exact(), rows)});
  out.section["file"] = io::object({{"stations", report.stations},
                                    {"parameters", report.parameters},
                                    {"rank", report.rank},
                                    {"gauge", report.gauge},
                                    {"condition", report.condition},
                                    {"excitation", report.excitation},
                                    {"norm_rms_mps2", report.norm_rms_mps2},
                                    {"parity_rms_mps2", report.parity_rms_mps2},
                                    {"p_value", report.p_value},
                                    {"outliers", report.outliers},
                                    {"temperature_min_degc", report.temperature_min_degc},
                                    {"temperature_max_degc", report.temperature_max_degc},
                                    {"date", file->context.date},
                                    {"serial", file->context.serial},
                                    {"log", file->context.log_file},
                                    {"made_by", file->context.plumb_version}});
  if (stated) {
    out.section["file"] = io::object({{"coefficients", file->context.coefficients},
                                      {"temperature_min_degc", report.temperature_min_degc},
                                      {"temperature_max_degc", report.temperature_max_degc},
                                      {"date", file->context.date},
                                      {"serial", file->context.serial},
                                      {"log", file->context.log_file},
                                      {"made_by", file->context.plumb_version}});
  }
  out.section["sensors"] = sensors_of(file->calibration);
  if (array.field == io::FieldKind::magnetic) {
    put_magnetic_housing(array, &file->calibration, &*file, out);
  } else {
    put_housing(*wiring, array, &file->calibration, out);
  }
  if (!out.facts.taken_for_exact.empty()) out.section["taken_for_exact"] = out.facts.taken_for_exact;
  out.e_cal_mps2 = worst_of(file->calibration);
  out.visited = file->context.down;
  out.calibration = std::make_unique<const Calibration>(file->calibration);
  return out;
}

io::FileExpected<findings::WiringCheck> wiring_of(const io::CalibrationFile& file, const io::ArrayFile& array) {
  std::vector<io::KnownAttitude> known = file.context.known_attitudes;
  io::add_known(array.input.known_attitudes, known);
  auto measured = findings::measured_attitudes(known, file.context.down);
  if (measured) return findings::check_wiring(array, &file.calibration.array, *std::move(measured));
  if (!file.context.down.empty())
    return tl::unexpected<io::FileError>(session::unknown_station(measured.error(), file.context.down.size()));
  return tl::unexpected<io::FileError>(
      io::FileError{"--known-attitude", 0, "", "the calibration file does not keep the attitudes of its stations",
                    "run plumb calibrate again with this plumb, or give the log (--stations)", io::ExitCode::usage});
}

io::FileExpected<CalibrationPart> calibration_of_stations(const std::string& path, const io::ArrayFile& array) {
  session::LogSpec log;
  log.path = path;
  io::FileExpected<session::CalibrationRun> run = session::run_calibration(array, log);
  if (!run) return tl::unexpected<io::FileError>(run.error());
  const bool means = array.input.rows == io::RowKind::stations && !array.input.count_column.empty();
  const std::uint32_t fewest = means ? fewest_samples(run->stations) : 1;
  CalibrationPart out = part_of(*std::move(run), array, "stations");
  out.samples_per_row = fewest;
  return out;
}

CalibrationPart predicted_calibration(const io::ArrayFile& tool, std::uint64_t seed) {
  io::ArrayFile array = tool;
  array.input.known_attitudes.clear();  // of stations of a log, and this stand is none
  const scenario::Scenario stand = planned_stand(array, seed);
  const double dwell_s = stand.dwell_s;
  auto simulator = scenario::Simulator::make(stand);
  if (!simulator) return part_with({false, "predicted", "the stand cannot be simulated: " + simulator.error(), ""});
  std::vector<Sample> samples;
  Sample sample;
  while (simulator->next(sample)) samples.push_back(sample);
  session::CalibrationRun run = session::run_calibration(array, samples);
  Json attitudes = planned_attitudes(run);
  CalibrationPart out = part_of(std::move(run), array, "predicted");
  out.section["planned"] = io::object({{"stations", kPlannedStations},
                                       {"samples_each", samples.size() / kPlannedStations},
                                       {"seconds_each", dwell_s},
                                       {"attitudes", std::move(attitudes)}});
  return out;
}

findings::GeometrySubject subject_of(const io::ArrayFile& array, const CalibrationPart& part,
                                     double days_since_calibration) {
  findings::GeometrySubject out;
  out.name = array.name;
  out.array = part.calibration ? session::array_to_certify(array, *part.calibration) : array.array;
  out.model = part.calibration ? part.calibration->model : array.datasheet.model();
  out.calibrated = part.calibration != nullptr;
  out.visited = part.visited;
  out.gravity = array.gravity;
  out.settings = findings::settings_of(array, days_since_calibration);
  out.settings.samples *= part.samples_per_row;
  out.file = std::make_unique<const io::ArrayFile>(array);
  return out;
}

Json array_section(const findings::GeometrySubject& subject, const findings::GeometryStudy& study) {
  Json out = geometry_document(subject, study);
  const bool magnetic = subject.field() == io::FieldKind::magnetic;
  const double per_g0 = magnetic ? kG0_mps2 * io::units_of(subject.field()).coarse_per_inside : 1.0;
  const auto size = [per_g0](double of_g0) { return std::isfinite(of_g0) ? Json(per_g0 * of_g0) : Json(); };
  Json map = Json::array();
  for (const findings::AttitudePoint& p : study.map)
    map.push_back({p.inclination_deg, p.toolface_deg, size(p.guaranteed_above_g0), size(p.nearest_mirror_g0),
                   p.not_guaranteed_sensors});
  out["attitude_map"] = io::object(
      {{"columns",
        io::texts({"inclination_deg", "toolface_deg", magnetic ? "guaranteed_above_ut" : "guaranteed_above_g0",
                   magnetic ? "nearest_mirror_ut" : "nearest_mirror_g0", "not_guaranteed_sensors"})},
       {"rows", std::move(map)}});
  return out;
}

verification::ArrayFacts array_facts(const findings::GeometrySubject& subject, const findings::GeometryStudy& study) {
  const auto known = [](double value, bool is) { return is ? std::optional<double>(value) : std::nullopt; };
  verification::ArrayFacts out;
  out.confirmed_grade = study.merit.confirmed_grade;
  out.provisional_grade = study.merit.provisional_grade;
  out.units = study.merit.units;
  const double level_rad =
      study.sizes.at[static_cast<std::size_t>(findings::SizeCondition::as_stated)].protection_level_at_rest_rad;
  out.protection_level_deg = known(deg_from_rad(level_rad), level_rad < kPi);
  out.field = subject.field();
  out.gravity_mps2 = subject.gravity.g_mps2;
  for (int i = 0; i < subject.array.size(); ++i) {
    const double least = study.thresholds.sensor[at(i)].detectable_mps2,
                 sure = study.sensors[at(i)].guaranteed_isolation_mps2;
    out.sensors.push_back({known(least, std::isfinite(least)), known(sure, std::isfinite(sure))});
  }
  for (const std::vector<findings::Finding>* list : {&study.warnings, &study.limits}) {
    for (const findings::Finding& f : *list)
      out.notes.push_back({to_string(f.code), geometry_words(f, subject, study)});
  }
  return out;
}

namespace {

/// Pairs of modes that some cell leads from and to.
std::set<std::pair<std::string, std::string>> possible_moves(const Json& machine) {
  std::set<std::pair<std::string, std::string>> out;
  for (const Json& cell : machine["cells"]) {
    if (cell["kind"] != "taken") continue;
    for (const Json& to : cell["leads_to"]) {
      if (to != cell["mode"]) out.insert({cell["mode"].get<std::string>(), to.get<std::string>()});
    }
  }
  return out;
}

}  // namespace

Json machine_section(const std::optional<verification::Replayed>& replayed) {
  Json out = io::parsed(machine_json());
  out["coverage"] = Json();
  if (!replayed) return out;
  out["coverage"] = coverage_json(replayed->coverage);
  out["coverage"]["moves_possible"] = possible_moves(out).size();
  return out;
}

}  // namespace render
}  // namespace PLUMB_ABI
}  // namespace plumb
