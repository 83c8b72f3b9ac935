/// Numbers and lists out of the page's JSON (private to web/core). A build without exceptions must ask before it takes:
/// nlohmann_json would end the program.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "explorer.hpp"
#include "plumb/array/named.hpp"
#include "plumb/core/error.hpp"

namespace plumb_web {

using nlohmann::json;

inline double number(const json& from, const char* key, double otherwise) {
  const auto found = from.find(key);
  return found != from.end() && found->is_number() ? found->get<double>() : otherwise;
}

inline std::vector<std::string> texts(const json& from, const char* key) {
  std::vector<std::string> out;
  const auto found = from.find(key);
  if (found == from.end() || !found->is_array()) return out;
  for (const json& one : *found) {
    if (one.is_string()) out.push_back(one.get<std::string>());
  }
  return out;
}

/// Axes as the page has them, of any length but zero; their number, or 0 where they are no list of 3 to kCapacity
/// directions.
inline int read_axes(const json& from, plumb::AxisList& axes) {
  const auto found = from.find("axes");
  if (found == from.end() || !found->is_array()) return 0;
  const std::size_t n = found->size();
  if (n < 3 || n > axes.size()) return 0;
  for (std::size_t i = 0; i < n; ++i) {
    const json& one = (*found)[i];
    if (!one.is_array() || one.size() != 3) return 0;
    for (std::size_t k = 0; k < 3; ++k) {
      if (!one[k].is_number()) return 0;
      axes[i][k] = one[k].get<double>();
    }
  }
  return static_cast<int>(n);
}

/// What the core refuses, with its remedy.
inline std::string refused(const plumb::Error& error) {
  return refusal(std::string(describe(error.code)) + ". Remedy: " + remedy(error.code));
}

/// What is said where `read_axes` refuses.
inline std::string axes_wanted() {
  return "the axes are no list of directions. Remedy: give 3 to " + std::to_string(plumb::kCapacity) +
         " of them, three numbers each";
}

}  // namespace plumb_web
