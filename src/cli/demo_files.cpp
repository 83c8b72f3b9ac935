#include "demo_files.hpp"

#include <Eigen/LU>
#include <Eigen/SVD>

#include "plumb/io/log_writer.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace cli {

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
