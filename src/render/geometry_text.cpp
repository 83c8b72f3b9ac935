// What `plumb geometry` prints.
#include <fmt/format.h>

#include <cmath>

#include "geometry_fields.hpp"
#include "plumb/core/units.hpp"
#include "plumb/render/calibration_notes.hpp"
#include "plumb/render/detection_sizes.hpp"
#include "plumb/render/field_words.hpp"
#include "plumb/render/figures.hpp"
#include "plumb/render/geometry_report.hpp"
#include "plumb/render/words.hpp"
#include "plumb/scenario/count_text.hpp"
#include "size_fields.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace render {
namespace {

using findings::ExpectedReading;
using findings::Finding;
using findings::GeometryStudy;
using findings::GeometrySubject;
using findings::HiddenWiring;
using findings::MapSummary;
using findings::SensorStudy;

constexpr std::size_t kMostListed = 12;

std::string line(const char* what, const std::string& value) { return fmt::format("{:<44} {}\n", what, value); }

bool is_magnetic(const GeometrySubject& subject) { return subject.field() == io::FieldKind::magnetic; }

const io::FieldUnits& units_of(const GeometrySubject& subject) { return io::units_of(subject.field()); }

std::string reading_text(const GeometrySubject& subject, const GeometryStudy& study) {
  const bool file = subject.file != nullptr;
  std::string out = fmt::format("{}: {}{}\n", subject.name, count_text(subject.array.size(), "sensor"),
                                subject.calibrated ? ", axes and uncertainty from the calibration" : "");
  if (file) {
    const io::ArrayFile& f = *subject.file;
    const char* const reads = is_magnetic(subject) ? "along the field (a sensor that points along it counts up)"
                              : f.datasheet.reads == Reads::gravity
                                  ? "gravity (a sensor that points down counts up)"
                                  : "specific force (a sensor that points up counts up)";
    out += fmt::format("reads {}; the log is in {}; gravity {:.5f} m/s^2 (1 sigma {:.3f} mg0)\n", reads,
                       f.input.unit.name, units_of(subject).coarse_per_inside * subject.gravity.g_mps2,
                       units_of(subject).fine_per_inside * subject.gravity.sigma_mps2);
  }
  out += fmt::format("\n  {:<15} {:>9} {:>9} {:>9} {:>9}   {:>32}\n", "sensor", "x", "y", "z", "noise",
                     is_magnetic(subject) ? "expected in the log, field along"
                     : file               ? "expected in the log, tool at"
                                          : "expected, g0, tool at");
  out += fmt::format("  {:<15} {:>9} {:>9} {:>9} {:>9}   {:>10} {:>10} {:>10}\n", "", "", "", "", "mg0",
                     is_magnetic(subject) ? "z" : "vertical", is_magnetic(subject) ? "-y" : "horiz. 0",
                     is_magnetic(subject) ? "-x" : "horiz. 90");
  for (int i = 0; i < subject.array.size(); ++i) {
    const Vec3& h = subject.array.axis(i);
    out += fmt::format("  {:<15} {:>9} {:>9} {:>9} {:>9.4f}  ", study.sensors[at(i)].id, fixed_words(h[0], 5),
                       fixed_words(h[1], 5), fixed_words(h[2], 5),
                       units_of(subject).fine_per_inside * subject.array.sigma_mps2(i));
    const ExpectedReading& e = study.sensors[at(i)].expected;
    for (std::size_t a = 0; a < 3; ++a)
      out +=
          fmt::format(" {:>10}", unsigned_zero(fmt::format("{:.4g}", file ? e.raw[a] : g0_from_mps2(e.down_mps2[a]))));
    out += "\n";
  }
  return is_magnetic(subject) ? out : out + "  (vertical: z down; horiz. 0 and 90: z level, toolface 0 and 90 deg)\n";
}

std::string merit_text(const GeometrySubject& subject, const GeometryStudy& study) {
  const FiguresOfMerit& f = study.merit;
  std::string out = "\ngeometry\n";
  out += line("  noise gain of the vector (GDOP)", fmt::format("{:.4f}", f.gdop));
  out += line("  condition of the axes", fmt::format("{:.4f}", f.condition));
  out += line("  angle between the nearest two axes", fmt::format("{:.3f} deg", deg_from_rad(f.nearest_angle_rad)));
  out += line("  smallest |det| of a triple", fmt::format("{:.4f}", f.min_triple_det));
  out += line("  worst condition of a triple", fmt::format("{:.4g}", f.max_triple_condition));
  out +=
      line("  near-singular triples", fmt::format("{} of {}", f.near_singular_triples, subject.array.triple_count()));
  const bool chips = f.units < subject.array.size();
  if (chips) out += line("  units, n: chips, and sensors on none", fmt::format("{}", f.units));
  out += line(chips ? "  most units in one plane, c" : "  most axes in one plane, c", fmt::format("{}", f.coplanarity));
  out += chips ? "\nfaulty units that can be isolated\n" : "\nfaulty sensors that can be isolated\n";
  out += line("  with confirmation, n - 1 - c", fmt::format("{}   over several attitudes", f.confirmed_grade));
  out += line("  provisionally, by parity alone, n - 2 - c",
              fmt::format("{}   at once, without gravity, reversible", f.provisional_grade));
  out += line("  correlated faults, n >= 2m + c + 1", fmt::format("{}   in one block", study.correlated_grade));
  out += line("  critical sensors",
              sensor_names(critical_sensors(subject.array, subject.array.all()), subject.array, "none"));
  return out;
}

std::string worst_text(const GeometryStudy& study) {
  if (study.worst.empty()) return "";
  std::string out =
      "\nworst case, in errors e of a healthy reading (T7: any attitude, any values of the other faulty ones)\n";
  out += fmt::format("  {:>7}", "faulty") + text_head(kWorstFields, &FieldOf<findings::WorstCase>::above);
  for (const findings::WorstCase& c : study.worst) out += fmt::format("  {:>7}", c.faults) + text_row(kWorstFields, c);
  return out;
}

std::string threshold_text(const GeometrySubject& subject, const GeometryStudy& study) {
  const TestSettings& s = subject.settings;
  std::string out =
      fmt::format("\nsizes by sensor, mg0, in one block of {:.0f} samples at any attitude, as stated\n", s.samples);
  const auto instead_of = [&subject, &study](int i) {
    return
        [&subject, &study, i](std::size_t k) { return is_beyond(subject, study, i, k) ? kBeyondFullScale : nullptr; };
  };
  const std::vector<int> widths = widths_with_words(kThresholdFields, [&subject, &study](std::size_t k) {
    bool any = false;
    for (int i = 0; i < subject.array.size(); ++i) any = any || is_beyond(subject, study, i, k);
    return any;
  });
  out += fmt::format("  {:<15}", "") + text_head(kThresholdFields, &ThresholdField::above, "", widths);
  out += fmt::format("  {:<15}", "sensor") + text_head(kThresholdFields, &ThresholdField::below, "", widths);
  for (int i = 0; i < subject.array.size(); ++i)
    out += fmt::format("  {:<15}", study.sensors[at(i)].id) +
           text_row_or(kThresholdFields, widths, instead_of(i), units_of(subject).fine_per_inside, subject, study, i);
  if (subject.array.units().grouped()) out += fmt::format("  {}\n", kSizesOfOneAxis);
  if (subject.file) out += "  drift since the calibration: " + drift_words(*subject.file, 0.0) + "\n";
  return out;
}

std::string attitude_text(const GeometrySubject& subject, const GeometryStudy& study) {
  std::string out;
  if (!study.levels.empty()) {
    out += "\nprotection level at rest, as stated, by the noise of a sample\n";
    out += fmt::format("  {:>22}", "noise of a sample, mg0");
    for (const auto& level : study.levels) out += fmt::format(" {:>8.2f}", level.sigma_fine);
    out += fmt::format("\n  {:>22}", "one sample, deg");
    for (const auto& level : study.levels) out += fmt::format(" {:>8.4f}", level.one_sample_deg);
    out += fmt::format("\n  {:>22}", fmt::format("block of {:.0f}, deg", subject.settings.samples));
    for (const auto& level : study.levels) out += fmt::format(" {:>8.4f}", level.block_deg);
    out += "\n";
  }
  if (study.map.empty()) return out;
  const MapSummary& s = study.one_attitude;
  const char* const unit = is_magnetic(subject) ? "uT" : "g0";
  const double per = is_magnetic(subject) ? units_of(subject).coarse_per_inside : g0_from_mps2(1.0);
  out += "\nby the length of gravity at one attitude (T8; more attitudes remove the rest)\n";
  out += line("  attitudes that leave a sensor unchecked",
              fmt::format("{:.0f} % of the sphere", 100.0 * s.not_guaranteed_share));
  out += line("  any fault is isolated above",
              fmt::format("{:.3f} {} at the best attitude (inclination {:.0f}, toolface {:.0f} deg), {:.3f} {} at the "
                          "worst",
                          per * s.least_clear_mps2, unit, s.best_inclination_deg, s.best_toolface_deg,
                          per * s.largest_clear_mps2, unit));
  if (subject.array.units().grouped())
    out +=
        "  of one axis at fault; a whole chip may fail and keep the length, as by a turn: other chips isolate that\n";
  return out;
}

std::string bias_text(const GeometrySubject& subject, const GeometryStudy& study) {
  std::string out = "\na bias common to all sensors\n";
  const auto effect = [](const CommonBias& b) {
    return fmt::format("{:.4f} of it seen by parity, {:.4f} of it in the vector", b.visibility, norm(b.vector_error));
  };
  out += line("  as mounted", effect(study.common));
  if (study.polarity.reverse.empty()) return out + line("  best polarities", "as mounted");
  return out +
         line("  best polarities", fmt::format("{} reversed: {}", sensor_names(study.polarity.reverse, subject.array),
                                               effect(study.polarity.effect)));
}

std::string hidden_wiring_text(const SensorArray& array, const GeometryStudy& study) {
  std::string out = "\nwiring and mounting\n";
  if (study.hidden.empty())
    out +=
        "  every reversed sensor, exchange of two and permutation of three is detected (not all sensors reversed at "
        "once)\n";
  std::size_t listed = 0;
  for (const HiddenWiring& h : study.hidden) {
    if (listed++ == kMostListed) {
      out += fmt::format("  ... and {} more (--json lists all)\n", study.hidden.size() - kMostListed);
      break;
    }
    const double off_deg = deg_from_rad(h.effect.inclination_rad);
    out += fmt::format("  not detected at any attitude: {}; {}, inclination {}\n", wiring_words(h, array),
                       h.effect.turn_rad >= kPi
                           ? "the vector is mirrored"
                           : fmt::format("the vector turns by up to {:.0f} deg", deg_from_rad(h.effect.turn_rad)),
                       off_deg < 0.05 ? "stays right" : fmt::format("off by up to {:.1f} deg", off_deg));
  }
  double nearest = 0.0;
  std::string id;
  for (const SensorStudy& s : study.sensors) {
    if (s.nearest_remount_rad > 0.0 && (nearest <= 0.0 || s.nearest_remount_rad < nearest)) {
      nearest = s.nearest_remount_rad;
      id = s.id;
    }
  }
  if (nearest > 0.0) {
    out += fmt::format(
        "  mounted on a mirror axis a sensor passes in that group of three at every attitude; nearest: {}, {:.1f} deg "
        "away\n",
        id, deg_from_rad(nearest));
  }
  return out;
}

std::string finding_text(const GeometrySubject& subject, const GeometryStudy& study) {
  std::string out;
  for (const Finding& f : study.warnings)
    out += fmt::format("\nwarning: {}: {}\n", to_string(f.code), geometry_words(f, subject, study));
  out += "\nknown limits\n";
  for (const Finding& f : study.limits)
    out += fmt::format("  {:<26} {}\n", to_string(f.code), geometry_words(f, subject, study));
  return out;
}

std::string triple_text(const SensorArray& array) {
  std::string out = fmt::format("\n  {:>9} {:>11}  {:<14}  {}\n", "det", "condition", "", "triple");
  for (int k = 0; k < array.triple_count(); ++k) {
    const Triple& t = array.triple(k);
    out += fmt::format("  {:>9} {:>11.4g}  {:<14}  {}\n", fixed_words(t.det, 5), t.condition,
                       t.votes ? "" : "near singular", sensor_names(t.set(), array));
  }
  return out;
}

}  // namespace

std::string geometry_text(const GeometrySubject& subject, const GeometryStudy& study) {
  const std::string out = reading_text(subject, study) + merit_text(subject, study) + worst_text(study) +
                          sizes_text(study.sizes, subject.array.size(), subject.field()) +
                          threshold_text(subject, study) + attitude_text(subject, study) + bias_text(subject, study) +
                          hidden_wiring_text(subject.array, study) + finding_text(subject, study) +
                          triple_text(subject.array);
  return in_field_words(out, subject.field());
}

}  // namespace render
}  // namespace PLUMB_ABI
}  // namespace plumb
