#include "plumb/render/identity.hpp"
#include "plumb/io/json_fields.hpp"

#include <fmt/format.h>

#include <Eigen/Core>
#include <array>
#include <boost/version.hpp>
#include <cstdint>

#include "build_identity.hpp"
#include "plumb/core/units.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace render {
namespace {

constexpr std::array<std::uint32_t, 64> kRound = {
    0x428a2f98, 0x71374491, 0xb5c0fbcf, 0xe9b5dba5, 0x3956c25b, 0x59f111f1, 0x923f82a4, 0xab1c5ed5,
    0xd807aa98, 0x12835b01, 0x243185be, 0x550c7dc3, 0x72be5d74, 0x80deb1fe, 0x9bdc06a7, 0xc19bf174,
    0xe49b69c1, 0xefbe4786, 0x0fc19dc6, 0x240ca1cc, 0x2de92c6f, 0x4a7484aa, 0x5cb0a9dc, 0x76f988da,
    0x983e5152, 0xa831c66d, 0xb00327c8, 0xbf597fc7, 0xc6e00bf3, 0xd5a79147, 0x06ca6351, 0x14292967,
    0x27b70a85, 0x2e1b2138, 0x4d2c6dfc, 0x53380d13, 0x650a7354, 0x766a0abb, 0x81c2c92e, 0x92722c85,
    0xa2bfe8a1, 0xa81a664b, 0xc24b8b70, 0xc76c51a3, 0xd192e819, 0xd6990624, 0xf40e3585, 0x106aa070,
    0x19a4c116, 0x1e376c08, 0x2748774c, 0x34b0bcb5, 0x391c0cb3, 0x4ed8aa4a, 0x5b9cca4f, 0x682e6ff3,
    0x748f82ee, 0x78a5636f, 0x84c87814, 0x8cc70208, 0x90befffa, 0xa4506ceb, 0xbef9a3f7, 0xc67178f2};

constexpr std::uint32_t turned(std::uint32_t x, unsigned by) { return x >> by | x << (32U - by); }

void digest(const unsigned char* block, std::array<std::uint32_t, 8>& state) {
  std::array<std::uint32_t, 64> w{};
  for (std::size_t k = 0; k < 16; ++k) {
    for (std::size_t b = 0; b < 4; ++b) w[k] = w[k] << 8U | block[4 * k + b];
  }
  for (std::size_t k = 16; k < 64; ++k) {
    const std::uint32_t a = w[k - 15], b = w[k - 2];
    w[k] = w[k - 16] + (turned(a, 7) ^ turned(a, 18) ^ a >> 3U) + w[k - 7] + (turned(b, 17) ^ turned(b, 19) ^ b >> 10U);
  }
  std::array<std::uint32_t, 8> s = state;
  for (std::size_t k = 0; k < 64; ++k) {
    const std::uint32_t one = s[7] + (turned(s[4], 6) ^ turned(s[4], 11) ^ turned(s[4], 25)) +
                              ((s[4] & s[5]) ^ (~s[4] & s[6])) + kRound[k] + w[k];
    const std::uint32_t two =
        (turned(s[0], 2) ^ turned(s[0], 13) ^ turned(s[0], 22)) + ((s[0] & s[1]) ^ (s[0] & s[2]) ^ (s[1] & s[2]));
    s = {one + two, s[0], s[1], s[2], s[3] + one, s[4], s[5], s[6]};
  }
  for (std::size_t k = 0; k < 8; ++k) state[k] += s[k];
}

}  // namespace

std::string sha256(std::string_view bytes) {
  std::array<std::uint32_t, 8> state = {0x6a09e667, 0xbb67ae85, 0x3c6ef372, 0xa54ff53a,
                                        0x510e527f, 0x9b05688c, 0x1f83d9ab, 0x5be0cd19};
  std::string padded(bytes);
  padded += static_cast<char>(0x80);
  while (padded.size() % 64 != 56) padded += '\0';
  const std::uint64_t length = std::uint64_t{8} * bytes.size();
  for (unsigned k = 0; k < 8; ++k) padded += static_cast<char>(length >> (56U - 8U * k) & 0xffU);
  std::array<unsigned char, 64> block{};
  for (std::size_t at = 0; at < padded.size(); at += 64) {
    for (std::size_t k = 0; k < 64; ++k) block[k] = static_cast<unsigned char>(padded[at + k]);
    digest(block.data(), state);
  }
  std::string out;
  for (const std::uint32_t word : state) out += fmt::format("{:08x}", word);
  return out;
}

Json build_json() {
  Json libraries = Json::array();
  const auto add = [&libraries](const char* name, const std::string& version, const char* licence) {
    libraries.push_back(io::object({{"name", name}, {"version", version}, {"licence", licence}}));
  };
  add("Eigen", fmt::format("{}.{}.{}", EIGEN_WORLD_VERSION, EIGEN_MAJOR_VERSION, EIGEN_MINOR_VERSION), "MPL-2.0");
  add("fmt", fmt::format("{}.{}.{}", FMT_VERSION / 10000, FMT_VERSION / 100 % 100, FMT_VERSION % 100), "MIT");
  add("nlohmann-json",
      fmt::format("{}.{}.{}", NLOHMANN_JSON_VERSION_MAJOR, NLOHMANN_JSON_VERSION_MINOR, NLOHMANN_JSON_VERSION_PATCH),
      "MIT");
  add("Boost", fmt::format("{}.{}.{}", BOOST_VERSION / 100000, BOOST_VERSION / 100 % 1000, BOOST_VERSION % 100),
      "BSL-1.0");
#ifdef __GLIBCXX__
  add("libstdc++", std::to_string(__GLIBCXX__), "GPL-3.0-or-later WITH GCC-exception-3.1");
#endif
  return io::object({{"version", PLUMB_VERSION},
                     {"commit", PLUMB_COMMIT},
                     {"compiler", PLUMB_BUILD_COMPILER},
                     {"flags", PLUMB_BUILD_FLAGS},
                     {"build_type", PLUMB_BUILD_TYPE},
                     {"target", PLUMB_BUILD_TARGET},
                     {"libraries", std::move(libraries)}});
}

BuildKey this_build() { return {PLUMB_COMMIT, PLUMB_BUILD_COMPILER, PLUMB_BUILD_FLAGS}; }

std::string not_of_this_build(const BuildKey& key, bool sources_alone) {
  const BuildKey here = this_build();
  const auto differ = [](const char* what, const std::string& theirs, const std::string& ours) {
    return fmt::format("{} \"{}\", this build is of \"{}\"", what, theirs, ours);
  };
  if (key.commit.empty() || (!sources_alone && key.compiler.empty())) return "they do not say of which build they are";
  if (key.commit != here.commit) return differ("commit", key.commit, here.commit);
  if (!sources_alone && key.compiler != here.compiler) return differ("compiler", key.compiler, here.compiler);
  if (!sources_alone && key.flags != here.flags) return differ("flags", key.flags, here.flags);
  const bool clean = here.commit != "unknown" && here.commit.find("-dirty") == std::string::npos;
  return clean ? std::string()
               : fmt::format("commit \"{}\" names no sources: build from a clean checkout", here.commit);
}

Json input_json(const char* role, const std::string& path, std::string_view bytes) {
  const std::size_t slash = path.find_last_of('/');
  return io::object({{"role", role},
                     {"name", slash == std::string::npos ? path : path.substr(slash + 1)},
                     {"bytes", bytes.size()},
                     {"sha256", sha256(bytes)}});
}

}  // namespace render
}  // namespace PLUMB_ABI
}  // namespace plumb
