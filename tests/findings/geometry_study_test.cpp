#include "plumb/findings/geometry_study.hpp"

#include <gtest/gtest.h>

#include "plumb/array/named.hpp"
#include "plumb/render/geometry_report.hpp"

namespace geometry_study_test {
namespace {

using namespace plumb;
using findings::FindingCode;

findings::GeometrySubject subject_of(const AxisList& axes, int n) {
  std::array<SensorRow, kCapacity> rows{};
  for (int i = 0; i < n; ++i) {
    const auto a = static_cast<std::size_t>(i);
    rows[a].id = make_id(("a" + std::to_string(i + 1)).c_str());
    rows[a].axis = axes[a];
    rows[a].sigma_mps2 = 1e-3;
  }
  findings::GeometrySubject out;
  out.name = "test";
  out.array = *SensorArray::make(rows.data(), n);
  return out;
}

TEST(GeometryStudy, OfThreeAxesFindsThatNoFaultCanBeIsolated) {
  AxisList axes{};
  const int n = orthogonal_triad(axes);
  const findings::GeometryStudy study = findings::study_geometry(subject_of(axes, n));
  EXPECT_TRUE(study.warnings.empty());
  EXPECT_TRUE(findings::has(study.limits, FindingCode::no_isolation));
  EXPECT_TRUE(findings::has(study.limits, FindingCode::critical_sensors));
  EXPECT_FALSE(findings::has(study.limits, FindingCode::gravity_needed));
}

TEST(GeometryStudy, OfAConeOfFiveHasNoWarning) {
  AxisList axes{};
  const int n = cone(axes, 5);
  const findings::GeometryStudy study = findings::study_geometry(subject_of(axes, n));
  EXPECT_TRUE(study.warnings.empty());
  EXPECT_FALSE(findings::has(study.limits, FindingCode::no_isolation));
  EXPECT_TRUE(findings::has(study.limits, FindingCode::common_scale));
}

TEST(GeometryStudy, WarnsOfThreeAxesNearOnePlane) {
  AxisList axes{};
  int n = orthogonal_triad(axes);
  axes[static_cast<std::size_t>(n++)] = {0.8, 0.6, 0.0};
  const findings::GeometryStudy study = findings::study_geometry(subject_of(axes, n));
  ASSERT_TRUE(findings::has(study.warnings, FindingCode::near_singular_triples));
  EXPECT_EQ(study.warnings.front().value, study.merit.near_singular_triples);
  EXPECT_EQ(study.warnings.front().limit, kMinTripleDet);
}

TEST(GeometryStudy, NamesMistakesOfWiringBySensor) {
  AxisList axes{};
  const int n = cone(axes, 4);
  const findings::GeometrySubject subject = subject_of(axes, n);
  using Kind = findings::HiddenWiring::Kind;
  const auto words = [&subject](Kind kind, std::array<int, 3> sensor) {
    return render::wiring_words({kind, sensor, {}}, subject.array);
  };
  EXPECT_EQ(words(Kind::reversed, {2, -1, -1}), "a3 reversed");
  EXPECT_EQ(words(Kind::exchanged, {0, 3, -1}), "a1 and a4 exchanged");
  EXPECT_EQ(words(Kind::exchanged_and_reversed, {0, 3, -1}), "a1 and a4 exchanged and reversed");
  EXPECT_EQ(words(Kind::turned, {0, 1, 3}), "a1, a2, a4 carry a2, a4, a1");
  EXPECT_EQ(words(Kind::turned, {0, 3, 1}), "a1, a2, a4 carry a4, a1, a2");
}

}  // namespace
}  // namespace geometry_study_test
