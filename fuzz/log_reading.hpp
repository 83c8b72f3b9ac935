/// A log of the paper's tool read to its end, with what holds of every row that is delivered.
#pragma once

#include <string>

#include "files.hpp"
#include "plumb/io/log_reader.hpp"

namespace fuzz {

struct Outcome {
  std::uint64_t rows = 0;
  std::uint64_t rows_bad = 0;
  std::uint64_t hash = 0;
};

inline Outcome read_under(const std::string& path, plumb::io::BadRowPolicy policy) {
  using namespace plumb;
  auto log = io::LogReader::open(path, paper_tool(), policy);
  if (!log) {
    demand_told(log.error());
    return {};
  }
  log->hash_bytes();
  Sample s;
  double last_s = 0.0;
  std::uint64_t rows = 0;
  for (;;) {
    const io::LogReader::Next next = log->next(s);
    if (next == io::LogReader::Next::end) break;
    if (next == io::LogReader::Next::error) {
      demand_told(log->error());
      break;
    }
    demand(s.time_s - s.time_s == 0.0 && (rows == 0 || s.time_s > last_s), "time is finite and increases");
    demand((s.delivered - paper_tool().array.all()).empty(), "only sensors that there are");
    demand(s.temperature_degc - s.temperature_degc == 0.0, "a temperature that can be used");
    last_s = s.time_s;
    ++rows;
  }
  demand(log->statistics().rows == rows, "rows are counted");
  return {rows, log->statistics().rows_bad, log->statistics().hash};
}

}  // namespace fuzz
