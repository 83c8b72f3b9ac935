#include "plumb/findings/unseen_wiring.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "plumb/core/units.hpp"
#include "plumb/findings/frame_turn.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace findings {
namespace {

/// Turns nearer to one another than this are one, and those nearer to none are none: a known attitude of the usual
/// tolerance does not tell them apart.
const double kSameTurn_rad = rad_from_deg(io::kKnownAttitudeTolerance_deg);
/// Turns to try that are as near as this are tried once.
constexpr double kTriedTurn = 0.02;
constexpr double kSingular = 1e-9;
constexpr double kSameAngle_rad = 1e-9;
constexpr int kPolarSteps = 60;
constexpr int kGridStep_deg = 5;

constexpr std::size_t at(int i) noexcept { return static_cast<std::size_t>(i); }

Mat3 transposed(const Mat3& m) noexcept { return {m[0], m[3], m[6], m[1], m[4], m[7], m[2], m[5], m[8]}; }

double det_of(const Mat3& m) noexcept { return det3({m[0], m[1], m[2]}, {m[3], m[4], m[5]}, {m[6], m[7], m[8]}); }

/// Inverse of the transpose: the cofactors over the determinant.
Mat3 inverse_transposed(const Mat3& m) noexcept {
  const Vec3 a = {m[0], m[1], m[2]}, b = {m[3], m[4], m[5]}, c = {m[6], m[7], m[8]};
  const double d = 1.0 / det3(a, b, c);
  const Vec3 bc = scaled(cross(b, c), d), ca = scaled(cross(c, a), d), ab = scaled(cross(a, b), d);
  return {bc[0], bc[1], bc[2], ca[0], ca[1], ca[2], ab[0], ab[1], ab[2]};
}

/// The orthogonal matrix nearest to `m`, by Newton's iteration.
Mat3 nearest_orthogonal(Mat3 m) noexcept {
  for (int k = 0; k < kPolarSteps; ++k) {
    const Mat3 other = inverse_transposed(m);
    double change = 0.0;
    for (std::size_t e = 0; e < m.size(); ++e) {
      const double next = 0.5 * (m[e] + other[e]);
      change = std::fmax(change, std::fabs(next - m[e]));
      m[e] = next;
    }
    if (!(change > 1e-15)) break;
  }
  return m;
}

/// Largest angle between a vector and its image.
double angle_of_turn(const Mat3& k) noexcept {
  if (det_of(k) < 0.0) return kPi;
  const Vec3 twice_sine = {k[7] - k[5], k[2] - k[6], k[3] - k[1]};
  return std::atan2(norm(twice_sine), k[0] + k[4] + k[8] - 1.0);
}

void add_outer(const Vec3& a, const Vec3& b, Mat3& sum) noexcept {
  for (std::size_t r = 0; r < 3; ++r) {
    for (std::size_t c = 0; c < 3; ++c) sum[3 * r + c] += a[r] * b[c];
  }
}

Vec3 wired_axis(const SensorArray& array, const Wiring& wiring, int i) noexcept {
  return scaled(array.axis(wiring.source[at(i)]), wiring.sign[at(i)]);
}

/// Which sensor, and which way round, each channel would have to carry for the array to be turned by `turn`: a perfect
/// matching of axes, the nearest first, and of parallel ones its own.
class Matching {
 public:
  Matching(const SensorArray& array, const SensorArray& shown, const Mat3& turn, double tolerance_rad)
      : n_(array.size()) {
    carrier_.fill(-1);
    const Mat3 back = transposed(turn);
    for (int i = 0; i < n_; ++i) {
      const Vec3 wanted = times(back, shown.axis(i));
      for (int k = 0; k < n_; ++k) {
        const int j = (i + k) % n_;
        const int sign = dot(wanted, array.axis(j)) < 0.0 ? -1 : 1;
        const double off_rad = angle_between_rad(wanted, scaled(array.axis(j), sign));
        if (off_rad <= tolerance_rad)
          near_[at(i)].push_back({kSameAngle_rad * std::round(off_rad / kSameAngle_rad), j, sign});
      }
      std::stable_sort(near_[at(i)].begin(), near_[at(i)].end(),
                       [](const Near& a, const Near& b) { return a.off_rad < b.off_rad; });
    }
  }

  std::optional<Wiring> find() {
    for (int i = 0; i < n_; ++i) {
      seen_.fill(false);
      if (!place(i)) return std::nullopt;
    }
    Wiring out = Wiring::correct();
    for (int i = 0; i < n_; ++i) {
      for (const Near& one : near_[at(i)]) {
        if (carrier_[at(one.sensor)] != i) continue;
        out.source[at(i)] = static_cast<std::uint8_t>(one.sensor);
        out.sign[at(i)] = static_cast<signed char>(one.sign);
      }
    }
    return out;
  }

 private:
  struct Near {
    double off_rad;
    int sensor, sign;
  };

  bool place(int i) {  // NOLINT(misc-no-recursion) no deeper than there are sensors
    for (const Near& one : near_[at(i)]) {
      const std::size_t j = at(one.sensor);
      if (seen_[j]) continue;
      seen_[j] = true;
      if (carrier_[j] < 0 || place(carrier_[j])) {
        carrier_[j] = i;
        return true;
      }
    }
    return false;
  }

  int n_;
  std::array<std::vector<Near>, kCapacity> near_;
  std::array<int, kCapacity> carrier_{};  ///< the channel that carries a sensor
  std::array<bool, kCapacity> seen_{};
};

bool alike(const Mat3& a, const Mat3& b) {
  return std::equal(a.begin(), a.end(), b.begin(), [](double x, double y) { return std::fabs(x - y) < kTriedTurn; });
}

Mat3 product(const Mat3& a, const Mat3& b) noexcept {
  Mat3 out{};
  for (std::size_t r = 0; r < 3; ++r) {
    for (std::size_t c = 0; c < 3; ++c)
      out[3 * r + c] = a[3 * r] * b[c] + a[3 * r + 1] * b[3 + c] + a[3 * r + 2] * b[6 + c];
  }
  return out;
}

/// How far the worst axis lies from where the wiring puts it.
double misfit_rad(const SensorArray& array, const SensorArray& shown, const Wiring& wiring, const Mat3& turn) noexcept {
  const Mat3 back = transposed(turn);
  double out = 0.0;
  for (int i = 0; i < array.size(); ++i)
    out = std::fmax(out, angle_between_rad(times(back, shown.axis(i)), wired_axis(array, wiring, i)));
  return out;
}

/// The three axes that span space best.
std::array<int, 3> best_base(const SensorArray& array) {
  std::array<int, 3> out = {0, 1, 2};
  double largest = -1.0;
  for (int i = 0; i < array.size(); ++i) {
    for (int j = i + 1; j < array.size(); ++j) {
      for (int k = j + 1; k < array.size(); ++k) {
        const double det = std::fabs(det3(array.axis(i), array.axis(j), array.axis(k)));
        if (!(det > largest + 1e-12)) continue;
        largest = det;
        out = {i, j, k};
      }
    }
  }
  return out;
}

double apart_rad(const UnseenWiring& a, const UnseenWiring& b) noexcept {
  return angle_of_turn(product(transposed(a.turn), b.turn));
}

/// Whether two of them show about the same direction at every attitude.
bool same_turn(const UnseenWiring& a, const UnseenWiring& b) noexcept { return apart_rad(a, b) <= kSameTurn_rad; }

/// Every way to put three signed axes in the place of the base that keeps the angles between them.
class Search {
 public:
  Search(const SensorArray& array, const SensorArray& shown, double tolerance_rad)
      : array_(array), shown_(shown), tolerance_rad_(tolerance_rad), base_(best_base(shown)) {}

  std::vector<UnseenWiring> find() {
    const int n = array_.size();
    for (int p = 0; p < n; ++p) {
      for (int q = 0; q < n; ++q) {
        if (q == p) continue;
        for (int r = 0; r < n; ++r) {
          if (r == p || r == q) continue;
          for (unsigned signs = 0; signs < 8; ++signs) consider({p, q, r}, signs);
        }
      }
    }
    return std::move(found_);
  }

 private:
  void consider(const std::array<int, 3>& image, unsigned signs) {
    std::array<Vec3, 3> wired{};
    for (std::size_t a = 0; a < 3; ++a)
      wired[a] = scaled(array_.axis(image[a]), (signs >> static_cast<unsigned>(a)) % 2 == 0 ? 1.0 : -1.0);
    Mat3 sum{};
    for (std::size_t a = 0; a < 3; ++a) {
      const Vec3 &here = shown_.axis(base_[a]), &next = shown_.axis(base_[(a + 1) % 3]);
      const double off = angle_between_rad(wired[a], wired[(a + 1) % 3]) - angle_between_rad(here, next);
      if (std::fabs(off) > 2.0 * tolerance_rad_) return;
      add_outer(here, wired[a], sum);
    }
    if (!(std::fabs(det_of(sum)) > kSingular)) return;
    const Mat3 turn = nearest_orthogonal(sum);
    if (std::any_of(tried_.begin(), tried_.end(), [&turn](const Mat3& t) { return alike(t, turn); })) return;
    tried_.push_back(turn);
    const std::optional<Wiring> wiring = Matching(array_, shown_, turn, 2.0 * tolerance_rad_).find();
    if (!wiring) return;
    const std::optional<Mat3> exact = unseen_turn(array_, shown_, *wiring, tolerance_rad_);
    if (exact) keep({*wiring, *exact, std::fmax(kSameTurn_rad, misfit(*wiring, *exact))});
  }

  double misfit(const Wiring& wiring, const Mat3& turn) const noexcept {
    return misfit_rad(array_, shown_, wiring, turn);
  }

  /// Of wirings that amount to about the same turn the one that fits best, known no better than holds them all.
  void keep(UnseenWiring fresh) {
    const auto known =
        std::find_if(found_.begin(), found_.end(), [&fresh](const UnseenWiring& one) { return same_turn(one, fresh); });
    if (known == found_.end()) {
      found_.push_back(fresh);
      return;
    }
    if (misfit(fresh.wiring, fresh.turn) < misfit(known->wiring, known->turn) - kSameAngle_rad)
      std::swap(*known, fresh);
    known->known_to_rad = std::fmax(known->known_to_rad, fresh.known_to_rad + apart_rad(*known, fresh));
  }

  const SensorArray& array_;
  const SensorArray& shown_;
  double tolerance_rad_;
  std::array<int, 3> base_;
  std::vector<Mat3> tried_;  ///< parallel axes give the same turn many times
  std::vector<UnseenWiring> found_;
};

/// Of the direction that the right wiring shows from what any of the others shows; the least of them.
double separation_rad(const Vec3& down, const WiringCheck& check) {
  double out = kPi;
  for (const std::size_t k : check.left)
    out = std::fmin(out, angle_between_rad(down, times(check.unseen[k].turn, down)));
  return out;
}

SeparatingAttitude best_attitude(const WiringCheck& check, const Mat3& frame) {
  SeparatingAttitude out;
  for (int inclination = kGridStep_deg; inclination < 180; inclination += kGridStep_deg) {
    for (int toolface = 0; toolface < 360; toolface += kGridStep_deg) {
      io::KnownAttitude one;
      one.inclination_rad = rad_from_deg(inclination);
      one.toolface_rad = rad_from_deg(toolface);
      const double apart_deg = deg_from_rad(separation_rad(down_of(one, frame), check));
      if (!(apart_deg > out.separation_deg + 1e-6)) continue;
      out = {static_cast<double>(inclination), static_cast<double>(toolface), apart_deg};
    }
  }
  return out;
}

/// Within the tolerance of each, or `least_rad` where that is more.
bool explains(const Mat3& turn, double least_rad, const std::vector<MeasuredAttitude>& measured, const Mat3& frame) {
  return std::all_of(measured.begin(), measured.end(), [&](const MeasuredAttitude& m) {
    const double most_rad = std::fmax(least_rad, m.stated.tolerance_rad);
    return angle_between_rad(m.down, times(turn, down_of(m.stated, frame))) <= most_rad;
  });
}

/// Of the axes of the fit, where there is one, and of the datasheet's.
std::vector<UnseenWiring> all_unseen(const SensorArray& nominal, const SensorArray* fitted) {
  std::vector<UnseenWiring> out;
  if (fitted != nullptr && fitted->size() == nominal.size()) out = unseen_wirings(nominal, *fitted, kUnseenAxis_rad);
  for (const UnseenWiring& one : unseen_wirings(nominal, nominal, kUnseenAxis_rad)) {
    if (std::none_of(out.begin(), out.end(), [&one](const UnseenWiring& known) { return same_turn(known, one); }))
      out.push_back(one);
  }
  return out;
}

}  // namespace

std::optional<Mat3> unseen_turn(const SensorArray& nominal, const SensorArray& shown, const Wiring& wiring,
                                double tolerance_rad) noexcept {
  Mat3 sum{};
  for (int i = 0; i < nominal.size(); ++i) add_outer(shown.axis(i), wired_axis(nominal, wiring, i), sum);
  if (!(std::fabs(det_of(sum)) > kSingular)) return std::nullopt;
  const Mat3 turn = nearest_orthogonal(sum);
  if (misfit_rad(nominal, shown, wiring, turn) > tolerance_rad) return std::nullopt;
  return angle_of_turn(turn) > kSameTurn_rad ? std::optional<Mat3>(turn) : std::nullopt;
}

std::vector<UnseenWiring> unseen_wirings(const SensorArray& nominal, const SensorArray& shown, double tolerance_rad) {
  return Search(nominal, shown, tolerance_rad).find();
}

const char* to_string(WiringStatus status) noexcept {
  switch (status) {
    case WiringStatus::open: return "open";
    case WiringStatus::confirmed: return "confirmed";
    case WiringStatus::contradicted: return "contradicted";
  }
  return "?";
}

WiringCheck check_wiring(const io::ArrayFile& array, const SensorArray* fitted,
                         std::vector<MeasuredAttitude> measured) {
  WiringCheck out;
  out.unseen = all_unseen(array.array, fitted);
  out.measured = std::move(measured);
  const double turned_rad = fitted != nullptr ? norm(turn_from_datasheet(array.datasheet, *fitted)) : 0.0;
  for (std::size_t k = 0; k < out.unseen.size(); ++k) {
    if (explains(out.unseen[k].turn, out.unseen[k].known_to_rad + turned_rad, out.measured, array.output_frame))
      out.left.push_back(k);
  }
  if (!explains(io::kIdentity3, 0.0, out.measured, array.output_frame)) {
    out.status = WiringStatus::contradicted;
  } else {
    out.status = out.left.empty() ? WiringStatus::confirmed : WiringStatus::open;
  }
  if (!out.left.empty()) out.take = best_attitude(out, array.output_frame);
  return out;
}

tl::expected<std::vector<MeasuredAttitude>, io::KnownAttitude> measured_attitudes(
    const std::vector<io::KnownAttitude>& known, const std::vector<Vec3>& down) {
  std::vector<MeasuredAttitude> out;
  for (const io::KnownAttitude& one : known) {
    const auto k = static_cast<std::size_t>(one.station - 1);
    if (one.station < 1 || k >= down.size() || !(norm(down[k]) > 0.0)) return tl::unexpected<io::KnownAttitude>(one);
    out.push_back({one, down[k]});
  }
  return out;
}

std::vector<MeasuredAttitude> measured_attitudes_of(const io::CalibrationFile* file, const io::ArrayFile& array) {
  std::vector<MeasuredAttitude> measured;
  if (file != nullptr) {
    std::vector<io::KnownAttitude> known = file->context.known_attitudes;
    io::add_known(array.input.known_attitudes, known);
    for (const io::KnownAttitude& one : known) {
      if (const auto found = measured_attitudes({one}, file->context.down)) measured.push_back(found->front());
    }
  }
  return measured;
}

WiringCheck check_wiring_of(const io::CalibrationFile* file, const io::ArrayFile& array) {
  return check_wiring(array, file != nullptr ? &file->calibration.array : nullptr, measured_attitudes_of(file, array));
}

}  // namespace findings
}  // namespace PLUMB_ABI
}  // namespace plumb
