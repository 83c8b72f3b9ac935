// The isolation rule against a second one, written from the design's text over plain sets: every subset is asked, in no
// order and without a short cut, and what died is kept in a std::set. Both answer the same evidence.
// Serves: REQ-061, REQ-070, REQ-072, REQ-073, REQ-075, REQ-121
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "detection/mirrored_oracle.hpp"
#include "plumb/detection/estimate_error.hpp"
#include "plumb/detection/isolation.hpp"
#include "support/simulated_tool.hpp"

namespace isolation_oracle_test {
namespace {

using namespace plumb;
using plumb_test::Noise;

constexpr double kSigma = 2e-4 * kG0_mps2;

std::vector<SensorSet> subsets(SensorSet of, int from, int to) {
  std::vector<SensorSet> out;
  for (std::uint32_t bits = 0; bits <= of.bits; ++bits) {
    const SensorSet s(bits);
    if (of.contains(s) && s.size() >= from && s.size() <= to) out.push_back(s);
  }
  return out;
}

/// The wrong gravities that explain what a set was off by at all stations so far.
struct Claim {
  float low = 0, high = 0;
};

/// The rule as the design has it, and what it remembers of an episode.
struct Rule {
  SensorSet monitored;
  int universe = 0, c = 2, size = 3;
  std::set<std::uint32_t> rejected;
  std::map<std::uint32_t, Claim> claims;
  Readings sum{};  ///< of root N times the means of the votes
  double sum_bound = 0.0;
  int sum_votes = 0;

  int strict() const { return std::max(0, monitored.size() - 1 - c); }
  int parity() const { return std::max(0, monitored.size() - 2 - c); }

  void clear() {
    rejected.clear();
    claims.clear();
    sum = Readings{};
    sum_bound = 0.0;
    sum_votes = 0;
  }
  void pose(const SensorArray& array, SensorSet set) {
    const int now = coplanarity(array, set);
    if (now + 1 != size || !monitored.contains(set) || universe != array.size()) clear();
    monitored = set;
    c = now;
    size = c + 1;
    universe = array.size();
  }
  int voting() const { return strict() < 1 ? 0 : static_cast<int>(subsets(monitored, size, size).size()); }
  bool died(SensorSet set) const {
    if (strict() < 1) return false;
    return std::any_of(rejected.begin(), rejected.end(),
                       [&](std::uint32_t bits) { return set.contains(SensorSet(bits)); });
  }
  int live() const {
    if (strict() < 1) return 0;
    int count = 0;
    for (const SensorSet s : subsets(monitored, size, size)) count += rejected.count(s.bits) == 0 ? 1 : 0;
    return count;
  }

  struct Doubt {
    std::vector<SensorSet> sets;
    bool excuses(SensorSet set) const {
      if (sets.size() > 64) return true;
      return std::any_of(sets.begin(), sets.end(), [&](SensorSet s) { return s.contains(set); });
    }
  };
  void add_up(const BlockTests& tests) {
    const SetTest all = tests.of(monitored);
    if (!all.tested || !tests.block().usable.contains(monitored)) return;
    ++sum_votes;
    sum_bound += all.parity_systematic;
    for (std::size_t i = 0; i < sum.size(); ++i)
      sum[i] += std::sqrt(tests.block().samples) * tests.block().mean_mps2[i];
  }
  /// What the votes add up to, against noise and all that is systematic in them.
  bool agrees_in_sum(const BlockTests& tests, SensorSet set) const {
    const LeastSquares fit = least_squares(tests.array(), set);
    if (sum_votes < 2 || !fit.valid) return true;
    const Vec3 x = fit.estimate(sum);
    double square = 0.0;
    for (int i = 0; i < universe; ++i) {
      const double r = (sum[static_cast<std::size_t>(i)] - dot(tests.array().axis(i), x)) / tests.array().sigma_mps2(i);
      if (set.has(i)) square += r * r;
    }
    const double quantile = tests.limits().reject[static_cast<std::size_t>(set.size() - 3)];
    return std::sqrt(square) <= quantile * std::sqrt(sum_votes) + sum_bound;
  }
  static double constant_error(const BlockTests& tests) {
    const double scale = tests.array().uncertainty().common_scale * tests.gravity().g_mps2;
    return 3.0 * (tests.gravity().sigma_mps2 + scale);
  }
  static double margin_of(const BlockTests& tests, const SetTest& t) {
    const double limit = t.norm_reject_limit(tests.limits());
    return std::max(0.0, limit * (t.norm_sigma_mps2 / std::sqrt(tests.block().samples)) - constant_error(tests));
  }
  /// What a set is off by goes on record, beside what is the same everywhere.
  void note_length(const BlockTests& tests, SensorSet set) {
    const SetTest t = tests.of(set);
    const double margin = margin_of(tests, t);
    const bool first = claims.count(set.bits) == 0;
    Claim& claim = claims[set.bits];
    const auto low = static_cast<float>(t.norm_error_mps2 - margin);
    const auto high = static_cast<float>(t.norm_error_mps2 + margin);
    claim.low = first ? low : std::max(claim.low, low);
    claim.high = first ? high : std::min(claim.high, high);
  }
  /// No gravity within its bounds explains what the set was off by at all votes.
  bool contradicts(const BlockTests& tests, SensorSet set, bool record) {
    if (record && tests.of(set).tested) note_length(tests, set);
    const auto known = claims.find(set.bits);
    if (known == claims.end()) return false;
    const double most = constant_error(tests), low = static_cast<double>(known->second.low);
    const auto high = static_cast<double>(known->second.high);
    return low > high || low > most || high < -most;
  }
  bool one_gravity(const BlockTests& tests, bool record) {
    bool holds = tests.limits().acceleration_mps2 > 0.0 && tests.block().usable.contains(monitored);
    for (int i = 0; i < universe; ++i)
      holds = holds && (!monitored.has(i) || tests.block().tolerance_mps2[static_cast<std::size_t>(i)] > 0.0F);
    if (!holds) return false;
    for (const SensorSet s : subsets(monitored, 4, 4)) {
      const SetTest t = tests.of(s);
      if (!t.tested || !t.parity_consistent(tests.limits()) || !agrees_in_sum(tests, s)) continue;
      if (record) note_length(tests, s);
      const double most = constant_error(tests);
      const auto known = claims.find(s.bits);
      const double low = known == claims.end() ? -most : std::max(-most, static_cast<double>(known->second.low));
      const double high = known == claims.end() ? most : std::min(most, static_cast<double>(known->second.high));
      if (high - low < margin_of(tests, t)) holds = false;
    }
    return holds;
  }
  /// One set of four or more: may it doubt gravity, and does it?
  void ask(const BlockTests& tests, SensorSet set, bool record, bool& agrees, Doubt& doubt) {
    const TestLimits& limits = tests.limits();
    const SetTest t = tests.of(set);
    if (!t.tested || !t.parity_consistent(limits) || !agrees_in_sum(tests, set)) return;
    if (t.least_leverage < 0.002 && !tests.corroborates_norm(set, t)) return;
    const double limit = t.norm_reject_limit(limits);
    const bool doubts = std::fabs(t.norm) > 0.5 * limit;
    if (!doubts) agrees = true;
    if (monitored.size() - set.size() >= 2) {
      if (record) note_length(tests, set);
      const auto known = claims.find(set.bits);
      if (known != claims.end() && known->second.low > known->second.high) return;
    }
    if (doubts) doubt.sets.push_back(set);
  }
  Doubt doubt(const BlockTests& tests, bool record) {
    Doubt out;
    const SensorSet there = monitored & tests.block().usable;
    const int smallest = std::max(c + 2, 4), deep = there.size() - 3;
    bool agrees = false;
    std::vector<int> sizes;
    for (int k = there.size(); k >= std::max(smallest, deep); --k) sizes.push_back(k);
    if (deep > smallest) sizes.push_back(smallest);
    for (const int k : sizes) {
      if (agrees) break;
      for (const SensorSet s : subsets(there, k, k)) ask(tests, s, record, agrees, out);
    }
    return out;
  }

  SensorSet by_parity(const BlockTests& tests, SensorSet corroborating) const {
    if (parity() < 1 || !tests.block().usable.contains(monitored)) return {};
    SensorSet cleared;
    for (const SensorSet f : subsets(monitored, 0, parity())) {
      if (f.size() > 3 && f.size() != parity()) continue;
      const SensorSet s = monitored - f;
      if (!corroborating.contains(s) || tests.of(s).parity_consistent(tests.limits())) cleared = cleared | s;
    }
    const SensorSet excluded = monitored - cleared;
    if (excluded.empty() || excluded.size() > parity()) return {};
    const SetTest rest = tests.of(monitored - excluded);
    return rest.tested && rest.parity_consistent(tests.limits()) ? excluded : SensorSet{};
  }

  IsolationAnswer vote(const BlockTests& tests, SensorSet corroborating) {
    const TestLimits& limits = tests.limits();
    IsolationAnswer out;
    out.voting = voting();
    const bool record = corroborating.contains(monitored);
    if (record) add_up(tests);
    const Doubt doubted = doubt(tests, record);
    const auto consistent = [&](SensorSet s) {
      const SetTest t = tests.of(s);
      return t.parity_consistent(limits) && (t.consistent(limits) || doubted.excuses(s));
    };
    out.norm_void = !doubted.sets.empty();
    out.parity = by_parity(tests, corroborating);
    out.full_consistent = !died(monitored) && consistent(monitored);
    if (strict() < 1) return out;
    const bool one = one_gravity(tests, record);
    SensorSet innocent;
    for (const SensorSet s : subsets(monitored, size, size)) {
      if (rejected.count(s.bits) != 0) continue;
      if (corroborating.contains(s) && !consistent(s)) {
        rejected.insert(s.bits);
      } else if (!one || !contradicts(tests, s, record)) {
        innocent = innocent | s;
        ++out.live;
      }
    }
    out.no_consistent_hypothesis = out.live == 0;
    const SensorSet suspected = monitored - innocent, left = monitored - suspected;
    if (!out.no_consistent_hypothesis && !suspected.empty() && suspected.size() <= strict() && tests.of(left).tested &&
        consistent(left))
      out.strict = suspected;
    return out;
  }

  /// Angle by which a bias that all of `set` share turns its estimate.
  static double drift_turn(const BlockTests& tests, SensorSet set, const SetTest& t) {
    const double length = norm(t.x_mps2);
    double across = 0.0, whole = 0.0;
    for (int i = 0; i < tests.array().size(); ++i) {
      if (!set.has(i) || length <= 0.0) continue;
      const double tau = static_cast<double>(tests.block().tolerance_mps2[static_cast<std::size_t>(i)]);
      const Vec3 column = estimate_column(tests.array(), t, i);
      across += tau * norm(cross(column, scaled(t.x_mps2, 1.0 / length)));
      whole += tau * std::fabs(dot(column, t.x_mps2)) / length;
    }
    return across > 0.0 ? std::atan2(across, std::max(0.0, length - whole)) : 0.0;
  }

  /// The number of faults that the level has to hold, by the words of `faults_covered`.
  int covers(const ProtectionTerms& terms, int least) const {
    int known = terms.provisional;
    if (terms.doubted) known = std::max(known, least);
    const int grade = std::min(strict(), 3);
    if (known > 0) return std::max({terms.faults, known, grade});
    return std::max(terms.faults, terms.unvalidated ? std::min(terms.faults + 1, grade) : 0);
  }

  FaultSetScan scan(const BlockTests& tests, SensorSet in_service, int depth, int asserted,
                    const ProtectionTerms& terms, SensorSet corroborating) {
    const TestLimits& limits = tests.limits();
    FaultSetScan out;
    out.minimum_faults.fill(255);
    const SensorSet there = monitored & tests.block().usable, serves = in_service & tests.block().usable;
    const SetTest used = tests.of(serves);
    const Doubt doubted = doubt(tests, false);
    const auto explains = [&](SensorSet rest) {
      const SetTest t = tests.of(rest);
      return t.tested && t.parity_consistent(limits) && (t.consistent(limits) || doubted.excuses(rest)) && !died(rest);
    };
    const auto level = [&](SensorSet rest) {
      const SetTest t = tests.of(rest);
      const double spread =
          std::hypot(tilt_sigma_rad(t.x_mps2, t.covariance), calibration_tilt_sigma_rad(tests.array(), t, rest));
      return angle_between_rad(t.x_mps2, used.x_mps2) + terms.k_integrity * spread + drift_turn(tests, rest, t);
    };
    struct Noted {
      int faults;
      bool explained;
      double rad;
    };
    std::vector<Noted> notes;
    const auto note = [&](int faults, SensorSet rest, bool tested, bool good) {
      if (!used.tested) return;
      if (good) notes.push_back({faults, true, level(rest)});
      if (!tested) notes.push_back({faults, false, plumb_test::mirrored_rad(tests, rest, used.x_mps2, terms)});
    };
    depth = std::max(depth, covers(terms, strict()));
    bool any_asserted = false;
    SensorSet common = there;
    for (const SensorSet f : subsets(there, 0, std::min(3, std::max(0, depth)))) {
      const SensorSet rest = there - f;
      const bool tested = tests.of(rest).tested, good = explains(rest);
      if (f.size() <= asserted && (good || !tested || !corroborating.contains(rest))) {
        any_asserted = true;
        common = common & f;
      }
      note(f.size(), rest, tested, good);
      if (!good) continue;
      for (int i = 0; i < universe; ++i) {
        auto& fewest = out.minimum_faults[static_cast<std::size_t>(i)];
        if (rest.has(i)) fewest = static_cast<std::uint8_t>(std::min<int>(fewest, f.size()));
      }
      if (f.size() < out.least) out.suspects = SensorSet{};
      if (f.size() <= out.least) out.suspects = out.suspects | f;
      out.least = std::min(out.least, f.size());
    }
    const SensorSet left = there & in_service;
    for (const SensorSet f : subsets(left != there ? left : SensorSet{}, 0, std::min(3, std::max(0, terms.faults)))) {
      note(f.size(), left - f, tests.of(left - f).tested, explains(left - f));
    }
    for (int i = 0; i < universe; ++i) {
      SensorSet line;
      for (int k = 0; k < universe; ++k) {
        if (norm(cross(tests.array().axis(i), tests.array().axis(k))) < std::sin(rad_from_deg(10.0)))
          line = line.with(k);
      }
      const SensorSet moved = line & (there - left), others = line & left;
      if (left.has(i) && moved.size() > 1)
        note(1, left - others, tests.of(left - others).tested, explains(left - others));
    }
    const int least = out.least <= 3 ? out.least : 0;
    out.covered = covers(terms, least);
    const int known = std::max(terms.provisional, terms.doubted ? least : 0);
    out.bears_more = !terms.doubted || out.covered >= known + terms.faults;
    bool any = false, bounded = out.covered <= 3;
    for (const Noted& told : notes) {
      if (told.faults > out.covered) continue;
      any = any || told.explained;
      bounded = bounded && told.rad < kPi;
      out.protection_rad = std::max(out.protection_rad, told.rad);
    }
    out.protection_available = any && bounded;
    const SetTest rest = tests.of(there - common);
    const bool consistent =
        rest.parity_consistent(limits) && (rest.consistent(limits) || doubted.excuses(there - common));
    if (any_asserted && rest.tested && consistent) out.asserted = common;
    return out;
  }
};

/// An episode: faults that stay, some of them in league or turning with the tool, a gravity that may be wrong.
struct Episode {
  Noise luck;
  SensorArray array;
  SensorSet faulty;
  std::array<double, kCapacity> fault{};
  double g_mps2 = kG0_mps2;
  bool wild = false, exact = false;

  Episode(const SensorArray& of, std::uint64_t seed) : luck(seed), array(of) {
    const int faults = static_cast<int>(5 * luck.uniform());
    for (int k = 0; k < faults; ++k) faulty = faulty.with(static_cast<int>(luck.uniform() * array.size()));
    const Vec3 lie = scaled(plumb_test::random_direction(luck), std::pow(10.0, 3.0 * luck.uniform() - 2.5));
    const bool league = luck.uniform() < 0.3;
    for (int i = 0; i < array.size(); ++i) {
      const double sign = luck.uniform() < 0.5 ? -1.0 : 1.0;  // drawn on its own: the same episode with every compiler
      const double own = sign * std::pow(10.0, 3.5 * luck.uniform() - 2.5);
      if (faulty.has(i)) fault[static_cast<std::size_t>(i)] = league ? dot(array.axis(i), lie) : own;
    }
    const double gravity = luck.uniform();
    if (gravity < 0.4) g_mps2 *= 1.0 + 0.01 * (luck.uniform() - 0.5);
    if (gravity < 0.05) g_mps2 = 0.0;
    wild = luck.uniform() < 0.2;
    exact = luck.uniform() < 0.1;
  }
  SensorSet some(double share) {
    SensorSet out;
    for (int i = 0; i < array.size(); ++i) out = luck.uniform() < share ? out.with(i) : out;
    return out;
  }
  BlockEvidence station() {
    BlockEvidence block;
    block.usable = luck.uniform() < 0.8 ? array.all() : some(0.85);
    block.samples = luck.uniform() < 0.02 ? 0.0 : luck.uniform() < 0.5 ? 1.0 : 32.0;
    // Without noise, and pointing where a bias that all share pushes: it turns nothing.
    Vec3 common{};
    const LeastSquares map = least_squares(array, array.all());
    for (int i = 0; i < array.size(); ++i) common = plus(common, map.column[static_cast<std::size_t>(i)]);
    const bool pushed = exact && norm(common) > 0.1;
    const Vec3 u = pushed ? scaled(common, 1.0 / norm(common)) : plumb_test::random_direction(luck);
    for (int i = 0; i < array.size(); ++i) {
      const auto a = static_cast<std::size_t>(i);
      const double sigma = exact ? 0.0 : kSigma / std::sqrt(std::max(1.0, block.samples));
      const double turning = wild && faulty.has(i) ? 2.0 * luck.uniform() : 1.0;
      block.mean_mps2[a] = dot(array.axis(i), u) * g_mps2 + turning * fault[a] + sigma * luck.normal();
    }
    return block;
  }
};

void expect_same(const FaultSetScan& code, const FaultSetScan& rule) {
  EXPECT_EQ(code.minimum_faults, rule.minimum_faults);
  EXPECT_EQ(code.suspects, rule.suspects);
  EXPECT_EQ(code.asserted, rule.asserted);
  EXPECT_EQ(code.least, rule.least);
  EXPECT_EQ(code.protection_available, rule.protection_available);
  EXPECT_EQ(code.covered, rule.covered);
  EXPECT_EQ(code.bears_more, rule.bears_more);
  EXPECT_NEAR(code.protection_rad, rule.protection_rad, 1e-7 + 1e-9 * rule.protection_rad);
}

void expect_same(const IsolationAnswer& code, const IsolationAnswer& rule) {
  EXPECT_EQ(code.strict, rule.strict);
  EXPECT_EQ(code.parity, rule.parity);
  EXPECT_EQ(code.live, rule.live);
  EXPECT_EQ(code.voting, rule.voting);
  EXPECT_EQ(code.no_consistent_hypothesis, rule.no_consistent_hypothesis);
  EXPECT_EQ(code.norm_void, rule.norm_void);
  EXPECT_EQ(code.full_consistent, rule.full_consistent);
}

void play(const SensorArray& array, std::uint64_t seed, int stations) {
  Episode episode(array, seed);
  Noise& luck = episode.luck;
  // At the second pair of rates noise alone lies about the limits: what one set allows its part does not.
  const bool sharp = luck.uniform() < 0.7;
  const bool steady = luck.uniform() < 0.5;
  const TestLimits limits =
      TestLimits::from_rates(array.size(), sharp ? 1e-5 : 0.3, sharp ? 1e-6 : 0.2, steady ? 0.0 : 1e-4);
  const GravityReference gravity{kG0_mps2, luck.uniform() < 0.5 ? 1e-3 : 1e-2, GravityModel::value};
  Isolation code;
  Rule rule;
  SensorSet monitored = luck.uniform() < 0.7 ? array.all() : episode.some(0.85);
  code.pose(array, monitored);
  rule.pose(array, monitored);
  for (int k = 0; k < stations; ++k) {
    BlockEvidence block = episode.station();
    const float drift_mps2 =
        luck.uniform() < 0.5 ? 0.0F : static_cast<float>(std::pow(10.0, 3.0 * luck.uniform() - 4.0));
    const bool some_exact = luck.uniform() < 0.3;
    for (float& tau : block.tolerance_mps2)
      tau = some_exact && luck.uniform() < 0.5 ? 0.0F : drift_mps2 * static_cast<float>(luck.uniform());
    const BlockTests tests(array, gravity, limits, block);
    const SensorSet corroborating = luck.uniform() < 0.7 ? array.all() : episode.some(0.8);
    if (luck.uniform() < 0.7) expect_same(code.vote(tests, corroborating), rule.vote(tests, corroborating));
    EXPECT_EQ(code.live(), rule.live());
    const int depth = static_cast<int>(6 * luck.uniform()) - 1, asserted = static_cast<int>(6 * luck.uniform()) - 1;
    const ProtectionTerms terms{static_cast<int>(5 * luck.uniform()), 5.0 * luck.uniform(),
                                std::max(0, static_cast<int>(6 * luck.uniform()) - 3), luck.uniform() < 0.5,
                                luck.uniform() < 0.5};
    const SensorSet in_service = luck.uniform() < 0.5   ? monitored
                                 : luck.uniform() < 0.5 ? array.all()
                                                        : episode.some(0.8);
    expect_same(code.scan(tests, in_service, depth, asserted, terms, corroborating),
                rule.scan(tests, in_service, depth, asserted, terms, corroborating));
    if (luck.uniform() < 0.1) {
      monitored = luck.uniform() < 0.7 ? monitored.without(monitored.lowest()) : array.all();
      code.pose(array, monitored);
      rule.pose(array, monitored);
    }
    if (luck.uniform() < 0.05) {  // the episode is over
      code.clear();
      rule.clear();
    }
    if (testing::Test::HasFailure()) return;
  }
}

SensorArray array_of(const std::vector<Vec3>& directions) {
  AxisList axes{};
  for (std::size_t i = 0; i < directions.size(); ++i) axes[i] = scaled(directions[i], 1.0 / norm(directions[i]));
  return plumb_test::make_array(axes, static_cast<int>(directions.size()), kSigma);
}

/// One sensor is a hundred times as good as the others, and what calibration leaves is not.
SensorArray uneven(int n) {
  std::array<SensorRow, kCapacity> rows{};
  AxisList axes{};
  cone_with_axis(axes, n);
  for (std::size_t i = 0; i < static_cast<std::size_t>(n); ++i) {
    rows[i].id = make_id(("a" + std::to_string(i)).c_str());
    rows[i].axis = axes[i];
    rows[i].sigma_mps2 = i == 2 ? 0.01 * kSigma : kSigma;
  }
  SensorArray array = *SensorArray::make(rows.data(), n);
  RowUncertainty left;
  for (std::size_t a = 0; a < 4 * static_cast<std::size_t>(n); ++a)
    left.covariance[a * (a + 1) / 2 + a] = a % 4 == 3 ? 1e-6 : 1e-8;
  array.set_uncertainty(left);
  return array;
}

TEST(IsolationOracle, AnswersAsASecondRuleDoesOverPlainSets) {
  std::vector<SensorArray> arrays = {array_of({{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}), plumb_test::tetrahedron(kSigma)};
  for (int n = 5; n <= std::min(8, kCapacity); ++n) arrays.push_back(plumb_test::cone_array(n, kSigma));
  if (kCapacity >= 6) {
    // Members that nobody checks: three of five in a plane, or nearly; pairs of one axis.
    arrays.push_back(
        array_of({{.004, -.863, .506}, {-.86, .011, .51}, {.013, .876, .483}, {.876, .006, .483}, {.002, .001, 1}}));
    arrays.push_back(array_of({{1, 0, 0}, {-.5, .87, 0}, {-.5, -.87, 0}, {.3, .95, .03}, {-.9, .4, .02}, {0, 0, 1}}));
    arrays.push_back(array_of({{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}}));
    if (kCapacity >= 8)  // seventy voting sets: more than a word has bits
      arrays.push_back(array_of(
          {{1, 0, 0}, {0, 1, 0}, {.7, .7, 0}, {0, 0, 1}, {.6, .2, .7}, {-.5, .6, .6}, {.2, -.7, .6}, {-.6, -.4, .6}}));
    arrays.push_back(uneven(5));
    arrays.push_back(uneven(6));
  }
  for (std::size_t a = 0; a < arrays.size(); ++a) {
    const int episodes = arrays[a].size() <= 5 ? 200 : 80;
    for (int k = 0; k < episodes; ++k) {
      play(arrays[a], 1000 * a + static_cast<std::uint64_t>(k), 8);
      ASSERT_FALSE(testing::Test::HasFailure()) << "array " << a << ", episode " << k;
    }
  }
}

}  // namespace
}  // namespace isolation_oracle_test
