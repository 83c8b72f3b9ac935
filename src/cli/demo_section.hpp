/// The six sections of `plumb demo`. Each measures, writes its files below `out` and returns what page, terminal
/// and demo.json show of it, so that the three cannot disagree.
#pragma once

#include <cstdint>
#include <string>

#include "plumb/core/config.hpp"
#include "plumb/io/file_error.hpp"
#include "plumb/io/json_fields.hpp"
#include "plumb/render/chapter.hpp"
#include "plumb/scenario/truth.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace cli {

struct DemoContext {
  std::string out;      ///< exists
  std::uint64_t seed;   ///< of everything that is drawn
  scenario::Tool tool;  ///< the paper's tool of this seed
};

struct DemoSection {
  render::Chapter chapter;
  std::string console;           ///< a few lines for the terminal, ending in a newline
  nlohmann::ordered_json facts;  ///< the same figures, in demo.json under the chapter's id
};

io::FileExpected<DemoSection> demo_geometry(const DemoContext& context);       // 1
io::FileExpected<DemoSection> demo_calibration(const DemoContext& context);    // 2: Figs 4-10
io::FileExpected<DemoSection> demo_gravity_error(const DemoContext& context);  // 3: Fig 11
io::FileExpected<DemoSection> demo_table2(const DemoContext& context);         // 4
io::FileExpected<DemoSection> demo_drill_a(const DemoContext& context);        // 5: four sensors
io::FileExpected<DemoSection> demo_drill_b(const DemoContext& context);        // 6: six sensors

}  // namespace cli
}  // namespace PLUMB_ABI
}  // namespace plumb
