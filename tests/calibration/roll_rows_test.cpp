/// Stations that share an inclination while the tool rolls: what gravity's length alone cannot see
/// (docs/theory.md, section 9.5).
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "calibration_support.hpp"

namespace roll_rows_test {
namespace {

using namespace calibration_test;

constexpr double kSigma = 2e-4 * plumb::kG0_mps2;

struct RollSet {
  std::vector<double> inclinations_deg;
  int rolls;
  double wobble_deg = 0.0;
};

plumb::FitOptions options_of(const RollSet& set) {
  plumb::FitOptions o;
  o.require_full_rank = false;
  o.estimate_misfit = false;
  o.roll_axis_deviation_rad = plumb::rad_from_deg(set.wobble_deg);
  return o;
}

std::vector<plumb::Station> stations_of(const RollSet& set, const plumb::Datasheet& d, const Truth& truth, Noise& noise,
                                        double sigma_mps2 = kSigma) {
  std::vector<plumb::Station> out;
  std::uint32_t group = 0;
  for (const double inclination : set.inclinations_deg) {
    ++group;
    for (int k = 0; k < set.rolls; ++k) {
      const double wobble = set.wobble_deg * noise.normal();
      out.push_back(station_at(d, truth, rolled(inclination + wobble, 360.0 * k / set.rolls), noise, sigma_mps2));
      out.back().roll_group = group;
    }
  }
  return out;
}

plumb::Expected<plumb::Calibration> fit(const plumb::Datasheet& d, const std::vector<plumb::Station>& stations,
                                        const plumb::FitOptions& o, plumb::FitReport* report = nullptr) {
  return plumb::calibrate(d, standard_gravity(), stations.data(), static_cast<int>(stations.size()), o, report);
}

void forget_groups(std::vector<plumb::Station>& stations) {
  for (plumb::Station& s : stations) s.roll_group = 0;
}

/// Mean square error of the inclination at the stations' own attitudes, no frame removed.
double inclination_error(const RollSet& set, const plumb::Datasheet& d, const Truth& truth,
                         const plumb::Calibration& c) {
  const plumb::LeastSquares ls = plumb::least_squares(c.array, c.array.all());
  Noise none(0);
  double sum = 0.0;
  int count = 0;
  for (const double inclination : set.inclinations_deg) {
    for (int k = 0; k < set.rolls; ++k) {
      const plumb::Station s = station_at(d, truth, rolled(inclination, 360.0 * k / set.rolls), none, 0.0);
      const Vec3 x = ls.estimate(c.model.apply(s.mean, 25.0, s.delivered));
      const double e = plumb::angle_between_rad(x, {0.0, 0.0, 1.0}) - plumb::rad_from_deg(inclination);
      sum += e * e;
      ++count;
    }
  }
  return sum / count;
}

TEST(RollRows, ThreeInclinationsGiveTheInclinationItself) {
  const RollSet set = {{0.0, 45.0, 90.0}, 8};
  double with = 0.0, without = 0.0, freedom = 0.0, chi2 = 0.0;
  constexpr int kRuns = 100;
  for (std::uint64_t seed = 900; seed < 900 + kRuns; ++seed) {
    Noise noise(seed);
    const plumb::Datasheet d = paper_tool(kSigma);
    const Truth truth = draw_truth(d, noise);
    std::vector<plumb::Station> stations = stations_of(set, d, truth, noise);
    const auto c = fit(d, stations, options_of(set));
    ASSERT_TRUE(c.has_value()) << "seed " << seed;
    EXPECT_EQ(c->report.rank, 15);
    EXPECT_EQ(c->report.gauge, 1);
    EXPECT_EQ(c->report.null_directions, 0);
    EXPECT_EQ(c->report.roll_groups, 3);
    with += inclination_error(set, d, truth, *c) / kRuns;
    chi2 += c->report.chi2;
    freedom += c->report.degrees_of_freedom;
    forget_groups(stations);
    const auto plain = fit(d, stations, options_of(set));
    ASSERT_TRUE(plain.has_value());
    EXPECT_EQ(plain->report.rank, 13);
    without += inclination_error(set, d, truth, *plain) / kRuns;
  }
  EXPECT_LE(std::sqrt(with), 0.3e-3);
  EXPECT_GE(std::sqrt(without), 10e-3);
  EXPECT_LE(chi2 / freedom, 1.05);
  RecordProperty("inclination_rad", std::to_string(std::sqrt(with)));
  std::cout << "[ measured ] inclination " << std::sqrt(with) << " rad, without the rows " << std::sqrt(without)
            << '\n';
}

TEST(RollRows, RanksAsMeasured) {
  struct Case {
    RollSet set;
    int without, with;
  };
  for (const Case& c :
       {Case{{{30.0}, 24}, 8, 10}, Case{{{30.0, 60.0}, 12}, 12, 14}, Case{{{0.0}, 24}, 2, 4},
        Case{{{30.0, 45.0, 60.0}, 8}, 13, 15}, Case{{{0.0, 10.0, 20.0, 40.0, 70.0, 90.0}, 5}, 13, 15}}) {
    Noise noise(17);
    const plumb::Datasheet d = paper_tool(kSigma);
    const Truth truth = draw_truth(d, noise);
    std::vector<plumb::Station> stations = stations_of(c.set, d, truth, noise);
    plumb::FitReport report;
    EXPECT_TRUE(fit(d, stations, options_of(c.set), &report).has_value()) << c.with;
    EXPECT_EQ(report.rank, c.with);
    EXPECT_EQ(report.gauge, 1);
    forget_groups(stations);
    EXPECT_TRUE(fit(d, stations, options_of(c.set), &report).has_value()) << c.without;
    EXPECT_EQ(report.rank, c.without);
    EXPECT_EQ(report.gauge, 3);
  }
}

TEST(RollRows, AnAxisDeviationThatIsStatedCostsLittle) {
  const RollSet set = {{0.0, 10.0, 20.0, 30.0, 40.0, 50.0, 60.0, 70.0, 80.0, 90.0}, 5, 0.05};
  double told = 0.0, untold = 0.0;
  constexpr int kRuns = 60;
  for (std::uint64_t seed = 1; seed <= kRuns; ++seed) {
    Noise noise(seed);
    const plumb::Datasheet d = paper_tool(kSigma);
    const Truth truth = draw_truth(d, noise);
    const std::vector<plumb::Station> stations = stations_of(set, d, truth, noise);
    const auto c = fit(d, stations, options_of(set));
    plumb::FitOptions sure = options_of(set);
    sure.roll_axis_deviation_rad = 0.0;
    const auto u = fit(d, stations, sure);
    ASSERT_TRUE(c.has_value() && u.has_value());
    told += inclination_error(set, d, truth, *c) / kRuns;
    untold += c->report.chi2 / c->report.degrees_of_freedom / kRuns;
    EXPECT_GT(u->report.chi2, 3.0 * c->report.chi2);
  }
  EXPECT_LE(std::sqrt(told), 0.3e-3);
  EXPECT_NEAR(untold, 1.0, 0.1);
}

TEST(RollRows, AnyAxisWillDo) {
  // The same tool and the same data, described in a frame that has been turned over: the same calibration, turned.
  const RollSet set = {{0.0, 45.0, 90.0}, 8};
  Noise noise(5);
  const plumb::Datasheet d = paper_tool(kSigma);
  const Truth truth = draw_truth(d, noise);
  const std::vector<plumb::Station> stations = stations_of(set, d, truth, noise);
  const auto cycled = [](const Vec3& v) { return Vec3{v[2], v[0], v[1]}; };
  plumb::Datasheet other = d;
  for (int i = 0; i < 4; ++i) other.sensor[at(i)].row.axis = cycled(d.sensor[at(i)].row.axis);
  plumb::FitOptions o = options_of(set), p = o;
  p.roll_axis = {1.0, 0.0, 0.0};
  const auto one = fit(d, stations, o), two = fit(other, stations, p);
  ASSERT_TRUE(one.has_value() && two.has_value());
  EXPECT_EQ(two->report.rank, 15);
  for (int i = 0; i < 4; ++i) {
    EXPECT_LE(plumb::norm(plumb::minus(cycled(one->array.axis(i)), two->array.axis(i))), 1e-9);
    EXPECT_NEAR(one->report.sigma[at(4 * i + 3)], two->report.sigma[at(4 * i + 3)], 1e-12);
  }
}

TEST(RollRows, GroupsOfOneStationChangeNothing) {
  const RollSet set = {{0.0, 45.0, 90.0}, 8};
  Noise noise(6);
  const plumb::Datasheet d = paper_tool(kSigma);
  const Truth truth = draw_truth(d, noise);
  std::vector<plumb::Station> stations = stations_of(set, d, truth, noise);
  stations.resize(16);
  std::uint32_t tag = 100;
  for (plumb::Station& s : stations) s.roll_group = tag++;
  const auto alone = fit(d, stations, options_of(set));
  forget_groups(stations);
  const auto plain = fit(d, stations, options_of(set));
  ASSERT_TRUE(alone.has_value() && plain.has_value());
  EXPECT_EQ(alone->report.gauge, 3);
  for (int i = 0; i < 4; ++i) EXPECT_EQ(alone->array.axis(i), plain->array.axis(i));
}

TEST(RollRows, RefusesTooManyGroupsAndAnAxisThatIsNone) {
  const RollSet set = {std::vector<double>(plumb::kMaxRollGroups + 1, 40.0), 2};
  Noise noise(7);
  const plumb::Datasheet d = paper_tool(kSigma);
  const Truth truth = draw_truth(d, noise);
  const std::vector<plumb::Station> stations = stations_of(set, d, truth, noise);
  const auto crowd = fit(d, stations, options_of(set));
  ASSERT_FALSE(crowd.has_value());
  EXPECT_EQ(crowd.error(), (plumb::Error{plumb::Errc::out_of_range, 1, 0.0, 0.0}));
  for (const Vec3& axis : {Vec3{0.0, 0.0, 2.0}, Vec3{0.0, 0.0, std::nan("")}, Vec3{}}) {
    plumb::FitOptions o = options_of(set);
    o.roll_axis = axis;
    const auto c = fit(d, stations, o);
    ASSERT_FALSE(c.has_value());
    EXPECT_EQ(c.error(), (plumb::Error{plumb::Errc::out_of_range, 0, 0.0, 0.0}));
  }
}

TEST(RollRows, TheSigmaOfAnInclinationIsWhatItIs) {
  const RollSet set = {{0.0, 45.0, 90.0}, 8};
  double with = 0.0, said = 0.0, without = 0.0, said_without = 0.0;
  constexpr int kRuns = 100;
  for (std::uint64_t seed = 300; seed < 300 + kRuns; ++seed) {
    Noise noise(seed);
    const plumb::Datasheet d = paper_tool(kSigma);
    const Truth truth = draw_truth(d, noise);
    std::vector<plumb::Station> stations = stations_of(set, d, truth, noise);
    const auto c = fit(d, stations, options_of(set));
    forget_groups(stations);
    const auto plain = fit(d, stations, options_of(set));
    ASSERT_TRUE(c.has_value() && plain.has_value());
    EXPECT_EQ(c->report.roll_axis, (Vec3{0.0, 0.0, 1.0}));
    EXPECT_EQ(plain->report.roll_axis, Vec3{});
    with += inclination_error(set, d, truth, *c) / kRuns;
    said += std::pow(c->report.inclination_sigma_rad, 2) / kRuns;
    without += inclination_error(set, d, truth, *plain) / kRuns;
    said_without += std::pow(plain->report.inclination_sigma_rad, 2) / kRuns;
  }
  EXPECT_LE(std::sqrt(with), 0.3e-3);
  EXPECT_NEAR(std::sqrt(said / with), 1.0, 0.25);
  EXPECT_NEAR(std::sqrt(said_without / without), 1.0, 0.25);
  std::cout << "[ measured ] inclination " << std::sqrt(with) << " rad, said " << std::sqrt(said) << "; without rows "
            << std::sqrt(without) << ", said " << std::sqrt(said_without) << '\n';
}

TEST(RollRows, GroupsOfOneAreCounted) {
  const RollSet set = {{0.0, 45.0, 90.0}, 8};
  Noise noise(9);
  const plumb::Datasheet d = paper_tool(kSigma);
  const Truth truth = draw_truth(d, noise);
  std::vector<plumb::Station> stations = stations_of(set, d, truth, noise);
  stations[3].roll_group = 77;
  const auto c = fit(d, stations, options_of(set));
  ASSERT_TRUE(c.has_value());
  EXPECT_EQ(c->report.roll_groups, 4);
  EXPECT_EQ(c->report.single_station_groups, 1);
  EXPECT_EQ(c->report.rank, 15);
}

TEST(RollRows, RefusesAnInvalidAxisDeviation) {
  const RollSet set = {{0.0, 45.0, 90.0}, 8};
  Noise noise(10);
  const plumb::Datasheet d = paper_tool(kSigma);
  const Truth truth = draw_truth(d, noise);
  const std::vector<plumb::Station> stations = stations_of(set, d, truth, noise);
  for (const double wobble : {-0.001, std::nan(""), std::numeric_limits<double>::infinity()}) {
    plumb::FitOptions o = options_of(set);
    o.roll_axis_deviation_rad = wobble;
    const auto c = fit(d, stations, o);
    ASSERT_FALSE(c.has_value());
    EXPECT_EQ(c.error(), (plumb::Error{plumb::Errc::out_of_range, 2, 0.0, 0.0}));
  }
}

TEST(RollRows, FullRankIsAskedForWithTheRowsInMind) {
  // Two inclinations leave one direction unseen, and the rows must not hide that.
  const RollSet set = {{30.0, 60.0}, 12};
  Noise noise(8);
  const plumb::Datasheet d = paper_tool(kSigma);
  const Truth truth = draw_truth(d, noise);
  plumb::FitOptions o = options_of(set);
  o.require_full_rank = true;
  const auto c = fit(d, stations_of(set, d, truth, noise), o);
  ASSERT_FALSE(c.has_value());
  EXPECT_EQ(c.error().code, plumb::Errc::unobservable);
  EXPECT_EQ(c.error().value, 14.0);
  EXPECT_EQ(c.error().limit, 15.0);
}

}  // namespace
}  // namespace roll_rows_test
