#include "demo_files.hpp"

#include <fmt/format.h>

#include <Eigen/LU>
#include <Eigen/SVD>

#include "plumb/io/log_writer.hpp"
#include "plumb/io/units.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace cli {

std::string paper_array_toml(const Datasheet& datasheet, double gravity_mps2) {
  std::string out = fmt::format(
      "# The paper's tool: three accelerometers on a cone about the tool axis z, the fourth along z.\n"
      "# Only what a datasheet says. What the sensors really do is found by `plumb calibrate`.\n"
      "name = \"paper-tetrahedron\"\n\n"
      "[gravity]\n"
      "model = \"value\"          # or \"normal\" with latitude, elevation and depth\n"
      "value = \"{} m/s^2\"\n"
      "sigma = \"0.15 mg\"        # how far it may be off, 1 sigma\n\n"
      "[input]\n"
      "reads = \"gravity\"        # a sensor that points down reads +1 g0\n"
      "unit = \"V\"               # of the numbers in the log\n"
      "time = \"t_s\"\n"
      "station = \"station\"      # -1: no station known, plumb finds the still stretches by itself\n",
      io::shortest(gravity_mps2));
  for (int i = 0; i < datasheet.size; ++i) {
    const DatasheetSensor& s = datasheet.sensor[static_cast<std::size_t>(i)];
    const Vec3& h = s.row.axis;
    out += fmt::format("\n[[sensor]]\nid = \"{}\"\naxis = [{}, {}, {}]\n", s.row.id.data(), io::shortest(h[0]),
                       io::shortest(h[1]), io::shortest(h[2]));
    out += fmt::format("scale = \"{:.10g} V/g0\"\nnoise = \"{:.10g} mg\"           # of one sample, 1 sigma\n",
                       s.coefficients.scale[0] * kG0_mps2, s.row.sigma_mps2 / (1e-3 * kG0_mps2));
    out += fmt::format(
        "full_scale = \"{:.10g} V\"\nresolution = \"{} V\"\nprior = {{bias = \"{:.10g} mg\", scale = \"{:.10g} %\", "
        "axis = \"{:.4g} deg\"}}\n",
        s.full_scale_raw, io::shortest(s.resolution_raw), s.prior.bias_mps2 / (1e-3 * kG0_mps2), 100.0 * s.prior.scale,
        deg_from_rad(s.prior.axis_rad));
  }
  return out;
}

io::FileExpected<std::vector<scenario::Truth>> write_log(const std::string& path, const io::ArrayFile& array,
                                                         const scenario::Scenario& scenario) {
  tl::expected<scenario::Simulator, std::string> simulator = scenario::Simulator::make(scenario);
  if (!simulator) {
    return tl::unexpected<io::FileError>(
        io::FileError{path, 0, "", simulator.error(), "report this as a bug of plumb", io::ExitCode::other});
  }
  io::FileExpected<io::LogWriter> writer = io::LogWriter::create(path, array);
  if (!writer) return tl::unexpected<io::FileError>(writer.error());
  std::vector<scenario::Truth> truth;
  Sample sample;
  while (simulator->next(sample)) {
    const io::FileExpected<void> written = writer->write(sample);
    if (!written) return tl::unexpected<io::FileError>(written.error());
    truth.push_back(simulator->truth());
  }
  const io::FileExpected<void> kept = writer->commit();
  if (!kept) return tl::unexpected<io::FileError>(kept.error());
  return truth;
}

void into_frame_of_nominal_axes(const scenario::Tool& tool, std::vector<scenario::Truth>& truth) {
  Eigen::Matrix3d attitude_profile = Eigen::Matrix3d::Zero();  // of Wahba's problem
  for (int i = 0; i < tool.datasheet.size; ++i) {
    const auto a = static_cast<std::size_t>(i);
    attitude_profile +=
        Eigen::Vector3d(tool.datasheet.sensor[a].row.axis.data()) * Eigen::Vector3d(tool.axes[a].data()).transpose();
  }
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(attitude_profile, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Eigen::Matrix3d u = svd.matrixU();
  const Eigen::Matrix3d v = svd.matrixV();
  const double hand = (u * v.transpose()).determinant();
  const Eigen::Matrix3d turn = u * Eigen::Vector3d(1.0, 1.0, hand).asDiagonal() * v.transpose();
  for (scenario::Truth& t : truth) {
    const Eigen::Vector3d turned = turn * Eigen::Vector3d(t.gravity_mps2.data());
    t.gravity_mps2 = {turned[0], turned[1], turned[2]};
  }
}

}  // namespace cli
}  // namespace PLUMB_ABI
}  // namespace plumb
