#include "plumb/scenario/random.hpp"

#include <Random123/philox.h>

#include <cstring>

#include "philox_many.hpp"
#include "plumb/scenario/portable_math.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace scenario {
namespace {

constexpr int kLayers = 256;
/// Start of the tail and area of a layer, for 256 layers of equal area under exp(-x^2/2); the area is
/// r exp(-r^2/2) + sqrt(pi/2) erfc(r/sqrt 2), evaluated with 40 digits.
constexpr double kTail = 3.6541528853610088;
constexpr double kArea = 0.004928673233974655;

constexpr double half_square_exp(double x) noexcept { return portable_exp(-0.5 * x * x); }

/// Square root for the tables only (std::sqrt is not constexpr).
constexpr double table_sqrt(double x) noexcept {
  double root = x > 1.0 ? x : 1.0;
  for (int i = 0; i < 40; ++i) root = 0.5 * (root + x / root);
  return root;
}

/// Layer i reaches from x[i+1] to x[i]; layer 0 is the base with the tail, given the width kArea/f(r).
struct Ziggurat {
  double x[kLayers + 1] = {};
  double f[kLayers + 1] = {};
  double closure = 0.0;  ///< f at the top as the recursion gives it: 1 if r and the area are right
};

constexpr Ziggurat make_ziggurat() noexcept {
  Ziggurat z{};
  z.x[0] = kArea / half_square_exp(kTail);
  z.f[0] = half_square_exp(z.x[0]);
  z.x[1] = kTail;
  z.f[1] = half_square_exp(kTail);
  for (int i = 2; i < kLayers; ++i) {
    z.x[i] = table_sqrt(-2.0 * portable_log(kArea / z.x[i - 1] + z.f[i - 1]));
    z.f[i] = half_square_exp(z.x[i]);
  }
  z.closure = kArea / z.x[kLayers - 1] + z.f[kLayers - 1];
  z.f[kLayers] = 1.0;
  return z;
}

constexpr Ziggurat kZiggurat = make_ziggurat();
static_assert(kZiggurat.closure > 1.0 - 1e-12 && kZiggurat.closure < 1.0 + 1e-12, "the layers must close at x = 0");

constexpr double kTwoToMinus53 = 1.0 / 9007199254740992.0;

/// In [0, 1), from the upper 53 bits.
double unit_of(std::uint64_t word) noexcept { return static_cast<double>(word >> 11U) * kTwoToMinus53; }
/// In (0, 1], for logarithms.
double positive_unit_of(std::uint64_t word) noexcept { return static_cast<double>((word >> 11U) + 1U) * kTwoToMinus53; }

/// Bit 8 of the word becomes the sign of x >= 0, without a branch that half of all numbers would miss.
double with_sign(double x, std::uint64_t word) noexcept {
  std::uint64_t bits = 0;
  std::memcpy(&bits, &x, sizeof bits);
  bits |= (word & 0x100U) << 55U;
  std::memcpy(&x, &bits, sizeof bits);
  return x;
}

/// Attempts share a counter word with the kind. One attempt fails in 1.2 % of cases, so the bound is
/// never met; it is there to make the loop total.
constexpr std::uint32_t kMaxAttempts = 1U << 20U;

}  // namespace

std::array<std::uint32_t, 4> philox_block(const std::array<std::uint32_t, 4>& counter,
                                          const std::array<std::uint32_t, 2>& key) noexcept {
  const r123::Philox4x32::ctr_type c = {{counter[0], counter[1], counter[2], counter[3]}};
  const r123::Philox4x32::key_type k = {{key[0], key[1]}};
  const r123::Philox4x32::ctr_type r = r123::Philox4x32()(c, k);
  return {r[0], r[1], r[2], r[3]};
}

Stream::Stream(std::uint64_t seed, Purpose purpose, std::uint32_t sub) noexcept
    : seed_(seed), id_(static_cast<std::uint32_t>(purpose) << 24U | (sub & 0xFFFFFFU)) {}

Stream::Block Stream::block(std::uint64_t index, Kind kind, std::uint32_t attempt) const noexcept {
  const auto low = [](std::uint64_t v) { return static_cast<std::uint32_t>(v); };
  const auto high = [](std::uint64_t v) { return static_cast<std::uint32_t>(v >> 32U); };
  const std::uint32_t selector = static_cast<std::uint32_t>(kind) << 24U | attempt;
  const auto w = philox_block({low(index), high(index), selector, id_}, {low(seed_), high(seed_)});
  return {std::uint64_t{w[0]} | std::uint64_t{w[1]} << 32U, std::uint64_t{w[2]} | std::uint64_t{w[3]} << 32U};
}

std::uint64_t Stream::bits(std::uint64_t index) const noexcept { return block(index, Kind::bits, 0).first; }

double Stream::uniform(std::uint64_t index) const noexcept { return unit_of(block(index, Kind::uniform, 0).first); }

double Stream::uniform(std::uint64_t index, double low, double high) const noexcept {
  const double u = uniform(index);
  return low * (1.0 - u) + high * u;  // this form cannot leave [low, high] by more than rounding
}

double Stream::normal(std::uint64_t index) const noexcept { return normal_from(block(index, Kind::normal, 0), index); }

/// `first` is the block of the first attempt.
double Stream::normal_from(const Block& first, std::uint64_t index) const noexcept {
  // Layer, sign and abscissa come from disjoint bits of one word (the classical code reuses them,
  // which correlates the layer with the value), the ordinate of the wedge test from the other word.
  Block b = first;
  for (std::uint32_t attempt = 1; attempt <= kMaxAttempts; ++attempt) {
    const auto layer = static_cast<std::size_t>(b.first & 0xFFU);
    const double sign = (b.first & 0x100U) != 0 ? -1.0 : 1.0;
    const double x = unit_of(b.first) * kZiggurat.x[layer];
    if (x < kZiggurat.x[layer + 1]) return sign * x;
    if (layer == 0) return sign * normal_tail(index, attempt);
    const double bottom = kZiggurat.f[layer];
    const double y = bottom + unit_of(b.second) * (kZiggurat.f[layer + 1] - bottom);
    if (y < half_square_exp(x)) return sign * x;
    b = block(index, Kind::normal, attempt);
  }
  return 0.0;
}

void Stream::normals(std::uint64_t first, int count, double* out) const noexcept {
  constexpr int kAtOnce = 64;
  PhiloxLanes<std::size_t{kAtOnce}> lanes;
  const PhiloxKey key = {static_cast<std::uint32_t>(seed_), static_cast<std::uint32_t>(seed_ >> 32U)};
  const std::uint32_t selector = static_cast<std::uint32_t>(Kind::normal) << 24U;
  for (int done = 0; done < count; done += kAtOnce) {
    const std::uint64_t from = first + static_cast<std::uint64_t>(done);
    philox_many(from, selector, id_, key, lanes);
    const int more = count - done < kAtOnce ? count - done : kAtOnce;
    for (int k = 0; k < more; ++k) {
      const auto a = static_cast<std::size_t>(k);
      const Block b = {lanes.first[a], lanes.second[a]};
      const auto layer = static_cast<std::size_t>(b.first & 0xFFU);
      const double x = unit_of(b.first) * kZiggurat.x[layer];
      out[done + k] =
          x < kZiggurat.x[layer + 1] ? with_sign(x, b.first) : normal_from(b, from + static_cast<std::uint64_t>(k));
    }
  }
}

/// Marsaglia's tail beyond r: exponential with rate r, accepted against the normal density.
double Stream::normal_tail(std::uint64_t index, std::uint32_t attempt) const noexcept {
  for (; attempt < kMaxAttempts; ++attempt) {
    const Block b = block(index, Kind::normal, attempt);
    const double x = -portable_log(positive_unit_of(b.first)) / kTail;
    const double y = -portable_log(positive_unit_of(b.second));
    if (y + y >= x * x) return kTail + x;
  }
  return kTail;
}

Vec3 Stream::direction(std::uint64_t index) const noexcept {
  const Vec3 v = {normal(3 * index), normal(3 * index + 1), normal(3 * index + 2)};
  const double length = norm(v);
  return length > 0.0 ? Vec3{v[0] / length, v[1] / length, v[2] / length} : Vec3{0.0, 0.0, 1.0};
}

std::uint64_t derive_seed(std::uint64_t seed, std::uint64_t index) noexcept {
  return Stream(seed, Purpose::seed).bits(index);
}

}  // namespace scenario
}  // namespace PLUMB_ABI
}  // namespace plumb
