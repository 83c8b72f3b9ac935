#include "plumb/report/page.hpp"

#include <fmt/format.h>

#include <array>
#include <kainjow/mustache.hpp>

#include "page_template.hpp"
#include "plumb/report/plot.hpp"
#include "plumb/report/words.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace report {
namespace {

using kainjow::mustache::data;

constexpr std::array kStates = {HealthState::nominal,           HealthState::suspect,       HealthState::isolated,
                                HealthState::degraded_3_sensor, HealthState::recalibrating, HealthState::failed};

data texts(const std::vector<std::string>& lines) {
  data list{data::type::list};
  for (const std::string& line : lines) list << data{"text", line};
  return list;
}

data row_data(const TimelineRow& row) {
  data out;
  out.set("time", fmt::format("{:.2f}", row.time_s));
  out.set("state", to_string(row.state));
  out.set("colour", colour_of(row.state));
  out.set("cause", to_string(row.cause));
  out.set("explanation", row.explanation);
  out.set("sensors", row.sensors);
  out.set("statistic", row.limit > 0.0 ? fmt::format("{:.4g}", row.statistic) : "–");
  out.set("limit", row.limit > 0.0 ? fmt::format("{:.4g}", row.limit) : "–");
  out.set("inclination", row.has_inclination ? fmt::format("{:.2f}", row.inclination_deg) : "–");
  out.set("output", to_string(row.validity));
  return out;
}

data sensor_data(const RunPage::Sensor& sensor) {
  data out;
  out.set("id", sensor.id);
  out.set("bias", sensor.bias);
  out.set("scale", sensor.scale);
  out.set("axis", sensor.axis);
  out.set("e_cal", sensor.e_cal);
  out.set("residual", sensor.residual);
  return out;
}

}  // namespace

std::string run_html(const RunPage& page) {
  data root;
  root.set("title", page.title);
  root.set("lead", page.lead);
  root.set("plot", page.plot_svg);
  root.set("has_plot", !page.plot_svg.empty());
  root.set("plot_missing", page.plot_missing);
  root.set("calibration", page.calibration);
  root.set("footer", page.footer);
  root.set("story", texts(page.story));
  root.set("commands", texts(page.commands));
  data figures{data::type::list};
  for (const RunPage::Figure& figure : page.figures) {
    data one;
    one.set("value", figure.value);
    one.set("label", figure.label);
    figures << one;
  }
  root.set("figures", figures);
  data rows{data::type::list};
  for (const TimelineRow& row : page.rows) rows << row_data(row);
  root.set("rows", rows);
  data sensors{data::type::list};
  for (const RunPage::Sensor& sensor : page.sensors) sensors << sensor_data(sensor);
  root.set("sensors", sensors);
  data files{data::type::list};
  for (const RunPage::File& file : page.files) {
    data one;
    one.set("name", file.name);
    one.set("what", file.what);
    files << one;
  }
  root.set("files", files);
  data states{data::type::list};
  for (const HealthState state : kStates) {
    data one;
    one.set("name", to_string(state));
    one.set("colour", colour_of(state));
    one.set("meaning", meaning(state));
    states << one;
  }
  root.set("states", states);
  kainjow::mustache::mustache page_template{kRunPageTemplate};
  return page_template.render(root);
}

}  // namespace report
}  // namespace PLUMB_ABI
}  // namespace plumb
