// Section 3 of the demo: Fig 11 of the paper.
#include <fmt/format.h>

#include "demo_picture.hpp"
#include "demo_section.hpp"
#include "plumb/findings/fit_figures.hpp"
#include "plumb/io/json_fields.hpp"
#include "plumb/study/gravity_error_study.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace cli {
namespace {

using findings::kMilliG0_mps2;
using study::GravityErrors;
using study::GravityErrorStudy;

constexpr const char* kCsv = "fig11_gravity_error.csv";

/// The three answers that are compared, in the order of the columns of the CSV.
struct Method {
  const char* name;
  const char* key;
  const char* colour;
  std::vector<double> GravityErrors::*errors;
};
const Method kMethods[] = {
    {"before: datasheet", "datasheet", kDatasheetColour, &GravityErrors::datasheet_mps2},
    {"after: the paper''s fits", "paper", kPaperColour, &GravityErrors::paper_mps2},
    {"after: plumb''s one fit", "plumb", kOwnColour, &GravityErrors::own_mps2},
};

std::string csv_of(const GravityErrorStudy& study) {
  std::string out = "combination,sensors,attitude,datasheet_mg0,paper_mg0,plumb_mg0\n";
  for (std::size_t c = 0; c < study.combination.size(); ++c) {
    const GravityErrors& errors = study.combination[c];
    for (std::size_t k = 0; k < errors.own_mps2.size(); ++k) {
      std::vector<std::string> cells = {std::to_string(c), study::name_of(errors.used), std::to_string(k + 1)};
      for (const Method& m : kMethods) cells.push_back(fmt::format("{:.5f}", (errors.*m.errors)[k] / kMilliG0_mps2));
      out += csv_line(cells);
    }
  }
  return out;
}

/// A strip of points per combination and method, with a bar at the rms.
std::string script_of(const GravityErrorStudy& study, bool narrow) {
  std::string out = plot_head("fig11_gravity_error", 1000, {520, 420}, narrow);
  out += fmt::format("set lmargin at screen {}\n", narrow ? 0.2 : 0.095);
  out +=
      "set rmargin at screen 0.975\n"
      "set tmargin at screen 0.89\n"
      "set bmargin at screen 0.12\n"
      "set logscale y\n"
      "set yrange [0.002:100]\n"
      "set ytics ('0.01' 0.01, '0.1' 0.1, '1' 1, '10' 10, '100' 100)\n"
      "set ylabel '| |g| error |, mg0' offset 0.5\n"
      "set grid ytics lw 0.4 lc rgb '#999999'\n"
      "set key at graph 0.5, graph 1.02 center bottom horizontal samplen 0.6 textcolor variable\n"
      "set xrange [-0.5:4.5]\n"
      "shown(e) = abs(e) > 0.002 ? abs(e) : 0.002\n";
  std::string tics;
  int arrow = 1;
  for (std::size_t c = 0; c < study.combination.size(); ++c) {
    const GravityErrors& errors = study.combination[c];
    tics += fmt::format("{}'{}' {}", c == 0 ? "" : ", ", c == 0 ? "all four" : study::name_of(errors.used), c);
    for (std::size_t m = 0; m < 3; ++m) {
      const double rms = study::rms_of(errors.*kMethods[m].errors) / kMilliG0_mps2;
      const double x = static_cast<double>(c) + 0.28 * (static_cast<double>(m) - 1.0);
      out += fmt::format("set arrow {} from {:.3f},{:.5f} to {:.3f},{:.5f} nohead front lw 2.6 lc rgb '{}'\n", arrow++,
                         x - 0.125, rms, x + 0.125, rms, kMethods[m].colour);
    }
  }
  out += "set xtics scale 0 (" + tics + ")\nplot ";
  for (std::size_t m = 0; m < 3; ++m) {
    out += fmt::format(
        "{}'{}' skip 1 using ($1{:+.2f}+0.2*(($3*0.618)-floor($3*0.618)-0.5)):(shown(${})) with points pt 7 ps 0.32 "
        "lc rgb '{}' title '{}'",
        m == 0 ? "" : ", ", kCsv, 0.28 * (static_cast<double>(m) - 1.0), m + 4, kMethods[m].colour, kMethods[m].name);
  }
  return out + "\n";
}

render::Table table_of(const GravityErrorStudy& study) {
  render::Table out;
  out.title = "Error of the length of gravity, mg0";
  out.head = {"sensors",           "datasheet rms", "paper rms",    "plumb rms",
              "datasheet largest", "paper largest", "plumb largest"};
  for (const GravityErrors& errors : study.combination) {
    std::vector<std::string> row = {study::name_of(errors.used)};
    for (const Method& m : kMethods)
      row.push_back(fmt::format("{:.3f}", study::rms_of(errors.*m.errors) / kMilliG0_mps2));
    for (const Method& m : kMethods)
      row.push_back(fmt::format("{:.3f}", study::largest_of(errors.*m.errors) / kMilliG0_mps2));
    out.rows.push_back(std::move(row));
  }
  out.note =
      "One sample at each attitude, white noise of 0.2 mg0 a sensor: the error left after calibration is that noise.";
  return out;
}

nlohmann::ordered_json facts_of(const GravityErrorStudy& study) {
  nlohmann::ordered_json out;
  for (const GravityErrors& errors : study.combination) {
    nlohmann::ordered_json one =
        io::object({{"sensors", study::name_of(errors.used)}, {"attitudes", errors.own_mps2.size()}});
    for (const Method& m : kMethods) {
      one["rms_mg0"][m.key] = std::stod(fmt::format("{:.4f}", study::rms_of(errors.*m.errors) / kMilliG0_mps2));
      one["largest_mg0"][m.key] = std::stod(fmt::format("{:.4f}", study::largest_of(errors.*m.errors) / kMilliG0_mps2));
    }
    out["combinations"].push_back(std::move(one));
  }
  return out;
}

}  // namespace

io::FileExpected<DemoSection> demo_gravity_error(const DemoContext& context) {
  const auto stations = study::calibration_stations(context.tool, context.seed);
  if (!stations) return study_failed(stations.error());
  const auto fits = study::fit_both(context.tool.datasheet, *stations);
  if (!fits) return study_failed(fits.error());
  const auto study = study::gravity_error_study(*fits, context.tool, context.seed);
  if (!study) return study_failed(study.error());
  const io::FileExpected<void> written = write_into(context.out, kCsv, csv_of(*study));
  if (!written) return tl::unexpected<io::FileError>(written.error());
  io::FileExpected<render::Picture> picture = draw(
      context.out, "fig11_gravity_error", [&study](bool narrow) { return script_of(*study, narrow); },
      "Fig 11: error of gravity before and after calibration",
      "A point per attitude, a bar at the rms, on a logarithmic scale. "
      "Before: nominal axes and coefficients. After: the "
      "paper's five separate fits and plumb's one fit.");
  if (!picture) return tl::unexpected<io::FileError>(picture.error());
  DemoSection out;
  out.chapter.id = "gravity-error";
  out.chapter.title = "3 What calibration leaves: Fig 11 of the paper";
  out.chapter.gist = "The error of the length of gravity at new attitudes, before and after calibration.";
  out.chapter.text = {
      fmt::format("{} new attitudes that no fit has used, one sample at each: the error of the length of the vector, "
                  "computed from all four sensors and from every triple.",
                  study->combination.front().own_mps2.size())};
  out.chapter.pictures.push_back(*std::move(picture));
  out.chapter.tables = {table_of(*study)};
  out.chapter.files = {{kCsv, "the errors"}};
  link_drawn(out.chapter, "fig11_gravity_error", "the picture");
  out.facts = facts_of(*study);
  const GravityErrors& all = study->combination.front();
  out.console = fmt::format(
      "3 error of gravity at {} new attitudes, all four, rms: datasheet {:.2f} mg0, paper's fit {:.3f}, plumb's fit "
      "{:.3f}\n",
      all.own_mps2.size(), study::rms_of(all.datasheet_mps2) / kMilliG0_mps2,
      study::rms_of(all.paper_mps2) / kMilliG0_mps2, study::rms_of(all.own_mps2) / kMilliG0_mps2);
  return out;
}

}  // namespace cli
}  // namespace PLUMB_ABI
}  // namespace plumb
