// How the magnetometers are turned, found from the dip, and refused where the attitudes cannot tell.
#include "plumb/survey/joint_alignment.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <iostream>
#include <limits>

#include "support/binomial_interval.hpp"
#include "turned_tool.hpp"

namespace joint_alignment_test {
namespace {

using namespace plumb;
using namespace plumb::survey;
using namespace simulated_survey;
using namespace turned_tool;

std::size_t at(Term term) { return static_cast<std::size_t>(term); }

AlignmentSettings unknown_dip() {
  AlignmentSettings out;
  out.dip_known = false;
  return out;
}

TEST(JointAlignment, FindsTheTurnAndTheDip) {
  TurnedTool tool;
  tool.turn_rad = degrees(0.6, -0.4, 0.5);
  World off;
  off.dip_rad += rad_from_deg(3.0);
  for (const bool known : {true, false}) {
    AlignmentSettings settings;
    settings.dip_known = known;
    const auto found = align_magnetometers(tool.of(scattered(40), known ? World{} : off), settings);
    ASSERT_TRUE(found.has_value()) << found.error().text();
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_NEAR(found->turn_rad[k], tool.turn_rad[k], 4.0 * found->sigma_rad[k]);
      EXPECT_LT(found->sigma_rad[k], rad_from_deg(0.01));
    }
    EXPECT_NEAR(found->dip_offset_rad, known ? 0.0 : rad_from_deg(-3.0), 4.0 * found->dip_sigma_rad);
    EXPECT_GT(found->chance, 1e-3);
    EXPECT_EQ(found->freedom, known ? 117 : 116);
    EXPECT_NEAR(found->held_out.normalised, 1.0, 0.4);
    EXPECT_EQ(found->held_out.decisive, 0);
  }
}

TEST(JointAlignment, IsAsSureOnABuildUpAsItsAzimuthAllows) {
  // About z magnetic east shows by sin I sin A: nothing on a hole to the north.
  for (const double azimuth_deg : {0.0, 45.0, 90.0, 135.0}) {
    TurnedTool tool;
    tool.turn_rad = degrees(0.6, -0.4, 0.5);
    const auto found = align_magnetometers(tool.of(build_up(azimuth_deg, 25)), {});
    ASSERT_EQ(found.has_value(), azimuth_deg > 0.0);
    if (!found) {
      EXPECT_EQ(found.error().why, NoAlignment::not_observable);
      EXPECT_EQ(found.error().rank, 2);
      EXPECT_EQ(found.error().axis[0].name(), "tool z");
      continue;
    }
    EXPECT_NEAR(found->turn_rad[2], tool.turn_rad[2], 4.0 * found->sigma_rad[2]);
    EXPECT_LT(found->sigma_rad[2], rad_from_deg(0.06));
    std::cout << "[ measured ] azimuth " << azimuth_deg << ": sigma about x, y, z " << deg_from_rad(found->sigma_rad[0])
              << ", " << deg_from_rad(found->sigma_rad[1]) << ", " << deg_from_rad(found->sigma_rad[2])
              << " deg; weakest correlates by " << found->axis[0].correlation << " with " << found->axis[0].with
              << "\n";
  }
}

struct Counted {
  int inside = 0, azimuth_inside = 0, tools = 0, azimuths = 0;
};

/// Tools, noise and references drawn as stated, attitudes at random.
Counted count_coverage(bool known, int tools) {
  constexpr double kChi3 = 7.814727903251179;  // 0.95 of a chi-square of three
  Counted out;
  std::mt19937_64 generator(known ? 31 : 32);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  for (int k = 0; k < tools; ++k) {
    TurnedTool tool;
    tool.seed = static_cast<unsigned>(k + 1);
    for (double& t : tool.turn_rad) t = rad_from_deg(0.5) * normal(generator);
    for (std::size_t t = 0; t < kTermCount; ++t)
      tool.errors[t] = sigma_of(static_cast<Term>(t), iscwsa_tool()) * normal(generator);
    tool.world.g_mps2 += 1.5e-3 * normal(generator);
    tool.world.field_tesla += 130e-9 * normal(generator);
    tool.world.dip_rad += (known ? rad_from_deg(0.2) : rad_from_deg(5.0)) * normal(generator);
    const auto draw = [&] {
      return Truth{std::acos(1.0 - 2.0 * uniform(generator)), 2.0 * kPi * uniform(generator),
                   2.0 * kPi * uniform(generator)};
    };
    std::vector<Truth> hole;
    for (int i = 0; i < 15; ++i) hole.push_back(draw());
    AlignmentSettings settings;
    settings.dip_known = known;
    const auto found = align_magnetometers(tool.of(hole), settings);
    if (!found) continue;
    ++out.tools;
    Eigen::Matrix3d c;
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j)
        c(i, j) = found->covariance[static_cast<std::size_t>(i) * kAlignmentUnknowns + static_cast<std::size_t>(j)];
    }
    const Vec3 off = minus(found->turn_rad, tool.turn_rad);
    const Eigen::Vector3d error(off[0], off[1], off[2]);
    out.inside += error.dot(c.inverse() * error) < kChi3 ? 1 : 0;
    // The azimuth of a station that took no part.
    const Truth truth = draw();
    TurnedTool again = tool;
    again.seed += 100000;
    const CorrectedStation next = aligned(again.of({truth})[0].measured, *found);
    const Attitude attitude = attitude_of(next.measured, next.total);
    if (!attitude.azimuth) continue;
    ++out.azimuths;
    const double miss = std::remainder(attitude.azimuth->angle.rad - truth.azimuth_rad, 2.0 * kPi);
    out.azimuth_inside += std::fabs(miss) < 1.959963985 * attitude.azimuth->angle.sigma_rad ? 1 : 0;
  }
  return out;
}

TEST(JointAlignment, CoversTheTruthAsOftenAsItSays) {
  constexpr int kTools = 2000;
  for (const bool known : {true, false}) {
    const Counted counted = count_coverage(known, kTools);
    EXPECT_GE(counted.tools, kTools - 2);  // one in a million does not fit by chance
    const auto turn = plumb_test::clopper_pearson(counted.inside, counted.tools, 0.999);
    const auto azimuth = plumb_test::clopper_pearson(counted.azimuth_inside, counted.azimuths, 0.999);
    EXPECT_TRUE(turn.low < 0.95 && 0.95 < turn.high) << counted.inside << " of " << counted.tools;
    EXPECT_TRUE(azimuth.low < 0.95 && 0.95 < azimuth.high) << counted.azimuth_inside << " of " << counted.azimuths;
    std::cout << "[ measured ] dip " << (known ? "known" : "unknown") << ": rotation in its 95 % region "
              << counted.inside << " of " << counted.tools << ", azimuth " << counted.azimuth_inside << " of "
              << counted.azimuths << "\n";
  }
}

TEST(JointAlignment, TakesInterferenceForWhatItIs) {
  // 600 nT along the tool, on a hole that turns: an unknown of its own beside the rotation.
  TurnedTool tool;
  tool.turn_rad = degrees(0.6, -0.4, 0.5);
  tool.errors[at(Term::magnetometer_bias_z)] = 600e-9;
  const auto found = align_magnetometers(tool.of(build_up(45.0, 25)), {});
  ASSERT_TRUE(found.has_value()) << found.error().text();
  EXPECT_NEAR(found->value[at(Term::magnetometer_bias_z)], 600e-9, 100e-9);
  for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(found->turn_rad[k], tool.turn_rad[k], 4.0 * found->sigma_rad[k]);
}

TEST(JointAlignment, SaysWhatItIsCorrelatedWith) {
  // Vertical: a rotation about x is the tilt of the accelerometers that their bias along y makes.
  TurnedTool tool;
  const auto upright = align_magnetometers(tool.of(build_up(0.0, 25, 0.0, 0.0)), {});
  ASSERT_FALSE(upright.has_value());
  const AlignmentAxis& across = upright.error().axis[2];
  EXPECT_NE(across.with.find("accelerometer bias"), std::string::npos) << across.with;
  EXPECT_GT(std::fabs(across.correlation), 0.5);
  // A tangent: only the reference of the dip knows the rotation about the tool's own axis.
  const auto tangent = align_magnetometers(tool.of(build_up(90.0, 25, 60.0, 60.0)), {});
  ASSERT_TRUE(tangent.has_value()) << tangent.error().text();
  EXPECT_EQ(tangent->axis[0].name(), "tool z");
  EXPECT_EQ(tangent->axis[0].with, "the reference of the dip");
  EXPECT_GT(std::fabs(tangent->axis[0].correlation), 0.95);
  EXPECT_GT(tangent->sigma_rad[2], rad_from_deg(0.2));
}

TEST(JointAlignment, RefusesWhatTheToolsErrorsExplainAsWell) {
  // Upright, and lying to the east at one toolface, with accelerometers off by 30 mg: along x neither length shows it,
  // and the dips take it for a rotation. Without that error the same stations tell the rotation.
  TurnedTool tool;
  std::vector<Truth> hole = build_up(0.0, 20, 0.0, 0.0);
  for (int k = 0; k < 8; ++k) hole.push_back({0.5 * kPi, 0.5 * kPi, 0.0});
  AlignmentSettings settings;
  EXPECT_TRUE(align_magnetometers(tool.of(hole), settings).has_value());
  settings.tool.accelerometer_bias_mps2 = 0.3;
  const auto found = align_magnetometers(tool.of(hole), settings);
  ASSERT_FALSE(found.has_value());
  EXPECT_EQ(found.error().why, NoAlignment::correlated) << found.error().text();
  EXPECT_EQ(found.error().axis[0].with, "accelerometer bias x");
  EXPECT_GT(std::fabs(found.error().axis[0].correlation), 0.9);
  EXPECT_NE(found.error().text().find("from accelerometer bias x (correlation "), std::string::npos)
      << found.error().text();
}

TEST(JointAlignment, RefusesWhatOnlyAnUnsureDipTells) {
  TurnedTool tool;
  std::vector<ReferencedStation> stations = tool.of(build_up(90.0, 25, 60.0, 60.0));
  for (ReferencedStation& s : stations) s.reference.field.dip_rad_sigma.common = rad_from_deg(1.0);
  const auto found = align_magnetometers(stations, {});
  ASSERT_FALSE(found.has_value());
  EXPECT_EQ(found.error().why, NoAlignment::not_observable);
  EXPECT_NE(found.error().text().find("along that axis is 0.866 at all of them"), std::string::npos)
      << found.error().text();
}

TEST(JointAlignment, NamesWhatTheAttitudesDoNotShow) {
  TurnedTool tool;
  const auto refusal = [&](const std::vector<Truth>& hole, const AlignmentSettings& settings, const World& world) {
    tool.world = world;
    const auto found = align_magnetometers(tool.of(hole, world), settings);
    EXPECT_FALSE(found.has_value());
    return found ? AlignmentRefusal{} : found.error();
  };
  const AlignmentRefusal vertical = refusal(build_up(0.0, 25, 0.0, 0.0), {}, World{});
  EXPECT_EQ(vertical.rank, 2);
  EXPECT_NE(
      vertical.text().find("do not show the rotation about tool z: the component of magnetic east along that axis "
                           "is 0.000"),
      std::string::npos)
      << vertical.text();
  const AlignmentRefusal tangent = refusal(build_up(90.0, 25, 60.0, 60.0), unknown_dip(), World{});
  EXPECT_EQ(tangent.rank, 2);
  EXPECT_NE(tangent.text().find("along that axis is 0.866 at all of them, within 0.000"), std::string::npos)
      << tangent.text();
  EXPECT_NE(tangent.text().find("looks like another dip"), std::string::npos);
  // Lying to the north at one toolface: east stays on tool x. Of the dip, only that rotation.
  std::vector<Truth> one(25, Truth{0.5 * kPi, 0.0, 0.5 * kPi});
  const AlignmentRefusal still = refusal(one, {}, World{});
  EXPECT_EQ(still.rank, 1);
  EXPECT_NE(still.text().find("rotations about axes across tool y"), std::string::npos) << still.text();
  EXPECT_EQ(refusal(one, unknown_dip(), World{}).rank, 0);
  EXPECT_NE(refusal(one, unknown_dip(), World{}).text().find("do not show any rotation"), std::string::npos);
  World pole;
  pole.dip_rad = rad_from_deg(89.95);
  for (const bool noisy : {true, false}) {
    tool.noisy = noisy;
    pole.dip_rad = noisy ? rad_from_deg(89.95) : 0.5 * kPi;
    EXPECT_NE(refusal(scattered(40), {}, pole).text().find("gravity and field are almost parallel"), std::string::npos)
        << refusal(scattered(40), {}, pole).text();
  }
}

TEST(JointAlignment, RefusesAnEstimateThatIsNoBetterThanWhatIsStated) {
  TurnedTool tool;
  AlignmentSettings settings;
  settings.stated_rad = rad_from_deg(0.005);
  const auto found = align_magnetometers(tool.of(scattered(40)), settings);
  ASSERT_FALSE(found.has_value());
  EXPECT_EQ(found.error().why, NoAlignment::not_observable);
  EXPECT_LT(found.error().rank, 3);
}

TEST(JointAlignment, RefusesDataWithAnotherError) {
  TurnedTool tool;
  std::vector<ReferencedStation> stations = tool.of(scattered(40));
  stations[11].measured.field_tesla[0] += 5e-6;
  const auto misfit = align_magnetometers(stations, {});
  ASSERT_FALSE(misfit.has_value());
  EXPECT_EQ(misfit.error().why, NoAlignment::misfit);
  EXPECT_GT(misfit.error().value, misfit.error().limit);
  tool.turn_rad = degrees(0.0, 9.0, 0.0);
  const auto turned = align_magnetometers(tool.of(scattered(40)), {});
  ASSERT_FALSE(turned.has_value());
  EXPECT_EQ(turned.error().why, NoAlignment::implausible);
  EXPECT_NE(turned.error().text().find("turned by 9.0"), std::string::npos) << turned.error().text();
  AlignmentSettings wide;
  wide.stated_rad = rad_from_deg(5.0);
  EXPECT_TRUE(align_magnetometers(tool.of(scattered(40)), wide).has_value());
}

TEST(JointAlignment, SaysWhatIsMissing) {
  TurnedTool tool;
  const std::vector<ReferencedStation> good = tool.of(scattered(40));
  const auto first = [&](std::size_t n) {
    return std::vector<ReferencedStation>(good.begin(), good.begin() + static_cast<std::ptrdiff_t>(n));
  };
  EXPECT_EQ(align_magnetometers({}, {}).error().why, NoAlignment::too_few_stations);
  EXPECT_EQ(align_magnetometers(first(5), {}).error().why, NoAlignment::too_few_stations);
  EXPECT_EQ(align_magnetometers(first(5), {}).error().limit, 6.0);
  EXPECT_EQ(align_magnetometers(first(6), unknown_dip()).error().limit, 7.0);
  std::vector<ReferencedStation> broken = good;
  broken[3].measured.field_tesla[1] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(align_magnetometers(broken, {}).error().why, NoAlignment::not_finite);
  EXPECT_EQ(align_magnetometers(broken, {}).error().value, 3.0);
  broken = good;
  broken[4].measured.random = {};
  EXPECT_EQ(align_magnetometers(broken, {}).error().why, NoAlignment::no_random_error);
  for (const NoAlignment why : {NoAlignment::too_few_stations, NoAlignment::not_finite, NoAlignment::no_random_error,
                                NoAlignment::not_converged, NoAlignment::not_observable, NoAlignment::correlated,
                                NoAlignment::misfit, NoAlignment::implausible}) {
    AlignmentRefusal refusal;
    refusal.why = why;
    EXPECT_GT(refusal.text().size(), 20U);
  }
}

TEST(JointAlignment, HoldsEachStationOut) {
  TurnedTool tool;
  tool.turn_rad = degrees(0.2, 0.3, -0.5);
  const std::vector<ReferencedStation> all = tool.of(scattered(14));
  const auto whole = align_magnetometers(all, {});
  ASSERT_TRUE(whole.has_value());
  double squares = 0.0;
  for (std::size_t k = 0; k < all.size(); ++k) {
    std::vector<ReferencedStation> others = all;
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(k));
    const auto without_it = align_magnetometers(others, {});
    ASSERT_TRUE(without_it.has_value());
    const Measurement m = aligned(all[k].measured, *without_it).measured;
    const double residual =
        totals_of(m.gravity_mps2, m.field_tesla).dip_rad - all[k].reference.field.dip_rad - without_it->dip_offset_rad;
    squares += residual * residual;
  }
  EXPECT_NEAR(whole->held_out.rms_rad, std::sqrt(squares / 14.0), 1e-3 * whole->held_out.rms_rad);
}

TEST(JointAlignment, CountsStationsThatNothingCouldHoldAgainst) {
  // All but one of them roll upright: that one alone shows the rotation about z.
  TurnedTool tool;
  std::vector<Truth> hole = build_up(0.0, 20, 0.0, 0.0);
  hole.push_back({0.5 * kPi, 0.5 * kPi, 0.0});
  const auto found = align_magnetometers(tool.of(hole), {});
  ASSERT_TRUE(found.has_value()) << found.error().text();
  EXPECT_EQ(found->held_out.decisive, 1);
  EXPECT_NE(found->held_out.worst, 20);
}

TEST(JointAlignment, TakesTheTurnOffTheAzimuth) {
  TurnedTool tool;
  tool.turn_rad = degrees(0.3, -0.2, 0.9);
  const std::vector<ReferencedStation> stations = tool.of(build_up(60.0, 25));
  const auto found = align_magnetometers(stations, {});
  ASSERT_TRUE(found.has_value()) << found.error().text();
  const ReferencedStation& last = stations[12];
  const Attitude before = attitude_of(last.measured, total_covariance(last.measured, iscwsa_tool()));
  const SurveyStation after = judge_corrected(aligned(last.measured, *found), last.reference, {});
  ASSERT_TRUE(before.azimuth && after.attitude.azimuth);
  EXPECT_GT(std::fabs(deg_from_rad(before.azimuth->angle.rad) - 60.0), 0.4);
  EXPECT_NEAR(after.attitude.azimuth->angle.rad, rad_from_deg(60.0), 4.0 * after.attitude.azimuth->angle.sigma_rad);
  EXPECT_EQ(after.status, StationStatus::accepted);
  // A bound of an axis is shared by those that it is turned into; the noise of all together stays.
  Measurement bounded = last.measured;
  bounded.bias_bound = {0.01, 0.0, 0.0, 0.0, 1e-6, 0.0};
  const Measurement turned = aligned(bounded, *found).measured;
  EXPECT_EQ(turned.bias_bound[0], 0.01);
  EXPECT_NEAR(turned.bias_bound[4], 1e-6, 1e-9);
  EXPECT_NEAR(turned.bias_bound[3], 1e-6 * std::fabs(found->rotation[1]), 1e-15);
  EXPECT_NEAR(turned.random[21] + turned.random[28] + turned.random[35], 3.0 * std::pow(20e-9, 2), 1e-22);
}

}  // namespace
}  // namespace joint_alignment_test
