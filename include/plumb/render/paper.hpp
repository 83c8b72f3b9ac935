/// A page made fit for the program that prints it.
#pragma once

#include <string>

#include "plumb/core/config.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace render {

/// The page in the colours of paper, with its contents behind the sign-off, so that this is one sheet. weasyprint 57
/// draws no line in the colour of the text around it, and no border that names its colour through a variable: both are
/// spelled out.
std::string for_paper(std::string html);

}  // namespace render
}  // namespace PLUMB_ABI
}  // namespace plumb
