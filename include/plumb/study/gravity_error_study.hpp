/// The counterpart of the paper's Fig 11: how far the length of gravity is off, before and after calibration, with all
/// sensors and with every triple, at attitudes that no fit has seen.
#pragma once

#include <vector>

#include "plumb/study/fits.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace study {

/// |x| - G at every attitude [m/s^2], one sample each.
struct GravityErrors {
  SensorSet used;
  std::vector<double> datasheet_mps2;  ///< nominal axes and coefficients
  std::vector<double> paper_mps2;      ///< the paper's fit of this combination
  std::vector<double> own_mps2;        ///< plumb's one fit, the axes of this combination
};

struct GravityErrorStudy {
  std::vector<GravityErrors> combination;  ///< in the order of `Fits::combinations`
};

double rms_of(const std::vector<double>& values) noexcept;
double largest_of(const std::vector<double>& values) noexcept;  ///< magnitude

inline constexpr int kValidationAttitudes = 48;

StudyExpected<GravityErrorStudy> gravity_error_study(const Fits& fits, const scenario::Tool& tool, std::uint64_t seed,
                                                     int attitudes = kValidationAttitudes);

}  // namespace study
}  // namespace PLUMB_ABI
}  // namespace plumb
