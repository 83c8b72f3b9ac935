#include "verify_table2.hpp"

#include <cmath>

#include "plumb/array/named.hpp"
#include "plumb/io/json_fields.hpp"
#include "plumb/render/report_parts.hpp"
#include "plumb/scenario/library.hpp"
#include "plumb/study/table2_study.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace cli {
namespace {

/// Within so much the axes and the scales of an array file are the paper's.
constexpr double kSameAxis = 1e-3, kSameScale = 0.01;

Json not_given(const std::string& reason) { return io::object({{"given", false}, {"reason", reason}}); }

/// Why the experiments cannot be played with this array; empty where they can.
std::string difference(const io::ArrayFile& array) {
  if (array.field != io::FieldKind::gravity) return "the experiments are of accelerometers";
  AxisList axes{};
  const int n = paper_tetrahedron(axes);
  if (array.array.size() != n) return "the array is not the paper's tetrahedron";
  for (int i = 0; i < n; ++i) {
    if (dot(array.array.axis(i), axes[static_cast<std::size_t>(i)]) < 1.0 - kSameAxis)
      return "the array is not the paper's tetrahedron, in the paper's order";
    const double scale = array.datasheet.sensor[static_cast<std::size_t>(i)].coefficients.scale[0];
    if (std::fabs(scale / scenario::kPaperScale_VpMps2 - 1.0) > kSameScale)
      return "its faults are voltages of sensors with 3 V/g0, and the scale of this array's sensors differs";
  }
  return "";
}

Json sensors_json(SensorSet set) { return set.empty() ? Json() : Json(study::name_of(set)); }

Json rows_of(const study::Table2Study& study) {
  Json out = Json::array();
  for (std::size_t e = 0; e < study::kTable2.size(); ++e) {
    const study::Table2Row& printed = study::kTable2[e];
    const study::Table2Result& r = study.result[e];
    Json triples = Json::array();
    for (std::size_t k = 0; k < printed.mae_triple_g.size(); ++k)
      triples.push_back(g0_from_mps2(r.finding.mae_triple_mps2[k]));
    out.push_back(io::object({{"number", printed.number},
                              {"faulty", sensors_json(printed.faulty)},
                              {"voltage", study::to_string(printed.level)},
                              {"mae_all_g0", g0_from_mps2(r.finding.mae_all_mps2)},
                              {"printed_mae_all_g", printed.mae_all_g},
                              {"mae_triple_g0", std::move(triples)},
                              {"printed_mae_triple_g", printed.mae_triple_g},
                              {"detected", r.finding.detected},
                              {"isolated", sensors_json(r.finding.isolated)},
                              {"as_printed", r.same_verdict},
                              {"monitor_state", to_string(r.state)},
                              {"monitor_excluded", sensors_json(r.excluded)},
                              {"monitor_after_attitudes", r.named_after},
                              {"monitor_suspected_a_healthy_one", (r.ever_named.bits & ~printed.faulty.bits) != 0},
                              {"monitor_silent_attitudes", r.silent}}));
  }
  return out;
}

}  // namespace

Json table2_section(const io::ArrayFile& array, std::uint64_t seed) {
  const std::string why = difference(array);
  if (!why.empty()) return not_given(why);
  const scenario::Tool tool = scenario::draw_tool(array.datasheet, seed, render::smallest_priors(array.datasheet));
  const auto stations = study::calibration_stations(tool, seed);
  if (!stations) return not_given(stations.error());
  const auto fits = study::fit_both(tool.datasheet, *stations);
  if (!fits) return not_given(fits.error());
  const auto study = study::table2_study(*fits, tool, seed);
  if (!study) return not_given(study.error());
  return io::object({{"given", true},
                     {"experiments", study::kExperiments},
                     {"as_printed", study->same_verdicts()},
                     {"attitudes", study::kTable2Attitudes},
                     {"rows", rows_of(*study)}});
}

}  // namespace cli
}  // namespace PLUMB_ABI
}  // namespace plumb
