/// Table 2 of the paper, played with the user's own tool where that is the paper's tetrahedron.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "plumb/io/array_file.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace cli {

using Json = nlohmann::ordered_json;

/// Sensors drawn within the priors of the array file, the paper's rule and plumb's monitor over the 23 experiments.
/// `given` is false, with the reason, for every other array and where the sensors do not read 3 per g0.
Json table2_section(const io::ArrayFile& array, std::uint64_t seed);

}  // namespace cli
}  // namespace PLUMB_ABI
}  // namespace plumb
