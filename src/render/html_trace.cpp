// Sections 6 to 8 of the verification page: traceability, identity and resources, change; and the page itself.
#include <fmt/format.h>

#include "html_view.hpp"
#include "plumb/io/json_fields.hpp"
#include "plumb/scenario/count_text.hpp"
#include "sign_off.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace render {
namespace {

std::string with_results(const Json& list) {
  std::string out;
  for (const Json& item : list) {
    out += (out.empty() ? "" : ", ") + item["name"].get<std::string>();
    if (item["result"].is_string()) out += " (" + item["result"].get<std::string>() + ")";
  }
  return out.empty() ? "-" : out;
}

void target_table(const Json& target, Section& out) {
  if (!target["given"].get<bool>())
    return out.notice(
        "Size, stack and instructions on the target: not given. Give " + target["how"].get<std::string>() + ".",
        "open");
  ViewRows rows;
  for (const Json& i : target["items"]) {
    const bool above = i["limit"].is_number() && i["value"].get<double>() > i["limit"].get<double>();
    rows.push_back({i["target"], i["name"], {i["value"], above ? "bad" : ""}, i["limit"], i["unit"]});
  }
  out.table("On the target", {"target", "figure", "value", "ceiling", "unit"}, rows,
            "Made by scripts/baremetal from " + target["commit"].get<std::string>() +
                ". Measured maxima are not worst-case times; instructions are not cycles.");
}

void analysis_table(const Json& analysis, Section& out) {
  if (!analysis["given"].get<bool>())
    return out.notice("Static analysis: not given. Give " + analysis["how"].get<std::string>() + ".", "open");
  ViewRows rows;
  for (const Json& row : analysis["by_check"]) rows.push_back({row["check"], row["count"]});
  if (rows.empty()) return out.text("Static analysis: clang-tidy printed no finding.");
  out.table("Findings of the static analysis", {"check", "findings"}, rows, "Each with its place in analysis.sarif.");
}

}  // namespace

Section trace_view(const Json& report) {
  const Json& t = report["traceability"];
  Section out("traceability", "6 Traceability", "From every requirement to its tests and proofs, and back.");
  if (!t["test_results"]["given"].get<bool>())
    out.notice("Results of the tests: not given. Give " + t["test_results"]["how"].get<std::string>() + ".", "open");
  std::vector<std::string> orphans;
  for (const Json& orphan : t["orphans"]) orphans.push_back(orphan);
  if (orphans.empty()) {
    out.text(
        "No orphans: every active requirement answers a hazard and has a test and a negative test, every hazard is "
        "answered, every test names a known requirement.");
  } else {
    out.list("Orphans", orphans);
  }
  ViewRows rows, texts;
  for (const Json& r : t["requirements"]) {
    const std::string result = r["result"];
    rows.push_back({r["id"],
                    r["title"],
                    {result, tone_of(result)},
                    joined_list(r["hazards"]),
                    joined_list(r["design"]),
                    shown(Json(r["tests"].size())),
                    shown(Json(r["negative_tests"].size())),
                    with_results(r["formal"])});
    texts.push_back({r["id"], r["statement"], joined_list(r["methods"]), with_results(r["tests"]),
                     with_results(r["negative_tests"])});
  }
  out.table("Requirements", {"id", "title", "result", "hazards", "design element", "tests", "negative", "formal items"},
            rows,
            "Design element: the sources that share their name with a test of the requirement. Traced: tests exist, "
            "their results were not given.");
  out.table("Requirements in full, with their tests by name",
            {"id", "statement", "methods", "verified by", "negative tests"}, texts, "", Fold::omitted);
  ViewRows hazards, tests;
  for (const Json& h : t["hazards"])
    hazards.push_back({h["id"], h["title"], h["statement"], joined_list(h["requirements"])});
  out.table("Back: hazards to requirements", {"id", "hazard", "what happens", "answered by"}, hazards);
  for (const Json& test : t["tests"]) {
    const std::string result = test["result"].is_string() ? test["result"].get<std::string>() : "not given";
    tests.push_back({test["name"], test["file"], joined_list(test["verifies"]), joined_list(test["negative"]), result});
  }
  out.table("Back: tests to requirements", {"test", "file", "verifies", "negative for", "result"}, tests, "",
            Fold::omitted);
  return out;
}

Section identity_view(const Json& report) {
  const Json& identity = report["identity"];
  const Json& build = identity["build"];
  Section out("identity", "7 Resources and identity", "Inputs, machine, and the command to repeat the run.");
  out.commands({identity["command"].get<std::string>()});
  ViewRows rows;
  for (const auto& [key, words] : {std::pair<const char*, const char*>{"version", "plumb"},
                                   {"commit", "commit"},
                                   {"compiler", "compiler"},
                                   {"flags", "flags"},
                                   {"build_type", "build"},
                                   {"target", "target"}})
    rows.push_back({words, build[key].get<std::string>()});
  rows.push_back({"seed", identity["seed"]});
  rows.push_back({"scenarios of each campaign", identity["scenarios"]});
  out.table("Identity", {"what", "is"}, rows);
  ViewRows inputs, libraries;
  for (const Json& i : identity["inputs"]) inputs.push_back({i["role"], i["name"], i["bytes"], i["sha256"]});
  out.table("Inputs", {"role", "file", "bytes", "SHA-256"}, inputs);
  for (const Json& l : build["libraries"]) libraries.push_back({l["name"], l["version"], l["licence"]});
  out.table("Libraries", {"library", "version", "licence"}, libraries, "", Fold::omitted);
  const Json& r = report["resources"];
  out.table("Resources", {"figure", "value"},
            {{"sensors", r["sensors"]},
             {"capacity of the tool", r["tool_capacity"]},
             {"monitor of the tool, bytes", r["tool_monitor_bytes"]}});
  out.text(
      "How long a step of the monitor took on the machine that made this report stands in the last line of the page "
      "and "
      "in `run` of report.json, because it differs from run to run.");
  target_table(r["target"], out);
  analysis_table(report["analysis"], out);
  return out;
}

Section change_view(const Json& report) {
  const Json& c = report["change"];
  Section out("change", "8 Change", "Against an earlier report.");
  if (!c["given"].get<bool>()) {
    out.notice("Not given: " + c["how"].get<std::string>() + ".", "open");
    return out;
  }
  out.text(fmt::format("Verdict before: {}; now: {}. {} {}.", shown(c["verdict_before"]), shown(c["verdict_now"]),
                       count_text(c["count"].get<std::uint64_t>(), "value"),
                       by_count(c["count"].get<std::uint64_t>(), "differs", "differ")));
  ViewRows rows;
  for (const Json& d : c["differences"]) rows.push_back({d["where"], d["before"], d["now"]});
  if (!rows.empty())
    out.table("What differs", {"where", "before", "now"}, rows,
              c["left_out"] == 0 ? "" : c["left_out"].dump() + " more are not listed.");
  return out;
}

namespace {

/// What the run cost, and how long a step of the monitor took while it did.
std::string run_words(const Json& run) {
  std::string out = fmt::format("Run {} on {}, {} s, threads: {}.", run.value("time", "-"), run.value("host", "-"),
                                shown(run.value("seconds", Json())), shown(run.value("threads", Json())));
  const Json step = run.value("monitor_step", Json());
  if (!step.is_object()) return out;
  const auto us = [&step](const char* key) { return shown(step[key], 1e-3); };
  return out + fmt::format(
                   " One step of the monitor took at most {} us in {} calls (median {} us, 99.9 % within {} us; {}; "
                   "{}): a measured maximum of this machine under this load, not a worst-case time.",
                   us("high_water_ns"), step["calls"].dump(), us("median_ns"), us("p999_ns"),
                   step["clock"].get<std::string>(), run.value("machine", "machine unknown"));
}

}  // namespace

std::string verification_html(const Json& report, const PagePictures& pictures) {
  const Json& build = report["identity"]["build"];
  return sections_html({"Verification of " + report["subject"]["name"].get<std::string>(),
                        fmt::format("{}, judged by plumb {} ({}). Every figure is in report.json beside this page.",
                                    count_text(report["subject"]["sensors"].get<std::uint64_t>(), "sensor"),
                                    build["version"].get<std::string>(), build["commit"].get<std::string>()),
                        "Accelerations in mg0 = 0.001 x 9.80665 m/s^2; angles in deg; intervals are 95 % "
                        "Clopper-Pearson (97.5 % bounds at 0 and at all), rounded outwards.",
                        run_words(report["run"])},
                       {verification_sign_off(report), verdict_view(report), array_view(report, pictures),
                        calibration_view(report, pictures), campaign_view(report, pictures), machine_view(report),
                        trace_view(report), identity_view(report), change_view(report)});
}

}  // namespace render
}  // namespace PLUMB_ABI
}  // namespace plumb
