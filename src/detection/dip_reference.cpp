#include "plumb/detection/dip_reference.hpp"

#include <cmath>
#include <limits>

#include "plumb/core/detail/numbers.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

using numbers::at;

namespace {

/// Limits are wider by so much, relative to what they are about: rounding, and the ends of a range that is a point.
constexpr double kDipRounding = 1e-9;
constexpr double kHalfTurn_rad = 0.5 * kPi;

/// What a station states, as intervals.
struct Bounds {
  Readings error_mps2{};                           ///< of each healthy reading
  double shortest_mps2 = 0.0, longest_mps2 = 0.0;  ///< gravity
  double least_mps2 = 0.0, most_mps2 = 0.0;        ///< gravity along the field
  double acceleration_mps2 = 0.0;
  Vec3 along{};  ///< the field's direction
};

bool all_finite(const ErrorOf& e) noexcept { return std::isfinite(e.sigma) && std::isfinite(e.bound); }
bool negative(const ErrorOf& e) noexcept { return e.sigma < 0.0 || e.bound < 0.0; }

bool all_finite(const DipStation& s, int sensors) noexcept {
  for (int i = 0; i < sensors; ++i) {
    const std::size_t k = at(i);
    if (!s.used.has(i)) continue;
    if (!std::isfinite(s.mean_mps2[k]) || !all_finite(ErrorOf{s.sigma_mps2[k], s.bound_mps2[k]})) return false;
  }
  return finite(s.field.field_nt) && all_finite(s.field.axis_error_nt) && all_finite(s.reference.total_error_nt) &&
         all_finite(s.reference.dip_error_rad) && finite(Vec3{s.gravity.g_mps2, s.gravity.sigma_mps2, s.sigmas}) &&
         finite(Vec3{s.field.vector_nt, s.field.turn_rad, s.acceleration_mps2}) &&
         finite(Vec3{s.reference.total_nt, s.reference.dip_rad, 0.0});
}

bool errors_are_positive(const DipStation& s, int sensors) noexcept {
  for (int i = 0; i < sensors; ++i)
    if (s.used.has(i) && (!(s.sigma_mps2[at(i)] > 0.0) || s.bound_mps2[at(i)] < 0.0)) return false;
  return s.sigmas > 0.0 && s.gravity.sigma_mps2 >= 0.0 && s.acceleration_mps2 >= 0.0 && s.field.vector_nt >= 0.0 &&
         s.field.turn_rad >= 0.0 && !negative(s.field.axis_error_nt) && !negative(s.reference.total_error_nt) &&
         !negative(s.reference.dip_error_rad);
}

/// The direction of the field, and how much of gravity lies along it. The angle between gravity and the field that was
/// read is that of the reference but for the dip's error and the turn of the reading (triangle inequality on the
/// sphere), cut off at the poles.
DipRefusal take_field(const DipStation& s, Bounds& out) noexcept {
  const double length_nt = norm(s.field.field_nt);
  const double error_nt = std::sqrt(3.0) * s.field.axis_error_nt.within(s.sigmas) + s.field.vector_nt;
  if (!(length_nt > error_nt)) return DipRefusal::too_coarse;
  const double allowed_nt = error_nt + s.reference.total_error_nt.within(s.sigmas);
  if (!(std::fabs(length_nt - s.reference.total_nt) <= allowed_nt)) return DipRefusal::field_length;
  const double turn_rad = angle_with_sine(error_nt / length_nt) + s.field.turn_rad;
  const double off_rad = s.reference.dip_error_rad.within(s.sigmas) + turn_rad + kDipRounding;
  const double low = sine_of(std::fmax(s.reference.dip_rad - off_rad, -kHalfTurn_rad));
  const double high = sine_of(std::fmin(s.reference.dip_rad + off_rad, kHalfTurn_rad));
  out.along = scaled(s.field.field_nt, 1.0 / length_nt);
  out.least_mps2 = low * (low < 0.0 ? out.longest_mps2 : out.shortest_mps2);
  out.most_mps2 = high * (high < 0.0 ? out.shortest_mps2 : out.longest_mps2);
  return DipRefusal::none;
}

DipRefusal bounds_of(const SensorArray& array, const DipStation& s, Bounds& out) noexcept {
  if (!array.all().contains(s.used) || s.used.size() < 3 || !spans_space(array, s.used))
    return DipRefusal::too_few_sensors;
  if (!all_finite(s, array.size())) return DipRefusal::not_finite;
  if (!errors_are_positive(s, array.size())) return DipRefusal::error_not_positive;
  if (!(s.gravity.g_mps2 > 0.0 && s.reference.total_nt > 0.0 && std::fabs(s.reference.dip_rad) <= kHalfTurn_rad))
    return DipRefusal::bad_reference;
  for (int i = 0; i < array.size(); ++i) {
    const std::size_t k = at(i);
    if (s.used.has(i)) out.error_mps2[k] = ErrorOf{s.sigma_mps2[k], s.bound_mps2[k]}.within(s.sigmas);
  }
  const double off_mps2 = s.sigmas * s.gravity.sigma_mps2;
  out.shortest_mps2 = s.gravity.g_mps2 - off_mps2;
  out.longest_mps2 = s.gravity.g_mps2 + off_mps2;
  out.acceleration_mps2 = s.acceleration_mps2;
  if (!(out.shortest_mps2 > 0.0)) return DipRefusal::too_coarse;
  return take_field(s, out);
}

/// Shifts t that are still possible, cut down condition by condition: one range, less an open one within it.
struct Shifts {
  double low = 0.0, high = 0.0, reach = 0.0;
  bool any = false, gap = false;
  double gap_low = 0.0, gap_high = 0.0;

  /// Keeps t with  least <= at - t slope <= most.  `reach`: no t that is left is larger.
  void keep(double at, double slope, double least, double most) noexcept {
    const double rounding = kDipRounding * (std::fabs(at) + std::fabs(least) + std::fabs(most));
    const double change = std::fabs(slope) * reach;
    least -= rounding;
    most += rounding;
    if (change <= rounding) {
      if (at < least - change || at > most + change) any = false;
      return;
    }
    const double a = (at - most) / slope, b = (at - least) / slope;
    low = std::fmax(low, std::fmin(a, b));
    high = std::fmin(high, std::fmax(a, b));
    if (!(low <= high)) any = false;
  }
  FaultRanges ranges() const noexcept {
    FaultRanges out;
    if (!any) return out;
    if (!gap || gap_low >= high || gap_high <= low) {
      out.append({low, high});
      return out;
    }
    if (gap_low >= low) out.append({low, gap_low});
    if (gap_high <= high) out.append({gap_high, high});
    return out;
  }
};

/// t with  shortest <= |x - t v| <= longest: roots of |v|^2 t^2 - 2 x.v t + |x|^2 - L^2.
Shifts of_length(const Vec3& x, const Vec3& v, double shortest, double longest) noexcept {
  Shifts out;
  const double square = dot(v, v), half = dot(x, v);
  const double across = dot(x, x) - half / square * half;  // of the least length squared
  const double outer = longest * longest * (1.0 + kDipRounding) - across;
  if (!(outer >= 0.0)) return out;
  const double middle = half / square;
  const double radius = std::sqrt(outer / square);
  out.any = true;
  out.low = middle - radius;
  out.high = middle + radius;
  out.reach = std::fabs(middle) + radius;
  const double inner = shortest * shortest * (1.0 - kDipRounding) - across;
  if (shortest > 0.0 && inner > 0.0) {
    const double hole = std::sqrt(inner / square);
    out.gap = true;
    out.gap_low = middle - hole;
    out.gap_high = middle + hole;
  }
  return out;
}

/// What errors of the healthy sensors do to the vector.
struct Spread {
  double length_mps2 = 0.0;  ///< at most, in any direction
  double along_mps2 = 0.0;   ///< along the field
  double shift_mps2 = 0.0;   ///< along the column of the faulty one, as a shift
};

/// Errors of the sensors but `apart` (-1: of all), the part along its column for itself: it is not told from a fault.
/// |sum e_j a_j|^2 is at most the sum of |e_j e_k a_j.a_k|, exactly that for two sensors.
Spread spread_of(const DipJudgement& j, const Bounds& bounds, int sensors, int apart) noexcept {
  Spread out;
  const Vec3 v = apart < 0 ? Vec3{} : j.column[at(apart)];
  const double square = dot(v, v);
  std::array<Vec3, kCapacity> moved{};
  double sum = 0.0;
  for (int i = 0; i < sensors; ++i) {
    if (!j.used.has(i) || i == apart) continue;
    const Vec3 c = scaled(j.column[at(i)], bounds.error_mps2[at(i)]);
    const double share = square > 0.0 ? dot(c, v) / square : 0.0;
    moved[at(i)] = minus(c, scaled(v, share));
    out.shift_mps2 += std::fabs(share);
    out.along_mps2 += std::fabs(dot(moved[at(i)], bounds.along));
    for (int k = 0; k < i; ++k) sum += 2.0 * std::fabs(dot(moved[at(i)], moved[at(k)]));
    sum += dot(moved[at(i)], moved[at(i)]);
  }
  out.length_mps2 = std::sqrt(sum) + bounds.acceleration_mps2;
  out.along_mps2 += bounds.acceleration_mps2;
  return out;
}

/// Entry (a, b) of what least squares leave of the readings: r = P y.
double parity_entry(const SensorArray& array, const DipJudgement& j, int a, int b) noexcept {
  return (a == b ? 1.0 : 0.0) - dot(array.axis(a), j.column[at(b)]);
}

/// A line of vectors x - t column_faulty (-1: x alone), and the errors that are allowed for: of all sensors but
/// `apart`.
struct SensorLine {
  int faulty = -1, apart = -1;
};

/// Residuals, which three sensors have none of: |r_a - t P_ai| is at most what the errors put there. `shifted_mps2`: so
/// much of t is no reading of sensor i, but what errors of the others do along its column.
void keep_residuals(const SensorArray& array, const DipStation& s, const DipJudgement& j, const Bounds& bounds,
                    SensorLine line, double shifted_mps2, Shifts& shifts) noexcept {
  if (j.used.size() == 3) return;
  for (int a = 0; a < array.size(); ++a) {
    if (!j.used.has(a)) continue;
    double limit = kDipRounding * bounds.longest_mps2;
    for (int b = 0; b < array.size(); ++b)
      if (j.used.has(b) && b != line.apart) limit += std::fabs(parity_entry(array, j, a, b)) * bounds.error_mps2[at(b)];
    const double residual = s.mean_mps2[at(a)] - dot(array.axis(a), j.x_mps2);
    const double slope = line.faulty < 0 ? 0.0 : parity_entry(array, j, a, line.faulty);
    limit += std::fabs(slope) * shifted_mps2;
    shifts.keep(residual, slope, -limit, limit);
  }
}

DipHypothesis explain(const SensorArray& array, const DipStation& s, const DipJudgement& j, const Bounds& bounds,
                      SensorLine line) noexcept {
  DipHypothesis out;
  const Spread spread = spread_of(j, bounds, array.size(), line.apart);
  const double shortest = bounds.shortest_mps2 - spread.length_mps2;
  const double longest = bounds.longest_mps2 + spread.length_mps2;
  const Vec3 v = line.faulty < 0 ? Vec3{} : j.column[at(line.faulty)];
  Shifts shifts;
  if (line.faulty < 0) {
    const double length = norm(j.x_mps2);
    shifts.any = shortest - kDipRounding * longest <= length && length <= longest * (1.0 + kDipRounding);
  } else {
    shifts = of_length(j.x_mps2, v, shortest, longest);
  }
  const double shifted = line.apart < 0 ? 0.0 : spread.shift_mps2 + bounds.acceleration_mps2 / norm(v);
  if (line.apart >= 0) out.margin_mps2 = bounds.error_mps2[at(line.apart)] + shifted;
  shifts.keep(dot(j.x_mps2, bounds.along), dot(v, bounds.along), bounds.least_mps2 - spread.along_mps2,
              bounds.most_mps2 + spread.along_mps2);
  keep_residuals(array, s, j, bounds, line, shifted, shifts);
  out.shift = shifts.ranges();
  const double sine = spread.length_mps2 / bounds.shortest_mps2;
  out.turn_rad = sine < 1.0 ? angle_with_sine(sine) : kPi;
  return out;
}

/// The vector and its map; false where the station is refused.
bool begin(const SensorArray& array, const DipStation& station, Bounds& bounds, DipJudgement& out) noexcept {
  out.refusal = bounds_of(array, station, bounds);
  if (out.refusal != DipRefusal::none) return false;
  out.used = station.used;
  out.column = least_squares(array, station.used).column;
  for (int i = 0; i < array.size(); ++i)
    if (station.used.has(i)) out.x_mps2 = plus(out.x_mps2, scaled(out.column[at(i)], station.mean_mps2[at(i)]));
  return true;
}

}  // namespace

const char* to_string(DipRefusal refusal) noexcept {
  switch (refusal) {
    case DipRefusal::none: return "none";
    case DipRefusal::too_few_sensors: return "too_few_sensors";
    case DipRefusal::not_finite: return "not_finite";
    case DipRefusal::error_not_positive: return "error_not_positive";
    case DipRefusal::bad_reference: return "bad_reference";
    case DipRefusal::too_coarse: return "too_coarse";
    case DipRefusal::field_length: return "field_length";
    case DipRefusal::sensors_changed: return "sensors_changed";
  }
  return "?";
}

DipJudgement judge_dip(const SensorArray& array, const DipStation& station) noexcept {
  DipJudgement out;
  Bounds bounds;
  if (!begin(array, station, bounds, out)) return out;
  out.none = explain(array, station, out, bounds, {-1, -1});
  for (int i = 0; i < array.size(); ++i)
    if (station.used.has(i)) out.faulty[at(i)] = explain(array, station, out, bounds, {i, i});
  return out;
}

// A fault passes for none where what it makes of the truth is within the limits of "no fault", which hold the errors
// once, and the errors that there are, which may work against it: twice, about the true vector.
double surely_seen_mps2(const SensorArray& array, const DipStation& station, const Vec3& gravity_mps2, int i) noexcept {
  constexpr double kNever = std::numeric_limits<double>::infinity();
  if (!finite(gravity_mps2) || !station.used.has(i)) return kNever;
  DipStation s = station;
  s.sigmas *= 2.0;
  s.acceleration_mps2 *= 2.0;
  s.field.vector_nt *= 2.0;
  s.field.turn_rad *= 2.0;
  s.field.axis_error_nt.bound *= 2.0;
  s.reference.total_error_nt.bound *= 2.0;
  s.reference.dip_error_rad.bound *= 2.0;
  for (int k = 0; k < array.size(); ++k) {
    s.mean_mps2[at(k)] = dot(array.axis(k), gravity_mps2);
    s.bound_mps2[at(k)] *= 2.0;
  }
  DipJudgement judged;
  Bounds bounds;
  if (!begin(array, s, bounds, judged)) return kNever;
  const FaultRanges unseen = explain(array, s, judged, bounds, {i, -1}).shift;
  double largest = 0.0;
  for (int k = 0; k < unseen.count; ++k) {
    const FaultRange& r = unseen.range[at(k)];
    largest = std::fmax(largest, std::fmax(std::fabs(r.low_mps2), std::fabs(r.high_mps2)));
  }
  return largest;
}

}  // namespace PLUMB_ABI
}  // namespace plumb
