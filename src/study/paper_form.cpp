#include "plumb/study/paper_form.hpp"

#include <Eigen/LU>
#include <Eigen/SVD>
#include <cmath>

namespace plumb {
inline namespace PLUMB_ABI {
namespace study {
namespace {

using std::size_t;

size_t at(int i) noexcept { return static_cast<size_t>(i); }

constexpr double kSingular = 1e-6;

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
  const int n = used.size();
  if ((n != 3 && n != 4) || !SensorSet::first(datasheet.size).contains(used)) return std::nullopt;
  Eigen::Matrix<double, Eigen::Dynamic, 3, 0, 4, 3> fitted(n, 3);
  Eigen::Matrix<double, Eigen::Dynamic, 3, 0, 4, 3> nominal(n, 3);
  PaperParameters out{};
  int row = 0;
  for (int i = 0; i < datasheet.size; ++i) {
    if (!used.has(i)) continue;
    fitted.row(row) = vector_of(frame.axis[at(i)]).transpose();
    nominal.row(row) = vector_of(datasheet.sensor[at(i)].row.axis).transpose();
    out[bias_index(row)] = frame.bias_mps2[at(i)];
    out[scale_index(n, row)] = frame.scale[at(i)];
    ++row;
  }
  if (n == 3) {
    const Eigen::Matrix3d axes = fitted;
    if (!(std::abs(axes.determinant()) > kSingular)) return std::nullopt;
    const Eigen::Matrix3d map = Eigen::Matrix3d(nominal) * axes.inverse();  // I - M times the scale taken up
    for (int j = 0; j < 3; ++j) {
      out[bias_index(j)] *= map(j, j);
      out[scale_index(3, j)] /= map(j, j);
      for (int i = 0; i < 3; ++i) {
        if (i != j) out[misalignment_index(3, i, j)] = -map(i, j) / map(j, j);
      }
    }
    return out;
  }
  for (int i = 0; i < 4; ++i) {
    Eigen::Matrix3d others;
    for (int k = 0, column = 0; k < 4; ++k) {
      if (k != i) others.col(column++) = fitted.row(k).transpose();
    }
    if (!(std::abs(others.determinant()) > kSingular)) return std::nullopt;
    const Eigen::Vector3d m = others.inverse() * (fitted.row(i) - nominal.row(i)).transpose();
    for (int k = 0, column = 0; k < 4; ++k) {
      if (k != i) out[misalignment_index(4, i, k)] = m[column++];
    }
  }
  return out;
}

}  // namespace study
}  // namespace PLUMB_ABI
}  // namespace plumb
