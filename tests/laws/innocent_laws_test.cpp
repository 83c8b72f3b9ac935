// Whom the monitor never blames: laws 1, 4, 7 and 8 of docs/property-testing.md, each over kLawCases cases.
#include "laws/law_run.hpp"

namespace innocent_laws_test {
namespace {

using namespace plumb;
using namespace plumb_test;

/// Behind a block, where noise is to be small beside what calibration leaves.
constexpr double kManySamples = 1024.0;

MonitorConfig config_of(int key) {
  MonitorConfig config;
  config.isolation_stations = key == 0 ? 4 : 1;
  return config;
}

/// Directions, noise and lies over some stations; broken where a healthy sensor is excluded.
LawOutcome never_latches_the_healthy(const LawTool& tool, LawCase& c, Watch& watch, int stations, TrialNoise& noise) {
  TrialAttitudes attitudes(noise);
  for (int k = 0; k < stations; ++k) {
    const Verdict& v = watch.station(c.with_noise(c.readings(attitudes.next(noise), noise), noise));
    const LawOutcome outcome = blames_the_healthy(tool, c, v.excluded, k);
    if (!outcome.broken.empty()) return outcome;
  }
  return {};
}

TEST(Law, OneNoHealthySensorIsExcludedWithinTheGradeAndTheBounds) {
  std::uint64_t told = 0;
  const LawCount count = run_law(1, kLawCases, [&told](std::uint64_t number, TrialNoise& noise) {
    Strata strata(number);
    const auto& tools = every_tool();
    const LawTool& tool = tools[slot(strata.digit(static_cast<int>(tools.size())))];
    const double gravity = strata.of(std::array<double, 5>{0.0, 1.0, -1.0, 3.0, -3.0});
    const double samples = strata.of(std::array<double, 2>{kTrialSamples, kManySamples});
    const Lie lie = strata.of(kEveryLie);
    const int m = 1 + strata.digit(tool.strict());
    const int key = noise.below(2);
    LawCase c(tool.tool, LawCase::some(tool.n(), m, noise), lie, gravity);
    c.samples = samples;
    c.draw(noise);
    Watch watch =
        noise.below(2) == 0 ? fresh_watch(tool, config_of(key), key) : proven_watch(tool, config_of(key), key, gravity);
    watch.samples = samples;
    const LawOutcome outcome = never_latches_the_healthy(tool, c, watch, 8, noise);
    told += watch.verdict().excluded.empty() ? 0U : 1U;
    return outcome;
  });
  EXPECT_EQ(count.broken, 0U);
  expect_some_excluded(told, count, 0.5);
}

/// Gravity off by ten sigma is beyond what the reference claims. What is promised then: one fault among five or more
/// sensors of which every four check each other.
TEST(Law, OneHoldsForOneFaultThoughGravityIsOffByTenSigma) {
  std::uint64_t told = 0;
  const LawCount count = run_law(10, kLawCases, [&told](std::uint64_t number, TrialNoise& noise) {
    Strata strata(number);
    const auto& tools = every_tool();
    const LawTool& tool = tools[slot(strata.digit(static_cast<int>(tools.size())))];
    if (tool.n() < 5 || tool.plane > 2) return not_of_this_law();
    const double gravity = strata.of(std::array<double, 2>{10.0, -10.0});
    LawCase c(tool.tool, LawCase::some(tool.n(), 1, noise), strata.of(kEveryLie), gravity);
    c.draw(noise);
    const int key = noise.below(2);
    Watch watch = fresh_watch(tool, config_of(key), key);
    const LawOutcome outcome = never_latches_the_healthy(tool, c, watch, 8, noise);
    told += watch.verdict().excluded.empty() ? 0U : 1U;
    return outcome;
  });
  EXPECT_EQ(count.broken, 0U);
  expect_some_excluded(told, count, 0.3);
}

TEST(Law, FourCorrelatedFaultsExcludeNoHealthySensorThoughTheyCannotBeIsolated) {
  std::uint64_t told = 0;
  const LawCount count = run_law(4, kLawCases, [&told](std::uint64_t number, TrialNoise& noise) {
    Strata strata(number);
    const auto& tools = every_tool();
    const LawTool& tool = tools[slot(strata.digit(static_cast<int>(tools.size())))];
    const int least = std::max(1, (tool.n() - tool.plane - 1) / 2 + 1);  // n - 2m < c + 1 from here on
    if (least > tool.strict()) return not_of_this_law();
    const Lie lie = strata.of(std::array<Lie, 2>{Lie::colluding, Lie::mirrored});
    const double gravity = strata.of(std::array<double, 5>{0.0, 1.0, -1.0, 3.0, -3.0});
    const int m = least + strata.digit(tool.strict() - least + 1);
    LawCase c(tool.tool, LawCase::some(tool.n(), m, noise), lie, gravity);
    c.draw(noise);
    const int key = noise.below(2);
    Watch watch =
        noise.below(2) == 0 ? fresh_watch(tool, config_of(key), key) : proven_watch(tool, config_of(key), key, gravity);
    const LawOutcome outcome = never_latches_the_healthy(tool, c, watch, 8, noise);
    told += watch.verdict().excluded.empty() ? 0U : 1U;
    return outcome;
  });
  EXPECT_EQ(count.broken, 0U);
  expect_some_excluded(told, count, 0.25);
}

/// The named limits: tools and faults that look healthy at every attitude. For the paper's tetrahedron the readings of
/// two of the sensors 1 to 3 may be exchanged: its axes, one of them negative, are those of another tetrahedron.
struct LinearEnd {
  std::uint64_t excluded = 0, open = 0, unseen = 0;
};

TEST(Law, EightLinearFaultsEndExcludedOrOpenAndNeverInAWrongExclusion) {
  static LinearEnd end;
  end = {};
  const LawCount count = run_law(8, kLawCases, [](std::uint64_t number, TrialNoise& noise) {
    Strata strata(number);
    const auto& tools = every_tool();
    const LawTool& tool = tools[slot(strata.digit(static_cast<int>(tools.size())))];
    const Lie lie = strata.of(std::array<Lie, 4>{Lie::scale, Lie::sign, Lie::remount, Lie::swap});
    const double gravity = strata.of(std::array<double, 5>{0.0, 1.0, -1.0, 3.0, -3.0});
    const int m = 1 + strata.digit(tool.strict());
    LawCase c(tool.tool, LawCase::some(tool.n(), m, noise), lie, gravity);
    c.draw(noise);
    Watch watch = proven_watch(tool, config_of(0), 0, gravity);
    const LawOutcome outcome = never_latches_the_healthy(tool, c, watch, 8, noise);
    const Verdict& v = watch.verdict();
    const bool out = (v.excluded | v.provisionally_excluded) == c.faulty();
    const bool open = v.validity != Validity::valid && v.validity != Validity::degraded;
    ++(out ? end.excluded : open ? end.open : end.unseen);
    return outcome;
  });
  EXPECT_EQ(count.broken, 0U);
  std::printf(
      "law 8: %llu ended excluded or provisionally excluded, %llu open or failed, %llu unseen or part of them unseen\n",
      static_cast<unsigned long long>(end.excluded), static_cast<unsigned long long>(end.open),
      static_cast<unsigned long long>(end.unseen));
  EXPECT_GT(3 * end.excluded, end.unseen) << "a monitor that sees nothing would pass as well";
}

TEST(Law, EightTheUnobservablePermutation) {
  AxisList axes{};
  const int n = paper_tetrahedron(axes);
  const TrialTool tool = exact_tool(axes, n);
  LawTool law;
  law.tool = tool;
  for (const SensorSet pair : {SensorSet::of(0).with(1), SensorSet::of(0).with(2), SensorSet::of(1).with(2)}) {
    TrialNoise noise(5);
    LawCase c(tool, pair, Lie::swap, 0.0);
    c.draw(noise);
    Watch watch(law, MonitorConfig());
    for (int k = 0; k < 12; ++k) watch.station(c.with_noise(c.readings(noise.direction(), noise), noise));
    EXPECT_EQ(watch.verdict().state, HealthState::nominal) << "a known limit (F08); the check is at commissioning";
    EXPECT_TRUE(watch.verdict().excluded.empty());
  }
}

/// Trouble that is no sensor's fault. `axial` is vibration along one axis, mostly that of a sensor, which then shakes
/// more than all others.
enum class Trouble : std::uint8_t { sway, push, common_bias, common_scale, time, silence, one_channel, axial };
constexpr std::array<Trouble, 8> kEveryTrouble = {Trouble::sway,         Trouble::push, Trouble::common_bias,
                                                  Trouble::common_scale, Trouble::time, Trouble::silence,
                                                  Trouble::one_channel,  Trouble::axial};

/// Samples, not block means: what moves within a block must be seen moving.
class TroubledRun {
 public:
  static constexpr int kWindow = 8;

  TroubledRun(const LawTool& tool, Trouble trouble, double gravity, TrialNoise& noise)
      : tool_(&tool), trouble_(trouble), gravity_(gravity), noise_(&noise) {
    bias_mps2_ = noise.sign() * noise.log_between(1e-4, 0.1) * kG0_mps2;
    scale_ = 1.0 + noise.sign() * noise.log_between(1e-4, 0.1);
    push_mps2_ = noise.log_between(1e-3, 1.0) * kG0_mps2;
    channel_ = noise.below(tool.n());
    axis_ = noise.uniform() < 0.7 ? tool.tool.row[slot(channel_)] : noise.direction();
    shake_mps2_ = noise.log_between(0.3, 3000.0) * kTrialSigma_mps2;
  }
  int channel() const { return trouble_ == Trouble::one_channel ? channel_ : -1; }

  LawOutcome run(HealthMonitor& monitor, int stations) {
    for (int k = 0; k < stations; ++k) {
      const Vec3 direction = noise_->direction();
      const bool troubled = trouble_ == Trouble::axial || noise_->uniform() < 0.7;
      const Vec3 steady = troubled ? push() : Vec3{};
      for (int s = 0; s < kWindow; ++s) {
        Vec3 moved = plus(steady, troubled && trouble_ == Trouble::sway ? push() : Vec3{});
        if (trouble_ == Trouble::axial) moved = scaled(axis_, shake_mps2_ * noise_->normal());
        const Verdict& v = monitor.step(sample(direction, moved, troubled, k));
        const SensorSet own = channel() >= 0 ? SensorSet::of(channel_) : SensorSet{};
        const SensorSet out = (v.excluded | v.provisionally_excluded | v.absent) - own;
        if (!out.empty()) {
          return {true,
                  "of " + std::to_string(tool_->n()) + " sensors " + names_of(out) + " are out for trouble " +
                      std::to_string(static_cast<int>(trouble_)) + "; station " + std::to_string(k),
                  {tool_->n(), 0, k}};
        }
      }
    }
    return {};
  }

 private:
  Vec3 push() {
    const bool pushed = trouble_ == Trouble::push || trouble_ == Trouble::sway;
    return pushed ? scaled(noise_->direction(), push_mps2_ * noise_->uniform()) : Vec3{};
  }

  Sample sample(const Vec3& direction, const Vec3& moved, bool troubled, int station) {
    const TrialTool& tool = tool_->tool;
    const double length = kG0_mps2 + gravity_ * tool.gravity.sigma_mps2;
    const Vec3 felt = plus(scaled(direction, length), moved);
    Sample s;
    s.time_s = time_s_ += 0.1;
    s.delivered = tool.array.all();
    s.temperature_degc = 25.0;
    s.station = static_cast<std::uint32_t>(station + 1);
    s.count = 4;
    const auto z = bounded_noise(tool_->n(), *noise_);
    for (int i = 0; i < tool_->n(); ++i) {
      double y = dot(tool.row[slot(i)], felt) + tool.offset_mps2[slot(i)] + 0.5 * tool.array.sigma_mps2(i) * z[slot(i)];
      if (troubled && trouble_ == Trouble::common_bias) y += bias_mps2_;
      if (troubled && trouble_ == Trouble::common_scale) y *= scale_;
      s.raw[slot(i)] = y;
    }
    const bool strikes = troubled && noise_->uniform() < 0.2;
    if (strikes && trouble_ == Trouble::time) {
      constexpr double kWild[] = {-1.0, 0.0, 7.0, 1e9};
      const double wild = kWild[noise_->below(4)];
      s.time_s = wild == 1e9 ? std::nan("") : s.time_s + wild;
      if (wild == 7.0) time_s_ = s.time_s;
    }
    if (strikes && trouble_ == Trouble::silence) s.delivered = SensorSet{};
    if (strikes && trouble_ == Trouble::one_channel) s.raw[slot(channel_)] = std::nan("");
    return s;
  }

  const LawTool* tool_;
  Trouble trouble_;
  double gravity_;
  TrialNoise* noise_;
  double bias_mps2_ = 0.0, scale_ = 1.0, push_mps2_ = 0.0, shake_mps2_ = 0.0, time_s_ = 1000.0;
  Vec3 axis_{};
  int channel_ = 0;
};

TEST(Law, SevenMotionAndGapsExcludeNoSensor) {
  static std::uint64_t common = 0, misread = 0;
  common = misread = 0;
  const LawCount count = run_law(7, kLawCases, [](std::uint64_t number, TrialNoise& noise) {
    Strata strata(number);
    const auto& tools = every_tool();
    const LawTool& tool = tools[slot(strata.digit(static_cast<int>(tools.size())))];
    const Trouble trouble = strata.of(kEveryTrouble);
    const double gravity = strata.of(std::array<double, 7>{0.0, 1.0, -1.0, 3.0, -3.0, 10.0, -10.0});
    static std::map<const LawTool*, std::unique_ptr<HealthMonitor>> known;
    auto& fresh = known[&tool];
    if (!fresh) {
      MonitorSetup setup;
      setup.array = tool.tool.array;
      setup.model.size = tool.n();
      setup.gravity = tool.tool.gravity;
      setup.config.window = TroubledRun::kWindow;
      fresh = std::make_unique<HealthMonitor>();
      EXPECT_TRUE(fresh->configure(setup).has_value());
    }
    HealthMonitor monitor = *fresh;
    const LawOutcome outcome = TroubledRun(tool, trouble, gravity, noise).run(monitor, 6);
    if (trouble != Trouble::common_bias) return outcome;
    // A bias that all share makes every sensor a faulty one, beyond every grade; by parity it can look like that of a
    // few. A known limit: counted, not asserted.
    ++common;
    misread += outcome.broken.empty() ? 0U : 1U;
    return not_of_this_law();
  });
  EXPECT_EQ(count.broken, 0U);
  std::printf("law 7: a bias that all share was taken for that of a few in %llu of %llu cases (known limit)\n",
              static_cast<unsigned long long>(misread), static_cast<unsigned long long>(common));
}

}  // namespace
}  // namespace innocent_laws_test
