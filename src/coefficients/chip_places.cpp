#include "plumb/coefficients/chip_places.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "../io/csv.hpp"
#include "../io/text_tools.hpp"
#include "plumb/core/units.hpp"
#include "plumb/scenario/count_text.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace coefficients {
namespace {

constexpr const char* kExample =
    "write the number of the chip in the file and its package or its three sensors: "
    "--instance 0=imu1, --instance \"0=a1,a2,a3\"";
const double kRightAngleWithin_rad = rad_from_deg(10.0);

tl::unexpected<io::FileError> refuse_place(const std::string& file, const std::string& field, const std::string& what,
                                           const std::string& remedy, io::ExitCode code = io::ExitCode::invalid_input) {
  return tl::unexpected<io::FileError>(io::FileError{file, 0, field, what, remedy, code});
}

tl::unexpected<io::FileError> refuse_option(const std::string& what, const std::string& remedy = kExample) {
  return refuse_place("--instance", "", what, remedy, io::ExitCode::usage);
}

std::string id_of(const io::ArrayFile& array, int i) { return array.array.row(i).id.data(); }

int sensor_called(const io::ArrayFile& array, std::string_view id) {
  for (int i = 0; i < array.array.size(); ++i) {
    if (id_of(array, i) == id) return i;
  }
  return -1;
}

std::string ids_of(const io::ArrayFile& array, const std::array<int, 3>& sensors) {
  std::vector<std::string> out;
  for (const int i : sensors) out.push_back(i >= 0 ? id_of(array, i) : "-");
  return io::joined(out);
}

bool at_right_angles(const io::ArrayFile& array, const std::array<int, 3>& s) {
  for (std::size_t k = 0; k < 3; ++k) {
    const double angle = angle_between_rad(array.array.axis(s[k]), array.array.axis(s[(k + 1) % 3]));
    if (!(std::fabs(angle - 0.5 * kPi) <= kRightAngleWithin_rad)) return false;
  }
  return true;
}

/// The sensors of each package, in the order of the file; without packages three in a row each.
std::vector<std::pair<std::string, std::vector<int>>> groups_of(const io::ArrayFile& array, SensorSet elsewhere) {
  std::vector<std::pair<std::string, std::vector<int>>> out;
  bool any = false;
  for (int i = 0; i < array.array.size(); ++i) any = any || !io::package_of(array, i).empty();
  int counted = 0;
  for (int i = 0; i < array.array.size(); ++i) {
    if (elsewhere.has(i)) continue;
    const std::string name = any ? io::package_of(array, i) : "chip " + std::to_string(counted++ / 3 + 1);
    auto found = std::find_if(out.begin(), out.end(), [&name](const auto& one) { return one.first == name; });
    if (found == out.end()) found = out.insert(out.end(), {name, {}});
    found->second.push_back(i);
  }
  return out;
}

io::FileExpected<ChipPlace> place_of_ids(const io::ArrayFile& array, const std::string& who) {
  ChipPlace out;
  out.name = who;
  std::size_t count = 0;
  for (std::size_t begin = 0; begin <= who.size(); ++count) {
    const std::size_t end = std::min(who.find(',', begin), who.size());
    std::string_view id = io::trimmed(std::string_view(who).substr(begin, end - begin));
    begin = end + 1;
    if (count >= 3 || id == "-") continue;
    int sensor = sensor_called(array, id);
    if (sensor < 0 && !id.empty() && id.front() == '-') {
      out.sign[count] = -1;
      id.remove_prefix(1);
      sensor = sensor_called(array, id);
    }
    if (sensor < 0) {
      std::vector<std::string> known;
      for (int i = 0; i < array.array.size(); ++i) known.push_back(id_of(array, i));
      return refuse_option(io::in_quotes(id) + " is neither a package nor a sensor of " + array.path,
                           io::did_you_mean(id, known) + kExample);
    }
    if (std::find(out.sensor.begin(), out.sensor.end(), sensor) != out.sensor.end())
      return refuse_option(io::in_quotes(id) + " stands there twice");
    out.sensor[count] = sensor;
  }
  const bool any = std::any_of(out.sensor.begin(), out.sensor.end(), [](int i) { return i >= 0; });
  if (count != 3 || !any)
    return refuse_option(io::in_quotes(who) + " is no package of " + array.path + ", and as sensors it names " +
                         std::to_string(count) + ": a chip has three, x, y and z");
  return out;
}

io::FileExpected<std::vector<PlacedChip>> by_choice(const io::ArrayFile& array, const std::vector<int>& instances,
                                                    const std::vector<InstanceChoice>& choices,
                                                    const std::string& path) {
  std::vector<PlacedChip> out;
  SensorSet taken;
  for (const InstanceChoice& choice : choices) {
    if (!instances.empty() && std::find(instances.begin(), instances.end(), choice.instance) == instances.end()) {
      std::vector<std::string> known;
      for (const int one : instances) known.push_back(std::to_string(one));
      return refuse_option("there is no chip " + std::to_string(choice.instance) + " in " + path,
                           "it holds: " + io::joined(known));
    }
    for (const PlacedChip& other : out) {
      if (other.instance == choice.instance)
        return refuse_option("chip " + std::to_string(choice.instance) + " is named twice", "name it once");
    }
    io::FileExpected<ChipPlace> place = place_named(array, choice.who);
    if (!place) return tl::unexpected<io::FileError>(place.error());
    for (const int sensor : place->sensor) {
      if (sensor < 0) continue;
      if (taken.has(sensor))
        return refuse_option(io::in_quotes(id_of(array, sensor)) + " is in two chips", "name every sensor once");
      taken = taken | SensorSet::of(sensor);
    }
    out.push_back({choice.instance, *std::move(place)});
  }
  return out;
}

}  // namespace

io::FileExpected<InstanceChoice> parse_instance(std::string_view text) {
  const std::size_t equals = text.find('=');
  std::int64_t number = 0;
  const bool told = equals != std::string_view::npos && equals > 0 &&
                    io::parse_whole(text.substr(0, equals), number) == io::CellKind::number;
  constexpr std::int64_t kMost = 99;
  if (!told || number < 0 || number > kMost)
    return refuse_option(io::in_quotes(text) + " is no number, \"=\" and a name");
  const std::string_view who = io::trimmed(text.substr(equals + 1));
  if (who.empty()) return refuse_option(io::in_quotes(text) + " names no sensors");
  return InstanceChoice{static_cast<int>(number), std::string(who)};
}

io::FileExpected<std::vector<ChipPlace>> places_of(const io::ArrayFile& array, SensorSet elsewhere) {
  std::vector<ChipPlace> out;
  for (const auto& [name, sensors] : groups_of(array, elsewhere)) {
    const std::string who = name.empty() ? "sensors without a package" : name;
    if (name.empty() || sensors.size() != 3)
      return refuse_place(
          array.path, who,
          "has " + count_text(sensors.size(), "sensor") + ", but a chip of the form has three: x, y and z",
          "state the chip of each sensor in that order (package = \"imu1\"), or name chips and sensors: "
          "--instance \"0=a1,a2,a3\"");
    ChipPlace place;
    place.name = name;
    std::copy(sensors.begin(), sensors.end(), place.sensor.begin());
    if (!at_right_angles(array, place.sensor))
      return refuse_place(
          array.path, who,
          "does not lie at right angles (" + ids_of(array, place.sensor) + "), so it is no chip of three axes",
          "name the sensors that are x, y and z of a chip: --instance \"0=a1,a2,a3\"");
    out.push_back(place);
  }
  return out;
}

io::FileExpected<ChipPlace> place_named(const io::ArrayFile& array, const std::string& who) {
  std::vector<int> sensors;
  for (int i = 0; i < array.array.size(); ++i) {
    if (io::package_of(array, i) == who) sensors.push_back(i);
  }
  if (sensors.empty()) return place_of_ids(array, who);
  if (sensors.size() != 3)
    return refuse_option("package " + io::in_quotes(who) + " has " + count_text(sensors.size(), "sensor") +
                             ", but a chip has three: x, y and z",
                         "name the sensors, \"-\" for an axis that the array does not have: --instance \"0=a1,a2,-\"");
  ChipPlace out;
  out.name = who;
  std::copy(sensors.begin(), sensors.end(), out.sensor.begin());
  return out;
}

io::FileExpected<std::vector<PlacedChip>> place_chips(const io::ArrayFile& array, const std::vector<int>& instances,
                                                      const std::vector<InstanceChoice>& choices,
                                                      const std::string& path, SensorSet elsewhere) {
  if (!choices.empty()) return by_choice(array, instances, choices, path);
  const io::FileExpected<std::vector<ChipPlace>> places = places_of(array, elsewhere);
  if (!places) return tl::unexpected<io::FileError>(places.error());
  if (places->size() != instances.size())
    return refuse_place(path, "",
                        "holds " + count_text(instances.size(), "chip") + ", but " + array.path + " has " +
                            std::to_string(places->size()),
                        "say which chip is which: --instance " +
                            std::to_string(instances.empty() ? 0 : instances.front()) + "=" +
                            io::shell_word(places->empty() ? "imu1" : places->front().name) +
                            " and so on; a chip that is not named is left out");
  std::vector<PlacedChip> out;
  for (std::size_t k = 0; k < instances.size(); ++k) out.push_back({instances[k], (*places)[k]});
  return out;
}

io::FileExpected<void> check_handedness(const io::ArrayFile& array, const ChipPlace& place, Form form) {
  if (!place.whole()) return {};
  const auto axis = [&](std::size_t k) { return scaled(array.array.axis(place.sensor[k]), place.sign[k]); };
  const double sense = array.datasheet.reads == Reads::gravity ? -1.0 : 1.0;
  if (sense * det3(axis(0), axis(1), axis(2)) > 0.0) return {};
  return refuse_place(array.path, place.name,
                      "is no right-handed frame in the order " + ids_of(array, place.sensor) + ", and x, y and z of " +
                          (form == Form::px4 ? "PX4" : "ArduPilot") + " (forward, right, down) are one",
                      "name the sensors in the order x, y, z, with \"-\" before one that reads the other way round: "
                      "--instance \"0=a1,-a2,a3\"");
}

}  // namespace coefficients
}  // namespace PLUMB_ABI
}  // namespace plumb
