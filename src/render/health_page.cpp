#include "plumb/render/health_page.hpp"
#include "plumb/io/json_fields.hpp"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "html_view.hpp"
#include "plumb/core/units.hpp"
#include "plumb/render/figures.hpp"
#include "plumb/render/measured_words.hpp"
#include "plumb/scenario/count_text.hpp"
#include "size_fields.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace render {
namespace {

std::string tone_of_colour(const std::string& colour) {
  return colour == "green" || colour == "yes" ? "good" : (colour == "red" || colour == "no" ? "bad" : "open");
}

std::string fixed(const Json& value, double factor, int decimals) {
  return value.is_number() ? fixed_words(factor * value.get<double>(), decimals) : "-";
}
/// Three decimals, however large.
std::string seconds(const Json& value) { return fixed(value, 1.0, 3); }
double number(const Json& value) { return value.is_number() ? value.get<double>() : std::nan(""); }
std::string with_sigma(const Json& value, const Json& sigma) { return angle_with_sigma(number(value), number(sigma)); }
std::string why(const Json& station) {
  const std::string out = joined_list(station["reasons"], "text");
  return out == "-" ? "" : out;
}

/// Of a tool with groups beside its accelerometers: what all of them say, before what these say alone.
Section groups_view(const Json& report) {
  Section out("groups", "Groups of the tool", "What each group of sensors says, and how they agree.");
  ViewRows rows;
  std::vector<std::string> distrusted;
  const auto add = [&](const std::string& name, const Json& sensors, bool good, const std::string& use,
                       const Json& excluded, const Json& page) {
    rows.push_back({name, joined_list(sensors), ViewCell(use, good ? "good" : "bad"), joined_list(excluded),
                    page.is_null() ? ViewCell("-") : ViewCell(page.get<std::string>())});
    if (!good) distrusted.push_back(name + ": " + use);
  };
  Json own = Json::array();
  for (const Json& sensor : report["extremes"]["sensors"]) own.push_back(sensor["id"]);
  add("accelerometers", own, report["answer"]["usable_for_survey"] == "yes", report["answer"]["sentence"],
      report["answer"]["excluded"], Json("this page"));
  for (const Json& g : report["groups"]) add(g["name"], g["sensors"], g["trusted"], g["use"], g["excluded"], g["page"]);
  out.table("Groups", {"group", "sensors", "verdict", "excluded", "page"}, rows);
  for (const Json& g : report["groups"]) {
    if (!g["dip"].is_null())
      out.text("Gravity against the field of " + g["name"].get<std::string>() + ": " + g["dip"].get<std::string>());
  }
  if (distrusted.empty()) {
    out.text("Every group may be used.");
  } else {
    out.list("What not to trust", distrusted);
  }
  return out;
}

Section answer_view(const Json& report) {
  const Json& a = report["answer"];
  Section out("verdict", "1 Answer", "Whether this tool may be used for a survey, and what to do.");
  out.notice(a["sentence"], tone_of_colour(a["usable_for_survey"]));
  std::vector<std::string> actions;
  for (const Json& action : a["actions"]) actions.push_back(action);
  out.list("What to do", actions);
  std::vector<std::string> open;
  for (const Json& item : a["open_items"])
    open.push_back(item["name"].get<std::string>() + ": " + item["text"].get<std::string>());
  if (!open.empty()) {
    out.notice("What this run cannot show is still open. Inclination and toolface rest on it.", "open");
    out.list("Open items", open);
  }
  out.figures({{"Usable for survey", a["usable_for_survey"], "the tool as it is at the end of the run"},
               {"Green stations", a["green"].dump(), "use them"},
               {"Orange stations", a["orange"].dump(), "for orientation only"},
               {"Red stations", a["red"].dump(), "do not use them"}});
  out.table("The monitor at the end", {"question", "answer"},
            {{"state", a["state"].get<std::string>() + ": " + a["state_means"].get<std::string>()},
             {"output", a["output"]},
             {"sensors in service", joined_list(a["in_service"])},
             {"excluded", joined_list(a["excluded"])},
             {"provisionally excluded", joined_list(a["provisionally_excluded"])},
             {"absent", joined_list(a["absent"])}});
  return out;
}

ViewRows station_rows(const Json& report) {
  ViewRows rows;
  for (const Json& s : report["stations"]) {
    const std::string colour = s["colour"];
    rows.push_back({s["number"], seconds(s["begin_s"]), depth_words(number(s["depth_m"])),
                    ViewCell(colour, tone_of_colour(colour)), fixed(s["length_mps2"], kMg0, 3),
                    shown(s["off_mps2"], kMg0), shown(s["length_limit_mps2"], kMg0),
                    with_sigma(s["inclination_deg"], s["inclination_sigma_deg"]),
                    with_sigma(s["toolface_deg"], s["toolface_sigma_deg"]), s["protection_level_calibrated_axes_deg"],
                    s["protection_level_housing_deg"], joined_list(s["used"]), why(s)});
  }
  return rows;
}

Section stations_view(const Json& report, const PagePictures& pictures) {
  Section out("stations", "2 Stations", "Every stretch at rest, with its survey values and their bounds.");
  if (report["stations"].empty()) {
    out.notice("The run has no complete block at rest.", "bad");
    return out;
  }
  out.picture("From station to station", picture_of(pictures, "run.svg"),
              "Length of gravity less its reference, with its limit, inclination, and the largest statistic of the "
              "tests over its limit, by station and colour",
              "Limit of |G|: three standard deviations of reference, noise and calibration together. Statistic: of "
              "parity, norm or MAE, whichever came nearest to its own limit in the station; above 1 is an alarm.");
  out.table(
      "Stations",
      {"station", "t, s", "depth, m", "verdict", "|G|, mg0", "off by, mg0", "limit, mg0", "inclination, deg",
       "toolface, deg", "bound in axes, deg", "bound in housing, deg", "sensors used", "why"},
      station_rows(report),
      "± is one standard deviation of noise and calibration; a fault may do more. Bound: the largest error of the "
      "direction under any single undetected fault, in the frame of the calibrated axes and in that of the housing; - "
      "where there is no bound. Figures are those of the last block of "
      "the station; a toolface needs an inclination of 3 deg.");
  return out;
}

Section roll_view(const Json& report, const PagePictures& pictures) {
  Section out("roll", "3 Roll test", "Length and inclination against the toolface.");
  bool any = false;
  for (const Json& s : report["stations"]) any = any || s["toolface_deg"].is_number();
  if (!any) {
    out.notice("No station has a toolface: the tool was within 3 deg of vertical, or had no direction.", "open");
    return out;
  }
  out.picture(
      "Roll test", picture_of(pictures, "roll.svg"),
      "Length of gravity less its reference, and inclination, against the toolface",
      "A healthy tool shows no pattern in the upper panel. A wave with one crest in a turn is a bias across the "
      "tool, one with two crests a scale or an alignment. The lower panel is meaningful only if the tool was rolled "
      "at one inclination.");
  return out;
}

Section events_view(const Json& report) {
  Section out("events", "4 Events", "Every change that the monitor reported, and why.");
  ViewRows rows;
  for (const Json& e : report["events"])
    rows.push_back({e["sequence"], seconds(e["t_s"]), e["from"], e["to"], e["cause"], joined_list(e["sensors"]),
                    e["statistic"], e["limit"], e["why"]});
  if (rows.empty()) {
    out.text("No change.");
  } else {
    out.table("Events", {"no.", "t, s", "from", "to", "cause", "sensors", "statistic", "limit", "in words"}, rows,
              "Statistic and limit share a unit: standard deviations for parity and norm, m/s^2 for mae.");
  }
  return out;
}

Section motion_view(const Json& report, const PagePictures& pictures) {
  Section out("motion", "5 In motion", "What the sensors say of each other while the tool moves.");
  const Json& m = report["motion"];
  if (m.is_null()) {
    out.text("Not judged: the array file has no table [motion]. The sensors were judged at rest alone.");
    return out;
  }
  if (!m["judged"].get<bool>()) {
    out.notice("Not judged: " + m["field"].get<std::string>() + " " + m["why"].get<std::string>() +
                   ". Remedy: " + m["remedy"].get<std::string>() + ".",
               "open");
    return out;
  }
  for (const Json& note : m["notes"])
    out.notice(note["what"].get<std::string>() + ". Remedy: " + note["remedy"].get<std::string>() + ".", "open");
  out.table(
      "In motion", {"figure", "value"},
      {{"samples judged", fmt::format("{} of {}", m["samples_judged"].dump(), m["samples"].dump())},
       {"alarms", m["alarms"]},
       {"first alarm at t, s", seconds(m["first_alarm_s"])},
       {"suspected at any time", joined_list(m["suspects"])},
       {"isolated", joined_list(m["isolated"], "id")},
       {"provisionally excluded", joined_list(m["excluded"], "id")},
       {"the two gyros disagree from t, s", seconds(m["gyros_disagree_s"])},
       {"blocks with a bounded force", m["blocks"]},
       {"mean bound of its error, mg0", shown(m["bound_mean_mps2"], kMg0)},
       {"largest bound, mg0", shown(m["bound_worst_mps2"], kMg0)},
       {"largest part of the bound", m["dominant"].is_null() ? ViewCell("-") : ViewCell(m["dominant"])}},
      "Isolated: faulty in every explanation of the contradictions. An exclusion in motion is provisional until the "
      "tool is at rest.");
  out.picture("Specific force in motion", picture_of(pictures, "motion.svg"),
              "Length of the specific force and the bound of its error over time",
              "Of blocks (32 samples each unless the array file states block_samples); where the run is long, each "
              "point stands for several, by the largest bound. "
              "Orange: contradictions are on record. A gap: no bound.");
  ViewRows rows;
  for (const Json& e : m["events"])
    rows.push_back({seconds(e["t_s"]), e["event"], joined_list(e["sensors"]), e["why"]});
  if (rows.empty()) {
    out.text("No contradiction in motion.");
  } else {
    out.table("Events in motion", {"t, s", "event", "sensors", "in words"}, rows);
  }
  return out;
}

/// 0 is what the monitor says where it found none.
std::string drift_words_of(const Json& mps2_per_h) {
  const double rate = number(mps2_per_h);
  return rate == 0.0 ? "none found" : fmt::format("{:+.3g}", kMg0 * rate);
}

Section extremes_view(const Json& report) {
  const Json& e = report["extremes"];
  Section out("extremes", "6 Extremes", "Extreme values of the run.");
  const double hours = (e["last_s"].get<double>() - e["first_s"].get<double>()) / 3600.0;
  out.table(
      "Of the run", {"figure", "value", "at t, s"},
      {{"duration, h", shown(hours), "-"},
       {"samples", e["samples"], "-"},
       {"samples refused", e["samples_refused"], "-"},
       {"blocks at rest", e["blocks"], "-"},
       {"blocks in motion", e["blocks_in_motion_text"], "-"},
       {"lowest temperature, degC", shown(e["temperature_min_degc"]), "-"},
       {"highest temperature, degC", shown(e["temperature_max_degc"]), "-"},
       {"fastest change of temperature, degC/min", shown(e["temperature_rate_degc_per_min"]), "-"},
       {"largest error of |G|, mg0", shown(e["off_mps2"], kMg0), seconds(e["off_at_s"])},
       {"largest statistic over its limit", shown(e["statistic_over_limit"]), seconds(e["statistic_over_limit_at_s"])},
       {"largest MAE of a group of three, mg0", shown(e["worst_mae_mps2"], kMg0), "-"},
       {"largest bound on the direction in the calibrated axes, deg", shown(e["protection_level_calibrated_axes_deg"]),
        "-"},
       {"largest bound on the direction in the housing, deg", shown(e["protection_level_housing_deg"]), "-"}});
  ViewRows rows;
  for (const Json& s : e["sensors"])
    rows.push_back({s["id"], s["blocks_clipped"], s["blocks_scattering"], s["blocks_not_finite"],
                    shown(s["rows_full_scale_in_motion"]), shown(s["rows_full_scale_at_rest"]),
                    shown(s["noise_measured_mps2"], kMg0), shown(s["noise_declared_mps2"], kMg0),
                    drift_words_of(s["drift_mps2_per_h"]), shown(s["cells_empty"]), shown(s["cells_not_finite"])});
  out.table("By sensor",
            {"sensor", "blocks clipped", "blocks scattering", "blocks not finite", "rows at full scale in motion",
             "rows at full scale at rest", "scatter of its own, mg0", "noise declared, mg0", "drift rate, mg0/h",
             "cells empty", "cells not finite"},
            rows,
            "Blocks at rest are counted. Scattering: one sensor scattered more than its noise; its own scatter is that "
            "in these blocks. Drift rate: below every limit, as if this sensor alone drifted; positive where its "
            "reading grows; 1 sigma is at most a sixth of it.");
  return out;
}

std::string told(const Json& text) { return text.get<std::string>().empty() ? "unknown" : text.get<std::string>(); }

Section basis_view(const Json& report) {
  const Json& basis = report["basis"];
  const Json& g = basis["gravity"];
  const Json& c = basis["calibration"];
  Section out("basis", "7 Basis", "The length of gravity, and the calibration.");
  out.table("Gravity", {"figure", "value"},
            {{"model", g["model"]},
             {"length, m/s^2", fixed(g["g_mps2"], 1.0, 6)},
             {"standard deviation, mg0", shown(g["sigma_mps2"], kMg0)}},
            "From [gravity] of the array file.");
  out.text("Drift since the calibration: " + basis["drift"]["text"].get<std::string>() +
           ". What a reading drifts by beyond that is in no limit and in no bound on the direction.");
  out.text("Alignment: " + basis["alignment"]["text"].get<std::string>() +
           ". Inclination and toolface in the housing are off by that much more.");
  out.text("Wiring: " + basis["wiring"]["text"].get<std::string>() + ".");
  put_sizes(report.value("detection_sizes", Json()), out);
  if (c.is_null()) {
    out.text("There was no calibration file: the run began by calibrating itself.");
    return out;
  }
  out.table(
      "Calibration, as it was read", {"figure", "value"},
      {{"log", c["log"]},
       {"date of the log", told(c["date"])},
       {"serial number of the tool", told(c["serial"])},
       {"made by", "plumb " + c["made_by"].get<std::string>()},
       {"stations", c["stations"]},
       {"length of gravity then, m/s^2", fixed(c["g_mps2"], 1.0, 6)},
       {"lowest temperature, degC", c["temperature_min_degc"]},
       {"highest temperature, degC", c["temperature_max_degc"]},
       {"rms of |G| less gravity, mg0", shown(c["norm_rms_mps2"], kMg0)},
       {"rms of parity, mg0", shown(c["parity_rms_mps2"], kMg0)},
       {"chance of such residuals or worse", c["p_value"]}},
      (c.contains("coefficients")
           ? "Nothing was fitted: these are coefficients of the form " + c["coefficients"].get<std::string>() +
                 ", with the uncertainty that was stated. "
           : std::string()) +
          "Date and serial number are those given to plumb calibrate. The hash of the file is in the next section.");
  ViewRows rows;
  for (const Json& s : c["sensors"])
    rows.push_back({s["id"], shown(s["bias_mps2"][0], kMg0), s["scale_raw_per_mps2"][0], fixed(s["axis"][0], 1.0, 5),
                    fixed(s["axis"][1], 1.0, 5), fixed(s["axis"][2], 1.0, 5), shown(s["sigma_mps2"], kMg0),
                    shown(s["e_cal_mps2"], kMg0), shown(s["residual_rms_mps2"], kMg0)});
  out.table("Coefficients by sensor",
            {"sensor", "bias, mg0", "scale, raw per m/s^2", "x", "y", "z", "noise of a sample, mg0",
             "left by the calibration, mg0", "rms residual, mg0"},
            rows, "At the reference temperature; every coefficient with all its digits stands in the data file.");
  return out;
}

std::string hash_of(const Json& input) {
  return input.contains("sha256") ? "sha256 " + input["sha256"].get<std::string>()
                                  : "fnv1a " + input["fnv1a"].get<std::string>();
}

Section identity_of(const Json& report) {
  const Json& id = report["identity"];
  const Json& build = id["build"];
  Section out("identity", "8 Identity", "Inputs, versions and the command to repeat the run.");
  ViewRows rows = {{"tool", "plumb " + build["version"].get<std::string>()},
                   {"commit", build["commit"]},
                   {"compiler", build["compiler"]},
                   {"configuration of the monitor", id["config_hash"]},
                   {"rows of the log", id["log"]["rows"]},
                   {"bad rows", id["log"]["rows_bad"]},
                   {"the log ended", id["log"]["ended"]}};
  out.table("Identity", {"what", "value"}, rows);
  ViewRows inputs;
  for (const Json& i : id["inputs"]) inputs.push_back({i["role"], i["name"], i["bytes"], hash_of(i)});
  out.table("Inputs", {"role", "file", "bytes", "hash"}, inputs);
  std::vector<std::string> lines;
  lines.push_back(id["command"]);
  out.commands(lines);
  return out;
}

}  // namespace

std::string health_html(const Json& report, const PagePictures& pictures, const std::string& data) {
  const Json& run = report["run"];
  const Json& id = report["identity"];
  std::vector<Section> sections = {
      answer_view(report),           stations_view(report, pictures), roll_view(report, pictures), events_view(report),
      motion_view(report, pictures), extremes_view(report),           basis_view(report),          identity_of(report)};
  if (report.contains("groups")) sections.insert(sections.begin(), groups_view(report));
  return sections_html({"Tool health: " + id["name"].get<std::string>(),
                        fmt::format("{}, watched by plumb {}. Every figure is in {} beside this page.",
                                    count_text(report["extremes"]["sensors"].size(), "sensor"),
                                    id["build"]["version"].get<std::string>(), data),
                        "mg0 = 0.001 x 9.80665 m/s^2; angles in deg. docs/health-report.md states the rules.",
                        fmt::format("Run {} on {}.", run.value("time", "-"), run.value("host", "-"))},
                       std::move(sections));
}

}  // namespace render
}  // namespace PLUMB_ABI
}  // namespace plumb
