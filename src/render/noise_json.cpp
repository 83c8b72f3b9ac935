#include <nlohmann/json.hpp>

#include "noise_words.hpp"
#include "plumb/io/json_fields.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace render {
namespace {

using io::object;
using noise::AxisStudy;

Json terms_json(const noise::NoiseFit& fit) {
  Json out = Json::object();
  for (const noise::Term term : noise::kAllTerms) {
    const noise::TermEstimate& one = fit.of(term);
    out[noise::to_string(term)] = object({{"value", one.value},
                                          {"low", one.low},
                                          {"high", one.high},
                                          {"visible", one.visible},
                                          {"more_hours", one.more_hours ? Json(*one.more_hours) : Json()}});
  }
  return out;
}

Json allan_json(const std::vector<noise::AllanPoint>& points) {
  Json out = Json::array();
  for (const noise::AllanPoint& point : points) {
    out.push_back(object({{"tau_s", point.tau_s},
                          {"deviation", point.deviation},
                          {"low", point.low},
                          {"high", point.high},
                          {"degrees_of_freedom", point.freedom}}));
  }
  return out;
}

Json peaks_json(const noise::Spectrum& spectrum) {
  Json out = Json::array();
  for (const noise::Peak& peak : spectrum.peaks) {
    out.push_back(object({{"frequency_hz", peak.frequency_hz},
                          {"amplitude", peak.amplitude},
                          {"over_floor", peak.over_floor},
                          {"width_hz", peak.width_hz},
                          {"origin", noise::to_string(peak.origin)},
                          {"order", peak.order},
                          {"aliased", peak.aliased}}));
  }
  return out;
}

Json whiteness_json(const noise::Whiteness& w) {
  return object({{"verdict", noise::to_string(w.verdict)},
                 {"block", w.block},
                 {"sample_sigma", w.sample_sigma},
                 {"block_sigma", w.block_sigma},
                 {"block_sigma_high", w.block_sigma_high},
                 {"factor", w.factor},
                 {"declare_sigma", w.declare_sigma},
                 {"best_block", w.best_block},
                 {"wander", w.wander}});
}

Json breaks_json(const noise::Stretch& stretch) {
  Json out = Json::object();
  for (const noise::BreakCode code : {noise::BreakCode::gap, noise::BreakCode::silent, noise::BreakCode::motion}) {
    const noise::Breaks& kind = stretch.breaks_of(code);
    if (kind.count == 0) continue;
    out[noise::to_string(code)] = object({{"count", kind.count},
                                          {"first_s", kind.first.time_s},
                                          {"worst_s", kind.worst.time_s},
                                          {"worst", kind.worst.value}});
  }
  return out;
}

Json axis_json(const NoiseAxis& axis) {
  const AxisStudy& study = axis.study;
  const bool judged = study.stretch.refused == noise::Refused::no;
  Json out = object({{"name", study.name},
                     {"unit", axis.unit.name.empty() ? Json() : Json(axis.unit.name)},
                     {"judged", judged},
                     {"refused", judged ? Json() : Json(noise::to_string(study.stretch.refused))},
                     {"readings", study.readings},
                     {"begin_s", study.stretch.begin_s},
                     {"rate_hz", study.stretch.period_s > 0.0 ? Json(1.0 / study.stretch.period_s) : Json()},
                     {"duration_s", study.duration_s},
                     {"filled", study.stretch.filled},
                     {"breaks", breaks_json(study.stretch)}});
  if (!judged) return out;
  out["mean"] = study.mean;
  out["resolution"] = study.stretch.resolution > 0.0 ? Json(study.stretch.resolution) : Json();
  out["terms"] = terms_json(study.fit);
  out["fitted_to_hz"] = study.fit.highest_hz;
  out["misfit"] = study.fit.misfit;
  out["misfit_hz"] = study.fit.misfit != 1.0 ? Json(study.fit.misfit_hz) : Json();
  out["peaks"] = peaks_json(study.spectrum);
  out["whiteness"] = whiteness_json(study.whiteness);
  out["noise"] = declare_words(axis);
  out[std::string("noise_declared_") + io::units_of(axis.unit.field).json_suffix] =
      axis.declared ? Json(*axis.declared) : Json();
  out["allan"] = allan_json(study.allan);
  return out;
}

}  // namespace

Json noise_json(const NoiseReport& report) {
  Json axes = Json::array(), remarks = Json::array();
  for (const NoiseAxis& axis : report.axes) axes.push_back(axis_json(axis));
  for (const NoiseRemark& one : noise_remarks(report))
    remarks.push_back(
        object({{"column", one.axis.empty() ? Json() : Json(one.axis)}, {"what", one.what}, {"remedy", one.remedy}}));
  return object({{"schema", kNoiseSchema},
                 {"version", kNoiseVersion},
                 {"log", report.log},
                 {"array", report.array.empty() ? Json() : Json(report.array)},
                 {"block", report.block},
                 {"columns", axes},
                 {"remarks", remarks},
                 {"toml", noise_lines(report)}});
}

}  // namespace render
}  // namespace PLUMB_ABI
}  // namespace plumb
