#include "temperature_json.hpp"

#include <algorithm>
#include <cmath>

#include "fit_words.hpp"
#include "plumb/findings/followed_direction.hpp"
#include "plumb/io/json_fields.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace render {
namespace {

using io::finite_or_null;
using io::Json;

Json levels_json(const TemperatureLevels& levels) {
  Json out = Json::array();
  for (int k = 0; k < levels.count; ++k) {
    const auto a = static_cast<std::size_t>(k);
    out.push_back(io::object({{"degc", levels.degc[a]}, {"stations", levels.stations[a]}}));
  }
  return out;
}

Json null_json(const TemperatureNull& null, const io::ArrayFile& array) {
  Json out = Json::array();
  const char* const kinds[] = {"bias", "scale", "axis"};
  for (int k = 0; k < null.terms; ++k) {
    const TemperatureTerm& term = null.term[static_cast<std::size_t>(k)];
    out.push_back(io::object({{"kind", kinds[static_cast<int>(term.kind)]},
                              {"order", term.order},
                              {"sensor", id_of(array, term.sensor)},
                              {"prior_sigmas", term.amount}}));
  }
  return out;
}

Json coefficients_json(const std::array<TemperatureCoefficient, kMaxTemperatureOrder + 1>& c, int order) {
  Json values = Json::array(), sigmas = Json::array(), shares = Json::array();
  for (int k = 0; k <= order; ++k) {
    const TemperatureCoefficient& one = c[static_cast<std::size_t>(k)];
    values.push_back(finite_or_null(one.value));
    sigmas.push_back(finite_or_null(one.sigma));
    shares.push_back(finite_or_null(one.data_share));
  }
  return io::object({{"value", std::move(values)}, {"sigma", std::move(sigmas)}, {"data_share", std::move(shares)}});
}

}  // namespace

io::Json temperature_json(const findings::CalibrationRun& run, const io::ArrayFile& array) {
  const TemperatureReport& t = run.temperature;
  Json out = io::object({{"order", t.order}, {"levels", levels_json(t.levels)}});
  Json missing = Json::array();
  for (int k = 0; k < t.missing; ++k) missing.push_back(t.missing_degc[static_cast<std::size_t>(k)]);
  out["missing_degc"] = std::move(missing);
  out["follows_inclination"] = t.follows_inclination;
  const findings::FollowedDirection follows =
      findings::followed_direction(run.temperature.order, run.stations, run.study.attitudes);
  out["follows_direction"] = follows.axis != 0 ? Json(std::string(1, follows.axis)) : Json();
  out["follows_time"] = t.follows_time;
  if (t.order == 0) return out;
  out["use_degc"] = {t.use_degc.lowest, t.use_degc.highest};
  out["parameters"] = t.parameters;
  out["rank"] = t.rank;
  out["gauge"] = t.gauge;
  out["condition"] = finite_or_null(t.condition);
  Json nulls = Json::array();
  for (int k = 0; k < std::min(t.null_directions, kMaxNullDirections); ++k)
    nulls.push_back(null_json(t.null[static_cast<std::size_t>(k)], array));
  out["null_directions"] = t.null_directions;
  out["null"] = std::move(nulls);
  if (!run.accepted) return out;
  out["inflation"] = finite_or_null(t.inflation);
  for (const TemperatureForecast& f : t.forecast) {
    out["expected_error"].push_back(io::object({{"degc", f.degc},
                                                {"reading_mps2", finite_or_null(f.reading_mps2)},
                                                {"sensor", id_of(array, f.sensor)},
                                                {"direction_rad", finite_or_null(f.tilt_rad)}}));
  }
  for (int i = 0; i < array.array.size(); ++i) {
    const auto a = static_cast<std::size_t>(i);
    out["sensors"].push_back(io::object({{"id", id_of(array, i)},
                                         {"reference_degc", run.accepted->model.sensor[a].reference_degc},
                                         {"SF_per_mps2", coefficients_json(t.sensor[a].scale, t.order)},
                                         {"B_mps2", coefficients_json(t.sensor[a].bias, t.order)}}));
  }
  return out;
}

}  // namespace render
}  // namespace PLUMB_ABI
}  // namespace plumb
