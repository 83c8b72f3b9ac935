/// Second part of section 4 of the demo: the 23 experiments with one attitude only.
#pragma once

#include "demo_section.hpp"
#include "plumb/study/one_attitude_study.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace cli {

/// Adds text, picture, table, files, console lines and facts to the section.
io::FileExpected<void> add_one_attitude(const DemoContext& context, const study::Fits& fits, DemoSection& section);

}  // namespace cli
}  // namespace PLUMB_ABI
}  // namespace plumb
