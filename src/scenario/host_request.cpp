#include "plumb/scenario/host_request.hpp"

#include <algorithm>
#include <charconv>
#include <utility>

#include "quantity_text.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace scenario {
namespace {

using Text = std::string_view;

tl::unexpected<std::string> refuse(std::string why) {
  return tl::unexpected<std::string>(std::move(why) + ", as in \"60.5s reset a2,a4 key 0x706c756d62\"");
}

std::string quoted(Text text) { return "'" + std::string(text) + "'"; }

/// The word before the first blank; takes it off the text.
Text take_word(Text& text) {
  const std::size_t begin = std::min(text.find_first_not_of(' '), text.size());
  const std::size_t end = std::min(text.find(' ', begin), text.size());
  const Text word = text.substr(begin, end - begin);
  text.remove_prefix(end);
  return word;
}

int sensor_named(Text id, const SensorArray& array) {
  for (int i = 0; i < array.size(); ++i) {
    if (id == array.row(i).id.data()) return i;
  }
  return -1;
}

tl::expected<SensorSet, std::string> read_sensors(Text text, const SensorArray& array) {
  SensorSet sensors;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    const Text id = text.substr(begin, end - begin);
    const int i = sensor_named(id, array);
    if (i < 0) return refuse("the array has no sensor " + quoted(id) + ". Remedy: name its sensors, joined by commas");
    sensors = sensors.with(i);
    begin = end + 1;
  }
  return sensors;
}

tl::expected<std::uint64_t, std::string> read_key(Text text) {
  const bool hex = text.substr(0, 2) == "0x";
  const Text digits = hex ? text.substr(2) : text;
  std::uint64_t key = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), key, hex ? 16 : 10);
  if (error == std::errc() && end == digits.data() + digits.size()) return key;
  return refuse(quoted(text) + " is not a key. Remedy: give a whole number below 2^64");
}

/// SENSORS key KEY
tl::expected<void, std::string> read_reset(Text& text, const SensorArray& array, HostRequest& out) {
  const auto sensors = read_sensors(take_word(text), array);
  if (!sensors) return tl::unexpected<std::string>(sensors.error());
  out.sensors = *sensors;
  if (take_word(text) != "key")
    return refuse("a reset needs a key. Remedy: end with `key` and the reset_key of the array file");
  const auto key = read_key(take_word(text));
  if (!key) return tl::unexpected<std::string>(key.error());
  out.key = *key;
  return {};
}

std::string ids_of(SensorSet sensors, const SensorArray& array, const char* between) {
  std::string out;
  for (int i = 0; i < array.size(); ++i) {
    if (sensors.has(i)) out += (out.empty() ? "" : between) + std::string(array.row(i).id.data());
  }
  return out;
}

}  // namespace

tl::expected<HostRequest, std::string> parse_host_request(Text text, const SensorArray& array) {
  HostRequest request;
  const auto time_s = read_quantity(take_word(text), time_units(), "time");
  if (!time_s) return refuse(time_s.error() + " and put it first");
  request.time_s = *time_s;
  const Text verb = take_word(text);
  if (verb == "reset") {
    const tl::expected<void, std::string> done = read_reset(text, array, request);
    if (!done) return tl::unexpected<std::string>(done.error());
  } else if (verb == "recalibrate") {
    request.kind = HostRequest::Kind::recalibrate;
  } else {
    return refuse("unknown request " + quoted(verb) + ". Remedy: write reset or recalibrate");
  }
  const Text rest = take_word(text);
  if (!rest.empty()) return refuse(quoted(rest) + " is not expected here. Remedy: remove it");
  return request;
}

const char* to_string(HostRequest::Kind kind) noexcept {
  switch (kind) {
    case HostRequest::Kind::reset: return "reset";
    case HostRequest::Kind::recalibrate: return "recalibrate";
  }
  return "?";
}

std::string to_text(const HostRequest& request, const SensorArray& array) {
  const std::string out = quantity_text(request.time_s, time_units()) + " " + to_string(request.kind);
  if (request.kind == HostRequest::Kind::recalibrate) return out;
  char digits[17];
  const auto [end, error] = std::to_chars(digits, digits + sizeof digits, request.key, 16);
  return out + " " + ids_of(request.sensors, array, ",") + " key 0x" +
         std::string(digits, error == std::errc() ? end : digits);
}

std::string describe(const HostRequest& request, const SensorArray& array) {
  if (request.kind == HostRequest::Kind::recalibrate) return "a recalibration";
  return "a reset that returns " + ids_of(request.sensors, array, ", ") + " to service";
}

Host::Host(std::vector<HostRequest> requests) : requests_(std::move(requests)) {
  std::stable_sort(requests_.begin(), requests_.end(),
                   [](const HostRequest& a, const HostRequest& b) { return a.time_s < b.time_s; });
}

}  // namespace scenario
}  // namespace PLUMB_ABI
}  // namespace plumb
