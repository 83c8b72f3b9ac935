/// What exactly was run: version, commit, compiler, flags, libraries, and the inputs by their hashes.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "plumb/core/config.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace render {

using Json = nlohmann::ordered_json;

/// SHA-256 (FIPS 180-4) as 64 hexadecimal digits.
std::string sha256(std::string_view bytes);

/// Of the build.
Json build_json();

/// What a result of tests or proofs is a result of. Empty: it does not say.
struct BuildKey {
  std::string commit, compiler, flags;
};
BuildKey this_build();

/// Why a result of such a build is none of this one; empty: it is. Proofs are of sources alone: no compiler, no flags.
std::string not_of_this_build(const BuildKey& key, bool sources_alone);

/// A file that the report rests on; its name without its directories, so that reports of two machines compare.
Json input_json(const char* role, const std::string& path, std::string_view bytes);

}  // namespace render
}  // namespace PLUMB_ABI
}  // namespace plumb
