#include "sign_off.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <optional>
#include <string_view>

#include "plumb/core/units.hpp"
#include "plumb/io/json_fields.hpp"
#include "plumb/render/figures.hpp"
#include "plumb/render/verdict_section.hpp"
#include "plumb/scenario/count_text.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace render {
namespace {

/// Numbers of the stations of one colour: "3, 6 to 9".
std::string stations_of(const Json& stations, const char* colour) {
  std::string out;
  std::uint64_t first = 0, last = 0;
  const auto close = [&] {
    if (first == 0) return;
    out += (out.empty() ? "" : ", ") + std::to_string(first);
    if (last > first) out += (last > first + 1 ? " to " : ", ") + std::to_string(last);
  };
  for (const Json& s : stations) {
    if (s["colour"] != colour) continue;
    const auto number = s["number"].get<std::uint64_t>();
    if (first == 0 || number != last + 1) {
      close();
      first = number;
    }
    last = number;
  }
  close();
  return out;
}

ViewFigure stations_answer(const Json& report) {
  const Json& a = report["answer"];
  const std::size_t all = report["stations"].size();
  const std::string red = stations_of(report["stations"], "red"), orange = stations_of(report["stations"], "orange");
  std::string label = "green: use them";
  if (!orange.empty()) label += "; for orientation only: " + orange;
  if (!red.empty()) label += "; do not use: " + red;
  const bool good = all > 0 && a["green"] == all;
  return {"Which stations?", fmt::format("{} of {}", a["green"].dump(), all), label,
          good ? "good" : (a["green"] == 0 || !red.empty() ? "bad" : "open")};
}

ViewFigure sensors_answer(const Json& report) {
  const Json& a = report["answer"];
  const std::size_t all = report["extremes"]["sensors"].size();
  std::string label = "in service at the end";
  for (const auto& [key, words] : {std::pair<const char*, const char*>{"excluded", "excluded"},
                                   {"provisionally_excluded", "provisionally excluded"},
                                   {"absent", "absent"}}) {
    if (!a[key].empty()) label += std::string("; ") + words + ": " + joined_list(a[key]);
  }
  const std::size_t left = a["in_service"].size();
  return {"Which sensors?", fmt::format("{} of {}", left, all), label,
          left == all ? "good" : (left < 3 ? "bad" : "open")};
}

ViewFigure bound_answer(const Json& report) {
  const char* const question = "How far off can it be?";
  if (report["stations"].empty()) return {question, "unknown", "there is no station", "bad"};
  const Json& last = report["stations"].back();
  const Json& bound = last["protection_level_housing_deg"];
  if (!bound.is_number()) return {question, "unbounded", "nothing bounds the direction of the last station", "open"};
  return {question, shown(bound) + " deg",
          "bound on the direction in the housing at the last station, under any single undetected fault",
          last["alert"].get<bool>() ? "open" : "good"};
}

ViewFigure length_answer(const Json& report) {
  const char* const question = "Is |G| right?";
  if (report["stations"].empty()) return {question, "unknown", "there is no station", "bad"};
  const Json& last = report["stations"].back();
  const Json &off = last["off_mps2"], &limit = last["length_limit_mps2"];
  if (!off.is_number() || !limit.is_number()) return {question, "unknown", "it has no length", "bad"};
  const double size = std::fabs(off.get<double>()), most = limit.get<double>();
  return {question, shown(std::round(1e3 * kMg0 * off.get<double>()) * 1e-3) + " mg0",
          fmt::format("off its reference at the last station; the limit is {} mg0", shown(limit, kMg0)),
          size <= most ? "good" : (size <= 2.0 * most ? "open" : "bad")};
}

ViewFigure distrust_answer(const Json& report) {
  std::string out;
  const auto add = [&out](const std::string& what) { out += (out.empty() ? "" : "; ") + what; };
  const std::string red = stations_of(report["stations"], "red"), orange = stations_of(report["stations"], "orange");
  if (!red.empty()) add("red stations for anything: " + red);
  if (!orange.empty()) add("orange stations for more than orientation: " + orange);
  if (!report["answer"]["excluded"].empty()) add("the readings of " + joined_list(report["answer"]["excluded"]));
  if (!report["answer"]["open_items"].empty())
    add("inclination and toolface as a whole: no known attitude confirms the wiring");
  add("a common turn of all axes in the housing, beyond what the alignment allows for");
  add("several sensors that all show the same wrong gravity");
  return {"What not to trust?", "Do not trust", out, "open"};
}

ViewFigure use_answer(const Json& report) {
  const std::string use = report["answer"]["usable_for_survey"];
  return {"Usable for survey?", use, "the tool as it is at the end of the run",
          use == "yes" ? "good" : (use == "no" ? "bad" : "open")};
}

/// Date and serial number as somebody gave them to plumb calibrate.
void add_calibration(const Json& calibration, ViewRows& out) {
  const auto of = [&calibration](const char* key) {
    return calibration.is_object() && calibration.contains(key) && calibration[key].is_string()
               ? told(calibration[key])
               : std::string("unknown");
  };
  out.push_back({"serial number", of("serial")});
  out.push_back({"calibration date", of("date")});
}

std::string build_words(const Json& build) {
  return fmt::format("{}, commit {}", build["version"].get<std::string>(), build["commit"].get<std::string>());
}

/// Which criterion colours which answer of a verification; a question without one has no verdict of its own.
struct Coloured {
  std::string_view question;
  verification::CriterionId criterion;
};
constexpr std::array<Coloured, 4> kColoured = {{{"How many faults?", verification::CriterionId::faults_isolated},
                                                {"How large?", verification::CriterionId::detectable_fault},
                                                {"Protection level?", verification::CriterionId::protection_level},
                                                {"How sure?", verification::CriterionId::wrong_exclusion}}};

std::string tone_of_answer(const std::string& question, const std::vector<verification::Criterion>& criteria) {
  if (question == "What not to trust?") return "open";
  for (const Coloured& row : kColoured) {
    if (question != row.question) continue;
    for (const verification::Criterion& c : criteria) {
      if (c.id == row.criterion) return tone_of(to_string(c.result));
    }
  }
  return "";
}

}  // namespace

std::string told(const Json& text) {
  return text.is_string() && !text.get<std::string>().empty() ? text.get<std::string>() : "unknown";
}

std::string hash_of(const Json& input) {
  return input.contains("sha256") ? "sha256 " + input["sha256"].get<std::string>()
                                  : "fnv1a " + input["fnv1a"].get<std::string>();
}

void add_inputs(const Json& inputs, ViewRows& out) {
  for (const Json& input : inputs)
    out.push_back({input["role"].get<std::string>(), input["name"].get<std::string>() + ", " + hash_of(input)});
}

Section sign_off_view(const SignOff& content) {
  Section out("signoff", "Sign-off", "The verdict, what it rests on, and who stands for it. Evidence follows.");
  out.notice(content.verdict, content.tone);
  out.figures(content.answers);
  out.table("", {"identity", ""}, content.identity);
  out.stamp(content.run);
  out.signature({"Issued by (name, role)", "Date", "Signature"});
  out.signature({"Approved by (name, role)", "Date", "Signature"});
  return out;
}

Section health_sign_off(const Json& report) {
  const Json &id = report["identity"], &calibration = report["basis"]["calibration"];
  ViewRows rows = {{"tool", id["name"]}};
  add_calibration(calibration, rows);
  add_inputs(id["inputs"], rows);
  rows.push_back({"judged by plumb", build_words(id["build"])});
  const ViewFigure use = use_answer(report);
  return sign_off_view(
      {report["answer"]["sentence"],
       use.tone,
       {use, stations_answer(report), sensors_answer(report), bound_answer(report), length_answer(report),
        distrust_answer(report)},
       rows,
       fmt::format("Run {} on {}.", report["run"].value("time", "-"), report["run"].value("host", "-"))});
}

Section verification_sign_off(const Json& report) {
  const Json &v = report["verdict"], &id = report["identity"], &c = report["calibration"];
  const std::vector<verification::Criterion> criteria = criteria_of(report);
  std::vector<ViewFigure> answers;
  for (const Json& a : v["answers"])
    answers.push_back({a["question"], a["value"], a["label"], tone_of_answer(a["question"], criteria)});
  ViewRows rows = {{"tool", report["subject"]["name"]}};
  add_calibration(c.value("file", Json()), rows);
  add_inputs(id["inputs"], rows);
  rows.push_back({"judged by plumb", build_words(id["build"])});
  return sign_off_view(
      {v["sentence"], tone_of(v["verdict"]), answers, rows,
       fmt::format("Run {} on {}.", report["run"].value("time", "-"), report["run"].value("host", "-"))});
}

}  // namespace render
}  // namespace PLUMB_ABI
}  // namespace plumb
