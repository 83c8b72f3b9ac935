/// Which sensors of an array are x, y and z of which chip of a coefficient file.
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "plumb/coefficients/coefficient_file.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace coefficients {

/// Three channels of an array as x, y and z of a chip.
struct ChipPlace {
  std::string name;                       ///< the package, or the ids
  std::array<int, 3> sensor{-1, -1, -1};  ///< -1: this axis is not in the array
  std::array<int, 3> sign{1, 1, 1};       ///< -1: the channel reads minus the chip's axis

  bool whole() const noexcept { return sensor[0] >= 0 && sensor[1] >= 0 && sensor[2] >= 0; }
};

/// "0=imu1" or "0=a1,-a2,a3": a chip of the file and the sensors that it is.
struct InstanceChoice {
  int instance = 0;
  std::string who;
};
/// Refuses what is not a number, "=" and a name.
io::FileExpected<InstanceChoice> parse_instance(std::string_view text);

/// The chips of the array in the order of the file, without the sensors `elsewhere`: those that `package` names, where
/// any does, else every three sensors in a row. Refuses packages of more or fewer than three, and three that do not lie
/// at right angles (10 deg).
io::FileExpected<std::vector<ChipPlace>> places_of(const io::ArrayFile& array, SensorSet elsewhere = {});

/// What `who` names: a package, or three ids with commas between them, "-" before one that reads the other way round,
/// or
/// "-" alone for an axis that the array does not have. Refuses names that the array does not have.
io::FileExpected<ChipPlace> place_named(const io::ArrayFile& array, const std::string& who);

/// A chip by its number, where it is.
struct PlacedChip {
  int instance = 0;
  ChipPlace place;
};

/// By `choices`, where there are any, else every chip of `instances`, which increase, to the chips of the array in
/// their order (`places_of`). With no `instances` every number is one. Refuses another number of chips than the array
/// has, an instance that there is not, one sensor twice.
io::FileExpected<std::vector<PlacedChip>> place_chips(const io::ArrayFile& array, const std::vector<int>& instances,
                                                      const std::vector<InstanceChoice>& choices,
                                                      const std::string& path, SensorSet elsewhere = {});

/// Refuses three sensors that are the axes of no right-handed frame, in the sense of a specific force: as they are
/// named they are not x, y and z of a chip. Says nothing of a place that is not whole.
io::FileExpected<void> check_handedness(const io::ArrayFile& array, const ChipPlace& place, Form form);

}  // namespace coefficients
}  // namespace PLUMB_ABI
}  // namespace plumb
