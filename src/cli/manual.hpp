/// The manual page and the completion of the shell, made from the definitions of the command line itself.
#pragma once

#include <string>
#include <vector>

#include "tool.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace cli {

struct Manual {
  const char* about;  ///< of the tool
  const std::vector<Command>& commands;
};

/// For man(7): `plumb --man`.
std::string man_page(const Manual& manual);
/// For the shells: `plumb --completion`, `plumb --completion-zsh`, `plumb --completion-fish`.
std::string bash_completion(const Manual& manual);
std::string zsh_completion(const Manual& manual);
std::string fish_completion(const Manual& manual);

}  // namespace cli
}  // namespace PLUMB_ABI
}  // namespace plumb
