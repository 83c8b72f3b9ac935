// The command line of plumb_monitor_attacks.
#pragma once

#include <cstdint>
#include <string>
#include <tl/expected.hpp>
#include <vector>

namespace plumb_bench {

struct Options {
  std::uint64_t seed = 20180227;
  std::uint64_t first = 0;
  std::uint64_t episodes = 20000;
  double adaptive_share = 0.1;
  std::vector<int> chosen{};  ///< families; all of them where none is named
  bool one = false;           ///< `first` alone, and every change of state of it
  bool quick = false, every_n = false, list = false;
  std::string state, json, before;
};

/// What `argv` says, or what is wrong with it.
tl::expected<Options, std::string> options_of(int argc, const char* const* argv);
const char* usage();

}  // namespace plumb_bench
