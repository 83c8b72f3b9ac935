// Lanes on top (state, output, cause, one per sensor), below them what was measured, on one axis of time.
#include "plumb/render/timeline_plot.hpp"

#include <fmt/format.h>

#include <array>
#include <utility>
#include <vector>

#include "plumb/render/plot.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace render {
namespace {

// Sizes in pixels of the picture.
constexpr double kRight = 25.0;
constexpr double kMarkLine = 25.0;  ///< of text above the lanes

/// For a desk or for a phone.
struct Width {
  double all, left;
  std::size_t mark_lines;
  bool narrow;
  /// Of what is plotted.
  double inner() const { return all - left - kRight; }
};
constexpr Width kDesk{1000.0, 105.0, 3, false};
constexpr Width kPhone{kNarrowWidth, 92.0, 6, true};

constexpr double kLane = 25.0;
constexpr double kTitle = 46.0;     ///< above each lower panel
constexpr double kKeys = 76.0;      ///< below the lanes of a phone, in five lines
constexpr double kKeyLines = 40.0;  ///< beside it on a phone, where the key stands below the title
constexpr double kBottom = 60.0;
constexpr double kCharacter = 8.0;  ///< width of a letter, generously

/// Colours that are readable on white and on black.
constexpr const char* kLineColours =
    "without_plumb = '#d0553c'\nwith_plumb = '#2f78b7'\nunconfirmed = '#c98a00'\ntruth = '#8a8a8a'\nbound = "
    "'#2c8f57'\n";
constexpr const char* kFaultColour = "#c53a3a";
constexpr const char* kQuietColour = "#7d8690";  ///< motion: no change
constexpr const char* kInServiceColour = "#2c8f57";
constexpr const char* kSetAsideColour = "#b97a00";
constexpr const char* kExcludedColour = "#4d545c";
constexpr const char* kAbsentColour = "#a9b0b8";

const char* colour_of_output(Validity validity) {
  switch (validity) {
    case Validity::valid: return colour_of(HealthState::nominal);
    case Validity::degraded: return colour_of(HealthState::degraded_3_sensor);
    case Validity::unconfirmed: return colour_of(HealthState::suspect);
    case Validity::held: return kQuietColour;
    case Validity::invalid: break;
  }
  return colour_of(HealthState::failed);
}

const char* colour_of_cause(Cause cause) {
  switch (cause) {
    case Cause::passed_block: return colour_of(HealthState::nominal);
    case Cause::moving: return kQuietColour;
    case Cause::parity:
    case Cause::norm:
    case Cause::mae:
    case Cause::no_consistent_hypothesis: return kFaultColour;
    case Cause::isolated_fault: return colour_of(HealthState::isolated);
    case Cause::calibration: return colour_of(HealthState::recalibrating);
    default: break;
  }
  return colour_of(HealthState::suspect);
}

/// What a lane shows from a moment on. Stretches of equal text belong together across those without one.
struct Stretch {
  double from_s = 0.0;
  double to_s = 0.0;
  std::string text;
  const char* colour = "";
};

/// One stretch per phase, neighbours of one kind joined.
template <class Show>
std::vector<Stretch> lane_of(const Timeline& timeline, Show show) {
  std::vector<Stretch> out;
  for (std::size_t k = 0; k < timeline.phases.size(); ++k) {
    const TimelinePhase& phase = timeline.phases[k];
    Stretch next = show(phase);
    next.from_s = phase.from_s;
    next.to_s = k + 1 < timeline.phases.size() ? timeline.phases[k + 1].from_s : timeline.end_s;
    if (!out.empty() && out.back().text == next.text && out.back().colour == std::string(next.colour)) {
      out.back().to_s = next.to_s;
    } else {
      out.push_back(next);
    }
  }
  return out;
}

std::string rectangle(double from_s, double to_s, double low, double high, const char* colour) {
  return fmt::format("set object rect from {:.6g},{:.4g} to {:.6g},{:.4g} fc rgb '{}' fs solid noborder front\n",
                     from_s, low, to_s, high, colour);
}

std::string draw_lane(const std::vector<Stretch>& lane, double middle) {
  std::string out;
  for (const Stretch& s : lane) {
    if (*s.colour != '\0') out += rectangle(s.from_s, s.to_s, middle - 0.4, middle + 0.4, s.colour);
  }
  return out;
}

/// Names the runs of equal text where there is room.
std::string name_runs(const Timeline& timeline, const Width& width, const std::vector<Stretch>& lane, double middle) {
  const double pixels_per_s = width.inner() / (timeline.end_s - timeline.begin_s);
  std::vector<Stretch> runs;
  for (const Stretch& s : lane) {
    if (s.text.empty()) continue;
    if (!runs.empty() && runs.back().text == s.text) {
      runs.back().to_s = s.to_s;
    } else {
      runs.push_back(s);
    }
  }
  std::string out;
  for (const Stretch& run : runs) {
    if ((run.to_s - run.from_s) * pixels_per_s < kCharacter * static_cast<double>(run.text.size())) continue;
    out += fmt::format("set label '{}' at {:.6g},{:.4g} center front tc rgb 'white'\n", run.text,
                       0.5 * (run.from_s + run.to_s), middle);
  }
  return out;
}

const char* colour_of_place(const TimelinePhase& phase, int sensor) {
  if (phase.in_service.has(sensor)) return kInServiceColour;
  if (phase.provisionally_excluded.has(sensor)) return kSetAsideColour;
  return phase.excluded.has(sensor) ? kExcludedColour : kAbsentColour;
}

std::string sensor_lane(const Timeline& timeline, int sensor, double middle) {
  const auto place = [sensor](const TimelinePhase& phase) {
    Stretch s;
    s.colour = colour_of_place(phase, sensor);
    return s;
  };
  const auto fault = [sensor](const TimelinePhase& phase) {
    Stretch s;
    s.colour = phase.faulty.has(sensor) ? kFaultColour : "";
    return s;
  };
  std::string out = draw_lane(lane_of(timeline, place), middle);
  for (const Stretch& s : lane_of(timeline, fault)) {
    if (*s.colour != '\0') out += rectangle(s.from_s, s.to_s, middle - 0.4, middle - 0.1, s.colour);
  }
  return out;
}

/// A vertical line at each change, and at each mark.
std::string vertical_lines(const Timeline& timeline, bool changes) {
  const auto line = [](double time_s, const std::string& style) {
    return fmt::format("set arrow from first {0:.6g}, graph 0 to first {0:.6g}, graph 1 nohead {1} back\n", time_s,
                       style);
  };
  std::string out;
  for (const TimelineRow& row : timeline.rows) {
    if (changes && row.time_s > timeline.begin_s)
      out += line(row.time_s, fmt::format("lw 0.8 dt 3 lc rgb '{}'", colour_of(row.state)));
  }
  for (const TimelineMark& mark : timeline.marks) {
    out += line(mark.time_s, fmt::format("lw 1.2 dt 2 lc rgb '{}'", kFaultColour));
  }
  return out;
}

/// Beside their lines, each on the lowest line of text that is still free there.
std::string mark_labels(const Timeline& timeline, const Width& width) {
  const double s_per_pixel = (timeline.end_s - timeline.begin_s) / width.inner();
  std::vector<double> free_s(width.mark_lines, timeline.begin_s);
  std::string out;
  for (const TimelineMark& mark : timeline.marks) {
    const double length_s = kCharacter * static_cast<double>(mark.text.size()) * s_per_pixel;
    // Also over what is beside the lanes, where a picture is narrow.
    const bool fits = mark.time_s + length_s <= timeline.end_s + kRight * s_per_pixel;
    const double from_s = fits ? mark.time_s : mark.time_s - length_s;
    std::size_t line = 0;
    while (line + 1 < free_s.size() && from_s < free_s[line]) ++line;
    free_s[line] = from_s + length_s;
    out += fmt::format("set label '{}' at first {:.6g}, graph 1 offset 0,{:.2f} {} front tc rgb '{}'\n", mark.text,
                       mark.time_s, 0.8 + 1.05 * static_cast<double>(line), fits ? "left" : "right", kFaultColour);
  }
  return out;
}

/// Lays panels out from top to bottom.
class Sheet {
 public:
  explicit Sheet(double height) : height_(height) {}
  std::string panel(double gap, double height) {
    const double top = at_ + gap;
    at_ = top + height;
    return fmt::format("\nset tmargin at screen {:.5f}\nset bmargin at screen {:.5f}\n", 1.0 - top / height_,
                       1.0 - at_ / height_);
  }

 private:
  double height_;
  double at_ = 0.0;
};

std::string lanes(const Timeline& timeline, const Width& width, Sheet& sheet) {
  const auto text_of = [](const char* text, bool quiet, const char* colour) {
    Stretch s;
    s.text = quiet ? "" : text;
    s.colour = colour;
    return s;
  };
  const std::vector<Stretch> state = lane_of(
      timeline, [&text_of](const TimelinePhase& p) { return text_of(to_string(p.state), false, colour_of(p.state)); });
  const std::vector<Stretch> output = lane_of(timeline, [&text_of](const TimelinePhase& p) {
    return text_of(to_string(p.validity), p.validity == Validity::held, colour_of_output(p.validity));
  });
  const std::vector<Stretch> cause = lane_of(timeline, [&text_of](const TimelinePhase& p) {
    const Cause shown = p.moving ? Cause::moving : p.cause;
    return text_of(shown == Cause::none ? "" : to_string(shown), p.moving, colour_of_cause(shown));
  });
  const auto n = static_cast<int>(timeline.sensors.size());
  const double count = 3.0 + n;
  std::string out = sheet.panel(kMarkLine * static_cast<double>(width.mark_lines), kLane * count);
  out += fmt::format("set yrange [0:{}]\nset format x ''\nset border 0\nunset xtics\n", count);
  out += std::string("set key at graph 1, graph 0 right top horizontal samplen 0.3 width -5") +
         (width.narrow ? " maxcols 1\n" : "\n");
  std::string tics;
  double middle = count - 0.5;
  const std::pair<const char*, const std::vector<Stretch>*> named[] = {
      {"state", &state}, {"output", &output}, {"cause", &cause}};
  for (const auto& [name, lane] : named) {
    out += draw_lane(*lane, middle) + name_runs(timeline, width, *lane, middle);
    tics += fmt::format("'{}' {}, ", name, middle);
    middle -= 1.0;
  }
  for (int i = 0; i < n; ++i) {
    out += sensor_lane(timeline, i, middle);
    tics += fmt::format("'{}' {}{}", timeline.sensors[static_cast<std::size_t>(i)], middle, i + 1 < n ? ", " : "");
    middle -= 1.0;
  }
  out += fmt::format("set ytics ({}) scale 0\n", tics) + vertical_lines(timeline, false) + mark_labels(timeline, width);
  const std::pair<const char*, const char*> key[] = {{"in service", kInServiceColour},
                                                     {"provisionally excluded", kSetAsideColour},
                                                     {"excluded", kExcludedColour},
                                                     {"motion", kQuietColour},
                                                     {"faulty", kFaultColour}};
  std::string plots;
  for (const auto& [name, colour] : key) {
    plots +=
        fmt::format("{}NaN with points pt 5 ps 1 lc rgb '{}' title '{}'", plots.empty() ? "plot " : ", ", colour, name);
  }
  return out + plots + "\nunset object\nunset label\nunset arrow\nset border 31 lw 0.7\nset ytics autofreq scale 0.6\n";
}

/// Title at the left, key at the right, both above the panel, so that neither hides a point. On a phone there is no
/// room for both in one line.
std::string frame(Sheet& sheet, double gap, double height, const char* title, bool narrow) {
  return sheet.panel(narrow ? gap + kKeyLines : gap, height) +
         fmt::format(
             "set label 1 '{}' at graph {}, graph 1 offset 0,{} left front\n"
             "set key at graph 1.005, graph 1 right bottom horizontal samplen 0.6 width -4 height 0.3{}\n",
             title, narrow ? "-0.22" : "0", narrow ? 2.7 : 0.55, narrow ? " maxcols 2" : "");
}

/// Columns by name, as the CSV has them.
std::string column(const char* name) { return fmt::format("${}", timeline_column(name)); }

/// Expression `value` where it is valid or degraded, or where it says that it does not; else nothing is drawn.
std::string where(bool published, const std::string& value) {
  const int output = timeline_column("output");
  const std::string test = published ? fmt::format("strcol({0}) eq 'valid' || strcol({0}) eq 'degraded'", output)
                                     : fmt::format("strcol({}) eq 'unconfirmed'", output);
  return fmt::format("({}) ? {} : NaN", test, value);
}

std::string points(const std::string& csv, const std::string& value, const char* style, const char* title) {
  return fmt::format("'{}' skip 1 using 1:({}) with points {} title '{}'", csv, value, style, title);
}

constexpr const char* kPlain = "pt 7 ps 0.45 lc rgb without_plumb";
constexpr const char* kSure = "pt 7 ps 0.45 lc rgb with_plumb";
constexpr const char* kUnsure = "pt 7 ps 0.45 lc rgb unconfirmed";

/// Absolute errors on a logarithmic axis: without plumb, with it, with it where it is not sure.
std::string errors(const std::string& csv, const char* plain, const char* plumb) {
  const auto least = [](const char* name) { return "least(" + column(name) + ")"; };
  return "plot " + points(csv, least(plain), kPlain, "without plumb") + ", " +
         points(csv, where(true, least(plumb)), kSure, "with plumb") + ", " +
         points(csv, where(false, least(plumb)), kUnsure, "unconfirmed");
}

}  // namespace

std::string timeline_script(const Timeline& timeline, const std::string& csv, const std::string& name, bool narrow) {
  const Width& width = narrow ? kPhone : kDesk;
  constexpr double kRatio = 130.0, kNorm = 130.0, kInclination = 160.0, kError = 180.0;
  const double height = kMarkLine * static_cast<double>(width.mark_lines) +
                        kLane * (3.0 + static_cast<double>(timeline.sensors.size())) + 4.0 * kTitle + kRatio + kNorm +
                        kInclination + kError + 24.0 + kBottom + (narrow ? 4.0 * kKeyLines + kKeys : 0.0);
  std::string out = fmt::format(
      "# Draws {1}.svg from {0}. Run: gnuplot {1}.gp\n"
      "set terminal svg size {2:.0f},{3:.0f} dynamic font 'sans-serif,15' linewidth 1.2\nset output '{1}.svg'\n"
      "set datafile separator ','\nset datafile missing ''\n{4}"
      "set lmargin at screen {5}\nset rmargin at screen {6}\n"
      "set xrange [{7:.6g}:{8:.6g}]\nset border 31 lw 0.7\nset tics scale 0.6\nset multiplot\n",
      csv, (narrow ? kNarrowPrefix + name : name), width.all, height, kLineColours, width.left / width.all,
      1.0 - kRight / width.all, timeline.begin_s, timeline.end_s);
  Sheet sheet(height);
  out += lanes(timeline, width, sheet);
  out += frame(
      sheet, kTitle + 24.0 + (narrow ? kKeys : 0.0), kRatio,
      narrow ? "statistic / limit (above 1: alarm)" : "statistic / limit of the test that decides (above 1: alarm)",
      narrow);
  out += vertical_lines(timeline, true) +
         "set xtics\nset grid ytics lw 0.4 lc rgb '#999999'\nset logscale y\nset yrange [0.01:*]\nset format y '%g'\n";
  const std::string ratio = column("statistic_over_limit");
  out += "plot 1 lw 1.4 lc rgb '#c53a3a' notitle, " + points(csv, ratio + " > 0.01 ? " + ratio + " : 0.01", kSure, "") +
         "\n";
  out += frame(sheet, kTitle, kNorm, "error of |g|, absolute", narrow) +
         "set ylabel 'mg0' offset 0.6\nset yrange [0.005:*]\nleast(x) = abs(x) > 0.005 ? abs(x) : 0.005\n" +
         errors(csv, "g_error_plain_mg0", "g_error_plumb_mg0") + "\n";
  out += frame(sheet, kTitle, kInclination, "inclination", narrow) +
         "unset logscale y\nset yrange [*:*]\nset offsets 0,0,graph 0.06,graph 0.06\nset ylabel 'deg'\n";
  // Later series cover earlier ones: the truth is a ring, so that it stays visible around a right answer.
  const std::string inclination = column("inclination_plumb_deg");
  out += "plot " + points(csv, column("inclination_plain_deg"), kPlain, "without plumb") + ", " +
         points(csv, where(true, inclination), kSure, "with plumb") + ", " +
         points(csv, where(false, inclination), kUnsure, "unconfirmed") + ", " +
         points(csv, column("inclination_true_deg"), "pt 6 ps 0.85 lc rgb truth", "true") + "\n";
  out += frame(sheet, kTitle, kError, "inclination error, absolute", narrow) +
         "set xlabel 'time, s' offset 0,0.4\nset format x '%g'\nset logscale y\nunset offsets\nset yrange [0.0005:*]\n"
         "least(x) = abs(x) > 0.0005 ? abs(x) : 0.0005\n";
  out += errors(csv, "error_plain_deg", "error_plumb_deg") + ", " +
         points(csv, column("protection_level_deg"), "pt 11 ps 0.5 lc rgb bound", "bound") + "\n";
  return out + "unset multiplot\nunset output\n";
}

}  // namespace render
}  // namespace PLUMB_ABI
}  // namespace plumb
