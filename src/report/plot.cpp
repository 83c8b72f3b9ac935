#include "plumb/report/plot.hpp"

#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>

#include <cerrno>
#include <cmath>
#include <cstring>

extern char** environ;

namespace plumb {
inline namespace PLUMB_ABI {
namespace report {
namespace {

/// Panels from top to bottom, as parts of the height of the picture.
struct Panel {
  double top, bottom;
  const char* title;
};
constexpr Panel kBand{0.955, 0.91, "state of the array"};
constexpr Panel kRatio{0.865, 0.655, "the test that decides: statistic / limit (above 1: alarm)"};
constexpr Panel kInclination{0.595, 0.375, "inclination"};
constexpr Panel kError{0.315, 0.08, "inclination error, absolute"};

/// Colours that are readable on white and on black.
constexpr const char* kColours =
    "without_plumb = '#d0553c'\nwith_plumb = '#2f78b7'\nunconfirmed = '#c98a00'\ntruth = '#8a8a8a'\nbound = "
    "'#2c8f57'\n";

/// Title at the left, key at the right, both above the panel, so that neither hides a point.
std::string frame_of(const Panel& panel) {
  return fmt::format(
      "\nset tmargin at screen {}\nset bmargin at screen {}\n"
      "set label 1 '{}' at graph 0, graph 1 offset 0,0.55 left front\n"
      "set key at graph 1.005, graph 1 right bottom horizontal samplen 0.6 width -1 height 0.3\n",
      panel.top, panel.bottom, panel.title);
}

/// One rectangle per stretch of one state, named where there is room.
std::string state_band(const Timeline& timeline) {
  std::string out;
  const double span_s = timeline.end_s - timeline.begin_s;
  const std::size_t n = timeline.rows.size();
  for (std::size_t k = 0; k < n; ++k) {
    const double from_s = timeline.rows[k].time_s;
    // Rows that change the sets of sensors but not the state do not end a stretch.
    std::size_t next = k + 1;
    while (next < n && timeline.rows[next].state == timeline.rows[k].state) ++next;
    const double to_s = next < n ? timeline.rows[next].time_s : timeline.end_s;
    const HealthState state = timeline.rows[k].state;
    out += fmt::format("set object rect from {:.6g},0 to {:.6g},1 fc rgb '{}' fs solid 0.85 noborder front\n", from_s,
                       to_s, colour_of(state));
    if (to_s - from_s > 0.09 * span_s) {
      out += fmt::format("set label '{}' at {:.6g},0.5 center front tc rgb 'white'\n", to_string(state),
                         0.5 * (from_s + to_s));
    }
    k = next - 1;
  }
  return out;
}

/// A vertical line in every panel at each change, and at each mark.
std::string vertical_lines(const Timeline& timeline) {
  const auto line = [](double time_s, const char* style) {
    return fmt::format("set arrow from first {0:.6g}, graph 0 to first {0:.6g}, graph 1 nohead {1} back\n", time_s,
                       style);
  };
  std::string out;
  for (const TimelineRow& row : timeline.rows) {
    if (row.time_s > timeline.begin_s)
      out += line(row.time_s, fmt::format("lw 0.8 dt 3 lc rgb '{}'", colour_of(row.state)).c_str());
  }
  for (const TimelineMark& mark : timeline.marks) out += line(mark.time_s, "lw 1.4 dt 2 lc rgb '#c53a3a'");
  return out;
}

std::string mark_labels(const Timeline& timeline) {
  std::string out;
  int tag = 10;
  for (const TimelineMark& mark : timeline.marks) {
    out += fmt::format("set label {} '{} ' at first {:.6g}, graph 0.86 right front tc rgb '#c53a3a'\n", tag++,
                       mark.text, mark.time_s);
  }
  return out;
}

/// One series: a column of the CSV, all rows or those that plumb vouched for (or not), as points.
std::string series(const std::string& csv, const std::string& column, const char* style, const char* title) {
  return fmt::format("'{}' skip 1 using 1:({}) with points {} title '{}'", csv, column, style, title);
}

}  // namespace

const char* colour_of(HealthState state) noexcept {
  switch (state) {
    case HealthState::nominal: return "#2c8f57";
    case HealthState::suspect: return "#b97a00";
    case HealthState::isolated: return "#2f78b7";
    case HealthState::degraded_3_sensor: return "#8f55c4";
    case HealthState::recalibrating: return "#1f8a99";
    case HealthState::failed: return "#c53a3a";
  }
  return "#777777";
}

std::string timeline_script(const Timeline& timeline, const std::string& csv, const std::string& svg) {
  const char* const plain = "pt 7 ps 0.5 lc rgb without_plumb";
  const char* const sure = "pt 7 ps 0.5 lc rgb with_plumb";
  const char* const unsure = "pt 7 ps 0.5 lc rgb unconfirmed";
  std::string out = fmt::format(
      "# Draws {1} from {0}. Run: gnuplot timeline.gp\n"
      "set terminal svg size 1000,960 dynamic font 'sans-serif,15' linewidth 1.2\nset output '{1}'\n"
      "set datafile separator ','\nset datafile missing ''\n{2}"
      "set lmargin at screen 0.105\nset rmargin at screen 0.975\n"
      "set xrange [{3:.6g}:{4:.6g}]\nset border lw 0.7\nset tics scale 0.6\nset multiplot\n",
      csv, svg, kColours, timeline.begin_s, timeline.end_s);
  out += frame_of(kBand) + "unset ytics\nset yrange [0:1]\nset format x ''\n" + state_band(timeline);
  out += "plot -1 notitle\nunset object\nunset label\n";
  out += frame_of(kRatio) + vertical_lines(timeline) + mark_labels(timeline);
  out += "set ytics\nset grid ytics lw 0.4 lc rgb '#999999'\nset logscale y\nset yrange [0.01:*]\nset format y '%g'\n";
  out +=
      "plot 1 lw 1.4 lc rgb '#c53a3a' notitle, " + series(csv, "$8 > 0.01 ? $8 : 0.01", sure, "") + "\nunset label\n";
  out += frame_of(kInclination) +
         "unset logscale y\nset yrange [*:*]\nset offsets 0,0,graph 0.06,graph 0.06\nset ylabel 'deg' offset 0.6\n";
  // Later series cover earlier ones: the truth is a ring, so that it stays visible around a right answer.
  out += "plot " + series(csv, "$11", plain, "without plumb") + ", " +
         series(csv, "strcol(3) eq 'unconfirmed' ? NaN : $10", sure, "with plumb") + ", " +
         series(csv, "strcol(3) eq 'unconfirmed' ? $10 : NaN", unsure, "with plumb, unconfirmed") + ", " +
         series(csv, "$9", "pt 6 ps 0.9 lc rgb truth", "true") + "\n";
  out += frame_of(kError) +
         "set xlabel 'time, s' offset 0,0.4\nset format x '%g'\nset logscale y\nunset offsets\nset yrange [0.0005:*]\n";
  out += "least(x) = abs(x) > 0.0005 ? abs(x) : 0.0005\n";
  out += "plot " + series(csv, "least($13)", plain, "without plumb") + ", " +
         series(csv, "strcol(3) eq 'unconfirmed' ? NaN : least($12)", sure, "with plumb") + ", " +
         series(csv, "strcol(3) eq 'unconfirmed' ? least($12) : NaN", unsure, "unconfirmed") + ", " +
         series(csv, "$14", "pt 11 ps 0.5 lc rgb bound", "plumb says: less than this") + "\n";
  return out + "unset multiplot\nunset output\n";
}

io::FileExpected<void> run_gnuplot(const std::string& directory, const std::string& script) {
  const auto failed = [](std::string what, std::string remedy) {
    return tl::unexpected<io::FileError>(
        io::FileError{"gnuplot", 0, "", std::move(what), std::move(remedy), io::ExitCode::other});
  };
  std::string program = "gnuplot";
  std::string argument = script;
  char* arguments[] = {program.data(), argument.data(), nullptr};
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addchdir_np(&actions, directory.c_str());
  pid_t child = 0;
  const int error = posix_spawnp(&child, "gnuplot", &actions, nullptr, arguments, environ);
  posix_spawn_file_actions_destroy(&actions);
  if (error == ENOENT)
    return failed("is not installed, so there is no plot",
                  "install it (Debian: apt-get install gnuplot-nox) and run again");
  if (error != 0)
    return failed(std::string("cannot be started: ") + std::strerror(error), "check the installation of gnuplot");
  int status = 0;
  while (waitpid(child, &status, 0) < 0) {
    if (errno != EINTR) return failed("was lost sight of", "run again");
  }
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) {
    return failed("did not draw the plot", "run `gnuplot " + script + "` in " + directory + " to see why");
  }
  return {};
}

std::string inline_svg(const std::string& svg) {
  const std::size_t begin = svg.find("<svg");
  if (begin == std::string::npos) return "";
  std::string out = svg.substr(begin);
  const auto drop = [&out](const std::string& from, const std::string& to) {
    for (std::size_t at = out.find(from); at != std::string::npos; at = out.find(from, at)) {
      const std::size_t end = out.find(to, at + from.size());
      if (end == std::string::npos) return;
      out.erase(at, end + to.size() - at);
    }
  };
  const auto replace = [&out](const std::string& from, const std::string& to) {
    for (std::size_t at = out.find(from); at != std::string::npos; at = out.find(from, at + to.size()))
      out.replace(at, from.size(), to);
  };
  drop("<title>", "</title>");
  drop("<desc>", "</desc>");
  drop("xmlns=\"", "\"");
  drop("xmlns:xlink=\"", "\"");
  replace("rgb(  0,   0,   0)", "currentColor");
  replace("\"black\"", "\"currentColor\"");
  replace("'black'", "'currentColor'");
  return out;
}

}  // namespace report
}  // namespace PLUMB_ABI
}  // namespace plumb
