#include "tell.hpp"

#include <memory>

#include "plumb/core/detail/fields.hpp"

namespace plumb_replay {
inline namespace PLUMB_ABI {

using namespace plumb;

namespace {

std::size_t slot(int i) { return static_cast<std::size_t>(i); }

void set(Trace& trace, const char* label, SensorSet sensors) { trace.integer(label, sensors.bits); }

void triples(Trace& trace, const char* label, const TripleSet& set, int sensors) {
  const int words = (triple_count_of(sensors) + 63) / 64;
  for (int k = 0; k < words; ++k) trace.integer(label, set.bits[slot(k)], k);
}

void tell_recalibration(Trace& trace, const RecalibrationProgress& now) {
  trace.word("recalibration.phase", to_string(now.phase));
  trace.integer("recalibration.offered", now.offered);
  trace.number("recalibration.stations", now.stations);
  trace.number("recalibration.held_out", now.held_out);
  trace.number("recalibration.stations_wanted", now.stations_wanted);
  set(trace, "recalibration.lacking", now.lacking);
  trace.numbers("recalibration.wanted_direction", now.wanted_direction, 3);
  trace.number("recalibration.refusal", static_cast<double>(now.last_refusal.code));
  trace.number("recalibration.refusal_index", now.last_refusal.index);
  trace.number("recalibration.refusal_value", now.last_refusal.value);
  trace.number("recalibration.refusal_limit", now.last_refusal.limit);
}

void tell_findings(Trace& trace, const NormMismatch& reference, const CalibrationFinding& calibration) {
  trace.word("reference.kind", to_string(reference.kind));
  trace.number("reference.attitudes", reference.attitudes);
  trace.number("reference.length", reference.length_mps2);
  trace.number("reference.length_bound", reference.length_bound_mps2);
  trace.number("reference.configure", reference.configure_mps2);
  trace.number("reference.widened", reference.widened_mps2);
  trace.numbers("reference.bias", reference.bias_mps2, 3);
  trace.number("reference.turn", reference.turn_rad);
  trace.integer("calibration.contradicted", calibration.contradicted);
  trace.integer("calibration.refused", calibration.refused);
  trace.number("calibration.attitudes", calibration.attitudes);
  trace.number("calibration.ratio", calibration.ratio);
  trace.number("calibration.tolerance", calibration.tolerance_mps2);
}

void tell_sensors(Trace& trace, const Verdict& v, int sensors) {
  set(trace, "configured", v.configured);
  set(trace, "in_service", v.in_service);
  set(trace, "provisionally_excluded", v.provisionally_excluded);
  set(trace, "excluded", v.excluded);
  set(trace, "absent", v.absent);
  set(trace, "suspects", v.suspects);
  set(trace, "clipped", v.clipped);
  set(trace, "scattering", v.scattering);
  set(trace, "not_finite", v.not_finite);
  set(trace, "noisy", v.noisy);
  set(trace, "stuck", v.stuck);
  set(trace, "contradicted_clip", v.contradicted_clip);
  for (int i = 0; i < sensors; ++i) trace.word("sensor_cause", to_string(v.sensor_cause[slot(i)]), i);
  trace.numbers("minimum_faults", v.minimum_faults, sensors);
  trace.word("grade", to_string(v.grade));
  trace.number("confirmed_grade", v.confirmed_grade);
  trace.number("provisional_grade", v.provisional_grade);
  trace.number("consistent_hypotheses", v.consistent_hypotheses);
  trace.number("stations_on_record", v.stations_on_record);
  trace.integer("wants_rotation", v.wants_rotation ? 1 : 0);
  trace.integer("rotation.wanted", v.rotation.wanted ? 1 : 0);
  trace.numbers("rotation.along", v.rotation.along, 3);
  trace.number("rotation.change", v.rotation.change_mps2);
  trace.number("rotation.angle", v.rotation.angle_rad);
}

void tell_figures(Trace& trace, const Verdict& v, int sensors) {
  trace.word("decided_by", to_string(v.decided_by));
  trace.number("statistic", v.statistic);
  trace.number("limit", v.limit);
  trace.number("margin", v.margin);
  trace.number("mae_all", v.mae_all_mps2);
  trace.number("mae_worst", v.mae_worst_mps2);
  trace.number("mae_worst_limit", v.mae_worst_limit_mps2);
  triples(trace, "triples_tested", v.triples_tested, sensors);
  triples(trace, "triples_passed", v.triples_passed, sensors);
  trace.number("parity", v.parity);
  trace.number("parity_limit", v.parity_limit);
  trace.number("norm_error", v.norm_error_mps2);
  trace.number("reference", v.reference_mps2);
  trace.number("reference_sigma", v.reference_sigma_mps2);
  trace.numbers("drift", v.drift_mps2_per_h, sensors);
  trace.number("noise_factor", v.noise_factor);
  trace.number("noise_correlation", v.noise_correlation);
  trace.number("temperature", v.temperature_degc);
  trace.number("temperature_rate", v.temperature_rate_degc_per_min);
  trace.number("block_fill", v.block_fill);
}

void tell_vector(Trace& trace, const Verdict& v) {
  trace.numbers("gravity", v.gravity_mps2, 3);
  trace.numbers("covariance", v.covariance, 9);
  trace.number("age", v.age_s);
  trace.numbers("latest", v.latest_mps2, 3);
  trace.number("protection_level", v.protection_level_calibrated_axes_rad);
  trace.number("protection_level_housing", v.protection_level_housing_rad);
  trace.number("toolface_protection", v.toolface_protection_housing_rad);
  trace.integer("usable", v.usable);
  trace.integer("faults_covered", v.faults_covered);
  trace.integer("protection_available", v.protection_available ? 1 : 0);
  trace.integer("alert", v.alert ? 1 : 0);
  trace.number("snapshot_refusal", static_cast<double>(v.snapshot_refusal));
  trace.integer("config_hash", v.config_hash);
}

/// Counts, or tells, what a list of fields leads over.
struct Walk {
  Trace* trace = nullptr;
  int count = 0;
  int sensor_count = kCapacity;

  int sensors() const noexcept { return sensor_count; }
  void fail() noexcept {}
  template <class T>
  void done(T&) noexcept {}
  template <class T, class Check>
  void scalar(T& value, const Check&) noexcept {
    const int k = count++;
    if (trace == nullptr) return;
    if constexpr (std::is_same_v<T, SensorSet>) {
      trace->integer("figure", value.bits, k);
    } else {
      trace->number("figure", static_cast<double>(value), k);
    }
  }
};

}  // namespace

void tell_setup(Trace& trace, const MonitorSetup& setup) {
  const int n = setup.array.size();
  trace.number("sensors", n);
  tell_model(trace, setup.model, setup.array);
  trace.number("gravity", setup.gravity.g_mps2);
  trace.number("gravity_sigma", setup.gravity.sigma_mps2);
  trace.numbers("full_scale", setup.full_scale_raw, n);
  trace.numbers("resolution", setup.resolution_raw, n);
  trace.numbers("frame", setup.output_frame, 9);
  trace.integer("lever_arms_known", setup.lever_arms_known ? 1 : 0);
  trace.integer("calibrated", setup.calibrated ? 1 : 0);
  trace.number("days", setup.days_since_calibration);
  trace.integer("window", static_cast<std::uint64_t>(setup.config.window));
  for (int i = 0; i < n; ++i) {
    trace.number("sigma", setup.array.sigma_mps2(i), i);
    trace.numbers("lever_arm", setup.lever_arm_m[slot(i)], 3);
    trace.number("stability", setup.stability[slot(i)].mps2, i);
  }
  trace.numbers("uncertainty", setup.array.uncertainty().covariance, RowUncertainty::packed_size(n));
  trace.numbers("misfit", setup.array.uncertainty().misfit_mps2, n);
}

void tell_sample(Trace& trace, const Sample& sample, int sensors) {
  trace.number("time", sample.time_s);
  trace.numbers("raw", sample.raw, sensors);
  trace.integer("delivered", sample.delivered.bits);
  trace.number("temperature", sample.temperature_degc);
  trace.integer("station", sample.station);
  trace.integer("count", sample.count);
}

void tell_verdict(Trace& trace, const Verdict& v, int sensors) {
  trace.number("time", v.time_s);
  trace.integer("sample", v.sample);
  trace.word("state", to_string(v.state));
  trace.integer("qualifiers", v.qualifiers);
  trace.word("validity", to_string(v.validity));
  trace.word("cause", to_string(v.cause));
  trace.integer("tick", v.tick ? 1 : 0);
  trace.integer("accepted", v.accepted ? 1 : 0);
  tell_record(trace, v.transition);
  tell_sensors(trace, v, sensors);
  tell_recalibration(trace, v.recalibration);
  tell_findings(trace, v.norm_mismatch, v.calibration);
  tell_figures(trace, v, sensors);
  tell_vector(trace, v);
}

void tell_record(Trace& trace, const TransitionRecord& record) {
  trace.integer("record.sequence", record.sequence);
  trace.number("record.time", record.time_s);
  trace.word("record.from", to_string(record.from));
  trace.word("record.to", to_string(record.to));
  trace.word("record.event", to_string(record.event));
  trace.word("record.cause", to_string(record.cause));
  trace.word("record.grade", to_string(record.grade));
  set(trace, "record.sensors", record.sensors);
  trace.number("record.statistic", record.statistic);
  trace.number("record.limit", record.limit);
}

void tell_counters(Trace& trace, const MonitorCounters& counters) {
  trace.integer("counted.samples", counters.samples);
  trace.integer("counted.time_refused", counters.time_refused);
  trace.integer("counted.gaps", counters.gaps);
  trace.integer("counted.temperature_out", counters.temperature_out);
  trace.integer("counted.moving_blocks", counters.moving_blocks);
  trace.integer("counted.rotating_blocks", counters.rotating_blocks);
}

void tell_model(Trace& trace, const SensorModel& model, const SensorArray& array) {
  for (int i = 0; i < array.size(); ++i) {
    trace.numbers("scale", model.sensor[slot(i)].scale, 4);
    trace.numbers("bias", model.sensor[slot(i)].bias, 4);
    trace.numbers("axis", array.axis(i), 3);
  }
}

void tell_error(Trace& trace, const Error& error) {
  trace.integer("answer", static_cast<std::uint64_t>(error.code));  // codes are only added: no word stands for one
  trace.number("answer_index", error.index);
  trace.number("answer_value", error.value);
  trace.number("answer_limit", error.limit);
}

void tell_memory(Trace& trace, const HealthMonitor& monitor) {
  const auto copy = std::make_unique<HealthMonitor>(monitor);
  Walk walk{&trace, 0, monitor.array().size()};
  transfer(walk, *copy, AnyBits{});
}

FieldCount count_verdict_fields() {
  FieldCount out;
  Verdict verdict;
  Walk walk;
  transfer(walk, verdict, AnyBits{});
  out.there = static_cast<std::uint64_t>(walk.count) + 1;  // `config_hash` is not stored
  const Words words;
  const auto trace = std::make_unique<Trace>(words, nullptr);
  trace->in(Part::verdicts);
  tell_verdict(*trace, verdict, kCapacity);
  out.told = trace->told(Part::verdicts);
  return out;
}

}  // namespace PLUMB_ABI
}  // namespace plumb_replay
