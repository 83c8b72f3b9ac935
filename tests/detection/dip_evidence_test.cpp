// Stations by length and dip together (docs/theory.md, T16): nobody healthy is named, no bound is too small.
#include "plumb/detection/dip_evidence.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <type_traits>
#include <vector>

#include "plumb/core/detail/archive.hpp"
#include "support/dip_scene.hpp"
#include "support/simulated_tool.hpp"

// Serves: REQ-221

namespace dip_evidence_test {
namespace {

using namespace plumb;
using plumb_test::DipScene;
using plumb_test::Noise;

constexpr auto kExact = [] { return 0.0; };

/// Three to five axes, any dip, errors within what is stated, one sensor at most that is faulty throughout.
struct Episode {
  Noise noise{*rc::gen::arbitrary<std::uint64_t>()};
  DipScene scene;
  int kind = *rc::gen::inRange(0, 3);
  int faulty = -1;
  bool constant = *rc::gen::arbitrary<bool>();
  double f_mps2 = 0.0;

  Episode() {
    const int n = *rc::gen::element(3, 3, 3, 3, kCapacity < 5 ? 4 : 5);
    const double least_det = *rc::gen::element(0.06, 0.4, 0.95);
    const double dip_deg = *rc::gen::oneOf(rc::gen::element(0.0, 90.0, -90.0),
                                           rc::gen::map(rc::gen::inRange(-900, 901), [](int k) { return 0.1 * k; }));
    scene = DipScene::make(plumb_test::sensors_along(plumb_test::random_axes(n, least_det, noise), n), dip_deg);
    scene.stated.field.vector_nt = *rc::gen::element(0.0, 100.0, 1500.0);
    scene.stated.acceleration_mps2 = *rc::gen::element(0.0, 0.01);
    scene.settle([this] { return draw(); });
    faulty = *rc::gen::inRange(-1, n);
    f_mps2 = fault();
  }
  double draw() {
    const double u = 2.0 * noise.uniform() - 1.0;
    return kind == 0 ? 0.0 : kind == 1 ? (u < 0.0 ? -1.0 : 1.0) : u;
  }
  double fault() { return (noise.uniform() < 0.5 ? -1.0 : 1.0) * 2.0 * kG0_mps2 * std::pow(1e-3, noise.uniform()); }
  /// A mirror fault, none for once, or any: unless it is to be constant.
  double fault_at(const Vec3& down) {
    if (faulty < 0) return 0.0;
    if (constant) return f_mps2;
    const int which = *rc::gen::inRange(0, 4);
    if (which == 0) return 0.0;
    return which == 1 ? plumb_test::mirror_fault_mps2(scene.array, faulty, scaled(down, scene.g_mps2)) : fault();
  }
  DipAssumption assumption() const { return constant ? DipAssumption::constant_bias : DipAssumption::any_fault; }
};

// Verifies: REQ-221, REQ-222
RC_GTEST_PROP(DipEvidenceLaw, NobodyHealthyIsNamedAndTheBoundHolds, ()) {
  Episode e;
  DipEvidence evidence(e.assumption());
  const int stations = *rc::gen::inRange(1, 6);
  for (int k = 0; k < stations; ++k) {
    const Vec3 down = plumb_test::random_direction(e.noise);
    const double f = e.fault_at(down);
    const DipStation station = e.scene.station(down, e.faulty, f, e.noise, [&] { return e.draw(); });
    const DipAnswer answer = evidence.add(judge_dip(e.scene.array, station));
    RC_ASSERT(answer.verdict != DipVerdict::not_judged && answer.verdict != DipVerdict::unexplained);
    RC_ASSERT(answer.named == -1 || answer.named == e.faulty);
    RC_ASSERT(e.faulty >= 0 || answer.verdict != DipVerdict::fault);
    RC_ASSERT(e.faulty < 0 || answer.suspects.has(e.faulty));
    RC_ASSERT(angle_between_rad(answer.gravity_mps2, down) <= answer.bound_rad + 1e-9);
    RC_ASSERT(answer.bound_rad <= kPi);
  }
}

/// The two explanations of the same readings (T16): gravity and its mirror in the plane of the field and axis k.
// Negative: REQ-221
RC_GTEST_PROP(DipEvidenceLaw, TwoSensorsWhoseFaultsLookAlikeAreBothKept, ()) {
  Noise noise(*rc::gen::arbitrary<std::uint64_t>());
  const DipScene scene = DipScene::make(plumb_test::sensors_along(plumb_test::random_axes(3, 0.1, noise), 3),
                                        0.1 * *rc::gen::inRange(-850, 851));
  const Vec3 down = plumb_test::random_direction(noise);
  const Vec3 along = plumb_test::direction_beside(down, 0.5 * kPi - scene.dip_rad, noise);
  const int k = *rc::gen::inRange(0, 3), i = (k + 1) % 3, j = (k + 2) % 3;
  Vec3 normal = cross(along, scene.array.axis(k));
  RC_PRE(norm(normal) > 0.01);
  normal = scaled(normal, 1.0 / norm(normal));
  const Vec3 other = minus(down, scaled(normal, 2.0 * dot(normal, down)));
  // Truth `down` with sensor i faulty, or truth `other` with sensor j.
  const double f = dot(scene.array.axis(i), minus(other, down)) * scene.g_mps2;
  const DipStation station = scene.station(down, along, i, f, noise, kExact);
  const DipJudgement judged = judge_dip(scene.array, station);
  RC_ASSERT(judged.refusal == DipRefusal::none);
  const double g = dot(scene.array.axis(j), minus(down, other)) * scene.g_mps2;
  RC_ASSERT(judged.faulty[static_cast<std::size_t>(i)].fault().has(f));
  RC_ASSERT(judged.faulty[static_cast<std::size_t>(j)].fault().has(g));
  const DipAnswer answer = DipEvidence().add(judged);
  RC_ASSERT(answer.named == -1);
  RC_ASSERT(answer.suspects.has(i) && answer.suspects.has(j));
  RC_ASSERT(angle_between_rad(answer.gravity_mps2, down) <= answer.bound_rad);
  RC_ASSERT(angle_between_rad(answer.gravity_mps2, other) <= answer.bound_rad);
}

/// ... at one attitude. A constant bias is told at another one; what may be any fault is told there as well, if no
/// other sensor explains both.
TEST(DipEvidence, AnotherAttitudeTellsWhichOfTheTwoItIs) {
  Noise noise(11);
  const DipScene scene = DipScene::make(plumb_test::triad_array(), 50.0);
  const Vec3 down = plumb_test::direction_at(50, 30);
  const Vec3 along = plumb_test::direction_beside(down, rad_from_deg(40.0), noise);
  Vec3 normal = cross(along, scene.array.axis(2));
  normal = scaled(normal, 1.0 / norm(normal));
  const Vec3 other = minus(down, scaled(normal, 2.0 * dot(normal, down)));
  const double f = dot(scene.array.axis(0), minus(other, down)) * scene.g_mps2;
  ASSERT_GT(std::fabs(f), 0.3);
  for (const DipAssumption assumption : {DipAssumption::any_fault, DipAssumption::constant_bias}) {
    DipEvidence evidence(assumption);
    const DipAnswer first = evidence.add(judge_dip(scene.array, scene.station(down, along, 0, f, noise, kExact)));
    EXPECT_EQ(first.verdict, DipVerdict::fault);
    EXPECT_EQ(first.named, -1);
    EXPECT_EQ(first.suspects, SensorSet::first(2));
    const Vec3 next = plumb_test::direction_at(20, 200);
    const DipAnswer second = evidence.add(judge_dip(scene.array, scene.station(next, 0, f, noise, kExact)));
    EXPECT_EQ(second.verdict, DipVerdict::fault);
    EXPECT_EQ(second.named, 0);
    EXPECT_LT(angle_between_rad(second.gravity_mps2, next), second.bound_rad);
    EXPECT_EQ(evidence.stations(), 2);
    EXPECT_EQ(evidence.suspects(), SensorSet::of(0));
    EXPECT_EQ(evidence.bias(0).has(f), assumption == DipAssumption::constant_bias);
  }
}

// Verifies: REQ-222
TEST(DipEvidence, AMirrorFaultIsNamedAndTheDirectionOfTheOthersIsBounded) {
  Noise noise(5);
  const DipScene scene = DipScene::make(plumb_test::triad_array(), 72.0);
  const Vec3 down = plumb_test::direction_at(40, 70);
  const double f = plumb_test::mirror_fault_mps2(scene.array, 0, scaled(down, scene.g_mps2));
  const DipStation station =
      scene.station(down, plumb_test::direction_beside(down, rad_from_deg(18.0), noise), 0, f, noise, kExact);
  const DipAnswer answer = DipEvidence().add(judge_dip(scene.array, station));
  EXPECT_EQ(answer.verdict, DipVerdict::fault);
  EXPECT_EQ(answer.named, 0);
  EXPECT_LT(angle_between_rad(answer.gravity_mps2, down), answer.bound_rad);
  EXPECT_LT(answer.bound_rad, rad_from_deg(5.0));
}

// Negative: REQ-222
TEST(DipEvidence, WithoutTheDipTheBoundIsThatOfAMirror) {
  Noise noise(5);
  const DipScene scene = DipScene::make(plumb_test::triad_array(), 72.0);
  const Vec3 down = plumb_test::direction_at(40, 70);
  const Vec3 along = plumb_test::direction_beside(down, rad_from_deg(18.0), noise);
  DipStation station = scene.station(down, along, -1, 0.0, noise, kExact);
  const DipAnswer with = DipEvidence().add(judge_dip(scene.array, station));
  EXPECT_EQ(with.verdict, DipVerdict::consistent);
  EXPECT_LT(with.bound_rad, rad_from_deg(8.0));
  station.reference.dip_error_rad.bound = kPi;
  const DipAnswer without = DipEvidence().add(judge_dip(scene.array, station));
  EXPECT_EQ(without.verdict, DipVerdict::unseen);
  EXPECT_EQ(without.mirrors, SensorSet::first(3));
  EXPECT_GT(without.bound_rad, rad_from_deg(60.0));
}

/// The dip knows no more than its error is stated to be: beyond that a healthy sensor may be named.
// Negative: REQ-221
TEST(DipEvidence, AnInterferenceBeyondItsBoundNamesHealthySensors) {
  Noise noise(17);
  int named = 0, with_bound = 0, faults = 0;
  for (int trial = 0; trial < 400; ++trial) {
    DipScene scene = DipScene::make(plumb_test::triad_array(), 60.0);
    const Vec3 down = plumb_test::random_direction(noise);
    DipScene disturbed = scene;
    disturbed.dip_rad += rad_from_deg(4.0);  // of the length that is expected
    DipStation station = disturbed.station(down, -1, 0.0, noise, kExact);
    const DipAnswer believed = DipEvidence().add(judge_dip(scene.array, station));
    if (believed.named >= 0) ++named;
    station.reference.dip_error_rad.bound = rad_from_deg(4.0);
    const DipAnswer bounded = DipEvidence().add(judge_dip(scene.array, station));
    if (bounded.verdict == DipVerdict::fault) ++faults;
    if (bounded.named >= 0) ++with_bound;
  }
  EXPECT_GT(named, 0);
  EXPECT_EQ(with_bound, 0);
  EXPECT_EQ(faults, 0);
}

/// A sensor that was healthy before has no constant bias: the evidence has to begin with the fault.
TEST(DipEvidence, AFaultThatBeginsNeedsANewBeginningWhereItIsTakenForConstant) {
  Noise noise(21);
  const DipScene scene = DipScene::make(plumb_test::triad_array(), 60.0);
  const double f = 0.3 * kG0_mps2;
  const auto judged = [&](double inclination_deg, double fault) {
    return judge_dip(scene.array,
                     scene.station(plumb_test::direction_at(inclination_deg, 40), 1, fault, noise, kExact));
  };
  DipEvidence any, constant(DipAssumption::constant_bias);
  EXPECT_NE(any.add(judged(30, 0.0)).verdict, DipVerdict::fault);
  EXPECT_NE(constant.add(judged(30, 0.0)).verdict, DipVerdict::fault);
  EXPECT_EQ(any.add(judged(50, f)).named, 1);
  EXPECT_NE(constant.add(judged(50, f)).named, 1);
  constant.forget();
  EXPECT_EQ(constant.stations(), 0);
  EXPECT_EQ(constant.add(judged(50, f)).named, 1);
  EXPECT_TRUE(constant.bias(1).has(f));
}

TEST(DipEvidence, AFaultThatDoesNotShowEverywhereStaysOne) {
  Noise noise(19);
  const DipScene scene = DipScene::make(plumb_test::triad_array(), 60.0);
  DipEvidence evidence;
  for (const double f : {3.0, 0.0, 0.0}) {
    const DipStation station = scene.station(plumb_test::direction_at(40, 70), 1, f, noise, kExact);
    const DipAnswer answer = evidence.add(judge_dip(scene.array, station));
    EXPECT_EQ(answer.verdict, DipVerdict::fault);
    EXPECT_EQ(answer.named, 1);
  }
}

// Verifies: REQ-223
TEST(DipEvidence, ARefusedStationChangesNothing) {
  Noise noise(23);
  const DipScene scene = DipScene::make(plumb_test::tetrahedron(), 60.0);
  const DipStation station = scene.station(plumb_test::direction_at(40, 70), 2, 1.0, noise, kExact);
  DipEvidence evidence;
  const DipAnswer before = evidence.add(judge_dip(scene.array, station));
  DipStation disturbed = station;
  disturbed.field.field_nt = scaled(disturbed.field.field_nt, 0.9);
  const DipAnswer refused = evidence.add(judge_dip(scene.array, disturbed));
  EXPECT_EQ(refused.verdict, DipVerdict::not_judged);
  EXPECT_EQ(refused.refusal, DipRefusal::field_length);
  EXPECT_EQ(refused.bound_rad, kPi);
  DipStation three = station;
  three.used = station.used.without(3);
  EXPECT_EQ(evidence.add(judge_dip(scene.array, three)).refusal, DipRefusal::sensors_changed);
  EXPECT_EQ(evidence.stations(), 1);
  const DipAnswer after = evidence.add(judge_dip(scene.array, station));
  EXPECT_EQ(after.named, before.named);
  EXPECT_EQ(after.bound_rad, before.bound_rad);
}

TEST(DipEvidence, SeveralFaultsAreNotExplainedByOne) {
  Noise noise(29);
  const DipScene scene = DipScene::make(plumb_test::tetrahedron(), 60.0);
  DipStation station = scene.station(plumb_test::direction_at(40, 70), 2, 1.0, noise, kExact);
  station.mean_mps2[0] -= 2.0;
  const DipAnswer answer = DipEvidence().add(judge_dip(scene.array, station));
  EXPECT_EQ(answer.verdict, DipVerdict::unexplained);
  EXPECT_EQ(answer.bound_rad, kPi);
  EXPECT_EQ(answer.named, -1);
}

TEST(DipEvidence, IsWrittenAndReadBackAsItWas) {
  Noise noise(31);
  const DipScene scene = DipScene::make(plumb_test::triad_array(), 60.0);
  DipEvidence evidence(DipAssumption::constant_bias);
  const DipStation station = scene.station(plumb_test::direction_at(40, 70), 1, 0.5, noise, kExact);
  evidence.add(judge_dip(scene.array, station));
  std::array<std::uint8_t, 1000> bytes{};
  ArchiveWriter out(bytes.data(), bytes.size(), 3);
  out.put(evidence);
  ASSERT_LE(out.used(), bytes.size());
  DipEvidence back;
  ArchiveReader in(bytes.data(), out.used(), 3);
  in.get(back);
  EXPECT_TRUE(in.sound());
  const DipJudgement next =
      judge_dip(scene.array, scene.station(plumb_test::direction_at(60, 10), 1, 0.5, noise, kExact));
  const DipAnswer expected = evidence.add(next), answer = back.add(next);
  EXPECT_EQ(answer.named, expected.named);
  EXPECT_EQ(answer.bound_rad, expected.bound_rad);
  // Suspects that do not serve are no state.
  bytes[0] ^= 0xFFU;
  bytes[7] ^= 0x7FU;  // the least end of a range: a number beyond its greatest end
  DipEvidence damaged;
  ArchiveReader again(bytes.data(), out.used(), 3);
  again.get(damaged);
  EXPECT_FALSE(again.sound());
  EXPECT_TRUE(std::is_trivially_copyable_v<DipEvidence>);
}

TEST(DipEvidence, EveryVerdictHasAName) {
  for (const DipVerdict v :
       {DipVerdict::not_judged, DipVerdict::consistent, DipVerdict::unseen, DipVerdict::fault, DipVerdict::unexplained})
    EXPECT_STRNE(to_string(v), "?");
  EXPECT_STREQ(to_string(DipVerdict::unseen), "unseen");
  EXPECT_STREQ(to_string(static_cast<DipVerdict>(77)), "?");
}

}  // namespace
}  // namespace dip_evidence_test
