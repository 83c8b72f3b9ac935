/// The 23 experiments with one attitude only. A standing tool shows one vector: a fault may hide in it, or look like
/// that of another sensor. How often the paper's rule errs there, and what plumb's monitor says of the same samples.
#pragma once

#include <array>

#include "plumb/study/proportion.hpp"
#include "plumb/study/table2_study.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace study {

/// Which experiments are counted together.
enum class FaultGroup : std::uint8_t { none, one_fixed, one_random, two_random };
inline constexpr int kFaultGroups = 4;
FaultGroup group_of(const Table2Row& experiment) noexcept;
const char* to_string(FaultGroup group) noexcept;

/// What a rule made of one block of samples.
enum class Answer : std::uint8_t {
  right,          ///< silent where nothing is wrong; the one faulty sensor isolated; two faulty: alarm, none isolated
  alarm_only,     ///< one faulty: alarm, none isolated
  silent_small,   ///< no alarm, no sensor off by the paper's limit of 0.05 g0
  silent_large,   ///< no alarm, a sensor off by 0.05 g0 or more
  names_healthy,  ///< a healthy sensor is named
  keeps_faulty,   ///< two faulty: one is named and the other declared correct
};
inline constexpr int kAnswers = 6;

struct AnswerCount {
  std::array<std::uint64_t, kAnswers> of{};
  std::uint64_t operator[](Answer a) const noexcept { return of[static_cast<std::size_t>(a)]; }
  std::uint64_t trials() const noexcept;
  /// The wrong thing said, or nothing where much is wrong.
  std::uint64_t errors() const noexcept {
    return (*this)[Answer::silent_large] + (*this)[Answer::names_healthy] + (*this)[Answer::keeps_faulty];
  }
  Proportion share(Answer a) const { return proportion((*this)[a], trials()); }
};

struct RuleRecord {
  std::array<AnswerCount, kFaultGroups> group{};
  /// Attitudes at which at least one of the experiments with one sensor at a fixed level ended in an error. They are
  /// drawn independently of each other; the experiments at one of them are not.
  std::uint64_t attitudes_in_error = 0;
  double largest_silent_mps2 = 0.0;      ///< largest error of a reading that raised no alarm
  double largest_silent_tilt_rad = 0.0;  ///< largest error of direction, due to the fault, without an alarm
  double largest_misled_tilt_rad = 0.0;  ///< the same after a wrong sensor was named, of the sensors that remain
  /// Of the experiments with a fault.
  AnswerCount faulty() const noexcept;
};

struct OneAttitudeStudy {
  RandomLaw law = RandomLaw::held;
  int attitudes = 0;
  RuleRecord paper;
  RuleRecord own;
};

inline constexpr int kOneAttitudes = 500;

/// One block of 32 samples per attitude and experiment; plumb's monitor has been proven before on a healthy tool.
/// With `RandomLaw::anew` only the experiments with random levels are run: the others would be the same.
StudyExpected<OneAttitudeStudy> one_attitude_study(const Fits& fits, const scenario::Tool& tool, std::uint64_t seed,
                                                   RandomLaw law, int attitudes = kOneAttitudes);

}  // namespace study
}  // namespace PLUMB_ABI
}  // namespace plumb
