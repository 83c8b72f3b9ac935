#include <cmath>

#include "plumb/core/units.hpp"
#include "plumb/io/json_fields.hpp"
#include "plumb/render/health_page.hpp"
#include "plumb/render/words.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace render {
namespace {

Json known(bool is_known, double value) { return is_known && std::isfinite(value) ? Json(value) : Json(); }

Json station_json(const verification::StationHealth& s, std::size_t number, const SensorArray& array) {
  Json reasons = Json::array();
  for (const verification::StationReason reason : reasons_against(s))
    reasons.push_back(io::object({{"reason", to_string(reason)}, {"text", explain(reason)}}));
  const Tilt& t = s.tilt;
  const bool bound = s.protected_by_bound;
  return io::object(
      {{"number", number},
       {"label", s.label < 0 ? Json() : Json(s.label)},
       {"begin_s", s.begin_s},
       {"end_s", s.end_s},
       {"depth_m", known(true, s.depth_m)},
       {"temperature_degc", s.temperature_degc},
       {"blocks", s.blocks},
       {"colour", to_string(colour_of(s))},
       {"reasons", std::move(reasons)},
       {"state", to_string(s.state)},
       {"output", to_string(s.validity)},
       {"cause", to_string(s.cause)},
       {"decided_by", to_string(s.decided_by)},
       {"statistic", s.statistic},
       {"limit", s.limit},
       {"length_mps2", s.length_mps2},
       {"reference_mps2", s.reference_mps2},
       {"off_mps2", s.off_mps2()},
       {"length_limit_mps2", s.length_limit_mps2},
       {"inclination_deg", known(t.inclination_valid, deg_from_rad(t.inclination_rad))},
       {"inclination_sigma_deg", known(t.inclination_valid, deg_from_rad(t.inclination_sigma_rad))},
       {"toolface_deg", known(t.toolface_valid, deg_from_rad(t.toolface_rad))},
       {"toolface_sigma_deg", known(t.toolface_valid, deg_from_rad(t.toolface_sigma_rad))},
       {"protection_level_calibrated_axes_deg", known(bound, deg_from_rad(s.protection_calibrated_axes_rad))},
       {"protection_level_housing_deg", known(bound, deg_from_rad(s.protection_housing_rad))},
       {"toolface_protection_housing_deg",
        known(bound && t.toolface_valid, deg_from_rad(s.toolface_protection_housing_rad))},
       {"alert", s.alert},
       {"used", io::ids_of(s.used, array)},
       {"provisionally_excluded", io::ids_of(s.provisionally_excluded, array)},
       {"excluded", io::ids_of(s.excluded, array)},
       {"absent", io::ids_of(s.absent, array)},
       {"worst_output", to_string(s.worst_validity)},
       {"worst_statistic_over_limit", s.worst_ratio},
       {"worst_off_mps2", s.worst_off_mps2},
       {"events", s.changes}});
}

Json event_json_of(const verification::NamedEvent& e, const SensorArray& array) {
  return io::object({{"sequence", e.sequence},
                     {"t_s", e.time_s},
                     {"from", to_string(e.from)},
                     {"to", to_string(e.to)},
                     {"event", to_string(e.event)},
                     {"cause", to_string(e.cause)},
                     {"why", explain(e, array)},
                     {"sensors", io::ids_of(e.sensors, array)},
                     {"statistic", e.statistic},
                     {"limit", e.limit}});
}

Json extremes_json(const verification::RunExtremes& e, const SensorArray& array) {
  Json sensors = Json::array();
  for (int i = 0; i < array.size(); ++i) {
    const auto a = static_cast<std::size_t>(i);
    sensors.push_back(io::object({{"id", array.row(i).id.data()},
                                  {"blocks_clipped", e.clipped[a]},
                                  {"blocks_scattering", e.scattering[a]},
                                  {"blocks_not_finite", e.not_finite[a]}}));
  }
  return io::object({{"samples", e.samples},
                     {"samples_refused", e.refused},
                     {"blocks", e.blocks},
                     {"first_s", e.first_s},
                     {"last_s", e.last_s},
                     {"temperature_min_degc", known(e.temperature_known, e.temperature_min_degc)},
                     {"temperature_max_degc", known(e.temperature_known, e.temperature_max_degc)},
                     {"temperature_rate_degc_per_min", e.temperature_rate_degc_per_min},
                     {"off_mps2", e.off_mps2},
                     {"off_at_s", known(e.off_at_s >= e.first_s, e.off_at_s)},
                     {"statistic_over_limit", e.ratio},
                     {"statistic_over_limit_at_s", known(e.ratio_at_s >= e.first_s, e.ratio_at_s)},
                     {"worst_mae_mps2", e.mae_mps2},
                     {"protection_level_calibrated_axes_deg", deg_from_rad(e.protection_calibrated_axes_rad)},
                     {"protection_level_housing_deg", deg_from_rad(e.protection_housing_rad)},
                     {"sensors", std::move(sensors)}});
}

/// Of a tool that failed none may be used, whatever sensors its monitor has not excluded.
SensorSet usable_of(const Verdict& last) { return last.state == HealthState::failed ? SensorSet() : last.in_service; }

}  // namespace

Json health_json(const verification::ToolHealth& health, const SensorArray& array,
                 const std::vector<std::string>& beside) {
  Json stations = Json::array(), events = Json::array();
  for (std::size_t k = 0; k < health.stations().size(); ++k)
    stations.push_back(station_json(health.stations()[k], k + 1, array));
  for (const verification::NamedEvent& event : health.events()) events.push_back(event_json_of(event, array));
  const Verdict& last = health.last();
  return io::object({{"schema", kHealthSchema},
                     {"version", kHealthVersion},
                     {"run", Json::object()},
                     {"answer", io::object({{"usable_for_survey", to_string(health.use())},
                                            {"sentence", health.sentence()},
                                            {"actions", health.actions(array, beside)},
                                            {"green", health.count(verification::Colour::green)},
                                            {"orange", health.count(verification::Colour::orange)},
                                            {"red", health.count(verification::Colour::red)},
                                            {"state", to_string(last.state)},
                                            {"state_means", meaning(last.state)},
                                            {"output", to_string(last.validity)},
                                            {"in_service", io::ids_of(usable_of(last), array)},
                                            {"excluded", io::ids_of(last.excluded, array)},
                                            {"provisionally_excluded", io::ids_of(last.provisionally_excluded, array)},
                                            {"absent", io::ids_of(last.absent, array)}})},
                     {"rule", io::object({{"length_sigmas", verification::kLengthSigmas},
                                          {"orange_beyond", verification::kLengthSigmas},
                                          {"red_beyond", 2.0 * verification::kLengthSigmas},
                                          {"page", "docs/health-report.md"}})},
                     {"stations", std::move(stations)},
                     {"events", std::move(events)},
                     {"extremes", extremes_json(health.extremes(), array)}});
}

Json residuals_json(const verification::ResidualTrace& trace, const SensorArray& array) {
  Json points = Json::array();
  for (const verification::ResidualPoint& p : trace.points()) {
    Json off = Json::array();
    for (int i = 0; i < array.size(); ++i) off.push_back(known(true, p.off_mps2[static_cast<std::size_t>(i)]));
    points.push_back(
        io::object({{"t_s", p.time_s}, {"depth_m", known(true, p.depth_m)}, {"off_mps2", std::move(off)}}));
  }
  return io::object({{"sensors", io::ids_of(array.all(), array)}, {"points", std::move(points)}});
}

}  // namespace render
}  // namespace PLUMB_ABI
}  // namespace plumb
