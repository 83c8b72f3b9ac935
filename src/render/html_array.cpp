// Sections 1 to 3 of the verification page: verdict, array, calibration.
#include <fmt/format.h>

#include "geometry_fields.hpp"
#include "html_view.hpp"
#include "plumb/core/units.hpp"
#include "plumb/io/json_fields.hpp"
#include "plumb/render/figures.hpp"
#include "plumb/render/plot.hpp"
#include "plumb/render/verdict_section.hpp"
#include "plumb/render/verification_exports.hpp"
#include "plumb/scenario/count_text.hpp"
#include "sensor_fields.hpp"
#include "size_fields.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace render {
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
    axes.push_back({s["id"], s["axis"][0], s["axis"][1], s["axis"][2], shown(s["sigma_mps2"], kMg0),
                    s["nearest_mirror_axis_deg"]});
    least.push_back(page_row(s["id"], kThresholdFields, s["thresholds_mps2"], s[kBeyondKey]));
  }
  out.table("Sensors", {"sensor", "x", "y", "z", "noise of a sample, mg0", "nearest mirror axis, deg"}, axes,
            "A sensor mounted on its mirror axis would pass in a group of three at every attitude.", Fold::when_long);
  out.table("Sizes by sensor, mg0, in one block at any attitude, as stated", page_head("sensor", kThresholdFields),
            least,
            "The last two are what the length of gravity tells at a single attitude; more attitudes remove the rest.",
            Fold::when_long);
}

void limits_tables(const Json& array, Section& out) {
  ViewRows worst, levels, triples;
  for (const Json& row : array["worst_case"]) worst.push_back(page_row(shown(row["faults"]), kWorstFields, row));
  if (!worst.empty())
    out.table("Worst case, in errors e of a healthy reading",
              page_head(has_chips(array) ? "faulty units" : "faulty sensors", kWorstFields), worst,
              "At any attitude, for any readings of the other faulty sensors, correlated or not.");
  for (const Json& row : array["protection_levels"])
    levels.push_back({row["sigma_mg0"], row["one_sample_deg"], row["block_deg"]});
  if (!levels.empty())
    out.table("Protection level by noise", {"noise of a sample, mg0", "one sample, deg", "one block, deg"}, levels, "",
              Fold::omitted);
  for (const Json& t : array["triples"])
    triples.push_back({joined_list(t["sensors"]), t["det"], t["condition"],
                       t["near_singular"].get<bool>() ? "near singular" : "monitored"});
  if (!triples.empty())
    out.table("Every group of three", {"sensors", "determinant", "condition", ""}, triples, "", Fold::omitted);
  ViewRows hidden;
  for (const Json& h : array["unobservable_permutations"])
    hidden.push_back({h["what"], h["turn_deg"], h["inclination_deg"]});
  if (hidden.empty()) {
    out.text(
        "Every reversed sensor, exchange of two and turn of three shows in a recording. That all sensors are reversed "
        "at once does not.");
  } else {
    out.table("Wiring errors that are not detectable at any attitude",
              {"mistake", "vector turned by, deg", "inclination off by, deg"}, hidden,
              "By the axes of the datasheet. One station of known attitude excludes them: --known-attitude.",
              Fold::omitted);
  }
}

/// What to do where there is no calibration yet.
void planned_tables(const Json& c, Section& out) {
  if (!c.contains("planned")) return;
  const Json& p = c["planned"];
  out.text(fmt::format(
      "To record: hold the tool still at {}, spread as in the table, {} s ({}) at each. Their angles "
      "need not be met nor known; no external reference is needed. This is the stand of the prediction below.",
      count_text(p["stations"].get<double>(), "attitude"), shown(p["seconds_each"]),
      count_text(p["samples_each"].get<double>(), "sample")));
  ViewRows rows;
  int number = 0;
  for (const Json& a : p["attitudes"])
    rows.push_back({std::to_string(++number), a["inclination_deg"], a["toolface_deg"]});
  out.table("Attitudes to record", {"number", "inclination, deg", "toolface, deg"}, rows, "", Fold::omitted);
}

}  // namespace

Section verdict_view(const Json& report) {
  const Json& v = report["verdict"];
  Section out("verdict", "1 Verdict", "The limits, the results, and their evidence.");
  ViewRows rows;
  for (const verification::Criterion& c : criteria_of(report)) {
    // What a phone shows without being pushed stands first.
    rows.push_back({entry_of(c.id).title,
                    {to_string(c.result), tone_of(to_string(c.result))},
                    c.found,
                    c.limit + " (" + c.limit_from + ")",
                    c.reason});
  }
  out.table("Against the limits", {"what", "result", "found", "limit (from)", "why"}, rows,
            v["limits_file"].is_null()
                ? "No limits file was given: false alarms, fault size, rates and times were not judged "
                  "(--limits)."
                : "Open: too few scenarios to say.");
  const Json& n = v["requirements"];
  std::vector<std::string> counted;
  std::vector<ViewCell> counts;
  for (const verification::RequirementCount& count : verification::kRequirementCounts) {
    if (count.title == nullptr) continue;
    counted.emplace_back(count.title);
    counts.emplace_back(shown(n[count.key]));
  }
  out.table("Requirements of the monitor", counted, {counts},
            "Verified: every test and formal item behind it was run and passed. Section 6 lists them.");
  if (!v["orphans"].empty()) out.list("Orphans", texts(v["orphans"]));
  out.picture(
      "The argument", {inline_svg(argument_svg(report)), "", inline_svg(argument_svg(report, true))},
      "The argument as a goal structure: the goal, six strategies, what each shows, and the section that holds the "
      "evidence.",
      "Goals are boxes, strategies are parallelograms, evidence is round. Green: shown; red: refuted; brown: open or "
      "not given.");
  out.list("Assumptions", texts(v["assumptions"]));
  out.list("Known limits", texts(v["known_limits"]));
  out.text("This report is evidence for your own safety case. plumb is neither certified nor qualified.");
  return out;
}

Section array_view(const Json& report, const PagePictures& pictures) {
  const Json& a = report["array"];
  const Json& f = a["figures_of_merit"];
  Section out("array", "2 The array", "What these axes can determine, by analysis.");
  out.picture("Axes", {axes_svg(a), "", axes_svg(a)},
              "The axes of the sensors, drawn in space; the table below lists their components.",
              "Seen from above the xy plane; z points down the tool. Dashed: down to the xy plane.");
  put_sizes(a["detection_sizes"], out);
  sensor_tables(a, out);
  const bool chips = has_chips(a);
  const std::string faulty = chips ? "faulty units" : "faulty sensors";
  if (chips) out.text(kSizesOfOneAxis);
  ViewRows merit = {{"noise gain of the vector (GDOP)", f["gdop"]},
                    {"condition of the axes", f["condition"]},
                    {"angle between the nearest two axes, deg", f["nearest_angle_deg"]},
                    {"smallest determinant of a group of three", f["min_triple_det"]},
                    {chips ? "most units in one plane" : "most axes in one plane", f["coplanarity"]},
                    {faulty + " isolated with confirmation (confirmed grade)", f["confirmed_grade"]},
                    {faulty + " excluded provisionally (provisional grade)", f["provisional_grade"]},
                    {"correlated " + faulty + " that can be isolated", f["correlated_grade"]},
                    {"sensors without which there is no vector", sensors_cell(a["critical_sensors"])}};
  if (chips) merit.insert(merit.begin() + 4, std::vector<ViewCell>{"units: chips, and sensors on none", f["units"]});
  out.table("Figures of merit", {"figure", "value"}, merit);
  const char* map = "geometry-attitudes.svg";
  if (!a["attitude_map"]["rows"].empty()) {
    out.picture("Attitudes that hide a fault, and mirror attitudes", picture_of(pictures, map),
                "Map over inclination and toolface: above, the fault from which on the length of gravity isolates; "
                "below, the least fault with a second explanation.",
                fmt::format("At {} % of all attitudes the length of gravity hides a fault of some sensor.",
                            shown(a["one_attitude"]["not_guaranteed_share"], 100.0)),
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
  Section out("calibration", "3 Calibration", "The errors that remain after calibration.");
  if (mode == "predicted") {
    out.notice(
        "Not given: predicted from a simulated stand. Give --stations LOG.csv or --calibration CAL.json for the real "
        "one; until then the verdict is open at best.",
        "open");
    planned_tables(c, out);
  } else {
    out.text("From " + mode + ".");
    if (mode == "known coefficients")
      out.notice("Not fitted: coefficients and uncertainty are as stated, and no station of this tool has tested them.",
                 "open");
  }
  if (!c["accepted"].get<bool>())
    out.notice("Refused: " + c["reason"].get<std::string>() + ". " + c.value("remedy", ""), "bad");
  if (c.contains("sensors")) {
    ViewRows rows;
    for (const Json& s : c["sensors"])
      rows.push_back({s["id"], shown(s["e_cal_mps2"], kMg0), shown(s["residual_rms_mps2"], kMg0)});
    out.table("What it leaves, mg0", {"sensor", "1 sigma in a reading", "residual, rms"}, rows, "", Fold::when_long);
  }
  const Json figures = c.contains("fit") ? c["fit"]["fit"] : c.value("file", Json::object());
  ViewRows rows;
  for (const auto& [key, words] : {std::pair<const char*, const char*>{"parameters", "parameters"},
                                   {"rank", "of them seen by the data"},
                                   {"gauge", "not observable from gravity (common rotation)"},
                                   {"stations", "stations"},
                                   {"condition", "condition"},
                                   {"excitation", "spread of attitudes (1: the whole sphere)"},
                                   {"chi2", "chi squared"},
                                   {"degrees_of_freedom", "degrees of freedom"},
                                   {"p_value", "p value"},
                                   {"outliers", "outlier stations"},
                                   {"date", "date of the log"},
                                   {"serial", "serial number of the tool"},
                                   {"coefficients", "not fitted; coefficients of the form"},
                                   {"made_by", "made by plumb"}}) {
    if (figures.contains(key) && !figures[key].is_null() && figures[key] != "")
      rows.push_back({words, shown(figures[key])});
  }
  if (!rows.empty()) out.table("The fit", {"figure", "value"}, rows);
  if (!c.contains("fit")) return out;
  const Json& fit = c["fit"];
  ViewRows parameters;
  for (const Json& s : fit["sensors"]) {
    parameters.push_back(page_row(s["id"], kSensorFields, s));
    parameters.back().emplace_back(shown(s["data_share"], 100.0));
  }
  std::vector<std::string> titles = page_head("sensor", kSensorFields);
  titles.emplace_back("from data, %");
  out.table("Parameters", titles, parameters, "", Fold::when_long);
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
    next.push_back({p["inclination_deg"], p["toolface_deg"], p["gain"]});
  if (!next.empty())
    out.table("What to record next", {"inclination, deg", "toolface, deg", "gain"}, next,
              mode == "predicted" ? "After those above: attitudes that best determine the least known parameters."
                                  : "Attitudes that best determine the least known parameters.");
  return out;
}

}  // namespace render
}  // namespace PLUMB_ABI
}  // namespace plumb
