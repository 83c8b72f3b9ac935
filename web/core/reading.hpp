/// Numbers and lists out of the page's JSON (private to web/core). A build without exceptions must ask before it takes:
/// nlohmann_json would end the program.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "explorer.hpp"
#include "plumb/array/named.hpp"
#include "plumb/array/sensor_array.hpp"
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

/// The chip of every sensor, by number; 0: a unit of its own.
using ChipList = std::array<std::uint8_t, static_cast<std::size_t>(plumb::kCapacity)>;

inline ChipList read_chips(const json& from) {
  ChipList out{};
  const auto found = from.find("chips");
  if (found == from.end() || !found->is_array()) return out;
  for (std::size_t i = 0; i < found->size() && i < out.size(); ++i) {
    const json& one = (*found)[i];
    const double chip = one.is_number() ? one.get<double>() : 0.0;
    if (chip >= 0.0 && chip <= plumb::kCapacity) out[i] = static_cast<std::uint8_t>(chip);
  }
  return out;
}

/// Sensor i, named by its number; the axis becomes a unit vector.
inline plumb::SensorRow row_of(const plumb::AxisList& axes, const ChipList& chips, int i, double noise_mps2) {
  const plumb::Vec3& axis = axes[static_cast<std::size_t>(i)];
  plumb::SensorRow row;
  row.id = plumb::make_id(("a" + std::to_string(i + 1)).c_str());
  const double length = plumb::norm(axis);
  row.axis = std::fabs(length - 1.0) > 1e-9 ? plumb::scaled(axis, 1.0 / length) : axis;
  row.sigma_mps2 = noise_mps2;
  row.chip = chips[static_cast<std::size_t>(i)];
  return row;
}

inline std::uint64_t seed_of(const json& from, const char* key, double otherwise) {
  return static_cast<std::uint64_t>(std::fabs(number(from, key, otherwise)));
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
