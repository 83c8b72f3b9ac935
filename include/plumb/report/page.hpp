/// The index page of a monitored run: one self-contained HTML file, no network, light and dark, phone and
/// desk. All figures come in as text, so that page and terminal say the same.
#pragma once

#include <string>
#include <vector>

#include "plumb/report/timeline.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace report {

struct RunPage {
  struct Figure {
    std::string value, label;
  };
  struct Sensor {
    std::string id, bias, scale, axis, e_cal, residual;
  };
  struct File {
    std::string name, what;
  };
  std::string title;
  std::string lead;                ///< one sentence below the title
  std::vector<Figure> figures;     ///< the few numbers that matter
  std::vector<std::string> story;  ///< what happened, a sentence each
  std::vector<TimelineRow> rows;
  std::string plot_svg;  ///< fit for inlining (`inline_svg`); empty: `plot_missing` is shown
  std::string plot_missing;
  std::string calibration;  ///< one sentence
  std::vector<Sensor> sensors;
  std::vector<std::string> commands;
  std::vector<File> files;
  std::string footer;
};

std::string run_html(const RunPage& page);

}  // namespace report
}  // namespace PLUMB_ABI
}  // namespace plumb
