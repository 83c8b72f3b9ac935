#include "plumb/array/sensor_array.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "linear.hpp"
#include "plumb/core/detail/numbers.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

using numbers::at;

namespace {

constexpr int pairs_of(int n) noexcept { return n * (n - 1) / 2; }

/// The id as it will be compared and printed: always terminated, nothing behind the terminator.
SensorId canonical(const SensorId& id) noexcept {
  SensorId out{};
  for (std::size_t i = 0; i + 1 < id.size() && id[i] != '\0'; ++i) out[i] = id[i];
  return out;
}

Error check_row(const SensorRow& row, int i) noexcept {
  if (row.id[0] == '\0') return Error{Errc::empty_id, i, 0.0, 0.0};
  for (const double h : row.axis) {
    if (!std::isfinite(h)) return Error{Errc::not_finite, i, h, 0.0};
  }
  const double length = norm(row.axis);
  if (!(std::fabs(length - 1.0) <= kAxisLengthTolerance)) return Error{Errc::axis_not_unit, i, length, 1.0};
  if (!std::isfinite(row.sigma_mps2)) return Error{Errc::not_finite, i, row.sigma_mps2, 0.0};
  // A subnormal sigma is positive, yet its reciprocal, the weight of the row, is not a number.
  if (!(row.sigma_mps2 >= std::numeric_limits<double>::min())) {
    return Error{Errc::sigma_not_positive, i, row.sigma_mps2, 0.0};
  }
  return Error{};
}

Triple make_triple(const Vec3& a, const Vec3& b, const Vec3& c, TripleForm& form) noexcept {
  Triple t;
  t.det = det3(a, b, c);
  array_detail::Rows rows;
  rows.add(a);
  rows.add(b);
  rows.add(c);
  const Vec3 s = array_detail::singular_values(rows);
  if (!(s[2] >= array_detail::kRankTolerance)) {
    t.condition = std::numeric_limits<double>::infinity();
    return t;
  }
  t.condition = s[0] / s[2];
  t.votes = std::fabs(t.det) >= kMinTripleDet;
  const auto w = array_detail::inverse_columns(a, b, c, t.det);
  form = {dot(w[0], w[0]),       dot(w[1], w[1]),       dot(w[2], w[2]),
          2.0 * dot(w[0], w[1]), 2.0 * dot(w[0], w[2]), 2.0 * dot(w[1], w[2])};
  return t;
}

Error check_rows(const SensorRow* rows, int n) noexcept {
  if (n < 3 || rows == nullptr) return Error{Errc::too_few_sensors, -1, rows == nullptr ? 0.0 : n, 3.0};
  if (n > kCapacity) return Error{Errc::too_many_sensors, -1, 1.0 * n, 1.0 * kCapacity};
  array_detail::Rows h;
  for (int i = 0; i < n; ++i) {
    const Error wrong = check_row(rows[i], i);
    if (wrong.code != Errc::ok) return wrong;
    for (int k = 0; k < i; ++k) {
      if (canonical(rows[k].id) == canonical(rows[i].id)) return Error{Errc::duplicate_id, i};
    }
    h.add(rows[i].axis);
  }
  const Vec3 s = array_detail::singular_values(h);
  if (!(s[2] >= array_detail::kRankTolerance)) {
    return Error{Errc::axes_rank_deficient, -1, s[2], array_detail::kRankTolerance};
  }
  return Error{};
}

}  // namespace

TripleForm SensorArray::form(int k) const noexcept {
  TripleForm out{};
  for (std::size_t c = 0; c < out.size(); ++c) out[c] = form_[c][at(k)];
  return out;
}

SensorId make_id(const char* text) noexcept {
  SensorId id{};
  if (text == nullptr) return id;
  for (std::size_t i = 0; i + 1 < id.size() && text[i] != '\0'; ++i) id[i] = text[i];
  return id;
}

// All sixteen are made below: clearing them first costs as much.
// NOLINTNEXTLINE(cppcoreguidelines-pro-type-member-init,hicpp-member-init)
AttitudeProducts::AttitudeProducts(const Vec3& g_mps2) noexcept {
  const std::array<double, 4> z = {g_mps2[0], g_mps2[1], g_mps2[2], 1.0};
  for (std::size_t p = 0; p < 4; ++p) {
    for (std::size_t q = 0; q < 4; ++q) value[4 * p + q] = z[p] * z[q];
  }
}

double RowUncertainty::at(int i, int j, const AttitudeProducts& attitude) const noexcept {
  const double misfit = i == j ? misfit_mps2[numbers::at(i)] : 0.0;
  return of_parameters_at(i, j, attitude) + misfit * misfit;
}

double RowUncertainty::of_parameters_at(int i, int j, const AttitudeProducts& attitude) const noexcept {
  const std::size_t rows = 4 * numbers::at(i >= j ? i : j), columns = 4 * numbers::at(i >= j ? j : i);
  std::size_t at = rows * (rows + 1) / 2 + columns;
  double sum = 0.0;
  for (std::size_t p = 0; p < 4; at += rows + ++p) {
    const double *const row = &covariance[at], *const product = &attitude.value[4 * p];
    if (i != j) {
      // Written out: it runs for every pair of sensors of every set of a block.
      sum += product[0] * row[0];
      sum += product[1] * row[1];
      sum += product[2] * row[2];
      sum += product[3] * row[3];
    } else {
      for (std::size_t q = 0; q < p; ++q) sum += 2.0 * product[q] * row[q];
      sum += product[p] * row[p];
    }
  }
  return sum;
}

bool RowUncertainty::is_zero(int sensors) const noexcept {
  const auto zero = [](double v) { return v == 0.0; };
  return zero(common_scale) && std::all_of(covariance.begin(), covariance.begin() + packed_size(sensors), zero) &&
         std::all_of(misfit_mps2.begin(), misfit_mps2.begin() + sensors, zero);
}

SensorSet RowUncertainty::without_variance(int sensors) const noexcept {
  constexpr double kNone = 1e-18;  // 1e-9 rad, relative, m/s^2, squared: no calibration knows a sensor so well
  SensorSet out;
  for (int i = 0; i < sensors; ++i) {
    const auto variance = [this, i](int p) {
      return covariance[numbers::at((4 * i + p) * (4 * i + p + 1) / 2 + 4 * i + p)];
    };
    const double of_row = variance(0) + variance(1) + variance(2);
    if (!(of_row > kNone && variance(3) > kNone)) out = out.with(i);
  }
  return out;
}

bool RowUncertainty::is_covariance() const noexcept {
  constexpr double kLeastShare = 1e-6, kMostVariance = 1e12;
  const auto entry = [this](int a, int b) { return covariance[numbers::at(a * (a + 1) / 2 + b)]; };
  double largest = 0.0;
  for (int a = 0; a < 4 * kCapacity; ++a) largest = std::fmax(largest, entry(a, a));
  if (!(largest <= kMostVariance) || !(common_scale >= 0.0 && common_scale <= 1.0)) return false;
  const double floor = kLeastShare * kLeastShare * largest;
  for (int a = 0; a < 4 * kCapacity; ++a) {
    if (!(entry(a, a) >= -floor)) return false;
    for (int b = 0; b < a; ++b) {
      const double square = entry(a, b) * entry(a, b);
      if (!(square <= (1.0 + kLeastShare) * entry(a, a) * entry(b, b) + largest * floor)) return false;
    }
  }
  return std::all_of(misfit_mps2.begin(), misfit_mps2.end(),
                     [](double sigma) { return sigma >= 0.0 && sigma * sigma <= kMostVariance; });
}

Expected<SensorArray> SensorArray::make(const SensorRow* rows, int n) noexcept {
  const Error wrong = check_rows(rows, n);
  if (wrong.code != Errc::ok) return tl::unexpected<Error>(wrong);
  SensorArray array;
  array.size_ = n;
  for (int i = 0; i < n; ++i) {
    array.rows_[at(i)] = rows[i];
    array.rows_[at(i)].id = canonical(rows[i].id);
  }
  array.derive();
  array.see_what_is_exact();
  return array;
}

Expected<void> SensorArray::set_rows(const SensorRow* rows) noexcept {
  const Error wrong = check_rows(rows, size_);
  if (wrong.code != Errc::ok) return tl::unexpected<Error>(wrong);
  for (int i = 0; i < size_; ++i) {
    rows_[at(i)] = rows[i];
    rows_[at(i)].id = canonical(rows[i].id);
  }
  derive();
  return {};
}

/// What the axes make of the triples, and the chips of the units.
void SensorArray::derive() noexcept {
  units_ = SensorUnits::of_chips(size_, [this](int i) { return row(i).chip; });
  std::size_t next = 0;
  for (int i = 0; i < size_; ++i) {
    for (int j = i + 1; j < size_; ++j) {
      for (int k = j + 1; k < size_; ++k) {
        Triple& t = triples_[next];
        TripleForm form{};
        t = make_triple(axis(i), axis(j), axis(k), form);
        t.sensors = {static_cast<std::uint8_t>(i), static_cast<std::uint8_t>(j), static_cast<std::uint8_t>(k)};
        for (std::size_t c = 0; c < form.size(); ++c) form_[c][next] = form[c];
        ++next;
      }
    }
  }
}

double SensorArray::row_covariance(int a, int b) const noexcept {
  const double own = uncertainty_.covariance[at(a >= b ? a * (a + 1) / 2 + b : b * (b + 1) / 2 + a)];
  if (a % 4 == 3 || b % 4 == 3) return own;
  const double share = uncertainty_.common_scale;
  return own + share * share * axis(a / 4)[at(a % 4)] * axis(b / 4)[at(b % 4)];
}

void SensorArray::set_uncertainty(const RowUncertainty& u) noexcept {
  uncertainty_ = u;
  see_what_is_exact();
}

void SensorArray::see_what_is_exact() noexcept {
  perfectly_known_ = uncertainty_.is_zero(size_);
  taken_for_exact_ = uncertainty_.without_variance(size_);
}

void SensorArray::rebuild() noexcept {
  see_what_is_exact();
  if (plausible()) derive();
}

bool SensorArray::plausible() const noexcept { return check_rows(rows_.data(), size_).code == Errc::ok; }

int SensorArray::triple_index(int i, int j, int k) const noexcept {
  if (i < 0 || j <= i || k <= j || k >= size_) return -1;
  // Triples that start below i, then those that start (i, below j), then those (i, j, below k).
  const int before_i = triple_count_of(size_) - triple_count_of(size_ - i);
  const int before_j = pairs_of(size_ - i - 1) - pairs_of(size_ - j);
  return before_i + before_j + (k - j - 1);
}

}  // namespace PLUMB_ABI
}  // namespace plumb
