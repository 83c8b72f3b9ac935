/// plumb simulate --flight and plumb monitor in a folder with an array.toml, and what the summary says of motion.
#pragma once

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "tool_runner.hpp"

namespace motion_runner {

using plumb_test::Directory;
using plumb_test::Outcome;
using plumb_test::run;

inline Outcome fly(const Directory& where, const std::vector<std::string>& more) {
  std::vector<std::string> arguments = {"simulate", "--flight", "drone", "array.toml", "--out", "flight.csv"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return run(where, arguments);
}

inline Outcome monitor(const Directory& where, const std::vector<std::string>& more,
                       const std::string& log = "flight.csv") {
  std::vector<std::string> arguments = {"monitor", "--array", "array.toml", "--calibrate-first", "--log", log};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return run(where, arguments);
}

/// The object `motion` of the summary, of a run with --json.
inline nlohmann::json motion_of(const Outcome& outcome) {
  std::istringstream in(outcome.out);
  std::string line, last;
  while (std::getline(in, line)) last = line;
  const nlohmann::json summary = nlohmann::json::parse(last, nullptr, false);
  if (!summary.is_object() || !summary.contains("summary")) {
    ADD_FAILURE() << outcome.out << outcome.err;
    return {};
  }
  return summary["summary"].value("motion", nlohmann::json());
}

}  // namespace motion_runner
