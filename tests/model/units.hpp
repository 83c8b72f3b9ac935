/// What fails at once in the breadth-first search: chips and single sensors, counted without the library's code.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace plumb_model {

using Set = std::uint8_t;
inline int count(unsigned s) { return __builtin_popcount(s); }

/// How many sensors every unit has: chips, and single sensors. Those of a unit have successive numbers.
class Units {
 public:
  explicit Units(std::vector<int> sizes) : sizes_(std::move(sizes)) {
    unsigned first = 0;
    for (const int size : sizes_) {
      members_.push_back(static_cast<Set>(((1U << size) - 1U) << first));
      first += static_cast<unsigned>(size);
    }
    sensors_ = static_cast<int>(first);
    for (unsigned set = 0; set < 1U << first; ++set) {  // looked up at every step of the search
      of_.push_back(static_cast<int>(parts(set).size()));
      flat_.push_back(most_in_a_plane(set));
    }
  }
  int sensors() const { return sensors_; }
  const std::vector<int>& sizes() const { return sizes_; }
  bool chips() const { return sensors_ > static_cast<int>(sizes_.size()); }
  /// Number of units with a sensor among these.
  int of(unsigned sensors) const { return of_[sensors]; }
  /// What of every unit is among these sensors, unit after unit.
  std::vector<Set> parts(unsigned sensors) const {
    std::vector<Set> out;
    for (const Set unit : members_) {
      if ((unit & sensors) != 0) out.push_back(static_cast<Set>(unit & sensors));
    }
    return out;
  }
  Set unit_of(int sensor) const {
    for (const Set unit : members_) {
      if ((unit >> sensor) & 1U) return unit;
    }
    return 0;
  }
  /// The largest number of units that have at most two sensors together: these may lie in one plane.
  int flat(unsigned sensors) const { return flat_[sensors]; }

 private:
  int most_in_a_plane(unsigned sensors) const {
    int most = 0;
    const std::vector<Set> all = parts(sensors);
    for (std::size_t a = 0; a < all.size(); ++a) {
      if (count(all[a]) <= 2) most = std::max(most, 1);
      for (std::size_t b = 0; b < a; ++b) {
        if (count(all[a] | all[b]) <= 2) most = std::max(most, 2);
      }
    }
    return most;
  }

  std::vector<int> sizes_;
  std::vector<Set> members_;
  std::vector<int> of_, flat_;
  int sensors_ = 0;
};

}  // namespace plumb_model
