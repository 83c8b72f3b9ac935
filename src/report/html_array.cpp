// Sections 1 to 3 of the verification page: verdict, array, calibration.
#include <fmt/format.h>

#include "figures.hpp"
#include "html_view.hpp"
#include "plumb/core/units.hpp"
#include "plumb/io/json_fields.hpp"
#include "plumb/report/plot.hpp"
#include "plumb/report/verification_exports.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace report {
namespace {

std::vector<std::string> texts(const Json& list) {
  std::vector<std::string> out;
  for (const Json& item : list)
    out.push_back(item.is_object() ? item["text"].get<std::string>() : item.get<std::string>());
  return out;
}

void sensor_tables(const Json& array, Section& out) {
  ViewRows axes, least;
  for (const Json& s : array["sensors"]) {
    const Json& t = s["thresholds_mps2"];
    axes.push_back({s["id"].get<std::string>(), shown(s["axis"][0]), shown(s["axis"][1]), shown(s["axis"][2]),
                    shown(s["sigma_mps2"], kMg0), shown(s["nearest_mirror_axis_deg"])});
    least.push_back({s["id"].get<std::string>(), shown(t["block_noise"], kMg0), shown(t["detectable"], kMg0),
                     shown(t["sure_detection"], kMg0), shown(t["set_aside"], kMg0), shown(t["sure_isolation"], kMg0),
                     shown(t["blind_half_width"], kMg0), shown(t["any_attitude"], kMg0)});
  }
  out.table("Sensors", {"sensor", "x", "y", "z", "noise of a sample, mg0", "nearest mirror axis, deg"}, axes,
            "A sensor mounted on its mirror axis would pass in a group of three at every attitude.");
  out.table("Least faults found, mg0, in one block at any attitude",
            {"sensor", "noise of a block", "detected mostly", "detected surely", "set aside by parity",
             "told apart surely", "one attitude: blind below", "one attitude: clear above"},
            least,
            "Mostly: missed in at most one block of a thousand. Surely: whatever the noise does within its bound. The "
            "last two "
            "are what the length of gravity tells at a single attitude; more attitudes remove the rest.");
}

void limits_tables(const Json& array, Section& out) {
  ViewRows worst, levels, triples;
  for (const Json& row : array["worst_case"])
    worst.push_back(
        {shown(row["faults"]), shown(row["detected_e"]), shown(row["told_apart_e"]), shown(row["vector_error_e"])});
  if (!worst.empty())
    out.table("Worst case, in errors e of a healthy reading",
              {"faulty sensors", "detected above", "told apart above", "vector off at most"}, worst,
              "At any attitude, whatever the other faulty sensors show, in league or not.");
  for (const Json& row : array["protection_levels"])
    levels.push_back({shown(row["sigma_mg0"]), shown(row["one_sample_deg"]), shown(row["block_deg"])});
  if (!levels.empty())
    out.table("Protection level by noise", {"noise of a sample, mg0", "one sample, deg", "one block, deg"}, levels, "",
              true);
  for (const Json& t : array["triples"])
    triples.push_back({joined_list(t["sensors"]), shown(t["det"]), shown(t["condition"]),
                       t["near_singular"].get<bool>() ? "near singular" : "votes"});
  if (!triples.empty())
    out.table("Every group of three", {"sensors", "determinant", "condition", ""}, triples, "", true);
  ViewRows hidden;
  for (const Json& h : array["hidden_wiring"])
    hidden.push_back({h["what"].get<std::string>(), shown(h["turn_deg"]), shown(h["inclination_deg"])});
  if (hidden.empty()) {
    out.text("Every reversed sensor, exchange of two and turn of three shows in a recording.");
  } else {
    out.table("Mistakes of wiring that show at no attitude",
              {"mistake", "vector turned by, deg", "inclination off by, deg"}, hidden,
              "Check one known attitude by hand.", true);
  }
}

/// What to do where there is no calibration yet.
void planned_tables(const Json& c, Section& out) {
  if (!c.contains("planned")) return;
  const Json& p = c["planned"];
  out.text(fmt::format(
      "To record: hold the tool still at {} attitudes, spread as in the table, {} s ({} samples) at each. Their angles "
      "need not be met nor known; no external reference is needed. This is the stand of the prediction below.",
      shown(p["stations"]), shown(p["seconds_each"]), shown(p["samples_each"])));
  ViewRows rows;
  int number = 0;
  for (const Json& a : p["attitudes"])
    rows.push_back({std::to_string(++number), shown(a["inclination_deg"]), shown(a["toolface_deg"])});
  out.table("Attitudes to record", {"number", "inclination, deg", "toolface, deg"}, rows, "", true);
}

}  // namespace

Section verdict_view(const Json& report) {
  const Json& v = report["verdict"];
  Section out("verdict", "1 Verdict", "What was asked for, what was found, and what it rests on.");
  out.notice(v["sentence"].get<std::string>(), tone_of(v["verdict"]));
  std::vector<std::array<std::string, 3>> figures;
  for (const Json& a : v["answers"])
    figures.push_back({a["question"].get<std::string>(), a["value"].get<std::string>(), a["label"].get<std::string>()});
  out.figures(figures);
  ViewRows rows;
  for (const Json& c : v["criteria"]) {
    const std::string result = c["result"];
    // What a phone shows without being pushed stands first.
    rows.push_back({c["name"].get<std::string>(),
                    {result, tone_of(result)},
                    c["found"].get<std::string>(),
                    c["limit"].get<std::string>() + " (" + c["limit_from"].get<std::string>() + ")",
                    c["reason"].get<std::string>()});
  }
  out.table("Against the limits", {"what", "result", "found", "limit (from)", "why"}, rows,
            v["limits_file"].is_null()
                ? "No limits file was given: false alarms, fault size, rates and times were not judged "
                  "(--limits)."
                : "Open: too few scenarios to say.");
  const Json& n = v["requirements"];
  out.table("Requirements of the monitor", {"all", "active", "verified", "failed", "open", "traced, results not given"},
            {{shown(n["requirements"]), shown(n["active"]), shown(n["verified"]), shown(n["failed"]), shown(n["open"]),
              shown(n["traced"])}},
            "Verified: every test and formal item behind it was run and passed. Section 6 lists them.");
  if (!v["orphans"].empty()) out.list("Orphans", texts(v["orphans"]));
  out.picture(
      "The argument", {inline_svg(argument_svg(report)), ""},
      "The argument as a goal structure: the goal, five strategies, what each shows, and the section that holds the "
      "evidence.",
      "Goals are boxes, strategies lean, evidence is round. Green: shown; red: refuted; brown: open or not given.");
  out.list("Assumptions", texts(v["assumptions"]));
  out.list("Known limits", texts(v["known_limits"]));
  out.text("This report is evidence for your own safety case. plumb is neither certified nor qualified.");
  out.signature({"Name", "Role", "Date", "Signature"});
  return out;
}

Section array_view(const Json& report, const PagePictures& pictures) {
  const Json& a = report["array"];
  const Json& f = a["figures_of_merit"];
  Section out("array", "2 The array", "What these axes can determine, before anything is played.");
  out.picture("Axes", {axes_svg(a), ""},
              "The axes of the sensors, drawn in space; the table below lists their components.",
              "Seen from above the xy plane; z points down the tool. Dashed: down to the xy plane.");
  sensor_tables(a, out);
  out.table("Figures of merit", {"figure", "value"},
            {{"noise gain of the vector (GDOP)", shown(f["gdop"])},
             {"condition of the axes", shown(f["condition"])},
             {"angle between the nearest two axes, deg", shown(f["nearest_angle_deg"])},
             {"smallest determinant of a group of three", shown(f["min_triple_det"])},
             {"most axes in one plane", shown(f["coplanarity"])},
             {"faulty sensors isolated for good (strict grade)", shown(f["strict_grade"])},
             {"faulty sensors set aside at once (parity grade)", shown(f["parity_grade"])},
             {"faulty sensors told apart even if in league", shown(f["collusion_grade"])},
             {"sensors without which there is no vector", joined_list(a["critical_sensors"])},
             {"protection level, deg", shown(a["protection_level_deg"])}});
  const char* map = "geometry-attitudes.svg";
  if (!a["attitude_map"]["rows"].empty()) {
    out.picture("Blind and mirror attitudes", picture_of(pictures, map),
                "Map over inclination and toolface: above, the fault from which on the length of gravity isolates; "
                "below, the least fault with a second explanation.",
                fmt::format("At {} % of all attitudes some sensor is blind to the length of gravity.",
                            shown(a["one_attitude"]["blind_share"], 100.0)),
                "geometry-attitudes.csv");
  }
  if (!a["protection_levels"].empty())
    out.picture("Protection level against noise", picture_of(pictures, "geometry-protection.svg"),
                "Protection level in degrees against the noise of a sample, for one sample and for a block.",
                "Tilt error that one fault, noise and calibration together can cause while nothing alarms.",
                "geometry-protection.csv");
  limits_tables(a, out);
  return out;
}

Section calibration_view(const Json& report, const PagePictures& pictures) {
  const Json& c = report["calibration"];
  const std::string mode = c["mode"];
  Section out("calibration", "3 Calibration", "What turning raw values into accelerations leaves.");
  if (mode == "predicted") {
    out.notice(
        "Not given: predicted from a simulated stand. Give --positions LOG.csv or --calibration CAL.json for the real "
        "one; until then the verdict is open at best.",
        "open");
    planned_tables(c, out);
  } else {
    out.text("From " + mode + ".");
  }
  if (!c["accepted"].get<bool>())
    out.notice("Refused: " + c["reason"].get<std::string>() + ". " + c.value("remedy", ""), "bad");
  if (c.contains("sensors")) {
    ViewRows rows;
    for (const Json& s : c["sensors"])
      rows.push_back({s["id"].get<std::string>(), shown(s["e_cal_mps2"], kMg0), shown(s["residual_rms_mps2"], kMg0)});
    out.table("What it leaves, mg0", {"sensor", "1 sigma in a reading", "residual, rms"}, rows);
  }
  const Json figures = c.contains("fit") ? c["fit"]["fit"] : c.value("file", Json::object());
  ViewRows rows;
  for (const auto& [key, words] : {std::pair<const char*, const char*>{"parameters", "parameters"},
                                   {"rank", "of them seen by the data"},
                                   {"gauge", "never seen by gravity (common rotation)"},
                                   {"stations", "stations"},
                                   {"condition", "condition"},
                                   {"excitation", "excitation (1: attitudes all over the sphere)"},
                                   {"chi2", "chi squared"},
                                   {"degrees_of_freedom", "degrees of freedom"},
                                   {"p_value", "p value"},
                                   {"outliers", "stations set aside"},
                                   {"date", "date of the log"},
                                   {"serial", "serial number of the tool"},
                                   {"made_by", "made by plumb"}}) {
    if (figures.contains(key) && !figures[key].is_null() && figures[key] != "")
      rows.push_back({words, shown(figures[key])});
  }
  if (!rows.empty()) out.table("The fit", {"figure", "value"}, rows);
  if (!c.contains("fit")) return out;
  const Json& fit = c["fit"];
  ViewRows parameters;
  for (const Json& s : fit["sensors"])
    parameters.push_back({s["id"].get<std::string>(), shown(s["bias_mps2"], kMg0), shown(s["bias_sigma_mps2"], kMg0),
                          shown(s["scale_change"], 100.0), shown(s["scale_sigma"], 100.0), shown(s["axis_shift_deg"]),
                          shown(s["axis_sigma_deg"]), shown(s["data_share"], 100.0)});
  out.table(
      "Parameters",
      {"sensor", "bias, mg0", "1 sigma", "scale change, %", "1 sigma", "axis turned, deg", "1 sigma", "from data, %"},
      parameters);
  if (!c["trace"].empty()) {
    out.picture(
        "Convergence", picture_of(pictures, "traces.svg"),
        "Bias, scale and axis of every sensor and the cost of the fit, iteration by iteration.",
        "Iteration by iteration from the datasheet (0) to the calibration, as Figs 4 to 7 of the paper show it. "
        "plumb makes one fit of all sensors and reads every group of three from it, so that Figs 8 to 10 are "
        "the same curves.",
        "traces.csv");
  }
  if (!fit["stations"].empty()) {
    out.picture(
        "Residuals", picture_of(pictures, "residuals.svg"),
        "Error of the length of gravity at every station, in mg0, in the fit and held out.",
        "Length of the vector less gravity, station by station; held out: predicted by a fit without the station.",
        "residuals.csv");
  }
  ViewRows next;
  for (const Json& p : fit["attitudes"]["record_next"])
    next.push_back({shown(p["inclination_deg"]), shown(p["toolface_deg"]), shown(p["gain"])});
  if (!next.empty())
    out.table("What to record next", {"inclination, deg", "toolface, deg", "gain"}, next,
              mode == "predicted" ? "After those above: attitudes that would tell most about what is then least known."
                                  : "Attitudes that would tell most about what is least known.");
  return out;
}

}  // namespace report
}  // namespace PLUMB_ABI
}  // namespace plumb
