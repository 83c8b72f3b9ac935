/// What is reported of every sensor of a geometry, and of the set (private to src/render).
#pragma once

#include <limits>

#include "field_table.hpp"
#include "plumb/findings/geometry_study.hpp"
#include "plumb/render/figures.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace render {

/// Of one attitude there is nothing to tell where no fault can be isolated.
inline double where_isolable(const findings::GeometryStudy& study, double value) {
  return study.merit.confirmed_grade > 0 ? value : std::numeric_limits<double>::infinity();
}

/// Least faults of a sensor, by its index [m/s^2].
using ThresholdField = FieldOf<findings::GeometrySubject, findings::GeometryStudy, int>;

// clang-format off
inline constexpr ThresholdField kThresholdFields[] = {
    {"block_noise",           [](const auto&, const auto& study, const int& i) { return study.budget.noise_mps2[at(i)]; },
     1.0, "noise of", "a block", kMg0, "{:.4f}", 10, "noise of a block", kMg0},
    {"drift_tolerance",       [](const auto& subject, const auto&, const int& i) { return subject.settings.tolerance_mps2[at(i)]; },
     1.0, nullptr, nullptr, kMg0, "", 0, nullptr, kMg0},
    {"minimum_detectable_bias", [](const auto&, const auto& study, const int& i) { return study.thresholds.sensor[at(i)].detectable_mps2; },
     1.0, "minimum", "detectable", kMg0, "{:.3f}", 10, "minimum detectable bias", kMg0},
    {"guaranteed_detection_any", [](const auto&, const auto& study, const int& i) { return study.thresholds.sensor[at(i)].guaranteed_detection_mps2; },
     1.0, "guaranteed", "detection", kMg0, "{:.3f}", 10, "guaranteed detection at any attitude", kMg0},
    {"provisional_exclusion", [](const auto&, const auto& study, const int& i) { return study.thresholds.sensor[at(i)].provisional_exclusion_mps2; },
     1.0, "provisional", "by parity", kMg0, "{:.3f}", 10, "provisional by parity", kMg0},
    {"guaranteed_isolation",  [](const auto&, const auto& study, const int& i) { return study.sensors[at(i)].guaranteed_isolation_mps2; },
     1.0, "guaranteed", "isolation", kMg0, "{:.3f}", 10, "guaranteed isolation over E attitudes", kMg0},
    {"not_guaranteed_below",  [](const auto&, const auto& study, const int& i) { return where_isolable(study, study.sensors[at(i)].blind_half_width_mps2); },
     1.0, "one attitude", "hidden below", kMg0, "{:.1f}", 12, "one attitude: not guaranteed below", kMg0},
    {"guaranteed_above",      [](const auto&, const auto& study, const int& i) { return where_isolable(study, study.sensors[at(i)].any_attitude_mps2); },
     1.0, "one attitude", "found above", kMg0, "{:.1f}", 12, "one attitude: guaranteed above", kMg0},
};

/// Whether figure k of sensor i is the size from which on a fault is found, and beyond what the sensor can read.
inline bool is_beyond(const findings::GeometrySubject& subject, const findings::GeometryStudy& study, int i,
                      std::size_t k) {
  constexpr bool kFoundFrom[] = {false, false, true, true, true, true, false, true};
  static_assert(std::size(kFoundFrom) == std::size(kThresholdFields));
  return kFoundFrom[k] && findings::is_beyond_full_scale(kThresholdFields[k].value(subject, study, i),
                                                         study.full_scale_mps2[at(i)]);
}

/// In errors e of a healthy reading.
inline constexpr FieldOf<findings::WorstCase> kWorstFields[] = {
    {"detected_e",     [](const auto& c) { return c.detected; },     1.0, "detected above",     nullptr, 1.0, "{:.2f} e", 16, "detected above",     1.0},
    {"told_apart_e",   [](const auto& c) { return c.told_apart; },   1.0, "isolated above",   nullptr, 1.0, "{:.2f} e", 16, "isolated above",   1.0},
    {"vector_error_e", [](const auto& c) { return c.vector_error; }, 1.0, "largest error of the vector", nullptr, 1.0, "{:.2f} e", 20, "largest error of the vector", 1.0},
};
// clang-format on

}  // namespace render
}  // namespace PLUMB_ABI
}  // namespace plumb
