#pragma once

#include <cstdint>
#include <string>

namespace plumb_replay {

struct Options {
  std::uint64_t seed = 1;
  int scenarios = 2000;
  std::string data;      ///< folder of the recordings; empty: none
  std::string examples;  ///< folder of the array files that read them
  std::string words;     ///< renamed words
  std::string trace;     ///< the one case that is told as text, or the beginning of its name
  std::string only;      ///< cases whose names begin so
  std::string perturb;   ///< the case of which one sample is one unit in the last place more
  bool quick = false;    ///< a few cases
  bool help = false;
};

/// False where the command line is none; why stands on standard error.
bool parse(int argc, char** argv, Options& out);
const char* usage();

}  // namespace plumb_replay
