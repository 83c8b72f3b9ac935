// Section 4 of the demo: Table 2 of the paper, and what becomes of it at one attitude.
#include <fmt/format.h>

#include <algorithm>

#include "demo_one_attitude.hpp"
#include "demo_picture.hpp"
#include "demo_section.hpp"
#include "plumb/io/json_fields.hpp"
#include "plumb/scenario/count_text.hpp"
#include "plumb/study/table2_study.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace cli {
namespace {

using study::kTable2;
using study::Table2Result;
using study::Table2Row;
using study::Table2Study;

constexpr int kOtherTools = 20;
constexpr const char* kTripleNames[] = {"1-2-3", "1-2-4", "1-3-4", "2-3-4"};

std::string sensors(SensorSet set, const char* none) { return set.empty() ? none : study::name_of(set); }

std::string mae(double measured_g, double printed_g) {
  return printed_g < 0.01 ? fmt::format("{:.6f} / {:.6f}", measured_g, printed_g)
                          : fmt::format("{:.4f} / {:.4f}", measured_g, printed_g);
}

/// What plumb's monitor made of the same samples.
std::string own_words(const Table2Result& r) {
  if (r.named_after > 0)
    return fmt::format("{} excluded after {}", sensors(r.excluded, "-"), count_text(r.named_after, "attitude"));
  return to_string(r.state);
}

render::Table table_of(const Table2Study& study) {
  render::Table out;
  out.title = "Table 2: mean absolute errors, measured / printed, g0";
  out.head = {"no.", "faulty", "voltage", "all four"};
  for (const char* name : kTripleNames) out.head.emplace_back(name);
  out.head.insert(out.head.end(), {"detected", "isolated", "verdict as printed", "plumb, same samples"});
  for (std::size_t e = 0; e < kTable2.size(); ++e) {
    const Table2Row& printed = kTable2[e];
    const Table2Result& r = study.result[e];
    std::vector<std::string> row = {std::to_string(printed.number), sensors(printed.faulty, "-"),
                                    study::to_string(printed.level),
                                    mae(g0_from_mps2(r.finding.mae_all_mps2), printed.mae_all_g)};
    for (std::size_t k = 0; k < 4; ++k)
      row.push_back(mae(g0_from_mps2(r.finding.mae_triple_mps2[k]), printed.mae_triple_g[k]));
    row.insert(row.end(), {r.finding.detected ? "yes" : "no", sensors(r.finding.isolated, "-"),
                           r.same_verdict ? "✓" : "✗", own_words(r)});
    out.rows.push_back(std::move(row));
  }
  out.note =
      "The paper's rule: a fault is detected where the error of all four reaches 0.05 g0; the sensors of the triples "
      "that stay below it are correct. Printed figures: Seyed Moosavi et al., Sensors 2018, Table 2, CC BY 4.0. The "
      "paper does not print its attitudes, so that the sizes of the errors differ; the verdicts do not depend on "
      "them. Random: one level per attitude.";
  return out;
}

std::string csv_of(const Table2Study& study) {
  std::string out = "number,faulty,voltage,set,measured_g0,printed_g0,detected,isolated,same_verdict,plumb\n";
  for (std::size_t e = 0; e < kTable2.size(); ++e) {
    const Table2Row& printed = kTable2[e];
    const Table2Result& r = study.result[e];
    const auto line = [&](const char* set, double measured_mps2, double printed_g) {
      out += csv_line({std::to_string(printed.number), sensors(printed.faulty, ""), study::to_string(printed.level),
                       set, fmt::format("{:.7f}", g0_from_mps2(measured_mps2)), fmt::format("{:.6g}", printed_g),
                       r.finding.detected ? "yes" : "no", sensors(r.finding.isolated, ""),
                       r.same_verdict ? "yes" : "no", own_words(r)});
    };
    line("1-2-3-4", r.finding.mae_all_mps2, printed.mae_all_g);
    for (std::size_t k = 0; k < 4; ++k) line(kTripleNames[k], r.finding.mae_triple_mps2[k], printed.mae_triple_g[k]);
  }
  return out;
}

std::string script_of(bool narrow) {
  return plot_head("table2", 760, {560, 420}, narrow) + fmt::format("set lmargin at screen {}\n", narrow ? 0.2 : 0.13) +
         "set rmargin at screen 0.96\n"
         "set tmargin at screen 0.96\n"
         "set logscale xy\n"
         "set xrange [1e-4:2]\n"
         "set yrange [1e-4:2]\n"
         "set format '10^{%T}'\n"
         "set xlabel 'printed, g0' offset 0,0.3\n"
         "set ylabel 'measured, g0' offset 0.5\n"
         "set arrow from 0.05,1e-4 to 0.05,2 nohead lw 1.2 dt 2 lc rgb '#c53a3a'\n"
         "set arrow from 1e-4,0.05 to 2,0.05 nohead lw 1.2 dt 2 lc rgb '#c53a3a'\n"
         "set label 'limit 0.05 g0' at 1.3e-4,0.065 left tc rgb '#c53a3a'\n"
         "set label 'both: healthy' at 1.2e-3,0.011 center tc rgb '#8a8a8a'\n"
         "set label 'both: faulty' at 0.35,0.068 center tc rgb '#8a8a8a'\n"
         "set key top left at graph 0.03, graph 0.95 Left reverse samplen 0.6\n"
         "plot x with lines lw 0.8 dt 3 lc rgb '#8a8a8a' notitle, 'table2.csv' skip 1 using (strcol(4) eq '1-2-3-4' "
         "? NaN : $6):5 with points pt 6 ps 0.7 lc rgb '#2f78b7' title 'triples', 'table2.csv' skip 1 using "
         "(strcol(4) eq '1-2-3-4' ? $6 : NaN):5 with points pt 7 ps 0.7 lc rgb '#d0553c' title 'all four'\n";
}

nlohmann::ordered_json facts_of(const Table2Study& study, const study::Proportion& others) {
  nlohmann::ordered_json out;
  out["experiments"] = study::kExperiments;
  out["verdicts_as_printed"] = study.same_verdicts();
  out["attitudes"] = study::kTable2Attitudes;
  out["other_tools"] = io::object({{"tools", others.trials},
                                   {"all_verdicts_as_printed", others.count},
                                   {"low_95", std::stod(fmt::format("{:.4f}", others.low))}});
  for (std::size_t e = 0; e < kTable2.size(); ++e) {
    const Table2Result& r = study.result[e];
    nlohmann::ordered_json one =
        io::object({{"number", kTable2[e].number},
                    {"mae_all_g0", std::stod(fmt::format("{:.6f}", g0_from_mps2(r.finding.mae_all_mps2)))},
                    {"mae_all_printed_g", kTable2[e].mae_all_g},
                    {"detected", r.finding.detected},
                    {"isolated", sensors(r.finding.isolated, "")},
                    {"as_printed", r.same_verdict},
                    {"plumb_state", to_string(r.state)},
                    {"plumb_excluded", sensors(r.excluded, "")},
                    {"plumb_after_attitudes", r.named_after}});
    out["rows"].push_back(std::move(one));
  }
  return out;
}

/// Experiments with one faulty sensor in which plumb excluded that one, the attitudes it took, those in which
/// it named a healthy one; and experiments with two faulty ones throughout which it published nothing as valid.
struct OwnTally {
  int right = 0, wrong = 0, most_attitudes = 0, pairs_without_output = 0;
};

OwnTally tally_of(const Table2Study& study) {
  OwnTally out;
  for (std::size_t e = 0; e < kTable2.size(); ++e) {
    const Table2Result& r = study.result[e];
    if (!(r.ever_named - kTable2[e].faulty).empty()) ++out.wrong;
    const bool without = r.state == HealthState::failed || r.state == HealthState::suspect;
    if (kTable2[e].faulty.size() == 2 && without && r.silent == 0) ++out.pairs_without_output;
    if (kTable2[e].faulty.size() != 1 || r.excluded != kTable2[e].faulty) continue;
    ++out.right;
    out.most_attitudes = std::max(out.most_attitudes, r.named_after);
  }
  return out;
}

}  // namespace

io::FileExpected<DemoSection> demo_table2(const DemoContext& context) {
  const auto stations = study::calibration_stations(context.tool, context.seed);
  if (!stations) return study_failed(stations.error());
  const auto fits = study::fit_both(context.tool.datasheet, *stations);
  if (!fits) return study_failed(fits.error());
  const auto study = study::table2_study(*fits, context.tool, context.seed);
  if (!study) return study_failed(study.error());
  const auto others = study::all_verdicts_as_printed(context.seed, kOtherTools);
  if (!others) return study_failed(others.error());
  const OwnTally own = tally_of(*study);
  DemoSection out;
  render::Chapter& chapter = out.chapter;
  chapter.id = "table2";
  chapter.title = "4 Faults: Table 2 of the paper";
  chapter.gist = "The paper's fault table, and the same faults at a single attitude.";
  chapter.text = {
      fmt::format(
          "The paper's 23 experiments: no fault, each sensor at 0 V, −3 V, +3 V and at random, and all pairs at "
          "random; {} attitudes of {} samples, pooled, with the paper's calibrations, rule and limit. {} of 23 "
          "verdicts are as printed. With other tools, noise, attitudes and levels all 23 are as printed in {} of {}.",
          study::kTable2Attitudes, study::kBlock, study->same_verdicts(), others->count, others->trials),
      fmt::format(
          "plumb's monitor saw the same samples attitude by attitude. In {} of the 16 experiments with one faulty "
          "sensor it excluded that one, after at most {} attitudes; it excluded a healthy sensor in {} of 23. Two "
          "faulty sensors of four cannot be isolated: in {} of these 6 experiments it published nothing as valid and "
          "ended without an output.",
          own.right, own.most_attitudes, own.wrong, own.pairs_without_output)};
  const io::FileExpected<void> written = write_into(context.out, "table2.csv", csv_of(*study));
  if (!written) return tl::unexpected<io::FileError>(written.error());
  io::FileExpected<render::Picture> picture =
      draw(context.out, "table2", script_of, "Table 2: measured against printed",
           "All 115 mean absolute errors of the table. A point in the lower left or the upper right quarter leads to "
           "the printed verdict.");
  if (!picture) return tl::unexpected<io::FileError>(picture.error());
  chapter.pictures.push_back(*std::move(picture));
  chapter.tables.push_back(table_of(*study));
  chapter.files = {{"table2.csv", "the table"}};
  link_drawn(chapter, "table2", "the picture of it");
  out.facts = facts_of(*study, *others);
  out.console = fmt::format(
      "4 Table 2: {} of 23 verdicts as printed ({} attitudes pooled); all 23 with {} of {} other tools; plumb "
      "excludes the faulty one in {} of 16\n",
      study->same_verdicts(), study::kTable2Attitudes, others->count, others->trials, own.right);
  const io::FileExpected<void> added = add_one_attitude(context, *fits, out);
  if (!added) return tl::unexpected<io::FileError>(added.error());
  return out;
}

}  // namespace cli
}  // namespace PLUMB_ABI
}  // namespace plumb
