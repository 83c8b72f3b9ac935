/// The table of scripts/bench: work of plumb beside the work of a rival, measured by turns in one run, and figures that
/// stand alone.
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
  Runs rival;
  double each = 1.0;  ///< pieces of work in one run, as rows of a log
};

/// Whose time: the processor's for this thread, or for all threads of the program; that on the wall.
enum class Clock { thread, program, wall };

struct Pair {
  std::string work;
  std::string rival;
  double least = 0.0;  ///< the rival's time over plumb's, as asked for; 0: nothing was
  std::function<Contest()> make;
  Clock clock = Clock::thread;  ///< of both
};

struct Figure {
  std::string work;
  double value = 0.0;
  double most = 0.0;  ///< 0: nothing was asked for
  std::string unit;
};
using Figures = std::function<std::vector<Figure>()>;

/// All that were enrolled.
std::vector<Pair>& pairs();
std::vector<Figures>& figures();

struct Enrolled {
  explicit Enrolled(Pair pair) { pairs().push_back(std::move(pair)); }
  explicit Enrolled(Figures more) { figures().push_back(std::move(more)); }
};

/// Prints the table: work, plumb, rival, ratio, bar, with machine and compiler.
int print_table();

}  // namespace plumb_bench
