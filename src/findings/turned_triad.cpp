#include "plumb/findings/turned_triad.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "plumb/core/units.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace findings {
namespace {

const double kRightAngleWithin_rad = rad_from_deg(10.0);

constexpr std::size_t at(int i) noexcept { return static_cast<std::size_t>(i); }

bool at_right_angles(const SensorArray& array, int i, int j) {
  return std::fabs(angle_between_rad(array.axis(i), array.axis(j)) - 0.5 * kPi) <= kRightAngleWithin_rad;
}

/// Of the signed permutation matrix with `sign[k]` at (k, source[k]).
int determinant(const TurnedTriad& t) noexcept {
  int inversions = 0;
  for (std::size_t a = 0; a < 3; ++a) {
    for (std::size_t b = a + 1; b < 3; ++b) inversions += t.source[a] > t.source[b] ? 1 : 0;
  }
  return t.sign[0] * t.sign[1] * t.sign[2] * (inversions % 2 == 0 ? 1 : -1);
}

int entry(const TurnedTriad& t, int row, int column) noexcept {
  return t.source[at(row)] == column ? t.sign[at(row)] : 0;
}

}  // namespace

std::vector<std::array<int, 3>> triads_of(const SensorArray& array, const std::vector<std::string>& package) {
  std::vector<std::array<int, 3>> out;
  std::vector<std::pair<std::string, std::vector<int>>> chips;  // in the order of the file
  for (int i = 0; i < array.size(); ++i) {
    const std::string name = at(i) < package.size() ? package[at(i)] : "";
    auto chip = std::find_if(chips.begin(), chips.end(), [&name](const auto& one) { return one.first == name; });
    if (chip == chips.end()) chip = chips.insert(chips.end(), {name, {}});
    chip->second.push_back(i);
  }
  for (const auto& [name, sensor] : chips) {
    for (std::size_t k = 0; k + 2 < sensor.size();) {
      const int a = sensor[k], b = sensor[k + 1], c = sensor[k + 2];
      const bool triad = at_right_angles(array, a, b) && at_right_angles(array, a, c) && at_right_angles(array, b, c);
      if (triad) out.push_back({a, b, c});
      k += triad ? 3 : 1;
    }
  }
  return out;
}

std::vector<TurnedTriad> turns_of(const std::array<int, 3>& triad) {
  std::vector<TurnedTriad> out;
  std::array<int, 3> source = {0, 1, 2};
  do {
    for (unsigned signs = 0; signs < 8; ++signs) {
      TurnedTriad one{triad, source, {}};
      for (unsigned k = 0; k < 3; ++k) one.sign[k] = (signs >> k) % 2 == 0 ? 1 : -1;
      if (!(one == TurnedTriad{triad})) out.push_back(one);
    }
  } while (std::next_permutation(source.begin(), source.end()));
  std::stable_partition(out.begin(), out.end(), is_turn);
  return out;
}

bool is_turn(const TurnedTriad& turned) noexcept { return determinant(turned) > 0; }

AxisAngle axis_of(const TurnedTriad& turned) noexcept {
  AxisAngle out;
  const int trace = entry(turned, 0, 0) + entry(turned, 1, 1) + entry(turned, 2, 2);
  out.deg = trace == -1 ? 180 : trace == 0 ? 120 : 90;
  if (out.deg != 180) {
    // The rows are where the axes of the chip point, so that the turn is the transpose. Twice the sine times the axis:
    // 2 for a quarter turn, 1 each for a third.
    out.axis = {entry(turned, 1, 2) - entry(turned, 2, 1), entry(turned, 2, 0) - entry(turned, 0, 2),
                entry(turned, 0, 1) - entry(turned, 1, 0)};
    for (int& component : out.axis) component = (component > 0) - (component < 0);
    return out;
  }
  // Half the matrix plus one is the square of the axis: a column of it that is not zero.
  for (int column = 0; column < 3; ++column) {
    for (int row = 0; row < 3; ++row) out.axis[at(row)] = entry(turned, row, column) + (row == column ? 1 : 0);
    if (out.axis != std::array<int, 3>{}) break;
  }
  for (int& component : out.axis) component = (component > 0) - (component < 0);
  return out;
}

Vec3 mended_axis(const SensorArray& array, const TurnedTriad& turned, int k) noexcept {
  return scaled(array.axis(turned.sensor[at(turned.source[at(k)])]), turned.sign[at(k)]);
}

void put_right(const TurnedTriad& turned, const Datasheet& datasheet, Station& station) noexcept {
  const Station before = station;
  for (const int sensor : turned.sensor) station.delivered = station.delivered.without(sensor);
  for (std::size_t k = 0; k < 3; ++k) {
    const int channel = turned.sensor[k], sensor = turned.sensor[at(turned.source[k])];
    const SensorCoefficients &from = datasheet.sensor[at(channel)].coefficients,
                             &to = datasheet.sensor[at(sensor)].coefficients;
    const double reading = before.mean[at(channel)] / from.scale[0] - from.bias[0];
    station.mean[at(sensor)] = to.scale[0] * (turned.sign[k] * reading + to.bias[0]);
    station.scatter[at(sensor)] = before.scatter[at(channel)] * std::fabs(to.scale[0] / from.scale[0]);
    if (before.delivered.has(channel)) station.delivered = station.delivered.with(sensor);
  }
}

}  // namespace findings
}  // namespace PLUMB_ABI
}  // namespace plumb
