// Sections 4 and 5 of the verification page: campaigns and state machine.
#include <fmt/format.h>

#include <map>

#include "html_view.hpp"
#include "plumb/core/units.hpp"
#include "plumb/io/json_fields.hpp"
#include "plumb/scenario/count_text.hpp"
#include "plumb/study/proportion.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace render {
namespace {

/// k of n and the interval, behind what was counted.
std::vector<ViewCell> rate_row(const std::string& words, const Json& rate) {
  return {words, shown(rate["count"]), shown(rate["of"]), lower_end(rate), upper_end(rate)};
}

/// Rates that bring their words.
ViewRows rate_rows(const Json& rates) {
  ViewRows rows;
  for (const Json& rate : rates) rows.push_back(rate_row(rate["words"], rate));
  return rows;
}

void rates_table(const Json& rates, Section& out) {
  out.table("All scenarios of the fault campaign", {"results", "k", "of n", "from, %", "to, %"}, rate_rows(rates),
            "A scenario may count in several rows; those drawn without a fault count too. " +
                std::string(study::kIntervalNote) + ".");
}

/// The unit of the campaign's sizes, which is not the size that section 2 guarantees.
std::string mdb_words(const Json& mdb_mps2) {
  double least = 0.0, most = 0.0;
  for (const Json& one : mdb_mps2) {
    const double size = one.get<double>();
    least = least == 0.0 || size < least ? size : least;
    most = size > most ? size : most;
  }
  if (!(most > 0.0)) return "";
  const std::string low = fmt::format("{:.3g}", 1e3 * g0_from_mps2(least));
  const std::string high = fmt::format("{:.3g}", 1e3 * g0_from_mps2(most));
  return fmt::format(
      " One MDB of a campaign is what shows through the noise of one block alone, {} mg0 here: a unit of size. The "
      "thresholds of section 2 are larger, because they hold at every attitude and include the calibration errors.",
      low == high ? high : low + " to " + high);
}

void fault_table(const Json& faults, bool chips, Section& out) {
  ViewRows rows, times;
  for (const Json& g : faults["by_fault"]) {
    const bool clean = g["wrong_exclusion"]["count"] == 0;
    rows.push_back({g["fault"],
                    g["faulty"],
                    shown_rate(g["detected"]),
                    shown_rate(g["isolated"]),
                    {shown_rate(g["wrong_exclusion"]), clean ? "" : "bad"},
                    shown_rate(g["misleading"]),
                    g["tilt_before_alarm_deg"],
                    g["tilt_usable_deg"]});
    const Json& d = g["to_detect"];
    const Json& i = g["to_isolate"];
    times.push_back({g["fault"], g["faulty"], d["cases"], d["median_s"], d["p95_s"], d["last_s"], i["cases"],
                     i["median_s"], i["p95_s"], i["last_s"]});
  }
  out.table(
      "By fault and size",
      {"fault", chips ? "units" : "sensors", "detected", "isolated exactly", "healthy one excluded", "misleading",
       "tilt before alarm, deg", "tilt while usable, deg"},
      rows,
      "k/n (interval): " + std::string(study::kIntervalNote) +
          std::string(
              ". Names as in plumb inject: stuck at a level, last value held, random, noise, missing, "
              "drift, scale, "
              "axis turned, spikes, bias in multiples of the minimal detectable one (MDB), ghost = a gravity that is "
              "turned.") +
          mdb_words(faults["mdb_mps2"]));
  out.table("Times from the onset, s",
            {"fault", chips ? "units" : "sensors", "detected", "median", "95 %", "last", "isolated", "median", "95 %",
             "last"},
            times, "", Fold::omitted);
}

/// The result of a longer campaign, which is what the verdict judges.
void reused_table(const Json& section, Section& out) {
  if (!section.contains("reused")) return;
  const Json& reused = section["reused"];
  out.table("The long campaign: " + reused["file"].get<std::string>(), {"results", "k", "of n", "from, %", "to, %"},
            rate_rows(reused["rates"]),
            "The same campaign with more scenarios, played elsewhere (--reuse). The verdict judges these rates.");
}

/// A row that is a station has no time of its own.
std::string block_words(const Json& subject, const Json& plan) {
  const auto rows = plan["block_samples"].get<std::uint64_t>();
  if (subject["rows"] != "stations") return count_text(rows, "sample") + ", " + shown(plan["block_s"]) + " s";
  return count_text(rows, "row") + ", each as the mean of " +
         count_text(subject["samples_per_row"].get<std::uint64_t>(), "sample");
}

std::string mae(const Json& measured_g0, const Json& printed_g) {
  return shown(measured_g0) + " / " + shown(printed_g);
}

void table2_part(const Json& t, Section& out) {
  out.heading("Table 2 of the paper");
  if (!t["given"].get<bool>()) return out.text("Not played: " + t["reason"].get<std::string>() + ".");
  out.text(fmt::format(
      "The 23 experiments of Seyed Moosavi et al., Sensors 2018, with a tool drawn from this array file: the "
      "paper's rule gives {} of {} verdicts as printed. Beside it what plumb's monitor made of the same "
      "samples, {} each.",
      t["as_printed"].dump(), t["experiments"].dump(), count_text(t["attitudes"].get<std::uint64_t>(), "attitude")));
  ViewRows verdicts, errors;
  for (const Json& r : t["rows"]) {
    const bool same = r["as_printed"], wrong = r["monitor_suspected_a_healthy_one"];
    verdicts.push_back({r["number"],
                        r["faulty"],
                        r["voltage"],
                        r["detected"].get<bool>() ? "yes" : "no",
                        r["isolated"],
                        {same ? "yes" : "no", same ? "good" : "bad"},
                        r["monitor_state"],
                        {r["monitor_excluded"], wrong ? "bad" : ""},
                        r["monitor_after_attitudes"] == 0 ? "-" : shown(r["monitor_after_attitudes"])});
    std::vector<ViewCell> row = {shown(r["number"]), mae(r["mae_all_g0"], r["printed_mae_all_g"])};
    for (std::size_t k = 0; k < r["mae_triple_g0"].size(); ++k)
      row.emplace_back(mae(r["mae_triple_g0"][k], r["printed_mae_triple_g"][k]));
    errors.push_back(std::move(row));
  }
  out.table("Table 2: verdicts",
            {"no.", "faulty", "voltage", "detected", "isolated", "as printed", "plumb ends in", "excluded",
             "after attitudes"},
            verdicts,
            "Detected, isolated: by the paper's rule. With two faulty sensors of four nothing can be isolated: that is "
            "beyond "
            "the grade.");
  out.table(
      "Table 2: mean absolute errors, measured / printed, g0", {"no.", "all four", "1-2-3", "1-2-4", "1-3-4", "2-3-4"},
      errors,
      "The paper does not print its attitudes, so that the sizes of the errors differ; its verdicts do not depend on "
      "them.");
}

void confusion_table(const Json& confusion, Section& out) {
  std::vector<std::string> head = {"faulty"};
  for (const Json& column : confusion["columns"]) head.push_back(column);
  ViewRows rows;
  for (const Json& row : confusion["rows"]) {
    std::vector<ViewCell> line = {row["faulty"] == 0 ? std::string("nobody") : shown(row["faulty"])};
    for (const Json& count : row["counts"]) line.emplace_back(shown(count));
    rows.push_back(line);
  }
  out.table("True state against published state", head, rows, "Scenarios, each in one column.");
}

void stanford_table(const Json& stanford, const std::string& title, Section& out) {
  ViewRows rows;
  const std::map<std::string, const char*> words = {
      {"available", "available: error within the protection level, that within the alert limit"},
      {"misleading", "error above the protection level, within the alert limit"},
      {"hazardous", "error above the alert limit, protection level within it"},
      {"unavailable", "unavailable: no protection level, or above the alert limit"},
      {"unavailable_misleading", "unavailable, and the error above the protection level"}};
  for (const auto& [name, rate] : stanford["regions"].items()) rows.push_back(rate_row(words.at(name), rate));
  out.table(title, {"region", "blocks", "of", "from, %", "to, %"}, rows);
}

void worst_table(const Json& worst, const std::string& title, Section& out) {
  ViewRows rows;
  for (const Json& w : worst)
    rows.push_back({w["what"], shown(w["value"]) + " " + shown(w["unit"]), w["story"], w["replay"]});
  if (!rows.empty())
    out.table(title, {"what", "size", "what happens", "run it again"}, rows,
              "Commands run in the directory of this report.");
}

void healthy_part(const Json& healthy, Section& out) {
  out.heading("Without faults");
  if (!healthy["played"].get<bool>()) return out.notice("Not played: " + healthy["reason"].get<std::string>(), "open");
  ViewRows rows;
  for (const auto& [key, words] :
       {std::pair<const char*, const char*>{"false_alarm_per_block", "false alarms, blocks up to the first"},
        {"false_alarm_per_scenario", "scenarios with a false alarm"},
        {"wrong_exclusion", "a sensor excluded"},
        {"misleading", "misleading"},
        {"beyond_protection", "error above the protection level"},
        {"unavailable", "an alert stands at the end"},
        {"failed", "ended in failed"}})
    rows.push_back(rate_row(words, healthy[key]));
  out.table("Healthy tool", {"what", "k", "of n", "from, %", "to, %"}, rows,
            std::string(study::kIntervalNote) +
                "; with the right gravity value and with one wrong by three sigma, in "
                "equal shares.");
  reused_table(healthy, out);
  worst_table(healthy["worst"], "Worst scenarios without faults", out);
}

}  // namespace

Section campaign_view(const Json& report, const PagePictures& pictures) {
  const Json& campaign = report["campaign"];
  Section out("campaign", "4 Fault campaign", "Simulated tools, attitudes and faults through the monitor, counted.");
  const Json& faults = campaign["faults"];
  if (!faults["played"].get<bool>()) {
    out.notice("Not played: " + faults["reason"].get<std::string>(), "open");
  } else {
    const Json& plan = faults["plan"];
    out.text(fmt::format(
        "{} of {}, {}, seed {}; attitudes: {}; a block is {}; alert limit {} "
        "deg. Up to {}.",
        count_text(plan["scenarios"].get<std::uint64_t>(), "scenario"),
        count_text(plan["stations"].get<std::uint64_t>(), "station"),
        count_text(plan["cells"].get<std::uint64_t>(), "combination"), plan["seed"].dump(),
        joined_list(plan["attitudes"]), block_words(report["subject"], plan), shown(plan["alert_limit_deg"]),
        count_text(
            faults["largest_faulty"].get<std::uint64_t>(),
            has_chips(report["array"]) ? "simultaneous fault of a chip or sensor" : "simultaneous sensor fault",
            has_chips(report["array"]) ? "simultaneous faults of chips or sensors" : "simultaneous sensor faults")));
    rates_table(faults["rates"], out);
    reused_table(faults, out);
    fault_table(faults, has_chips(report["array"]), out);
    confusion_table(faults["confusion"], out);
    if (!faults["by_size"].empty()) {
      ViewRows sizes;
      for (const Json& bin : faults["by_size"])
        sizes.push_back({bin["from_mdb"], bin["to_mdb"], shown_rate(bin["detected"]), shown_rate(bin["isolated"])});
      out.picture(
          "Detection and isolation by size", picture_of(pictures, "by-size.svg"),
          "Share of single constant errors detected and isolated, by size in multiples of the minimal detectable "
          "bias, with intervals.",
          "Single constant errors; bars are 95 % intervals (97.5 % bounds at 0 and at all).", "by-size.csv");
      out.table("Detection and isolation by size, the data", {"from, MDB", "to, MDB", "detected", "isolated"}, sizes,
                "", Fold::omitted);
    }
    out.picture("Time to detect and to isolate", picture_of(pictures, "times.svg"),
                "Share of the detected and of the isolated faults against the time since the onset.",
                "Of the faults that were detected, and of those that were isolated.", "times.csv");
    out.picture("Stanford diagram", picture_of(pictures, "stanford.svg"),
                "Blocks by tilt error and protection level, in octaves; the alert limit as lines.",
                "Blocks by error and protection level. Below the diagonal the error is above the protection level; "
                "the upper row: no protection level.",
                "stanford.csv");
    stanford_table(faults["stanford"], "Blocks by region", out);
    worst_table(faults["worst"], "Worst scenarios", out);
  }
  healthy_part(campaign["healthy"], out);
  table2_part(campaign["table2"], out);
  if (campaign.contains("replayed")) {
    const Json& again = campaign["replayed"];
    out.text(
        fmt::format("{} {} played again by other code (the simulator and the monitor for 24 sensors): {} "
                    "{} in every block.",
                    count_text(again["scenarios"].get<std::uint64_t>(), "scenario"),
                    by_count(again["scenarios"].get<std::uint64_t>(), "was", "were"), again["agree"].dump(),
                    by_count(again["agree"].get<std::uint64_t>(), "agrees", "agree")));
  }
  return out;
}

namespace {

/// States and transitions that the replayed scenarios went through.
void coverage_tables(const Json& coverage, Section& out) {
  ViewRows states, moves, missed;
  for (const Json& s : coverage["states"]) {
    const bool seen = s["samples"] != 0;
    states.push_back({s["mode"], {s["samples"], seen ? "" : "open"}});
  }
  for (const Json& m : coverage["moves"]) moves.push_back({m["from"], m["to"], m["count"]});
  std::map<std::string, std::string> cells;
  for (const Json& c : coverage["cells"]) {
    if (c["records"] == 0) {
      std::string& list = cells[c["mode"]];
      list += (list.empty() ? "" : ", ") + c["event"].get<std::string>();
    }
  }
  for (const auto& [mode, events] : cells) missed.push_back({mode, events});
  out.table("States, in samples", {"state", "samples"}, states, "", Fold::omitted);
  out.table("Transitions that were taken", {"from", "to", "times"}, moves, "", Fold::omitted);
  out.table(
      "Cells in which no replayed scenario left a record", {"state", "events"}, missed,
      "Cells that only count leave none, and what the host asks for and fits do not occur in campaigns. That tests "
      "and model reach every cell is shown by their results, where they are given (--test-results, --assurance).",
      Fold::omitted);
}

/// Proved, exhaustively checked and sampled are three different things, and stand in tables of their own.
void assurance_tables(const Json& given, Section& out) {
  const struct {
    const char *kind, *title, *note;
  } kinds[] = {
      {"proved", "Proved",
       "For all numbers and states within the stated bounds, by a proof that a machine has checked."},
      {"exhaustive", "Exhaustively checked", "Every state or case within the bound named, and nothing beyond it."},
      {"compared", "Compared", "Two independent descriptions that must agree."},
      {"sampled", "Sampled", "Random cases: evidence, not proof."}};
  for (const auto& kind : kinds) {
    ViewRows rows;
    for (const Json& i : given["items"]) {
      const std::string result = i["result"];
      if (i["kind"] == kind.kind)
        rows.push_back({i["title"], i["tool"], i["figure"], i["seconds"], {result, tone_of(result)}});
    }
    if (!rows.empty()) out.table(kind.title, {"what", "tool", "bound or figure", "s", "result"}, rows, kind.note);
  }
  out.text("Made from " + given["version"].get<std::string>() +
           (given["complete"].get<bool>() ? "." : ", the quick form, without the larger arrays."));
}

}  // namespace

Section machine_view(const Json& report) {
  const Json& machine = report["state_machine"];
  Section out("machine", "5 State machine",
              "The one table that runs in the monitor, and where some replayed scenarios went.");
  const Json& coverage = machine["coverage"];
  out.picture("States and transitions", {machine_svg(machine, false), "", machine_svg(machine, true)},
              "The states of the monitor; thick lines are transitions that the replayed scenarios took, thin ones "
              "those that the table allows.",
              "Thick: taken by the replayed scenarios. Thin: possible by the table.");
  std::map<std::pair<std::string, std::string>, std::uint64_t> records;
  if (coverage.is_null()) {
    out.notice("No campaign was played, so the coverage is unknown.", "open");
  } else {
    out.text(fmt::format(
        "{} {} replayed for this, the first of each campaign, and not the campaigns as a "
        "whole. They visited "
        "{} of {} states, took {} of {} transitions between them, and left a record in {} of {} cells of "
        "the table that "
        "do something.",
        count_text(report["campaign"]["replayed"]["scenarios"].get<std::uint64_t>(), "scenario"),
        by_count(report["campaign"]["replayed"]["scenarios"].get<std::uint64_t>(), "was", "were"),
        coverage["modes_visited"].dump(), coverage["modes"].dump(), coverage["moves"].size(),
        coverage["moves_possible"].dump(), coverage["cells_recorded"].dump(), coverage["cells_taken"].dump()));
    coverage_tables(coverage, out);
    for (const Json& cell : coverage["cells"])
      records[{cell["mode"], cell["event"]}] = cell["records"].get<std::uint64_t>();
  }
  std::vector<std::string> head = {"event (rank order)"};
  for (const Json& mode : machine["modes"]) head.push_back(mode["mode"]);
  ViewRows rows;
  for (const Json& event : machine["events_in_rank_order"]) {
    if (event == "none") continue;
    std::vector<ViewCell> row = {event.get<std::string>()};
    for (const Json& mode : machine["modes"]) {
      for (const Json& cell : machine["cells"]) {
        if (cell["mode"] != mode["mode"] || cell["event"] != event) continue;
        const std::string kind = cell["kind"];
        const std::uint64_t seen = records[{mode["mode"], event}];
        std::string text =
            kind == "taken" ? joined_list(cell["actions"]) + "; " + cell["target"].get<std::string>() : kind;
        if (text.rfind("-; ", 0) == 0) text = text.substr(3);
        row.emplace_back(seen > 0 ? text + " (" + std::to_string(seen) + ")" : text, seen > 0 ? "good" : "");
      }
    }
    rows.push_back(row);
  }
  out.table("The table", head, rows, "In brackets: records that the replayed scenarios left in the cell.");
  const Json& given = report["traceability"]["assurance_results"];
  if (!given["given"].get<bool>()) {
    out.notice("Proofs and model checking: results not given. Give " + given["how"].get<std::string>() + ".", "open");
    return out;
  }
  assurance_tables(given, out);
  return out;
}

}  // namespace render
}  // namespace PLUMB_ABI
}  // namespace plumb
