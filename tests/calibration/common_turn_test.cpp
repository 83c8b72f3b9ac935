// Whether the tool was rolled about the axis stated: roll groups turn all axes together, and the nominal ones know by
// how much they may.
#include <gtest/gtest.h>

#include <cmath>

#include "calibration_support.hpp"
#include "plumb/calibration/acceptance.hpp"

namespace common_turn_test {
namespace {

using namespace calibration_test;
using plumb::Concern;
using plumb::Errc;

constexpr double kSigma = 2e-4 * plumb::kG0_mps2;

/// Eight rolls at 0, 45 and 90 deg about an axis that lies `off_deg` from z.
std::vector<plumb::Station> rolls(const plumb::Datasheet& d, const Truth& truth, double off_deg, Noise& noise) {
  const double towards = 2.0 * plumb::kPi * noise.uniform();
  const Vec3 turn = plumb::scaled({std::cos(towards), std::sin(towards), 0.0}, plumb::rad_from_deg(off_deg));
  std::vector<plumb::Station> out;
  std::uint32_t group = 0;
  for (const double inclination_deg : {0.0, 45.0, 90.0}) {
    ++group;
    for (int k = 0; k < 8; ++k) {
      out.push_back(station_at(d, truth, turned(rolled(inclination_deg, 45.0 * k), turn), noise, kSigma));
      out.back().roll_group = group;
    }
  }
  return out;
}

struct Judged {
  plumb::FitReport report;
  plumb::Judgement judgement;
};

Judged judged(const plumb::Datasheet& d, const std::vector<plumb::Station>& stations,
              const plumb::FitOptions& options = {}) {
  Judged out;
  const auto fit =
      plumb::calibrate(d, standard_gravity(), stations.data(), static_cast<int>(stations.size()), options, &out.report);
  if (fit) {
    out.judgement = plumb::judge(d, standard_gravity(), *fit, {}, {});
  } else {
    out.judgement.error = fit.error();
  }
  return out;
}

/// Axes as a datasheet with normal errors of its own prior has them.
Truth normal_truth(const plumb::Datasheet& d, Noise& noise) {
  Truth t = draw_truth(d, noise, 1.0, 0.0);
  for (int i = 0; i < d.size; ++i) {
    const double x = noise.normal(), y = noise.normal(), z = noise.normal();
    const double length = plumb::norm(t.w[at(i)]);
    t.w[at(i)] = plumb::plus(t.w[at(i)], plumb::scaled({x, y, z}, d.sensor[at(i)].prior.axis_rad));
    t.w[at(i)] = plumb::scaled(t.w[at(i)], length / plumb::norm(t.w[at(i)]));
  }
  return t;
}

TEST(CommonTurn, ARightAxisIsNotRefusedAndTheTurnIsAsSure) {
  double squares = 0.0;
  int refused = 0, told = 0;
  constexpr int kRuns = 500;
  for (std::uint64_t seed = 1; seed <= kRuns; ++seed) {
    Noise noise(seed);
    plumb::AxisList axes{};
    const int n = 4 + static_cast<int>(seed % 3);
    if (n == 4) {
      plumb::paper_tetrahedron(axes);
    } else {
      plumb::cone_with_axis(axes, n);
    }
    const plumb::Datasheet d = datasheet_of(axes, n, kSigma);
    const Judged j = judged(d, rolls(d, normal_truth(d, noise), 0.0, noise));
    const plumb::CommonTurn& turn = j.report.common_turn;
    ASSERT_GT(turn.sigma_rad, 0.0) << seed;
    squares += turn.sigmas() * turn.sigmas() / kRuns;
    refused += j.judgement.concern == Concern::roll_axis ? 1 : 0;
    told += turn.sigmas() > plumb::AcceptanceLimits{}.told_common_turn_sigmas ? 1 : 0;
  }
  EXPECT_EQ(refused, 0);
  EXPECT_NEAR(squares, 2.0, 0.3) << "two directions";
  EXPECT_NEAR(told / static_cast<double>(kRuns), std::exp(-2.0), 0.05);
  std::cout << "[ measured ] right axis: refused " << refused << ", told " << told << " of " << kRuns << '\n';
}

TEST(CommonTurn, AnAxisThatIsWrongByManySigmasIsRefusedAsSuch) {
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    for (const double off_deg : {8.0, 12.0, 25.0}) {  // 1 sigma is 0.7 deg here; axes may be 15 deg off
      Noise noise(seed);
      const plumb::Datasheet d = paper_tool(kSigma);
      const Truth truth = draw_truth(d, noise);
      const Judged j = judged(d, rolls(d, truth, off_deg, noise));
      EXPECT_EQ(j.judgement.error.code, Errc::implausible) << seed << ' ' << off_deg;
      EXPECT_EQ(j.judgement.error.index, -1) << seed << ' ' << off_deg;
      EXPECT_GT(j.judgement.error.value, j.judgement.error.limit);
      if (off_deg < 10.0) {
        EXPECT_EQ(j.judgement.concern, Concern::roll_axis) << seed;
      }
      EXPECT_NEAR(plumb::deg_from_rad(j.report.common_turn.rad), off_deg, 3.0);
      EXPECT_EQ(j.report.common_turn.sensor, -1);
      // The same attitudes say nothing of a roll axis where nobody says that they were rolls.
      std::vector<plumb::Station> plain = rolls(d, truth, off_deg, noise);
      for (plumb::Station& s : plain) s.roll_group = 0;
      EXPECT_EQ(judged(d, plain).judgement.error.code, Errc::ok) << seed << ' ' << off_deg;
      EXPECT_EQ(judged(d, plain).report.common_turn.sigma_rad, 0.0);
    }
  }
}

TEST(CommonTurn, TheSigmaIsThatOfTheNominalAxesAlone) {
  Noise noise(3);
  const plumb::Datasheet d = paper_tool(kSigma);
  std::vector<plumb::Station> stations = rolls(d, draw_truth(d, noise), 0.5, noise);
  const plumb::CommonTurn turn = judged(d, stations).report.common_turn;
  for (plumb::Station& s : stations) s.roll_group = 0;
  EXPECT_NEAR(turn.sigma_rad, judged(d, stations).report.inclination_sigma_rad, 1e-9);
}

/// One axis that is far off turns the mean of all, too.
TEST(CommonTurn, OneAxisThatIsOffIsNotTheRollAxis) {
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    for (int sensor = 0; sensor < 4; ++sensor) {
      Noise noise(seed);
      const plumb::Datasheet d = paper_tool(kSigma);
      Truth truth = draw_truth(d, noise);
      Vec3& w = truth.w[at(sensor)];
      const Vec3 helper = std::fabs(w[2]) < 0.7 ? Vec3{0.0, 0.0, 1.0} : Vec3{1.0, 0.0, 0.0};
      const Vec3 across = plumb::cross(w, helper);
      w = turned(w, plumb::scaled(across, plumb::rad_from_deg(13.0) / plumb::norm(across)));
      const Judged j = judged(d, rolls(d, truth, 0.0, noise));
      EXPECT_NE(j.judgement.concern, Concern::roll_axis) << seed << ' ' << sensor;
      EXPECT_EQ(j.report.common_turn.sensor, sensor) << seed;
    }
  }
}

TEST(CommonTurn, AnyDirectionOfTheRollAxisIsJudgedAlike) {
  Noise noise(11);
  const plumb::Datasheet d = paper_tool(kSigma);
  const std::vector<plumb::Station> stations = rolls(d, draw_truth(d, noise), 2.0, noise);
  const auto cycled = [](const Vec3& v) { return Vec3{v[2], v[0], v[1]}; };
  plumb::Datasheet other = d;
  for (int i = 0; i < 4; ++i) other.sensor[at(i)].row.axis = cycled(d.sensor[at(i)].row.axis);
  plumb::FitOptions o;
  o.roll_axis = {1.0, 0.0, 0.0};
  const plumb::CommonTurn one = judged(d, stations).report.common_turn,
                          two = judged(other, stations, o).report.common_turn;
  EXPECT_NEAR(one.rad, two.rad, 1e-9);
  EXPECT_NEAR(one.sigma_rad, two.sigma_rad, 1e-12);
}

}  // namespace
}  // namespace common_turn_test
