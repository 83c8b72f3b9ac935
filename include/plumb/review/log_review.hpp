/// What a log says of its accelerometers without an array file and without a calibration of plumb: which chips there
/// are, what they read at rest, whether they agree, at rest and in motion, and which one does not.
///
/// Every finding is a code with a figure, a limit and a place; `render` has the words. A log without redundancy, or
/// without a stretch at rest, leaves questions open: those are said too, and never counted as answered.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "plumb/review/log_digest.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace review {

enum class Grade : std::uint8_t { green, orange, red };

enum class FindingCode : std::uint8_t {
  gravity_length,       ///< the length of specific force at rest is not that of gravity
  disagreement,         ///< chips differ at rest
  motion_disagreement,  ///< chips differ in motion, in several cells in a row
  common_length,        ///< all chips read the same length at rest, and it is not that of gravity
  orientation,          ///< chips agree in length but not in direction: mounting or axes
  axis_stuck,           ///< an axis does not change while others do
  chip_frozen,          ///< no axis of a chip changes
  clipping,
  vibration,
  noise,         ///< scatter at rest above the class of the sensor
  drift,         ///< the reading at rest wanders within one stretch
  changed,       ///< at rest again as before, a chip reads something else; the place is what lies between
  gaps,          ///< records are missing
  backwards,     ///< time goes back
  skew,          ///< two chips show the same motion at different times
  late,          ///< the chip begins later than others
  stray,         ///< a record has a time far from all others
  stopped,       ///< the chip says nothing any more while others go on
  uncalibrated,  ///< the autopilot has no calibration of this chip
  disabled,      ///< switched off in the autopilot's parameters: its readings are logged, not used
  far_offset,    ///< the installed calibration has an offset or a scale that no sensor in order needs
  far_scale,
  autopilot_failed,  ///< the autopilot itself took the chip for failed
  autopilot_apart,   ///< by the autopilot's own comparison the chip is apart from the others at rest
  damage,            ///< bytes of the log that could not be read
};

constexpr std::size_t kNoChip = static_cast<std::size_t>(-1);

/// Units of `figure`, `limit` and `uncertainty` (95 %): m/s^2, but degrees of orientation, seconds of gaps, skew and
/// stopped, readings of clipping and backwards, reports of autopilot_failed, 1 of far_scale, bytes of damage;
/// `disabled` has none of them and is green. Of what does not change, `figure` is what it reads and `limit` how many
/// readings are alike.
struct Finding {
  FindingCode code = FindingCode::damage;
  Grade grade = Grade::orange;
  std::size_t chip = kNoChip;   ///< which one, where the log tells
  std::size_t other = kNoChip;  ///< of two that differ, where it does not: `chip` and `other`
  int axis = -1;                ///< 0, 1, 2, or -1: none in particular
  double figure = 0.0, limit = 0.0, uncertainty = 0.0;
  double from_s = logs::kAbsent, to_s = logs::kAbsent;
  std::uint64_t times = 1;       ///< how often it happened; the place is that of the worst or longest
  std::size_t likely = kNoChip;  ///< of two that differ: the one that other findings of the log name, of one only
  bool told_by_length = false;   ///< named because its length is not gravity's, not because two others agree
};

/// Why a question was left open.
enum class OpenQuestion : std::uint8_t {
  one_chip,       ///< agreement needs two
  two_chips,      ///< which of two is wrong is told only by the length of gravity
  never_at_rest,  ///< lengths at rest, noise and drift
  never_in_motion,
  one_attitude,  ///< an error across gravity, or of scale, is seen only in part
  slow_log,      ///< vibration and noise: fewer than kFastHz readings a second
  no_calibration_in_log,
  not_compared,      ///< a chip has too few readings to be compared with another one
  motion_unclear,    ///< chips differ in motion by more than the limit, within what scatter and turning allow
  more_calibration,  ///< the autopilot turns or corrects readings in a way that is not applied here: they are not
                     ///< compared
};

struct InstalledCalibration {
  bool present = false;
  Axes offset_mps2{};
  Axes scale{1.0, 1.0, 1.0};
  bool more =
      false;  ///< the autopilot also turns the readings or corrects them by temperature; that is not applied here
  bool applied_here = false;  ///< by this review, since the log holds readings before the calibration
};

struct ChipSummary {
  std::string name;  ///< "accelerometer 1", or the topic
  std::uint64_t device_id = 0;
  std::vector<std::size_t> sources;  ///< of the digest
  std::size_t judged = 0;            ///< the source that it is judged by
  InstalledCalibration calibration;
  double rate_hz = logs::kAbsent;
  double from_s = logs::kAbsent, to_s = logs::kAbsent;
  double coldest_degc = logs::kAbsent, warmest_degc = logs::kAbsent;
  Axes scatter_mps2 = logs::kAbsentAxes;  ///< at rest, standard deviation of single readings
  double vibration_mps2 = logs::kAbsent;  ///< the worst cell in motion, root of the sum of the axes' variances
  double vibration_at_s = logs::kAbsent;
  std::uint64_t clipped = 0;     ///< readings, of the axis with most
  bool disabled = false;         ///< by the autopilot's parameters
  bool stray = false;            ///< a record at its beginning or end has a time far from all others
  bool compared = false;         ///< with another chip, at rest or in motion
  double lag_s = logs::kAbsent;  ///< behind the first chip that is fast enough, by the motion that both saw
  double lag_uncertainty_s = logs::kAbsent;
};

/// A stretch at rest: what each chip read, NaN where it did not.
struct Stretch {
  double from_s = 0.0, to_s = 0.0;
  std::vector<Axes> mean_mps2;           ///< by chip, with the installed calibration
  std::vector<double> uncertainty_mps2;  ///< 95 %, of the mean's length
};

struct LogReview {
  std::string name;
  std::string understood;  ///< as `LogDigest` has it
  double from_s = logs::kAbsent, to_s = logs::kAbsent;
  logs::LogExtent extent;
  std::vector<ChipSummary> chips;
  std::vector<Stretch> stretches;
  double at_rest_s = 0.0;
  double gravity_mps2 = 0.0, gravity_half_mps2 = 0.0;  ///< by which lengths were judged, and half its range
  std::size_t motion_cells = 0;                        ///< in which at least two chips were compared
  double motion_agreement_mps2 = logs::kAbsent;        ///< the median over them of the largest difference
  std::vector<Finding> findings;                       ///< the worst first
  std::vector<OpenQuestion> open;
  std::vector<Note> notes;
  bool judged = false;  ///< something was compared with something
  Grade grade = Grade::green;
};

struct ReviewSettings {
  /// Gravity where the log was taken; without it, anywhere on the ground of the Earth.
  std::optional<double> gravity_mps2;
  /// What is known of a table of text, for `review_file`.
  logs::CsvHints table;
};

/// A pure function of the digest.
LogReview review_log(const LogDigest& digest, const ReviewSettings& settings = {});

}  // namespace review
}  // namespace PLUMB_ABI
}  // namespace plumb
