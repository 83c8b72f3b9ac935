// The argument of a verification report in goal structuring notation: goals are boxes, strategies lean, evidence is
// round.
#include <fmt/format.h>

#include "markup.hpp"
#include "plumb/io/json_fields.hpp"
#include "plumb/report/verification_exports.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace report {
namespace {

constexpr double kWidth = 205.0, kHeight = 66.0, kStepX = 225.0;

/// Up to four lines of about so many letters; longer text ends in dots.
std::string lines_at(double x, double y, const std::string& text, std::size_t letters = 30) {
  std::vector<std::string> lines = {""};
  std::string word;
  for (const char c : text + " ") {
    if (c != ' ') {
      word += c;
      continue;
    }
    if (!lines.back().empty() && lines.back().size() + 1 + word.size() > letters) lines.emplace_back();
    lines.back() += (lines.back().empty() ? "" : " ") + word;
    word.clear();
  }
  if (lines.size() > 4) {
    lines.resize(4);
    lines.back() += " ...";
  }
  std::string out;
  double at = y - 7.5 * static_cast<double>(lines.size() - 1) + 4.0;
  for (const std::string& line : lines) {
    out += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"middle\">{}</text>\n", x, at, in_markup(line));
    at += 15.0;
  }
  return out;
}

const char* colour_of_result(const std::string& result) {
  if (result == "good") return "#2c8f57";
  return result == "bad" ? "#c53a3a" : "#b97a00";
}

std::string shape(const char* kind, double x, double y, const std::string& text, const std::string& result) {
  const std::string style = fmt::format("fill=\"none\" stroke=\"{}\" stroke-width=\"2.5\"", colour_of_result(result));
  const double l = x - 0.5 * kWidth, r = x + 0.5 * kWidth, t = y - 0.5 * kHeight, b = y + 0.5 * kHeight;
  std::string out;
  if (*kind == 'g')
    out =
        fmt::format("<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{}\" height=\"{}\" {}/>\n", l, t, kWidth, kHeight, style);
  if (*kind == 's')
    out = fmt::format("<path d=\"M{:.1f} {:.1f} H{:.1f} L{:.1f} {:.1f} H{:.1f} Z\" {}/>\n", l + 14.0, t, r, r - 14.0, b,
                      l, style);
  if (*kind == 'e')
    out = fmt::format("<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{}\" height=\"{}\" rx=\"33\" {}/>\n", l, t, kWidth,
                      kHeight, style);
  return out + lines_at(x, y, text, *kind == 'e' ? 27 : 30);
}

std::string arrow(double x1, double y1, double x2, double y2) {
  return fmt::format(
      "<line x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\" stroke=\"currentColor\" opacity=\"0.6\"/>\n", x1,
      y1, x2, y2);
}

struct Branch {
  std::string strategy, goal, evidence, result;
};

std::string tone(const std::string& result) { return result == "met" ? "good" : result == "not met" ? "bad" : "open"; }

/// The worst result of the criteria whose names are listed; "open" where none was judged.
std::string worst_of(const Json& criteria, std::initializer_list<const char*> names) {
  std::string out;
  for (const Json& c : criteria) {
    for (const char* name : names) {
      if (c["name"] != name) continue;
      const std::string is = tone(c["result"]);
      if (out.empty() || is == "bad" || (is == "open" && out == "good")) out = is;
    }
  }
  return out.empty() ? "open" : out;
}

}  // namespace

std::string argument_svg(const Json& report) {
  const Json& v = report["verdict"];
  const Json& c = v["criteria"];
  const Json& n = v["requirements"];
  const Json& faults = report["campaign"]["faults"];
  const bool played = faults.value("played", false);
  const bool proofs = report["traceability"]["assurance_results"]["given"];
  const std::string level = report["array"]["protection_level_deg"].is_number()
                                ? fmt::format("{:.3g} deg", report["array"]["protection_level_deg"].get<double>())
                                : "none";
  const int failed = n["failed"], verified = n["verified"], active = n["active"];
  std::string proven = proofs ? "good" : "open";
  for (const Json& item : report["traceability"]["assurance_results"].value("items", Json::array())) {
    if (item["result"] != "holds") proven = "bad";
  }
  const Branch branches[] = {
      {"by analysis of the geometry", "faults within the grade are isolated, errors bounded",
       fmt::format("section 2: strict grade {}, protection level {}",
                   report["array"]["figures_of_merit"]["strict_grade"].get<int>(), level),
       worst_of(c, {"Faulty sensors isolated for good", "Protection level against the alert limit",
                    "Least constant error that is detected in one block"})},
      {"by calibration", "what calibration leaves is known",
       "section 3: " + report["calibration"]["mode"].get<std::string>(), worst_of(c, {"Calibration accepted"})},
      {"by counting simulated faults", "no healthy sensor is excluded, nothing misleads",
       played ? fmt::format("section 4: {} scenarios, wrong exclusions {}, misleading {}",
                            faults["plan"]["scenarios"].get<std::uint64_t>(),
                            faults["rates"]["wrong_exclusion"]["count"].get<std::uint64_t>(),
                            faults["rates"]["misleading"]["count"].get<std::uint64_t>())
              : "section 4: not played",
       played ? worst_of(
                    c, {"Healthy sensors excluded", "Misleading output", "False alarms", "Replay by other code agrees"})
              : "open"},
      {"by proof and model checking", "the state machine keeps its properties",
       proofs ? "section 5: results given" : "section 5: results not given", proven},
      {"over the requirements", "every requirement answers a hazard and is tested",
       fmt::format("section 6: {} of {} verified, {} failed, {} orphans", verified, active, failed,
                   v["orphans"].size()),
       failed > 0 || !v["orphans"].empty() ? "bad"
       : verified == active                ? "good"
                                           : "open"}};
  const std::string verdict = v["verdict"];
  const double width = kStepX * 5.0 + 10.0, middle = 0.5 * width;
  std::string out = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {} 440\" font-family=\"sans-serif\" font-size=\"12.5\" "
      "fill=\"currentColor\">\n",
      width);
  out += shape("g", middle, 45.0, report["subject"]["name"].get<std::string>() + " is fit for purpose: " + verdict,
               verdict == "fit"    ? "good"
               : verdict == "open" ? "open"
                                   : "bad");
  double x = 0.5 * kStepX + 5.0;
  for (const Branch& b : branches) {
    out += arrow(middle, 78.0, x, 137.0) + shape("s", x, 170.0, b.strategy, b.result);
    out += arrow(x, 203.0, x, 247.0) + shape("g", x, 280.0, b.goal, b.result);
    out += arrow(x, 313.0, x, 357.0) + shape("e", x, 390.0, b.evidence, b.result);
    x += kStepX;
  }
  return out + "</svg>\n";
}

}  // namespace report
}  // namespace PLUMB_ABI
}  // namespace plumb
