/// Work of plumb beside the work of a rival, measured by turns in one run: the table of scripts/bench.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

namespace plumb_bench {

/// Does its work so many times over.
using Runs = std::function<void(std::size_t count)>;

struct Contest {
  Runs plumb;
  Runs rival;  ///< empty: plumb's figure stands against the bar alone
};

struct Pair {
  std::string work;   ///< "kernel, 4 sensors"
  std::string rival;  ///< "Eigen LU of every triple"; of a pair without one: what the figure is
  /// plumb's time over the rival's; without a rival nanoseconds. 0: nothing was asked for.
  double most = 0.0;
  std::function<Contest()> make;
  std::string note;  ///< where there is no rival: not a time of `make` but these words
};

/// All that were enrolled, in the order of their names.
std::vector<Pair>& pairs();

struct Enrolled {
  explicit Enrolled(Pair pair) { pairs().push_back(std::move(pair)); }
};

/// Prints the table: work, plumb, rival, ratio, bar, with machine and compiler.
int print_table();

}  // namespace plumb_bench
