#include "plumb/scenario/truth.hpp"

#include "plumb/scenario/random.hpp"
#include "tilted.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace scenario {
namespace {

double draw(const Stream& stream, std::uint64_t index, double span, TruthSpans::Shape shape) noexcept {
  return shape == TruthSpans::Shape::normal ? span * stream.normal(index) : stream.uniform(index, -span, span);
}

}  // namespace

Tool perfect_tool(const Datasheet& datasheet) noexcept {
  Tool tool;
  tool.datasheet = datasheet;
  tool.model = datasheet.model();
  for (int i = 0; i < datasheet.size; ++i) {
    const auto s = static_cast<std::size_t>(i);
    tool.axes[s] = datasheet.sensor[s].row.axis;
  }
  return tool;
}

Tool draw_tool(const Datasheet& datasheet, std::uint64_t seed, const TruthSpans& spans) noexcept {
  Tool tool = perfect_tool(datasheet);
  for (int i = 0; i < datasheet.size; ++i) {
    const auto s = static_cast<std::size_t>(i);
    const Stream stream(seed, Purpose::truth, static_cast<std::uint32_t>(i));
    const double bias_mps2 = draw(stream, 0, spans.bias_mps2, spans.shape);
    const double scale = draw(stream, 1, spans.scale, spans.shape);
    const double a_rad = draw(stream, 2, spans.axis_rad, spans.shape);
    const double b_rad = draw(stream, 3, spans.axis_rad, spans.shape);
    tool.model.sensor[s].bias[0] += bias_mps2;
    for (double& coefficient : tool.model.sensor[s].scale) coefficient *= 1.0 + scale;
    tool.axes[s] = tilted(tool.axes[s], a_rad, b_rad);
  }
  return tool;
}

}  // namespace scenario
}  // namespace PLUMB_ABI
}  // namespace plumb
