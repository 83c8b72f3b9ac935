/// The calibration file (JSON, schema "plumb-calibration" version 1): checksummed, bound to its array,
/// every double bit for bit.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "plumb/calibration/calibration.hpp"
#include "plumb/gravity/gravity.hpp"
#include "plumb/io/array_file.hpp"
#include "plumb/io/file_error.hpp"
#include "plumb/io/hash.hpp"
#include "plumb/io/motion_calibration.hpp"
#include "plumb/paper/paper_calibration.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace io {

inline constexpr const char* kCalibrationSchema = "plumb-calibration";
inline constexpr int kCalibrationVersion = 2;
/// The first one has the gravity at which it was calibrated in its covariance, and lengths allow for it twice.
inline constexpr int kOldestCalibrationVersion = 1;
/// Of the section `paper`, which a file need not have.
inline constexpr int kPaperSectionVersion = 1;

/// How the axes of a magnetic group were turned into the frame of the accelerometers: by the dip of its stations.
struct FrameAlignment {
  Vec3 turn_rad{};                          ///< rotation vector, from the axes as the fit had them
  std::array<double, 9> covariance_rad2{};  ///< of a further small rotation about x, y, z of the tool, row-major
  double base_bound_rad = 0.0;              ///< how far the frame of the accelerometers may be turned from the housing
  int stations = 0;                         ///< that it rests on

  /// Numbers that a bound can be made of.
  bool plausible() const noexcept;
};

/// Where a calibration comes from. No clock time: the same input gives the same bytes, and the date is what the user
/// says.
struct CalibrationContext {
  std::string log_file;  ///< only the last part of the path is kept
  std::uint64_t log_bytes = 0;
  std::uint64_t log_hash = 0;  ///< FNV-1a of the bytes of the log
  int stations = 0;            ///< used by the fit
  std::string plumb_version;
  std::string date;    ///< of the log, "2026-03-31"; empty: not given
  std::string serial;  ///< of the tool; empty: not given
  /// Not empty: nothing was fitted; the form of the file in `log_file` that stated the coefficients ("px4").
  std::string coefficients;
  GravityReference gravity;  ///< that the fit assumed
  std::vector<Vec3> down;    ///< by station of the log, as the fit shows it, tool frame; 0 where it shows none
  std::vector<KnownAttitude> known_attitudes;  ///< what was stated of those stations
};

struct CalibrationFile {
  Calibration calibration;
  CalibrationContext context;
  std::shared_ptr<const PaperCalibration> paper;    ///< null where the fits by the paper's method were not asked for
  std::shared_ptr<const MotionCalibration> motion;  ///< null where no log in motion was fitted
  std::string array_name;
  std::string array_file;                   ///< last part of the path
  std::optional<FrameAlignment> alignment;  ///< of a magnetic group, where its axes were aligned
};

/// `paper` and `alignment`, where given, go along.
std::string calibration_json(const Calibration& calibration, const ArrayFile& array, const CalibrationContext& context,
                             const PaperCalibration* paper = nullptr, const FrameAlignment* alignment = nullptr);

FileExpected<void> write_calibration(const std::string& path, const Calibration& calibration, const ArrayFile& array,
                                     const CalibrationContext& context, const PaperCalibration* paper = nullptr,
                                     const FrameAlignment* alignment = nullptr);

/// The calibration file `from`, byte for byte but for its checksum, and what a log in motion showed, into `to`, which
/// may be the same.
FileExpected<void> add_motion(const std::string& from, const std::string& to, const MotionCalibration& motion,
                              const ArrayFile& array);

/// Refuses, with remedy: unreadable, truncated, edited (checksum), another schema or version, a
/// calibration of another array (names the id, axis, scale or bias that differs), fits by the paper's method that are
/// not those of this array's sensors.
FileExpected<CalibrationFile> read_calibration(const std::string& path, const ArrayFile& array);

}  // namespace io
}  // namespace PLUMB_ABI
}  // namespace plumb
