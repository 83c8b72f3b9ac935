#include "plumb/study/paper_form.hpp"

#include <Eigen/LU>
#include <Eigen/SVD>

#include "plumb/paper/paper_parameters.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace study {
namespace {

using std::size_t;

size_t at(int i) noexcept { return static_cast<size_t>(i); }

Eigen::Vector3d vector_of(const Vec3& v) noexcept { return {v[0], v[1], v[2]}; }

/// Rotation that brings the axes nearest to the datasheet's (Wahba).
Eigen::Matrix3d turn_onto_nominal(const scenario::Tool& tool) {
  Eigen::Matrix3d profile = Eigen::Matrix3d::Zero();
  for (int i = 0; i < tool.datasheet.size; ++i) {
    profile += vector_of(tool.datasheet.sensor[at(i)].row.axis) * vector_of(tool.axes[at(i)]).transpose();
  }
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(profile, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Eigen::Matrix3d u = svd.matrixU();
  const Eigen::Matrix3d v = svd.matrixV();
  const double hand = (u * v.transpose()).determinant();
  return u * Eigen::Vector3d(1.0, 1.0, hand).asDiagonal() * v.transpose();
}

}  // namespace

CommonFrame frame_of(const Calibration& calibration) noexcept {
  CommonFrame out;
  for (int i = 0; i < calibration.array.size(); ++i) {
    out.scale[at(i)] = calibration.model.sensor[at(i)].scale[0];
    out.bias_mps2[at(i)] = calibration.model.sensor[at(i)].bias[0];
    out.axis[at(i)] = calibration.array.axis(i);
  }
  return out;
}

CommonFrame frame_of(const Datasheet& datasheet, const std::array<double, kFitParameters>& parameters) noexcept {
  CommonFrame out;
  const double sign = datasheet.reads == Reads::gravity ? 1.0 : -1.0;
  for (int i = 0; i < datasheet.size; ++i) {
    const Vec3 w = {parameters[at(4 * i)], parameters[at(4 * i + 1)], parameters[at(4 * i + 2)]};
    const double length = norm(w);
    const SensorCoefficients& nominal = datasheet.sensor[at(i)].coefficients;
    out.scale[at(i)] = nominal.scale[0] * length;
    out.bias_mps2[at(i)] = (nominal.bias[0] + sign * parameters[at(4 * i + 3)]) / length;
    out.axis[at(i)] = scaled(w, 1.0 / length);
  }
  return out;
}

CommonFrame frame_of(const scenario::Tool& tool) noexcept {
  CommonFrame out;
  const Eigen::Matrix3d turn = turn_onto_nominal(tool);
  for (int i = 0; i < tool.datasheet.size; ++i) {
    const Eigen::Vector3d axis = turn * vector_of(tool.axes[at(i)]);
    out.scale[at(i)] = tool.model.sensor[at(i)].scale[0];
    out.bias_mps2[at(i)] = tool.model.sensor[at(i)].bias[0];
    out.axis[at(i)] = {axis[0], axis[1], axis[2]};
  }
  return out;
}

std::optional<PaperParameters> paper_form(const Datasheet& datasheet, const CommonFrame& frame,
                                          SensorSet used) noexcept {
  if (!SensorSet::first(datasheet.size).contains(used)) return std::nullopt;
  std::array<SensorRow, kCapacity> nominal{}, fitted{};
  SensorModel common;
  for (int i = 0; i < datasheet.size; ++i) {
    if (!used.has(i)) continue;
    const size_t row = at(common.size++);
    nominal[row] = fitted[row] = datasheet.sensor[at(i)].row;
    fitted[row].axis = frame.axis[at(i)];
    common.sensor[row].scale = {frame.scale[at(i)]};
    common.sensor[row].bias = {frame.bias_mps2[at(i)]};
  }
  const int n = common.size;
  const Expected<SensorArray> along = SensorArray::make(nominal.data(), n);
  const Expected<SensorArray> really = SensorArray::make(fitted.data(), n);
  if (!along || !really) return std::nullopt;
  const Expected<SensorModel> form = plumb::paper_form(*along, *really, common);
  if (!form) return std::nullopt;
  PaperParameters out{};
  for (int i = 0; i < n; ++i) {
    out[bias_index(i)] = form->sensor[at(i)].bias[0];
    out[scale_index(n, i)] = form->sensor[at(i)].scale[0];
    for (int j = 0; j < n; ++j) {
      if (i != j) out[misalignment_index(n, i, j)] = form->misalignment[at(i * kCapacity + j)];
    }
  }
  return out;
}

}  // namespace study
}  // namespace PLUMB_ABI
}  // namespace plumb
