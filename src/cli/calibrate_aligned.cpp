#include "calibrate_aligned.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "plumb/findings/alignment.hpp"
#include "plumb/findings/fit_study.hpp"
#include "plumb/findings/frame_turn.hpp"
#include "plumb/survey/calibrated_axes.hpp"
#include "read_array.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace cli {
namespace {

constexpr double kLeastTurn_rad = rad_from_deg(0.1), kMostTurn_rad = rad_from_deg(30.0);

/// What the axes of the datasheet say of a common rotation: no less than the loosest of them.
double stated_of(const Datasheet& datasheet) {
  double out = kLeastTurn_rad;
  for (int i = 0; i < datasheet.size; ++i)
    out = std::max(out, datasheet.sensor[static_cast<std::size_t>(i)].prior.axis_rad);
  return std::min(out, kMostTurn_rad);
}

std::string words_of(const survey::JointAlignment& found, const findings::Alignment& bound, std::size_t stations) {
  const auto degrees = [](const Vec3& rad) {
    const auto one = [](double x) { return 0.0 + std::round(1000.0 * deg_from_rad(x)) / 1000.0; };  // no -0.000
    return fmt::format("{:.3f}, {:.3f}, {:.3f}", one(rad[0]), one(rad[1]), one(rad[2]));
  };
  return fmt::format(
      "aligned by the dip at {} stations: axes turned by {} deg about x, y, z of the tool (1 sigma {} deg), into the "
      "frame of the accelerometers; within {:.3g} deg of the housing\n",
      stations, degrees(found.turn_rad), degrees(found.sigma_rad), deg_from_rad(bound.bound_rad));
}

}  // namespace

std::optional<io::FileError> misuse_of_alignment(const io::ArrayFile& array, const std::string& align_by,
                                                 bool known_attitudes) {
  const bool magnetic = array.field == io::FieldKind::magnetic;
  if (!align_by.empty() && !magnetic)
    return io::FileError{"--align-by",
                         0,
                         "",
                         "aligns magnetometers, and " + array.path + " is no magnetic group",
                         "name the group: --array " + array_file_of(array.path) + "#mag",
                         io::ExitCode::usage};
  if (known_attitudes && magnetic)
    return io::FileError{"--known-attitude",
                         0,
                         "",
                         "inclination and toolface do not say how the magnetic field lies in the tool: that takes "
                         "an azimuth as well",
                         "give --align-by ACC.json, the calibration of the accelerometers: the dip of the field then "
                         "shows how the magnetometers lie to them",
                         io::ExitCode::usage};
  return std::nullopt;
}

io::FileExpected<io::FrameAlignment> align_group(const std::string& array_path, const std::string& calibration,
                                                 const session::LogSpec& log, const io::ArrayFile& group,
                                                 session::CalibrationRun& fit, std::string& text) {
  const io::FileExpected<io::ArrayFile> tool =
      read_array(array_file_of(array_path), "plumb calibrate", Serves::gravity);
  if (!tool) return tl::unexpected<io::FileError>(tool.error());
  const io::FileExpected<io::CalibrationFile> accelerometers = io::read_calibration(calibration, *tool);
  if (!accelerometers) return tl::unexpected<io::FileError>(accelerometers.error());
  const io::FileExpected<std::vector<Station>> still = session::find_stations(*tool, log);
  if (!still) return tl::unexpected<io::FileError>(still.error());
  const std::vector<Station> kept = findings::chosen(fit.stations, fit.study.kept);
  const survey::CommonStations common = survey::common_stations({accelerometers->calibration, tool->gravity, *still},
                                                                {*fit.accepted, group.gravity, kept}, group.magnetic);
  const auto found = survey::align_axes(common, group.magnetic, stated_of(group.datasheet));
  if (!found)
    return tl::unexpected<io::FileError>(
        io::FileError{log.path, 0, "", "the magnetometers could not be aligned: " + found.error().text(),
                      "add stations at other attitudes; without --align-by the calibration is written as it is, its "
                      "axes as a whole known by the datasheet only",
                      io::ExitCode::not_accepted});
  findings::apply_turn(found->rotation, *fit.accepted);
  for (SeenAttitude& one : fit.study.attitudes) one.direction = times(found->rotation, one.direction);
  io::FrameAlignment out;
  out.turn_rad = found->turn_rad;
  out.covariance_rad2 = survey::rotation_covariance(*found);
  out.base_bound_rad = findings::alignment_of(*tool, &*accelerometers).bound_rad;
  out.stations = static_cast<int>(common.stations.size());
  io::CalibrationFile aligned;
  aligned.alignment = out;
  text = words_of(*found, findings::alignment_of(group, &aligned), common.stations.size());
  return out;
}

}  // namespace cli
}  // namespace PLUMB_ABI
}  // namespace plumb
