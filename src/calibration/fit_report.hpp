/// What the report says beside the fit itself. Private to the calibration module.
#pragma once

#include "fit_tally.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace fit {

/// By chi^2: what explains worse by this much, at odds of 1000 to 1, is no explanation beside the best.
inline constexpr double kSeparable = 13.8;

struct Fitted {
  explicit Fitted(Harmonics* harmonics) noexcept : tally(harmonics) {}
  Parameters theta{};
  FitTally tally;
};

/// True where `Datasheet::array` is sure to accept; cheaper, for it builds no triples.
bool plainly_sound(const Datasheet& datasheet) noexcept;

/// What is wrong before any fit; the report gets what the stations alone tell.
Error refused_input(const Datasheet& datasheet, const GravityReference& gravity, const FitOptions& options,
                    const Station* stations, int count, FitFigures& report) noexcept;
/// The part of it that the stations cause.
Error refused_stations(const Problem& problem, const FitOptions& options, FitFigures& report) noexcept;

/// Eigenvalues of the information below this part of the largest count as zero.
double rank_floor(const FitTally& tally) noexcept;

/// Temperatures, clipped readings, noise of the samples.
void note_stations(const Problem& problem, FitFigures& report) noexcept;
/// The stations that the screen omits: how many, and the first of them.
void note_outliers(const Problem& problem, FitFigures& report, std::array<Outlier, kMaxOutliers>& list) noexcept;
/// The sensor to which most of the outliers point; -1 where none does.
int most_blamed(const Problem& problem) noexcept;
void note_common_scale(const Datasheet& datasheet, const Parameters& theta, FitFigures& report) noexcept;

/// By the axes of theta, turned about the roll axis as near to the nominal ones as can be.
CommonTurn common_turn(const Datasheet& datasheet, const Vec3& roll_axis, const Parameters& theta) noexcept;
/// `all`: the stations as they were before outliers lost their count.
LevelMisfit level_misfit(const Problem& problem, const Parameters& theta, const Station* all,
                         double misfit_variance) noexcept;

/// The parameter that is furthest beyond its physical bound, or ok; that of the one sensor without which all is well,
/// where there is one. `suspects` gets all of which that is so about as well.
Error implausible(const Datasheet& datasheet, const Roll& roll, const FitOptions& options, const Parameters& theta,
                  SensorSet& suspects) noexcept;

/// A fit of full rank, judged by its own figures.
Error judge_figures(const Problem& problem, const FitOptions& options, const Fitted& fitted,
                    FitFigures& report) noexcept;
/// `high_variance_sensor` and what goes with it; by what factor its residuals widen every variance (>= 1).
double note_loud_sensor(const Problem& problem, const FitTally& tally, FitFigures& report) noexcept;

/// Three sensors, stations rejected, and too little left to say that they were the right ones: poor_fit (value =
/// stations rejected, limit = how many may be; or value = p of the rest, limit = what it may be).
Error doubtful_screening(const Datasheet& datasheet, const FitFigures& report) noexcept;

/// A sensor whose own samples are noisier than declared, where the residuals are no noise either.
Error noisy_samples(const Datasheet& datasheet, const FitOptions& options, const FitFigures& report) noexcept;

/// 1 sigma of an inclination about the roll axis, mean over the stations where roll rows have seen it, else over the
/// sphere [rad].
double inclination_sigma(const Problem& problem, const Parameters& theta, const SensorArray& calibrated) noexcept;

/// Two channels that hold the very same numbers at every station, which two sensors with noise never do: implausible,
/// index = the later one.
Error same_numbers(const Problem& problem) noexcept;

/// Two channels that read alike at every station although their axes differ: implausible, index = the later one. For
/// fits that failed: at a single attitude healthy sensors may do so too.
Error twin_channels(const Problem& problem) noexcept;

}  // namespace fit
}  // namespace PLUMB_ABI
}  // namespace plumb
