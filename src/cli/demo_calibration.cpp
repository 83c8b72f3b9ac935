// Section 2 of the demo: Figs 4 to 10 of the paper, by its method and by plumb's.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "demo_picture.hpp"
#include "demo_section.hpp"
#include "plumb/findings/fit_figures.hpp"
#include "plumb/io/json_fields.hpp"
#include "plumb/study/calibration_study.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace cli {
namespace {

using findings::kMilliG0_mps2;
using study::FitHistory;
using study::IterationPoint;

constexpr int kPlainInverseTools = 50;

/// Positions of the sensors of a set, counted from 1: "1234".
std::string digits_of(SensorSet used) {
  std::string name = study::name_of(used);
  name.erase(std::remove(name.begin(), name.end(), '-'), name.end());
  return name;
}

std::vector<int> members_of(SensorSet used) {
  std::vector<int> out;
  for (int i = 0; i < kCapacity; ++i) {
    if (used.has(i)) out.push_back(i);
  }
  return out;
}

/// One parameter of eq (3) as it is drawn.
struct Curve {
  std::size_t index = 0;  ///< in PaperParameters, and after three columns in the CSV
  std::string name;
  const char* colour = "";
  int point = 7;
};

enum class Kind { bias, scale, misalignment };

/// Factor to the unit of the picture: mg0, V/g0, none.
double unit_of(Kind kind) {
  switch (kind) {
    case Kind::bias: return 1.0 / kMilliG0_mps2;
    case Kind::scale: return kG0_mps2;
    case Kind::misalignment: return 1.0;
  }
  return 1.0;
}

Kind kind_of(int n, std::size_t index) {
  if (index < static_cast<std::size_t>(n)) return Kind::bias;
  return index < static_cast<std::size_t>(2 * n) ? Kind::scale : Kind::misalignment;
}

std::vector<Curve> curves_of(SensorSet used, Kind kind) {
  constexpr int kPoint[] = {7, 5, 9, 13};
  const std::vector<int> sensor = members_of(used);
  const int n = used.size();
  std::vector<Curve> out;
  for (int i = 0; i < n; ++i) {
    const int s = sensor[static_cast<std::size_t>(i)];
    if (kind == Kind::bias) out.push_back({study::bias_index(i), fmt::format("a{}", s + 1), kSensorColour[s], 7});
    if (kind == Kind::scale) out.push_back({study::scale_index(n, i), fmt::format("a{}", s + 1), kSensorColour[s], 7});
    for (int j = 0; j < n && kind == Kind::misalignment; ++j) {
      const int t = sensor[static_cast<std::size_t>(j)];
      if (j != i) {
        out.push_back(
            {study::misalignment_index(n, i, j), fmt::format("m{}{}", s + 1, t + 1), kSensorColour[s], kPoint[t]});
      }
    }
  }
  return out;
}

std::string csv_of(const FitHistory& history) {
  const int n = history.used.size();
  std::vector<std::string> head = {"method", "iteration", "cost_g0_4"};
  for (const Kind kind : {Kind::bias, Kind::scale, Kind::misalignment}) {
    for (const Curve& c : curves_of(history.used, kind)) {
      const char* const pattern = kind == Kind::bias ? "bias_{}_mg0" : kind == Kind::scale ? "scale_{}_v_per_g0" : "{}";
      head.push_back(fmt::format(fmt::runtime(pattern), c.name));
    }
  }
  std::string out = csv_line(head);
  const auto row = [&](const char* method, std::size_t iteration, const std::string& cost, const PaperParameters& p) {
    std::vector<std::string> cells = {method, std::to_string(iteration), cost};
    for (std::size_t k = 0; k < static_cast<std::size_t>(paper_parameters(n)); ++k)
      cells.push_back(fmt::format("{:.6f}", p[k] * unit_of(kind_of(n, k))));
    out += csv_line(cells);
  };
  row("truth", 0, "", history.truth);
  for (std::size_t k = 0; k < history.paper.size(); ++k)
    row("paper", k, fmt::format("{:.4e}", history.paper[k].cost_g4), history.paper[k].parameter);
  for (std::size_t k = 0; k < history.own.size(); ++k)
    row("plumb", k, fmt::format("{:.4e}", history.own[k].cost_g4), history.own[k].parameter);
  return out;
}

struct Range {
  double low = 0.0;
  double high = 1.0;
};

/// Of all curves of both methods and the truth, with some air.
Range range_of(const FitHistory& history, const std::vector<Curve>& curves, double unit) {
  Range r{1e300, -1e300};
  const auto take = [&](const PaperParameters& p) {
    for (const Curve& c : curves) {
      r.low = std::min(r.low, p[c.index] * unit);
      r.high = std::max(r.high, p[c.index] * unit);
    }
  };
  take(history.truth);
  for (const IterationPoint& p : history.paper) take(p.parameter);
  for (const IterationPoint& p : history.own) take(p.parameter);
  const double air = 0.07 * std::max(r.high - r.low, 1e-12);
  return {r.low - air, r.high + air};
}

std::string csv_name(const FitHistory& history) { return "calibration_" + digits_of(history.used) + ".csv"; }

/// Two panels with the same axes, the paper's method at the left. The dashed lines are what is really the case.
std::string parameter_script(const FitHistory& history, Kind kind, const std::string& name, bool narrow) {
  const std::vector<Curve> curves = curves_of(history.used, kind);
  const Range y = range_of(history, curves, unit_of(kind));
  const std::size_t last = std::max(history.paper.size(), history.own.size()) - 1;
  const bool many = curves.size() > 4;
  std::string out = plot_head(name, 1000, many ? Heights{520, 760} : Heights{460, 640}, narrow);
  out += fmt::format(
      "set xrange [-0.2:{}.2]\nset yrange [{:.6g}:{:.6g}]\nset xtics 1\nset xlabel 'iteration' offset 0,0.4\n"
      "set grid ytics lw 0.4 lc rgb '#999999'\nset tmargin at screen 0.9\nset bmargin at screen {}\nset multiplot\n",
      last, y.low, y.high, many ? 0.27 : 0.22);
  const std::string rows = many ? (narrow ? "5" : "3") : (narrow ? "2" : "1");
  const char* const label = kind == Kind::bias    ? "bias, mg0"
                            : kind == Kind::scale ? "scale factor, V/g0"
                                                  : "misalignment m_{ij}";
  const auto panel = [&](const char* method, const char* title, bool left) {
    std::string text = fmt::format("set label 1 '{}' at graph 0, graph 1 offset 0,0.7 left\n", title);
    // On a phone one above the other.
    text += narrow ? fmt::format(
                         "set lmargin at screen 0.2\nset rmargin at screen 0.97\nset tmargin at screen {}\n"
                         "set bmargin at screen {}\n",
                         left ? 0.95 : 0.53,
                         left   ? 0.6
                         : many ? 0.24
                                : 0.18)
                   : fmt::format("set lmargin at screen {}\nset rmargin at screen {}\n", left ? 0.11 : 0.555,
                                 left ? 0.53 : 0.975);
    if (narrow)
      text += left ? "unset xlabel\nset format x ''\n" : "set xlabel 'iteration' offset 0,0.4\nset format x '%g'\n";
    if (left || narrow) text += fmt::format("set ylabel '{}' offset 1.2\nset format y '%g'\n", label);
    if (!left && !narrow) text += "unset ylabel\nset format y ''\n";
    text += left ? "unset key\n"
                 : "set key at screen " + std::string(narrow ? "0.55" : "0.535") +
                       ", screen 0.01 center bottom horizontal maxrows " + rows + " samplen 2\n";
    text += "plot ";
    for (const Curve& c : curves) {
      text += fmt::format("{:.6f} with lines lw 0.9 dt 2 lc rgb '{}' notitle, ", history.truth[c.index] * unit_of(kind),
                          c.colour);
    }
    for (std::size_t k = 0; k < curves.size(); ++k) {
      text += fmt::format(
          "{}'{}' skip 1 using (strcol(1) eq '{}' ? $2 : NaN):{} with linespoints lw 1.3 pt {} ps 0.7 lc rgb '{}' "
          "title '{}'",
          k == 0 ? "" : ", ", csv_name(history), method, curves[k].index + 4, curves[k].point, curves[k].colour,
          curves[k].name);
    }
    return text + "\n";
  };
  out += panel("paper", "by the paper''s method", true);
  out += panel("plumb", history.used.size() == 4 ? "by plumb''s fit" : "by plumb''s one fit of all four", false);
  return out + "unset multiplot\n";
}

std::string cost_script(const FitHistory& history, bool narrow) {
  std::string out = plot_head("fig07_cost", 1000, {420, 360}, narrow);
  const std::size_t last = std::max(history.paper.size(), history.own.size()) - 1;
  out += fmt::format(
      "set lmargin at screen {1}\n"
      "set rmargin at screen 0.975\n"
      "set tmargin at screen 0.95\n"
      "set bmargin at screen 0.16\n"
      "set xrange [-0.2:{0}.2]\n"
      "set xtics 1\n"
      "set xlabel 'iteration' offset 0,0.4\n"
      "set logscale y\n"
      "set format y '10^{{%T}}'\n"
      "set ylabel 'E_g, g0^4' offset {2}\n"
      "set grid ytics lw 0.4 lc rgb '#999999'\n"
      "set key top right samplen 2\n",
      last, narrow ? 0.2 : 0.095, narrow ? 1.5 : 0.5);
  const auto curve = [&](const char* method, const char* colour, int point, double size, const char* title) {
    return fmt::format(
        "'{}' skip 1 using (strcol(1) eq '{}' ? $2 : NaN):3 with linespoints lw 1.5 pt {} ps {} lc rgb '{}' title '{}'",
        csv_name(history), method, point, size, colour, title);
  };
  return out + "plot " + curve("paper", kPaperColour, 6, 1.2, "the paper''s method") + ", " +
         curve("plumb", kOwnColour, 7, 0.7, "plumb''s fit") + "\n";
}

render::Table summary_table(const std::vector<FitHistory>& histories) {
  render::Table out;
  out.title = "Where the two methods end";
  out.head = {"sensors",
              "method",
              "iterations",
              "E_g at the start, g0^4",
              "E_g at the end, g0^4",
              "bias error, mg0 rms",
              "scale error, % rms",
              "misalignment error, rms"};
  for (const FitHistory& h : histories) {
    const auto row = [&](const char* method, const std::vector<IterationPoint>& points) {
      const study::ParameterError error = study::error_of(h, points.back());
      out.rows.push_back({study::name_of(h.used), method, std::to_string(points.size() - 1),
                          fmt::format("{:.2e}", points.front().cost_g4), fmt::format("{:.2e}", points.back().cost_g4),
                          fmt::format("{:.4f}", error.bias_mps2 / kMilliG0_mps2),
                          fmt::format("{:.5f}", 100.0 * error.scale), fmt::format("{:.6f}", error.misalignment)});
    };
    row("paper", h.paper);
    row("plumb", h.own);
  }
  out.note =
      "Errors are against the true values, in the frame in which the true axes lie nearest to the nominal ones. The "
      "paper fits every triple separately; plumb's triples come from its one fit.";
  return out;
}

render::Table parameter_table(const FitHistory& all) {
  render::Table out;
  out.title = "Bias and scale factor of the four sensors";
  out.head = {"sensor", "bias true, mg0", "paper", "plumb", "scale true, V/g0", "paper", "plumb"};
  const int n = all.used.size();
  for (int i = 0; i < n; ++i) {
    const auto bias = [&](const PaperParameters& p) {
      return fmt::format("{:.3f}", p[study::bias_index(i)] / kMilliG0_mps2);
    };
    const auto scale = [&](const PaperParameters& p) {
      return fmt::format("{:.5f}", p[study::scale_index(n, i)] * kG0_mps2);
    };
    out.rows.push_back({fmt::format("a{}", i + 1), bias(all.truth), bias(all.paper.back().parameter),
                        bias(all.own.back().parameter), scale(all.truth), scale(all.paper.back().parameter),
                        scale(all.own.back().parameter)});
  }
  return out;
}

std::string hessian_note(const study::Proportion& ends) {
  return fmt::format(
      "The paper's cost uses only the length of gravity, so it determines 9 of the 20 parameters of four sensors (9 "
      "of the 12 of a triple) and the Hessian of eq (11) is singular. As printed, with its plain inverse, the "
      "iteration met its stop rule within 100 steps in {} of {} simulated tools ({} %, {}; "
      "which ones depends on the rounding of the machine). The paper's method as shown here therefore "
      "takes the smallest step that satisfies the nine observable directions; it always ends.",
      ends.count, ends.trials, study::rounded_share(ends, 2, 100.0), study::interval_words(ends, 3, 100.0));
}

nlohmann::ordered_json facts_of(const std::vector<FitHistory>& histories, const study::Proportion& ends) {
  nlohmann::ordered_json out;
  const auto rounded = [](double value) { return std::stod(fmt::format("{:.4g}", value)); };
  for (const FitHistory& h : histories) {
    const auto method = [&](const std::vector<IterationPoint>& points) {
      const study::ParameterError error = study::error_of(h, points.back());
      return io::object({{"iterations", points.size() - 1},
                         {"cost_start_g0_4", rounded(points.front().cost_g4)},
                         {"cost_end_g0_4", rounded(points.back().cost_g4)},
                         {"bias_error_mg0", rounded(error.bias_mps2 / kMilliG0_mps2)},
                         {"scale_error", rounded(error.scale)},
                         {"misalignment_error", rounded(error.misalignment)}});
    };
    nlohmann::ordered_json one =
        io::object({{"sensors", study::name_of(h.used)}, {"paper", method(h.paper)}, {"plumb", method(h.own)}});
    one["paper"]["converged"] = h.paper_converged;
    one["paper"]["rank"] = h.paper_rank;
    out["fits"].push_back(std::move(one));
  }
  out["plain_inverse"] = {
      {"ends", ends.count}, {"tools", ends.trials}, {"low_95", rounded(ends.low)}, {"high_95", rounded(ends.high)}};
  return out;
}

struct Figure {
  const char* name;
  std::size_t history;  ///< 0: all four, 1: the triple 1-2-3
  Kind kind;
  const char* title;
  const char* caption;
};

constexpr Figure kFigures[] = {
    {"fig04_bias", 0, Kind::bias, "Fig 4: biases of the four sensors",
     "Dashed: the true biases. The paper's method converges to other values: the length of gravity does not separate "
     "the four biases. plumb's fit also uses that the four readings must agree."},
    {"fig05_scale", 0, Kind::scale, "Fig 5: scale factors of the four sensors",
     "Dashed: the true scale factors, 3 V/g0 within 2 %."},
    {"fig06_misalignment", 0, Kind::misalignment, "Fig 6: misalignments of the four sensors",
     "Colour: the sensor that is corrected; shape: the sensor whose reading corrects it. Dashed: the true values."},
    {"fig08_bias_123", 1, Kind::bias, "Fig 8: biases of the triple 1-2-3",
     "With three sensors the length of gravity determines the biases, and both methods find them."},
    {"fig09_scale_123", 1, Kind::scale, "Fig 9: scale factors of the triple 1-2-3",
     "The paper's method leaves the rotation of the triple undetermined; that rotation enters the scale factors and "
     "misalignments."},
    {"fig10_misalignment_123", 1, Kind::misalignment, "Fig 10: misalignments of the triple 1-2-3",
     "Dashed: the true values. The distance to them is the rotation that the paper's method leaves undetermined."},
};

io::FileExpected<void> add_pictures(const DemoContext& context, const std::vector<FitHistory>& histories,
                                    render::Chapter& chapter) {
  const auto add = [&](const char* name, const ScriptOf& script, const char* title,
                       const char* caption) -> io::FileExpected<void> {
    io::FileExpected<render::Picture> picture = draw(context.out, name, script, title, caption);
    if (!picture) return tl::unexpected<io::FileError>(picture.error());
    chapter.pictures.push_back(*std::move(picture));
    link_drawn(chapter, name, title);
    return {};
  };
  for (const Figure& f : kFigures) {
    if (f.history == 1 && f.kind == Kind::bias) {
      const io::FileExpected<void> cost = add(
          "fig07_cost", [&](bool narrow) { return cost_script(histories.front(), narrow); }, "Fig 7: error of gravity",
          "E_g of eq (10) over the 48 stations, of the vectors that each method computes. Both reach the noise, so "
          "this figure alone does not show which parameters are right.");
      if (!cost) return cost;
    }
    const io::FileExpected<void> drawn = add(
        f.name, [&](bool narrow) { return parameter_script(histories[f.history], f.kind, f.name, narrow); }, f.title,
        f.caption);
    if (!drawn) return drawn;
  }
  return {};
}

std::string console_of(const std::vector<FitHistory>& histories, const study::Proportion& ends) {
  const FitHistory& all = histories.front();
  const study::ParameterError paper = study::error_of(all, all.paper.back());
  const study::ParameterError own = study::error_of(all, all.own.back());
  return fmt::format(
      "2 calibration, four sensors, 48 stations: paper's method {} iterations, E_g {:.1e} to {:.1e} g0^4, bias error "
      "{:.3f} mg0 rms\n"
      "                                          plumb's fit    {} iterations, E_g {:.1e} to {:.1e} g0^4, bias error "
      "{:.3f} mg0 rms\n"
      "  eq (11) with the plain inverse, as printed, ends in {} of {} tools ({:.1f} to {:.1f} %)\n",
      all.paper.size() - 1, all.paper.front().cost_g4, all.paper.back().cost_g4, paper.bias_mps2 / kMilliG0_mps2,
      all.own.size() - 1, all.own.front().cost_g4, all.own.back().cost_g4, own.bias_mps2 / kMilliG0_mps2, ends.count,
      ends.trials, 100.0 * ends.low, 100.0 * ends.high);
}

}  // namespace

io::FileExpected<DemoSection> demo_calibration(const DemoContext& context) {
  const study::StudyExpected<study::CalibrationStudy> study = study::calibration_study(context.tool, context.seed);
  if (!study) return study_failed(study.error());
  const study::StudyExpected<study::Proportion> ends = study::plain_inverse_ends(context.seed, kPlainInverseTools);
  if (!ends) return study_failed(ends.error());
  DemoSection out;
  render::Chapter& chapter = out.chapter;
  chapter.id = "calibration";
  chapter.title = "2 Calibration: Figs 4 to 10 of the paper";
  chapter.gist = "The paper's method and plumb's fit, iteration by iteration, against the truth.";
  chapter.text = {
      "The tool is held still at 48 random attitudes with unknown angles; only the length of gravity is given. From "
      "the same 48 station means the paper's method and plumb's fit each estimate biases, scale factors and "
      "misalignments, starting from the datasheet. As this tool is simulated, the true values are known and drawn "
      "beside them.",
      hessian_note(*ends)};
  for (const FitHistory& history : study->history) {
    const io::FileExpected<void> written = write_into(context.out, csv_name(history), csv_of(history));
    if (!written) return tl::unexpected<io::FileError>(written.error());
    chapter.files.push_back({csv_name(history), "every iteration, sensors " + study::name_of(history.used)});
  }
  const io::FileExpected<void> drawn = add_pictures(context, study->history, chapter);
  if (!drawn) return tl::unexpected<io::FileError>(drawn.error());
  chapter.tables = {summary_table(study->history), parameter_table(study->history.front())};
  out.facts = facts_of(study->history, *ends);
  out.console = console_of(study->history, *ends);
  return out;
}

}  // namespace cli
}  // namespace PLUMB_ABI
}  // namespace plumb
