// The report of a fit as a table for people.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

#include "finding_words.hpp"
#include "fit_words.hpp"
#include "plumb/core/units.hpp"
#include "plumb/findings/column_findings.hpp"
#include "plumb/findings/fit_remarks.hpp"
#include "plumb/render/alignment_words.hpp"
#include "plumb/render/field_words.hpp"
#include "plumb/render/figures.hpp"
#include "plumb/render/fit_report.hpp"
#include "plumb/render/wiring_words.hpp"
#include "plumb/render/words.hpp"
#include "plumb/scenario/count_text.hpp"
#include "sensor_fields.hpp"
#include "temperature_words.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace render {
namespace {

constexpr std::size_t kOddStationsListed = 5;
/// Rounding.
constexpr double kNoExcitation = 1e-9;
constexpr std::size_t kTextWidth = 116;
constexpr std::size_t kLabelWidth = 20;

/// "  label   text", the text wrapped at blanks and indented below itself.
std::string line(const std::string& label, const std::string& text) {
  std::string out = fmt::format("{:<{}}", "  " + label, kLabelWidth);
  std::size_t column = kLabelWidth;
  std::size_t begin = 0;
  while (begin < text.size()) {
    std::size_t end = text.find(' ', begin);
    if (end == std::string::npos) end = text.size();
    const std::size_t width = end - begin;
    if (column > kLabelWidth && column + 1 + width > kTextWidth) {
      out += "\n" + std::string(kLabelWidth, ' ');
      column = kLabelWidth;
    } else if (column > kLabelWidth) {
      out += ' ';
      ++column;
    }
    out.append(text, begin, width);
    column += width;
    begin = end + 1;
  }
  return out + "\n";
}

std::string lines(const std::string& label, const std::vector<std::string>& texts) {
  std::string out;
  for (std::size_t k = 0; k < texts.size(); ++k) out += line(k == 0 ? label : "", texts[k]);
  return out;
}

std::string stations_text(const findings::CalibrationRun& run, const io::ArrayFile& array) {
  std::string out =
      fmt::format("\n  {:>7}  {:>12} {:>12}  {:>8}  {:>11}  {:>9} {:>9} {:>9}\n", "station", "begin s", "end s",
                  "samples", "temperature", fmt::format("norm {}", fine_unit(array)), "incl. deg", "held out");
  for (std::size_t k = 0; k < run.stations.size(); ++k) {
    const Station& s = run.stations[k];
    const Vec3& u = run.study.attitudes[k].direction;
    const bool fitted = k < run.study.residuals.size();
    const std::vector<int>& used = run.study.kept;
    const bool kept = std::binary_search(used.begin(), used.end(), static_cast<int>(k));
    const bool predicted = k < run.study.predicted.size() && run.study.predicted[k].judged;
    out += fmt::format(
        "  {:>7}  {:>12.3f} {:>12.3f}  {:>8}  {:>6.1f} degC  {:>9} {:>9} {:>9}\n", k + 1, s.begin_s, s.end_s, s.count,
        s.temperature_degc,
        fitted ? unsigned_zero(fmt::format("{:+.3f}", in_fine(array, run.study.residuals[k].norm_error_mps2))) : "-",
        norm(u) > 0.0 ? fmt::format("{:.1f}", deg_from_rad(std::atan2(std::hypot(u[0], u[1]), u[2]))) : "-",
        !kept       ? "rejected"
        : predicted ? fmt::format("{:.2f} s", run.study.predicted[k].sigmas)
                    : "-");
  }
  return out + "  held out: error of the prediction from the other stations, in sigmas of that prediction\n";
}

std::string clipped_names(const FitReport& report, const io::ArrayFile& array) {
  return sensor_names(report.clipped_sensors, array.array);
}

std::string columns_section(const findings::CalibrationRun& run, const io::ArrayFile& array) {
  std::vector<std::string> words;
  for (const findings::Finding& f : findings::column_findings(run, array)) words.push_back(column_words(f, run, array));
  if (const std::string unit = temperature_unit_words(run, array); !unit.empty()) words.push_back(unit);
  return lines("columns", words);
}

std::string fit_section(const findings::CalibrationRun& run, const io::ArrayFile& array) {
  const FitReport& r = run.told();
  std::string out = "\nfit\n";
  const bool judged = r.rank > 0;
  out += line("stop", fmt::format("{} after {}, from the {}", to_string(run.report.stop),
                                  count_text(run.report.iterations, "iteration"), to_string(run.report.start)));
  if (!judged) {
    return out + line("rank", "not known: there is no fit to these stations");
  }
  std::string rank = fmt::format("{} of {} parameters determined by the data", r.rank, r.parameters);
  if (r.gauge > 1) {
    rank += fmt::format("; {} are a common rotation of all axes, which gravity cannot show: see alignment", r.gauge);
  } else if (r.gauge == 1) {
    rank += "; 1 is a rotation of all axes about the roll axis, which gravity cannot show: see alignment";
  }
  out += line("rank", rank);
  if (const std::string rolls = roll_words(r); !rolls.empty()) out += line("roll groups", rolls);
  const bool by_nominal_axes = run.wiring.measured.empty();  // else known attitudes say more: the alignment
  if (by_nominal_axes && r.inclination_sigma_rad > 0.0 && r.null_directions == 0)
    out += line("inclination", inclination_words(r));
  if (run.study.shown) {
    const bool open = run.wiring.status == findings::WiringStatus::open;
    out += line("wiring", (open ? "OPEN: " : "") + wiring_text(run.wiring, array));
    out +=
        line("alignment", alignment_words(findings::alignment_of(array, run.study.shown.get(), run.wiring.measured)));
  }
  if (const std::string axis = roll_axis_words(r); !axis.empty()) out += line("roll axis", axis);
  const std::vector<std::string> unseen = unobservable(run, array);
  out += unseen.empty() ? line("not determined", "nothing") : lines("not determined", unseen);
  out +=
      line("condition", fmt::format("{:.3g} of the observable part, in prior sigmas (below 30 is good)", r.condition));
  return out;
}

std::string temperature_section(const findings::CalibrationRun& run, const io::ArrayFile& array) {
  std::string out;
  for (const TemperatureFact& fact : temperature_facts(run, array)) out += line(fact.label, fact.words);
  return out.empty() ? out : "\ntemperature\n" + out;
}

std::string residual_section(const findings::CalibrationRun& run, const io::ArrayFile& array) {
  if (!run.study.shown) return "";
  const FitReport& r = run.told();
  std::string out = "\nresiduals\n";
  out += line("length of gravity", fmt::format("{:.3f} mg0 rms", in_fine(array, r.norm_rms_mps2)));
  out += line("parity", array.array.size() > 3 ? fmt::format("{:.3f} mg0 rms", in_fine(array, r.parity_rms_mps2))
                                               : std::string("none: three sensors do not check one another"));
  out += line("beyond the noise", fmt::format("{:.3f} mg0", in_fine(array, r.misfit_mps2)));
  out += line("chi^2", fmt::format("{:.4g} for {}, p = {:.3g}: {}", r.chi2,
                                   count_text(r.degrees_of_freedom, "degree of freedom", "degrees of freedom"),
                                   r.p_value, p_value_words(r)));
  if (noise_overstated(r)) out += line("noise", measure_noise_words(array));
  const HoldOut& h = run.study.held_out;
  if (h.judged > 0) {
    std::string words = fmt::format("norm {:.3f} mg0 rms (largest {:.3f})", in_fine(array, h.norm_rms_mps2),
                                    in_fine(array, h.norm_max_mps2));
    if (array.array.size() > 3) {
      words += fmt::format(", parity {:.3f} mg0 rms (largest {:.3f})", in_fine(array, h.parity_rms_mps2),
                           in_fine(array, h.parity_max_mps2));
    }
    words += fmt::format("; {:.2f} times what the fit claims; {} of {}, each predicted by a fit without it", h.sigmas,
                         h.judged, count_text(run.study.kept.size(), "station"));
    if (h.not_judged > 0) words += fmt::format("; {} not, the rest being too few without them", h.not_judged);
    out += line("held out", words);
  } else {
    out += line("held out", h.not_judged > 0 ? "not possible: the stations that remain do not determine every parameter"
                                             : "not requested");
  }
  std::vector<std::string> odd;
  for (const findings::OddStation& s : findings::odd_stations(run)) {
    if (odd.size() < kOddStationsListed) odd.push_back(fmt::format("station {} ({:.1f} sigma)", s.number, s.sigmas));
  }
  if (!odd.empty()) out += line("stand out", listed(odd));
  const std::vector<std::string> outliers = outlier_words(run, array);
  if (const std::string level = level_words(r, array); !level.empty()) out += line("bends", level);
  if (!outliers.empty()) out += line("rejected", listed(outliers) + "; the values come from the other stations");
  if (r.clipped > 0)
    out += line("at full scale",
                fmt::format("{} of {}, not used", count_text(r.clipped, "reading"), clipped_names(r, array)));
  if (run.study.odd.sensor >= 0) {
    out += line("stands out", id_of(array, run.study.odd.sensor) + ": " + odd_sensor_words(run.study.odd, array) +
                                  "; look at its channel");
  }
  if (const std::string loud = high_variance_words(r, array); !loud.empty()) out += line("stands out", loud);
  for (const findings::Finding& f : findings::noise_remarks(run, array)) {
    out += line("noise", noise_words(r, array, f.sensor) +
                             ": declare the measured noise; the limits of the monitor depend on it; " +
                             measure_noise_words(array));
  }
  out += line("common scale", common_scale_words(run));
  return out;
}

/// The table in the units of the array's field.
std::array<SensorField, std::size(kSensorFields)> sensor_fields(const io::ArrayFile& array) {
  std::array<SensorField, std::size(kSensorFields)> out{};
  std::copy(std::begin(kSensorFields), std::end(kSensorFields), out.begin());
  if (array.field == io::FieldKind::gravity) return out;
  const io::FieldUnits& units = io::units_of(array.field);
  for (SensorField& field : out) {
    if (field.of_json == kMilli) {
      field.below = units.fine;
      field.of_text *= kMilli * units.fine_per_inside;
    } else if (field.below == nullptr) {  // the scale
      field.of_text /= kG0_mps2 * units.coarse_per_inside;
    }
  }
  return out;
}

std::string sensors_section(const findings::CalibrationRun& run, const io::ArrayFile& array) {
  const auto fields = sensor_fields(array);
  const std::string per = array.field == io::FieldKind::gravity ? "g0" : io::units_of(array.field).coarse;
  std::string out = fmt::format("\n  {:<15}", "sensor") + text_head(fields, &SensorField::above) +
                    fmt::format("  {:<15}", "") +
                    text_head(fields, &SensorField::below, array.input.unit.name + "/" + per);
  for (const findings::SensorFigures& f : findings::sensor_figures(run, array))
    out += fmt::format("  {:<15}", f.id) + text_row(fields, f);
  return out +
         "  data: how much of a value comes from the log (100 %) rather than from the datasheet (0 %). axis: turned "
         "against the\n  nominal one. e_cal: what calibration leaves in a reading (1 sigma).\n";
}

std::string paper_parameters_section(const findings::CalibrationRun& run, const io::ArrayFile& array) {
  if (!run.study.shown || array.field != io::FieldKind::gravity) return "";
  if (!run.study.paper) return "\n" + line("eqs (1)-(3)", paper_words(run.study.paper.error(), array));
  const SensorModel& model = *run.study.paper;
  std::string out =
      fmt::format("\n  {:<15} {:>10} {:>14}", "eqs (1)-(3)", "B, mg0", "SF, " + array.input.unit.name + "/g0");
  for (int k = 0; k < model.size; ++k) out += fmt::format(" {:>11}", "m_i" + std::to_string(k + 1));
  out += "\n";
  for (int i = 0; i < model.size; ++i) {
    const auto a = static_cast<std::size_t>(i);
    out += fmt::format("  {:<15} {:>10} {:>14.7g}", id_of(array, i),
                       fixed_words(in_fine(array, model.sensor[a].bias[0]), 3), model.sensor[a].scale[0] * kG0_mps2);
    for (int k = 0; k < model.size; ++k) {
      out += i == k ? fmt::format(" {:>11}", "-")
                    : fmt::format(" {:>11}",
                                  unsigned_zero(fmt::format(
                                      "{:+.6f}", model.misalignment[static_cast<std::size_t>(i * kCapacity + k)])));
    }
    out += "\n";
  }
  return out;
}

std::string paper_fits_section(const PaperCalibration& paper, const io::ArrayFile& array) {
  using PaperField = FieldOf<findings::PaperFigures>;
  std::string out = fmt::format("\n  {:<20} {:<16} {:>10} {:>6}", "the paper's fit of", "", "iterations", "rank") +
                    text_head(kPaperFields, &PaperField::above) + std::string(57, ' ') +
                    text_head(kPaperFields, &PaperField::below);
  bool silent = false;
  for (const findings::PaperFigures& f : findings::paper_figures(paper, array)) {
    out +=
        fmt::format("  {:<20} {:<16} {:>10} {:>6}", paper_sensors(f, array), paper_outcome(f), f.iterations, f.rank) +
        text_row(kPaperFields, f);
    silent = silent || !f.sound;
  }
  if (silent) out += fmt::format("  three that did not converge with rank {} are not used in paper mode\n", kPaperRank);
  return out;
}

std::string attitude_section(const findings::CalibrationRun& run, const io::ArrayFile& array, bool suggest) {
  const Coverage& c = run.study.coverage;
  std::string out = "\nattitudes\n";
  if (c.attitudes > 0) {
    out += line("inclinations", fmt::format("{} distinct, from {:.0f} to {:.0f} deg, in {}", c.inclinations,
                                            deg_from_rad(c.inclination_min_rad), deg_from_rad(c.inclination_max_rad),
                                            count_text(c.attitudes, "station")));
  }
  if (run.told().rank > 0)
    out += line("excitation", fmt::format("{:.3g} (evenly spread = 1, below 0.05 is poor)",
                                          run.told().excitation < kNoExcitation ? 0.0 : run.told().excitation));
  const std::vector<std::string> lacking = coverage_words(run, array);
  out += lacking.empty() ? line("lacking", "nothing") : lines("lacking", lacking);
  if (!suggest || run.study.next.empty()) return out;
  std::vector<std::string> next;
  for (const PlannedAttitude& attitude : run.study.next) next.push_back(attitude_words(attitude));
  return out + lines("record next", next);
}

std::string text_of(const findings::CalibrationRun& run, const io::ArrayFile& array, const ReportParts& parts) {
  std::string out = fmt::format(
      "array       {} ({}), gravity {:.6f} m/s^2 ({})\n", array.name, count_text(array.array.size(), "sensor"),
      io::units_of(array.field).coarse_per_inside * array.gravity.g_mps2,
      array.field == io::FieldKind::gravity ? to_string(array.gravity.model) : array.magnetic.source);
  out += fmt::format("log         {} used, {} skipped, {}\n", count_text(run.log.rows, "row"),
                     count_text(run.log.rows_bad, "bad row"), count_text(run.stations.size(), "station"));
  out += columns_section(run, array);
  if (parts.stations) out += stations_text(run, array);
  out += fit_section(run, array) + temperature_section(run, array) + residual_section(run, array) +
         sensors_section(run, array) + temperature_table(run, array) + paper_parameters_section(run, array);
  if (run.paper) out += paper_fits_section(*run.paper, array);
  const bool too_little = run.refusal.code == Errc::too_few_stations || run.refusal.code == Errc::unobservable;
  out += attitude_section(run, array, parts.suggest || (too_little && run.log_findings.empty()));
  if (run.interrupted) out += "\ninterrupted: the fit uses the stations up to then\n";
  if (run.accepted) return out + "\naccepted\n";
  const Refusal refusal = refusal_of(run, array);
  if (run.study.shown) out += "\nthe values above are those of the refused fit; none was written\n";
  return out + "\nNOT ACCEPTED: " + refusal.reason + "\nwhat to do:   " + refusal.next + "\n";
}

}  // namespace

std::string fit_text(const findings::CalibrationRun& run, const io::ArrayFile& array, const ReportParts& parts) {
  return in_field_words(text_of(run, array, parts), array.field);
}

}  // namespace render
}  // namespace PLUMB_ABI
}  // namespace plumb
