// The argument of a verification report in goal structuring notation: goals are boxes, strategies lean, evidence is
// round.
#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "markup.hpp"
#include "plumb/io/json_fields.hpp"
#include "plumb/render/verdict_section.hpp"
#include "plumb/render/verification_exports.hpp"
#include "plumb/scenario/count_text.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace render {
namespace {

constexpr double kHeight = 66.0, kStepX = 225.0, kPhoneStepY = 180.0;

/// Of a shape, and what fits into a line of it.
struct Width {
  double px;
  std::size_t letters;
};
constexpr Width kDesk{205.0, 30}, kPhone{178.0, 26};

/// Up to four lines of about so many letters; longer text ends in dots.
std::string lines_at(double x, double y, const std::string& text, std::size_t letters) {
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

const char* colour_of_result(verification::Result result) {
  switch (result) {
    case verification::Result::met: return "#2c8f57";
    case verification::Result::open: return "#b97a00";
    case verification::Result::not_met: return "#c53a3a";
  }
  return "?";
}

std::string shape(const char* kind, double x, double y, const std::string& text, verification::Result result,
                  const Width& width) {
  const std::string style = fmt::format("fill=\"none\" stroke=\"{}\" stroke-width=\"2.5\"", colour_of_result(result));
  const double l = x - 0.5 * width.px, r = x + 0.5 * width.px, t = y - 0.5 * kHeight, b = y + 0.5 * kHeight;
  std::string out;
  if (*kind == 'g')
    out = fmt::format("<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{}\" height=\"{}\" {}/>\n", l, t, width.px, kHeight,
                      style);
  if (*kind == 's')
    out = fmt::format("<path d=\"M{:.1f} {:.1f} H{:.1f} L{:.1f} {:.1f} H{:.1f} Z\" {}/>\n", l + 14.0, t, r, r - 14.0, b,
                      l, style);
  if (*kind == 'e')
    out = fmt::format("<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{}\" height=\"{}\" rx=\"33\" {}/>\n", l, t, width.px,
                      kHeight, style);
  return out + lines_at(x, y, text, width.letters - (*kind == 'e' ? 3 : 0));
}

std::string arrow(double x1, double y1, double x2, double y2) {
  return fmt::format(
      "<line x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\" stroke=\"currentColor\" opacity=\"0.6\"/>\n", x1,
      y1, x2, y2);
}

using verification::Result;
using verification::Strategy;

struct Branch {
  const char *how, *goal;
  std::string evidence;
};

std::string geometry_words(const Json& array) {
  const Json& level = array["detection_sizes"]["as_stated"]["protection_level_at_rest_deg"];
  return fmt::format("section 2: confirmed grade {}, protection level {}",
                     array["figures_of_merit"]["confirmed_grade"].get<int>(),
                     level.is_number() ? fmt::format("{:.3g} deg", level.get<double>()) : "none");
}

std::string campaign_words(const Json& faults) {
  if (!faults.value("played", false)) return "section 4: not played";
  return fmt::format("section 4: {}, wrong exclusions {}, misleading {}",
                     count_text(faults["plan"]["scenarios"].get<std::uint64_t>(), "scenario"),
                     faults["rates"]["wrong_exclusion"]["count"].get<std::uint64_t>(),
                     faults["rates"]["misleading"]["count"].get<std::uint64_t>());
}

std::string given(const Json& part) { return part["given"].get<bool>() ? "given" : "not given"; }

std::string requirements_words(const Json& verdict) {
  const Json& n = verdict["requirements"];
  return fmt::format("section 6: {} of {} verified, {} failed, {} orphans", n["verified"].get<int>(),
                     n["active"].get<int>(), n["failed"].get<int>(), verdict["orphans"].size());
}

Branch branch_of(Strategy strategy, const Json& report) {
  switch (strategy) {
    case Strategy::geometry:
      return {"by analysis of the geometry", "faults within the grade are isolated, errors bounded",
              geometry_words(report["array"])};
    case Strategy::calibration:
      return {"by calibration", "what calibration leaves is known",
              "section 3: " + report["calibration"]["mode"].get<std::string>()};
    case Strategy::campaign:
      return {"by counting simulated faults", "no healthy sensor is excluded, nothing misleads",
              campaign_words(report["campaign"]["faults"])};
    case Strategy::proof:
      return {"by proof and model checking", "the state machine keeps its properties",
              "section 5: results " + given(report["traceability"]["assurance_results"])};
    case Strategy::requirements:
      return {"over the requirements", "every requirement answers a hazard and is tested",
              requirements_words(report["verdict"])};
    case Strategy::build:
      return {
          "by examination of the build", "the code has no findings and fits its target",
          "section 7: analysis " + given(report["analysis"]) + ", resources " + given(report["resources"]["target"])};
  }
  return {"?", "?", "?"};
}

/// Those of which something was judged: the build is examined elsewhere, and given or not.
std::vector<Strategy> judged_strategies(const std::vector<verification::Criterion>& criteria) {
  std::vector<Strategy> out;
  for (int k = 0; k < verification::kStrategies; ++k) {
    const auto strategy = static_cast<Strategy>(k);
    if (std::any_of(criteria.begin(), criteria.end(), [strategy](const verification::Criterion& c) {
          return verification::entry_of(c.id).strategy == strategy;
        }))
      out.push_back(strategy);
  }
  return out;
}

/// One branch beside the other, each downwards.
std::string branch_on_desk(const Branch& branch, Result result, std::size_t k, std::size_t of) {
  const double middle = 0.5 * (kStepX * static_cast<double>(of) + 10.0);
  const double x = kStepX * (static_cast<double>(k) + 0.5) + 5.0;
  return arrow(middle, 78.0, x, 137.0) + shape("s", x, 170.0, branch.how, result, kDesk) + arrow(x, 203.0, x, 247.0) +
         shape("g", x, 280.0, branch.goal, result, kDesk) + arrow(x, 313.0, x, 357.0) +
         shape("e", x, 390.0, branch.evidence, result, kDesk);
}

/// One branch below the other, off a line at the left: how, the goal beside it, the evidence below that.
std::string branch_on_phone(const Branch& branch, Result result, std::size_t k) {
  const double y = 140.0 + kPhoneStepY * static_cast<double>(k), how = 105.0, goal = 305.0;
  return arrow(6.0, y, how - 0.5 * kPhone.px + 7.0, y) + shape("s", how, y, branch.how, result, kPhone) +
         arrow(how + 0.5 * kPhone.px - 7.0, y, goal - 0.5 * kPhone.px, y) +
         shape("g", goal, y, branch.goal, result, kPhone) + arrow(goal, y + 33.0, goal, y + 47.0) +
         shape("e", goal, y + 80.0, branch.evidence, result, kPhone);
}

}  // namespace

std::string argument_svg(const Json& report, bool narrow) {
  const std::string verdict = report["verdict"]["verdict"];
  const std::vector<verification::Criterion> criteria = criteria_of(report);
  const std::vector<Strategy> strategies = judged_strategies(criteria);
  const auto count = static_cast<double>(strategies.size());
  const double width = narrow ? 400.0 : kStepX * count + 10.0, height = narrow ? 90.0 + kPhoneStepY * count : 440.0;
  std::string out = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {} {}\" font-family=\"sans-serif\" font-size=\"12.5\" "
      "fill=\"currentColor\">\n",
      width, height);
  out += shape("g", narrow ? 105.0 : 0.5 * width, 45.0,
               report["subject"]["name"].get<std::string>() + " is fit for purpose: " + verdict,
               verdict == "fit"       ? Result::met
               : verdict == "not fit" ? Result::not_met
                                      : Result::open,
               narrow ? kPhone : kDesk);
  if (narrow) out += arrow(16.0, 45.0, 6.0, 45.0) + arrow(6.0, 45.0, 6.0, 140.0 + kPhoneStepY * (count - 1.0));
  for (std::size_t k = 0; k < strategies.size(); ++k) {
    const Branch branch = branch_of(strategies[k], report);
    const Result result = verification::result_of(strategies[k], criteria);
    out += narrow ? branch_on_phone(branch, result, k) : branch_on_desk(branch, result, k, strategies.size());
  }
  return out + "</svg>\n";
}

}  // namespace render
}  // namespace PLUMB_ABI
}  // namespace plumb
