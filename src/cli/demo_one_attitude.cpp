#include "demo_one_attitude.hpp"

#include <fmt/format.h>

#include "demo_picture.hpp"
#include "plumb/io/json_fields.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace cli {
namespace {

using study::Answer;
using study::AnswerCount;
using study::FaultGroup;
using study::RandomLaw;
using study::RuleRecord;

struct Look {
  const char* words;
  const char* colour;
};
/// In the order of `Answer`.
constexpr Look kLook[] = {
    {"right", "#2c8f57"},
    {"alarm, no sensor isolated", "#2f78b7"},
    {"no alarm, fault below 0.05 g0", "#9a9a9a"},
    {"no alarm, fault of 0.05 g0 or more", "#c98a00"},
    {"healthy sensor isolated", "#c53a3a"},
    {"one of two isolated, the other used", "#8f55c4"},
};
static_assert(sizeof(kLook) / sizeof(kLook[0]) == study::kAnswers, "a look for every answer");

/// One bar of the picture and row of the table.
struct Line {
  std::string what;
  const char* rule;
  AnswerCount count;
};

using Studies = std::vector<study::OneAttitudeStudy>;

std::vector<Line> lines_of(const Studies& studies) {
  std::vector<Line> out;
  for (const study::OneAttitudeStudy& s : studies) {
    for (int g = 0; g < study::kFaultGroups; ++g) {
      const auto group = static_cast<FaultGroup>(g);
      const bool random = group == FaultGroup::one_random || group == FaultGroup::two_random;
      if (s.law == RandomLaw::anew && !random) continue;  // not run
      std::string what = study::to_string(group);
      if (random) what += s.law == RandomLaw::held ? ", held" : ", anew each sample";
      out.push_back({what, "paper", s.paper.group[static_cast<std::size_t>(g)]});
      out.push_back({what, "plumb", s.own.group[static_cast<std::size_t>(g)]});
    }
  }
  return out;
}

std::string csv_of(const std::vector<Line>& lines) {
  std::string out = "faults,rule,trials,right,alarm_only,silent_small,silent_large,names_healthy,keeps_faulty\n";
  for (const Line& line : lines) {
    std::vector<std::string> cells = {"\"" + line.what + "\"", line.rule, std::to_string(line.count.trials())};
    for (const std::uint64_t n : line.count.of) cells.push_back(std::to_string(n));
    out += csv_line(cells);
  }
  return out;
}

/// Stacked bars, those of the two rules close together; the shares as numbers where there is room. On a phone what
/// fails stands above its two bars, else beside them.
std::string script_of(const std::vector<Line>& lines, bool narrow) {
  const double pitch = narrow ? 1.95 : 1.45, least_share = narrow ? 12.0 : 4.5;
  std::string out = plot_head("one_attitude", 1000, {640, 900}, narrow);
  out += fmt::format(
      "set lmargin at screen {1}\n"
      "set rmargin at screen 0.97\n"
      "set tmargin at screen 0.99\n"
      "set bmargin at screen 0.25\n"
      "set xrange [0:100]\n"
      "set yrange [{0}:{2}]\n"
      "unset ytics\n"
      "set xtics nomirror\n"
      "set border 1\n"
      "set xlabel 'share of the blocks, %' offset 0,0.4\n"
      "set key at screen 0.5, screen 0.01 center bottom vertical maxrows {3} Left reverse samplen 1.2\n",
      -pitch * static_cast<double>(lines.size()) / 2.0 + (narrow ? 0.7 : -0.1), narrow ? 0.25 : 0.385,
      narrow ? 0.8 : 0.35, narrow ? 6 : 3);
  for (std::size_t k = 0; k < lines.size(); ++k) {
    const Line& line = lines[k];
    const double top = -pitch * static_cast<double>(k / 2) - (k % 2 == 0 ? 0.0 : 0.58);
    const double bottom = top - 0.5;
    if (k % 2 == 0) {
      out += narrow ? fmt::format("set label '{}' at screen 0.02, first {:.3f} left\n", line.what, top + 0.35)
                    : fmt::format("set label '{}' at screen 0.32, first {:.3f} right\n", line.what, top - 0.54);
    }
    out += fmt::format("set label '{}' at graph 0, first {:.3f} right offset -0.6,0\n", line.rule, top - 0.25);
    double left = 0.0;
    for (std::size_t a = 0; a < line.count.of.size(); ++a) {
      const double share = 100.0 * line.count.share(static_cast<Answer>(a)).share();
      if (share <= 0.0) continue;
      out += fmt::format("set object rect from {:.4f},{:.3f} to {:.4f},{:.3f} fc rgb '{}' fs solid noborder\n", left,
                         bottom, left + share, top, kLook[a].colour);
      if (share >= least_share) {
        out += fmt::format("set label '{:.1f}' at {:.4f},{:.3f} center front tc rgb 'white'\n", share,
                           left + 0.5 * share, top - 0.25);
      }
      left += share;
    }
  }
  out += "plot ";
  for (std::size_t a = 0; a < study::kAnswers; ++a)
    out += fmt::format("{}NaN with lines lw 9 lc rgb '{}' title '{}'", a == 0 ? "" : ", ", kLook[a].colour,
                       kLook[a].words);
  return out + "\n";
}

std::string interval(const study::Proportion& p) {
  return fmt::format("{} of {}, {} % ({} to {})", p.count, p.trials, study::rounded_share(p, 3, 100.0),
                     study::rounded_down(100.0 * p.low, 3, 100.0), study::rounded_up(100.0 * p.high, 3, 100.0));
}

render::Table table_of(const std::vector<Line>& lines) {
  render::Table out;
  out.title = "Results of the two rules at one attitude";
  out.head = {"faults", "rule"};
  for (const Look& look : kLook) out.head.push_back(look.words);
  out.head.push_back("errors, with 95 % interval");
  for (const Line& line : lines) {
    std::vector<std::string> row = {line.what, line.rule};
    for (const std::uint64_t n : line.count.of) row.push_back(std::to_string(n));
    row.push_back(interval(study::proportion(line.count.errors(), line.count.trials())));
    out.rows.push_back(std::move(row));
  }
  out.note =
      "Errors: no alarm although a reading is wrong by 0.05 g0 or more, a healthy sensor isolated, or one of two "
      "faulty sensors declared correct. With two faulty sensors an alarm without isolation is the right result. "
      "Intervals: Clopper-Pearson, as if all blocks were independent; experiments share their attitudes.";
  return out;
}

double right_share(const RuleRecord& record) {
  const AnswerCount& fixed = record.group[static_cast<std::size_t>(FaultGroup::one_fixed)];
  const AnswerCount& random = record.group[static_cast<std::size_t>(FaultGroup::one_random)];
  return 100.0 * static_cast<double>(fixed[Answer::right] + random[Answer::right]) /
         static_cast<double>(fixed.trials() + random.trials());
}

std::string unnoticed(const RuleRecord& own) {
  const std::uint64_t count = own.faulty()[Answer::silent_small] + own.faulty()[Answer::silent_large];
  if (count == 0) return "It detected every fault.";
  return fmt::format(
      "In {} of these blocks it detected no fault: the stuck value was within {:.2f} mg0 of the right reading, which "
      "turned the vector by at most {:.3f} deg.",
      count, 1e3 * g0_from_mps2(own.largest_silent_mps2), deg_from_rad(own.largest_silent_tilt_rad));
}

std::vector<std::string> text_of(const study::OneAttitudeStudy& held, const study::OneAttitudeStudy& anew) {
  const AnswerCount paper = held.paper.faulty();
  const AnswerCount own = held.own.faulty();
  const AnswerCount paper_anew = anew.paper.group[static_cast<std::size_t>(FaultGroup::one_random)];
  const auto attitudes = static_cast<std::uint64_t>(held.attitudes);
  return {
      fmt::format(
          "Table 2 pools many attitudes. A tool at rest has one, and there a fault may turn the vector without "
          "changing its length, or leave two triples consistent. The same 23 experiments at each of {} single "
          "attitudes, one block of {} samples each: the paper's rule errs in {} of the blocks with a fault. At {} of "
          "the attitudes it errs for at least one sensor at 0, −3 or +3 V. The direction without an alarm was wrong "
          "by up to {:.0f} deg.",
          held.attitudes, study::kBlock, interval(study::proportion(paper.errors(), paper.trials())),
          interval(study::proportion(held.paper.attitudes_in_error, attitudes)),
          deg_from_rad(held.paper.largest_silent_tilt_rad)),
      fmt::format(
          "plumb's monitor, validated before with healthy sensors, errs in {} on the same samples. The price: at one "
          "attitude it isolates no sensor; it marks the output as unconfirmed and asks for another attitude. The "
          "paper's rule isolates the right sensor in {:.0f} % of the blocks with one faulty sensor. {}",
          interval(study::proportion(own.errors(), own.trials())), right_share(held.paper), unnoticed(held.own)),
      fmt::format(
          "A random voltage has two readings: one level for the whole time at rest (held), or a new level at each "
          "sample (anew). With new levels a block holds many faults, and the paper's rule errs in {} with one such "
          "sensor.",
          interval(study::proportion(paper_anew.errors(), paper_anew.trials())))};
}

nlohmann::ordered_json facts_of(const Studies& studies) {
  nlohmann::ordered_json out;
  for (const study::OneAttitudeStudy& s : studies) {
    const auto rule = [&](const RuleRecord& record) {
      nlohmann::ordered_json one;
      for (int g = 0; g < study::kFaultGroups; ++g) {
        const AnswerCount& count = record.group[static_cast<std::size_t>(g)];
        if (count.trials() == 0) continue;
        one["groups"].push_back(io::object({{"faults", study::to_string(static_cast<FaultGroup>(g))},
                                            {"trials", count.trials()},
                                            {"right", count[Answer::right]},
                                            {"alarm_only", count[Answer::alarm_only]},
                                            {"silent_small", count[Answer::silent_small]},
                                            {"silent_large", count[Answer::silent_large]},
                                            {"names_healthy", count[Answer::names_healthy]},
                                            {"keeps_faulty", count[Answer::keeps_faulty]}}));
      }
      const study::Proportion errors = study::proportion(record.faulty().errors(), record.faulty().trials());
      one["errors"] = {{"count", errors.count},
                       {"trials", errors.trials},
                       {"low_95", std::stod(fmt::format("{:.5f}", errors.low))},
                       {"high_95", std::stod(fmt::format("{:.5f}", errors.high))}};
      if (s.law == RandomLaw::held) one["attitudes_in_error"] = record.attitudes_in_error;
      one["largest_silent_mg0"] = std::stod(fmt::format("{:.3f}", 1e3 * g0_from_mps2(record.largest_silent_mps2)));
      one["largest_silent_tilt_deg"] = std::stod(fmt::format("{:.4f}", deg_from_rad(record.largest_silent_tilt_rad)));
      return one;
    };
    out.push_back(io::object({{"random_level", s.law == RandomLaw::held ? "held" : "anew"},
                              {"attitudes", s.attitudes},
                              {"paper", rule(s.paper)},
                              {"plumb", rule(s.own)}}));
  }
  return out;
}

}  // namespace

io::FileExpected<void> add_one_attitude(const DemoContext& context, const study::Fits& fits, DemoSection& section) {
  Studies studies;
  for (const RandomLaw law : {RandomLaw::held, RandomLaw::anew}) {
    auto study = study::one_attitude_study(fits, context.tool, context.seed, law);
    if (!study) return study_failed(study.error());
    studies.push_back(*std::move(study));
  }
  const std::vector<Line> lines = lines_of(studies);
  const io::FileExpected<void> written = write_into(context.out, "one_attitude.csv", csv_of(lines));
  if (!written) return written;
  io::FileExpected<render::Picture> picture = draw(
      context.out, "one_attitude", [&lines](bool narrow) { return script_of(lines, narrow); },
      "The same experiments at one attitude",
      fmt::format("Blocks at {} attitudes. Green and blue are correct results; amber, red and violet are errors.",
                  studies.front().attitudes));
  if (!picture) return tl::unexpected<io::FileError>(picture.error());
  render::Chapter& chapter = section.chapter;
  for (std::string& line : text_of(studies.front(), studies.back())) chapter.text.push_back(std::move(line));
  chapter.pictures.push_back(*std::move(picture));
  chapter.tables.push_back(table_of(lines));
  chapter.files.push_back({"one_attitude.csv", "counts at one attitude"});
  link_drawn(chapter, "one_attitude", "the picture of them");
  section.facts["one_attitude"] = facts_of(studies);
  const AnswerCount paper = studies.front().paper.faulty();
  const AnswerCount own = studies.front().own.faulty();
  section.console += fmt::format(
      "  with one attitude ({} of them), blocks with a fault: the paper's rule errs in {}\n"
      "  {:>47} plumb errs in {}, isolates no sensor, undetected {} (at most {:.2f} mg0)\n",
      studies.front().attitudes, interval(study::proportion(paper.errors(), paper.trials())), "",
      interval(study::proportion(own.errors(), own.trials())), own[Answer::silent_small] + own[Answer::silent_large],
      1e3 * g0_from_mps2(studies.front().own.largest_silent_mps2));
  return {};
}

}  // namespace cli
}  // namespace PLUMB_ABI
}  // namespace plumb
