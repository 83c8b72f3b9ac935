/// What the stations can and cannot see: rank, null directions, posterior covariance with the gauge removed.
#include <cmath>

#include "fit_internal.hpp"
#include "plumb/numeric/cholesky.hpp"
#include "plumb/numeric/symmetric_eigen.hpp"
#include "plumb/numeric/symmetric_eigenvalues.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

using numbers::at;

namespace fit {
namespace {

/// Three directions in parameter space, stored sensor by sensor: the common rotations, that about the roll axis first.
using Directions = std::array<Parameters, 3>;

/// How many of them no station sees: all, or that about the roll axis where roll groups see the others.
std::size_t unseen_rotations(const Roll& roll) noexcept { return roll.used ? 1 : 3; }

double inner(const Parameters& a, const Parameters& b, int n4) noexcept {
  double sum = 0.0;
  for (int k = 0; k < n4; ++k) sum += a[at(k)] * b[at(k)];
  return sum;
}

/// Common rotations dW_i = W_i x e_q, natural units.
Directions rotations(const Roll& roll, const Parameters& theta, int n) noexcept {
  std::array<Vec3, 3> axes = {Vec3{1.0, 0.0, 0.0}, Vec3{0.0, 1.0, 0.0}, Vec3{0.0, 0.0, 1.0}};
  if (roll.used) {
    const Vec3 z = roll.axis;
    const Vec3 across = cross(z, std::fabs(z[0]) < 0.7 ? axes[0] : axes[1]);
    axes = {z, scaled(across, 1.0 / norm(across)), cross(z, scaled(across, 1.0 / norm(across)))};
  }
  Directions out{};
  for (int q = 0; q < 3; ++q) {
    for (int i = 0; i < n; ++i) {
      const Vec3 d = cross(row_of(theta, i), axes[at(q)]);
      for (int p = 0; p < 3; ++p) out[at(q)][at(4 * i + p)] = d[at(p)];
    }
  }
  return out;
}

double reciprocal(double v) noexcept { return v > 0.0 ? 1.0 / v : 0.0; }

/// The rotations in prior units, orthonormal. Frozen parameters (prior sigma zero) are omitted.
Directions gauge_basis(const Datasheet& datasheet, const Directions& rotation) noexcept {
  const int n = datasheet.size;
  Directions out = rotation;
  for (std::size_t q = 0; q < 3; ++q) {
    for (int i = 0; i < n; ++i) {
      const DatasheetSensor& s = datasheet.sensor[at(i)];
      const double across = reciprocal(s.prior.axis_rad);
      const Vec3 d = row_of(out[q], i);
      const double along = dot(s.row.axis, d) * (reciprocal(s.prior.scale) - across);
      for (int p = 0; p < 3; ++p) out[q][at(4 * i + p)] = across * d[at(p)] + along * s.row.axis[at(p)];
    }
    for (std::size_t r = 0; r < q; ++r) {
      const double shared = inner(out[r], out[q], 4 * n);
      for (int k = 0; k < 4 * n; ++k) out[q][at(k)] -= shared * out[r][at(k)];
    }
    const double length = reciprocal(std::sqrt(inner(out[q], out[q], 4 * n)));
    for (int k = 0; k < 4 * n; ++k) out[q][at(k)] *= length;
  }
  return out;
}

/// Information about a direction of unit length.
double information_along(const double* information, const Parameters& v, int n4) noexcept {
  double sum = 0.0;
  for (int i = 0; i < n4; ++i) {
    double row = 0.0;
    for (int j = 0; j < n4; ++j) row += information[i * n4 + j] * v[at(j)];
    sum += v[at(i)] * row;
  }
  return sum;
}

void mirror(double* m, int n4) noexcept {
  for (int i = 0; i < n4; ++i) {
    for (int j = i + 1; j < n4; ++j) m[i * n4 + j] = m[j * n4 + i];
  }
}

/// (information + 1)^-1 in prior units, lower triangle given, both triangles left. False where it is not positive.
bool invert(double* information, int n4) noexcept {
  for (int k = 0; k < n4; ++k) information[k * n4 + k] += 1.0;
  if (!cholesky_factor(information, n4, n4)) return false;
  cholesky_inverse(information, n4, n4);
  return true;
}

/// The same from the eigenvectors.
void posterior(const Parameters& values, const double* vectors, int n4, double* out) noexcept {
  for (int i = 0; i < n4; ++i) {
    Parameters weighted;
    for (int k = 0; k < n4; ++k) weighted[at(k)] = vectors[i * n4 + k] / (1.0 + std::fmax(values[at(k)], 0.0));
    for (int j = 0; j <= i; ++j) {
      double sum = 0.0;
      for (int k = 0; k < n4; ++k) sum += weighted[at(k)] * vectors[j * n4 + k];
      out[i * n4 + j] = sum;
    }
  }
  mirror(out, n4);
}

/// S C S, block by block.
void to_natural(const PriorRoots& roots, int n, double* m) noexcept {
  const int n4 = 4 * n;
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j <= i; ++j) {
      double* block = m + at(4 * i * n4 + 4 * j);
      for (std::size_t q = 0; q < 4; ++q) {
        const std::size_t s = at(n4);
        const Vec3 column = times(roots[at(i)].axes, Vec3{block[q], block[s + q], block[2 * s + q]});
        for (std::size_t p = 0; p < 3; ++p) block[p * s + q] = column[p];
        block[3 * s + q] *= roots[at(i)].bias;
      }
      for (std::size_t p = 0; p < 4; ++p) {
        double* line = block + p * at(n4);
        const Vec3 along = times(roots[at(j)].axes, Vec3{line[0], line[1], line[2]});
        for (std::size_t q = 0; q < 3; ++q) line[q] = along[q];
        line[3] *= roots[at(j)].bias;
      }
    }
  }
  mirror(m, n4);
}

/// K = R (R'R)^-1, so that 1 - K R' takes the best common rotation out of a parameter error. This is the
/// rotation that `turn_to_datasheet` settles afterwards: the covariance is that of the turned axes.
Directions removal(const Directions& rotation, std::size_t unseen, int n4) noexcept {
  Directions out{};
  if (unseen == 1) {
    const double share = reciprocal(inner(rotation[0], rotation[0], n4));
    for (int k = 0; k < n4; ++k) out[0][at(k)] = share * rotation[0][at(k)];
    return out;
  }
  const Symmetric3 gram = {inner(rotation[0], rotation[0], n4), inner(rotation[0], rotation[1], n4),
                           inner(rotation[0], rotation[2], n4), inner(rotation[1], rotation[1], n4),
                           inner(rotation[1], rotation[2], n4), inner(rotation[2], rotation[2], n4)};
  for (int k = 0; k < n4; ++k) {
    const Vec3 row = solve(gram, Vec3{rotation[0][at(k)], rotation[1][at(k)], rotation[2][at(k)]});
    for (std::size_t q = 0; q < 3; ++q) out[q][at(k)] = row[q];
  }
  return out;
}

/// (1 - K R') C (1 - R K') = C - K Y' - Y K' + K Z K' with Y = C R, Z = R'C R.
void remove_gauge(const Directions& rotation, const Directions& k, std::size_t unseen, int n4, double* c) noexcept {
  Directions y{};
  for (std::size_t q = 0; q < unseen; ++q) {
    for (int j = 0; j < n4; ++j) {
      for (int i = 0; i < n4; ++i) y[q][at(i)] += c[j * n4 + i] * rotation[q][at(j)];
    }
  }
  // Half of Z goes with either side: y <- Y - K Z / 2.
  Directions half = y;
  for (std::size_t q = 0; q < unseen; ++q) {
    for (std::size_t r = 0; r < unseen; ++r) {
      const double z = 0.5 * inner(rotation[r], y[q], n4);
      for (int i = 0; i < n4; ++i) half[q][at(i)] -= z * k[r][at(i)];
    }
  }
  for (int i = 0; i < n4; ++i) {
    for (int j = 0; j <= i; ++j) {
      double sum = c[i * n4 + j];
      for (std::size_t q = 0; q < unseen; ++q) sum -= k[q][at(i)] * half[q][at(j)] + half[q][at(i)] * k[q][at(j)];
      c[i * n4 + j] = sum;
    }
  }
  mirror(c, n4);
}

/// Prior variance of every parameter with the same gauge removed.
Parameters prior_variance(const PriorRoots& roots, const Directions& rotation, const Directions& k, std::size_t unseen,
                          int n) noexcept {
  const int n4 = 4 * n;
  Parameters out;
  Directions y;
  std::array<std::array<double, 3>, 3> z{};
  for (std::size_t q = 0; q < unseen; ++q) {
    y[q] = times_roots(roots, n, times_roots(roots, n, rotation[q]));
    for (std::size_t r = 0; r < unseen; ++r) z[r][q] = inner(rotation[r], y[q], n4);
  }
  for (int i = 0; i < n4; ++i) {
    const Symmetric3& a = roots[at(i / 4)].axes;
    const std::array<double, 4> own = {a[0] * a[0] + a[1] * a[1] + a[2] * a[2], a[1] * a[1] + a[3] * a[3] + a[4] * a[4],
                                       a[2] * a[2] + a[4] * a[4] + a[5] * a[5],
                                       roots[at(i / 4)].bias * roots[at(i / 4)].bias};
    double variance = own[at(i % 4)];
    for (std::size_t q = 0; q < unseen; ++q) {
      variance -= 2.0 * k[q][at(i)] * y[q][at(i)];
      for (std::size_t r = 0; r < unseen; ++r) variance += k[q][at(i)] * k[r][at(i)] * z[q][r];
    }
    out[at(i)] = std::fmax(variance, 0.0);
  }
  return out;
}

/// Takes the directions of `basis` out of column c of `vectors`.
void orthogonalise(const Parameters& basis, double* vectors, int n4, int c) noexcept {
  double shared = 0.0;
  for (int k = 0; k < n4; ++k) shared += basis[at(k)] * vectors[k * n4 + c];
  for (int k = 0; k < n4; ++k) vectors[k * n4 + c] -= shared * basis[at(k)];
}

double column_length(const double* vectors, int n4, int c) noexcept {
  double sum = 0.0;
  for (int k = 0; k < n4; ++k) sum += vectors[k * n4 + c] * vectors[k * n4 + c];
  return std::sqrt(sum);
}

/// Null eigenvectors (the first `null` columns) less the gauge: the longest remainder first, so that what
/// the gauge used up is never mistaken for a direction.
void keep_null_directions(const Directions& gauge, std::size_t unseen, int n4, int null, double* vectors,
                          FitReport& report) noexcept {
  for (int c = 0; c < null; ++c) {
    for (std::size_t q = 0; q < unseen && report.gauge > 0; ++q) orthogonalise(gauge[q], vectors, n4, c);
  }
  const int kept = report.null_directions < kMaxNullDirections ? report.null_directions : kMaxNullDirections;
  for (int d = 0; d < kept; ++d) {
    int longest = 0;
    for (int c = 1; c < null; ++c) {
      if (column_length(vectors, n4, c) > column_length(vectors, n4, longest)) longest = c;
    }
    const double scale = reciprocal(column_length(vectors, n4, longest));
    Parameters& direction = report.null_direction[at(d)].component;
    for (int k = 0; k < n4; ++k) direction[at(k)] = scale * vectors[k * n4 + longest];
    for (int c = 0; c < null; ++c) orthogonalise(direction, vectors, n4, c);
  }
}

void count_rank(const Parameters& values, const Vec3& along_gauge, std::size_t unseen, int n4, double floor,
                FitReport& report) noexcept {
  const double largest = values[at(n4 - 1)];
  report.rank = 0;
  report.gauge = 0;
  const double threshold = floor * largest;
  for (int k = n4 - 1; k >= 0 && largest > 0.0; --k) {
    if (!(values[at(k)] > threshold)) break;
    ++report.rank;
    report.condition = std::sqrt(largest / values[at(k)]);
  }
  for (std::size_t q = 0; q < unseen; ++q) {
    if (along_gauge[q] <= threshold) ++report.gauge;
  }
  if (report.gauge > n4 - report.rank) report.gauge = n4 - report.rank;
  report.null_directions = n4 - report.rank - report.gauge;
}

}  // namespace

bool analyse(const Datasheet& datasheet, const Roll& roll, const PriorRoots& roots, const Parameters& theta,
             double floor, double* information, double* scratch, FitReport& report) noexcept {
  const int n = datasheet.size;
  const int n4 = 4 * n;
  mirror(information, n4);
  const std::size_t unseen = unseen_rotations(roll);
  const Directions rotation = rotations(roll, theta, n);
  const Directions gauge = gauge_basis(datasheet, rotation);
  Vec3 along_gauge{};
  for (std::size_t q = 0; q < unseen; ++q) along_gauge[q] = information_along(information, gauge[q], n4);
  for (int k = 0; k < n4 * n4; ++k) scratch[k] = information[k];
  Parameters values;
  if (!symmetric_eigenvalues(scratch, n4, n4, values.data())) return false;
  count_rank(values, along_gauge, unseen, n4, floor, report);
  if (report.null_directions == 0) {
    if (!invert(information, n4)) return false;
  } else {
    // Directions are wanted, and the small values with their own accuracy.
    if (!symmetric_eigen(information, n4, n4, values.data(), scratch)) return false;
    count_rank(values, along_gauge, unseen, n4, floor, report);
    posterior(values, scratch, n4, information);
    keep_null_directions(gauge, unseen, n4, n4 - report.rank, scratch, report);
  }
  to_natural(roots, n, information);
  const Directions k = removal(rotation, unseen, n4);
  remove_gauge(rotation, k, unseen, n4, information);
  const Parameters prior = prior_variance(roots, rotation, k, unseen, n);
  for (int i = 0; i < n4; ++i) {
    const double variance = std::fmax(information[i * n4 + i], 0.0);
    report.sigma[at(i)] = std::sqrt(variance);
    report.data_share[at(i)] = std::fmax(1.0 - variance * reciprocal(prior[at(i)]), 0.0);
    if (!(prior[at(i)] > 0.0)) report.data_share[at(i)] = 0.0;
  }
  return true;
}

int rank_of_held(const Datasheet& datasheet, const double* blocks, double floor) noexcept {
  constexpr int kStride = 2 * kCapacity;
  std::array<double, std::size_t{kStride} * kStride> information{};
  const int n2 = 2 * datasheet.size;
  for (int i = 0; i < datasheet.size; ++i) {
    for (int j = 0; j <= i; ++j) {
      const DatasheetSensor& a = datasheet.sensor[at(i)];
      const DatasheetSensor& b = datasheet.sensor[at(j)];
      const double* m = blocks + at(kMomentCount * (i * (i + 1) / 2 + j));  // xx xy xz x yy yz y zz z 1
      const Vec3 first = {m[3], m[6], m[8]};
      const Vec3 across = times(Symmetric3{m[0], m[1], m[2], m[4], m[5], m[7]}, b.row.axis);
      const std::size_t p = at(2 * i), q = at(2 * j), s = at(kStride);
      information[p * s + q] = a.prior.scale * b.prior.scale * dot(a.row.axis, across);
      information[p * s + q + 1] = a.prior.scale * b.prior.bias_mps2 * dot(a.row.axis, first);
      information[(p + 1) * s + q] = a.prior.bias_mps2 * b.prior.scale * dot(b.row.axis, first);
      information[(p + 1) * s + q + 1] = a.prior.bias_mps2 * b.prior.bias_mps2 * m[9];
    }
  }
  for (int i = 0; i < n2; ++i) {
    for (int j = i + 1; j < n2; ++j) information[at(i * kStride + j)] = information[at(j * kStride + i)];
  }
  std::array<double, kStride> values{};
  if (!symmetric_eigenvalues_of_few(information.data(), n2, kStride, values.data())) return -1;
  int rank = 0;
  for (int k = 0; k < n2; ++k) {
    if (values[at(k)] > floor * values[at(n2 - 1)]) ++rank;
  }
  return rank;
}

void inflate(double factor, int n4, double* covariance, FitReport& report) noexcept {
  for (int k = 0; k < n4 * n4; ++k) covariance[k] *= factor;
  for (int k = 0; k < n4; ++k) report.sigma[at(k)] *= std::sqrt(factor);
}

}  // namespace fit
}  // namespace PLUMB_ABI
}  // namespace plumb
