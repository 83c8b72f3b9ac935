#include "plumb/render/rate_geometry.hpp"

#include <fmt/format.h>

#include <cmath>

#include "plumb/core/units.hpp"
#include "plumb/io/json_fields.hpp"
#include "plumb/render/figures.hpp"
#include "plumb/scenario/count_text.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace render {
namespace {

using findings::RateGeometry;
using findings::RateSizes;
using io::Json;

std::string rate_line(const char* what, const std::string& value) { return fmt::format("{:<44} {}\n", what, value); }

std::string rate_words(double radps) {
  return std::isfinite(radps) ? fmt::format("{:.4f}", deg_from_rad(radps)) : std::string("-");
}

Json rate_sizes_json(const RateSizes& sizes, std::size_t i) {
  return io::object({{"rate_radps", sizes.rate_radps},
                     {"guaranteed_detection_radps", io::finite_or_null(sizes.axis[i].detected_radps)},
                     {"guaranteed_isolation_radps", io::finite_or_null(sizes.axis[i].isolated_radps)}});
}

std::string rate_size_table(const io::ArrayFile& group, const RateGeometry& found) {
  std::string out = fmt::format(
      "\nleast steady errors, deg/s, in two blocks of {} samples, the other axes as far off as their bounds allow\n",
      group.rate.block_samples[2]);
  const std::string rest = fmt::format("at rest, up to {:.3g} deg/s", deg_from_rad(found.at_rest.rate_radps));
  const std::string turning = fmt::format("turning, up to {:.4g} deg/s", deg_from_rad(found.turning.rate_radps));
  out += fmt::format("  {:<15} {:>27}   {:>27}\n", "", rest, turning);
  out += fmt::format("  {:<15} {:>13} {:>13}   {:>13} {:>13}\n", "gyro", "detected from", "isolated from",
                     "detected from", "isolated from");
  for (int i = 0; i < group.array.size(); ++i) {
    const findings::RateSize &a = found.at_rest.axis[at(i)], &b = found.turning.axis[at(i)];
    out += fmt::format("  {:<15} {:>13} {:>13}   {:>13} {:>13}\n", group.array.row(i).id.data(),
                       rate_words(a.detected_radps), rate_words(a.isolated_radps), rate_words(b.detected_radps),
                       rate_words(b.isolated_radps));
  }
  return out + "  guaranteed, by parity; at rest each axis is held against zero too, which names a suspected one\n";
}

}  // namespace

std::string rate_geometry_text(const io::ArrayFile& group, const RateGeometry& found) {
  const SensorArray& array = group.array;
  std::string out = fmt::format("{}: {}\n", group.name, count_text(array.size(), "gyro"));
  out += fmt::format("reads the rate about each axis; the log is in {}; of a rate no length is known\n",
                     group.input.unit.name);
  out += fmt::format("\n  {:<15} {:>9} {:>9} {:>9} {:>12}\n", "gyro", "x", "y", "z", "noise, deg/s");
  for (int i = 0; i < array.size(); ++i) {
    const Vec3& h = array.axis(i);
    out += fmt::format("  {:<15} {:>9} {:>9} {:>9} {:>12.4f}\n", array.row(i).id.data(), fixed_words(h[0], 5),
                       fixed_words(h[1], 5), fixed_words(h[2], 5), deg_from_rad(array.sigma_mps2(i)));
  }
  const FiguresOfMerit& f = found.merit;
  out += "\ngeometry\n";
  out += rate_line("  noise gain of the vector (GDOP)", fmt::format("{:.4f}", f.gdop));
  out += rate_line("  condition of the axes", fmt::format("{:.4f}", f.condition));
  out +=
      rate_line("  angle between the nearest two axes", fmt::format("{:.3f} deg", deg_from_rad(f.nearest_angle_rad)));
  out += rate_line("  most units in one plane, c", fmt::format("{} of {}", f.coplanarity, f.units));
  out += rate_line("  faulty units that parity isolates at once", fmt::format("{}", found.isolated_units));
  out += rate_size_table(group, found);
  return found.isolated_units > 0 ? out : out + "\nwarning: no_isolation: " + kNoRateIsolation + "\n";
}

std::string rate_geometry_json(const io::ArrayFile& group, const RateGeometry& found) {
  const SensorArray& array = group.array;
  Json sensors = Json::array();
  for (int i = 0; i < array.size(); ++i) {
    sensors.push_back(io::object({{"id", array.row(i).id.data()},
                                  {"axis", array.axis(i)},
                                  {"sigma_radps", array.sigma_mps2(i)},
                                  {"at_rest", rate_sizes_json(found.at_rest, at(i))},
                                  {"turning", rate_sizes_json(found.turning, at(i))}}));
  }
  const FiguresOfMerit& f = found.merit;
  const Json out =
      io::object({{"name", group.name},
                  {"unit", group.input.unit.name},
                  {"samples", group.rate.block_samples[2]},
                  {"figures_of_merit", io::object({{"gdop", f.gdop},
                                                   {"condition", f.condition},
                                                   {"nearest_angle_deg", deg_from_rad(f.nearest_angle_rad)},
                                                   {"units", f.units},
                                                   {"coplanarity", f.coplanarity}})},
                  {"isolated_units", found.isolated_units},
                  {"sensors", std::move(sensors)}});
  return out.dump(2) + "\n";
}

}  // namespace render
}  // namespace PLUMB_ABI
}  // namespace plumb
