/// A true tool drawn from a datasheet: what the sensors really are, which plumb does not know.
#pragma once

#include <array>
#include <cstdint>

#include "plumb/calibration/datasheet.hpp"
#include "plumb/calibration/sensor_model.hpp"
#include "plumb/core/config.hpp"
#include "plumb/core/units.hpp"
#include "plumb/core/vec3.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace scenario {

/// A datasheet and the truth behind it. The truth is in the common-frame form: misalignment stands in
/// the axes, so reading i = axes[i] . g, then `model` turns it into raw values.
struct Tool {
  Datasheet datasheet;
  SensorModel model;
  std::array<Vec3, kCapacity> axes{};         ///< true unit axes in the tool frame
  std::array<Vec3, kCapacity> lever_arm_m{};  ///< of each sensor from the axis of rotation, tool frame
};

/// How far a truth may lie from the datasheet (defaults: docs/theory.md, section 9.2). `uniform` draws within
/// +- the span, `normal` takes the span as 1 sigma.
struct TruthSpans {
  enum class Shape : std::uint8_t { uniform, normal };
  double bias_mps2 = 0.02 * kG0_mps2;
  double scale = 0.02;                  ///< relative
  double axis_rad = rad_from_deg(2.0);  ///< tilt about each of two axes across the nominal one
  Shape shape = Shape::uniform;
};

/// A tool that is exactly its datasheet.
Tool perfect_tool(const Datasheet& datasheet) noexcept;

/// Draws biases, scale factors and axes. Sensor i uses its own stream, so that adding a sensor does not
/// change the others; temperature coefficients are those of the datasheet.
Tool draw_tool(const Datasheet& datasheet, std::uint64_t seed, const TruthSpans& spans = {}) noexcept;

}  // namespace scenario
}  // namespace PLUMB_ABI
}  // namespace plumb
