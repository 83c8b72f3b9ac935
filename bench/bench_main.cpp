// plumb_bench: Google Benchmark's own options, or --table for the table of scripts/bench.
#include <benchmark/benchmark.h>

#include <string>

#include "pairs.hpp"

int main(int argc, char** argv) {
  if (argc == 2 && std::string(argv[1]) == "--table") return plumb_bench::print_table();
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
