#include "plumb/session/choice_texts.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cmath>

namespace plumb {
inline namespace PLUMB_ABI {
namespace session {
namespace {

/// A smaller fraction of any recording that can be made holds out nothing.
constexpr double kLeastFraction = 0.001;

bool number(const std::string& text, std::size_t begin, std::size_t end, double& value) {
  const auto read = std::from_chars(text.data() + begin, text.data() + end, value);
  return read.ec == std::errc{} && read.ptr == text.data() + end && std::isfinite(value);
}

}  // namespace

std::string read_hold_out(const std::string& text, findings::HoldOutChoice& choice) {
  choice = findings::HoldOutChoice{};
  if (text == "none") {
    choice.none = true;
    return "";
  }
  if (text == "one") {
    choice.all = true;
    return "";
  }
  double value = 0.0;
  const char* const end = text.data() + text.size();
  const auto read = std::from_chars(text.data(), end, value);
  if (read.ec == std::errc{} && read.ptr == end) {
    if (value >= kLeastFraction && value <= 0.5) {
      choice.folds = static_cast<int>(std::lround(1.0 / value));
      choice.once = true;
      return "";
    }
    if (value >= 2.0 && value <= 10000.0 && value == std::floor(value)) {
      choice.folds = static_cast<int>(value);
      return "";
    }
  }
  return "\"" + text +
         "\" is neither a number of folds (2 or more), nor a fraction of the stations (0.001 to 0.5), nor `one` (each "
         "station alone), nor `none`";
}

std::string read_temperature_order(const std::string& text, int& order) {
  order = kAutomaticOrder;
  if (text == "auto") return "";
  if (text.size() == 1 && text[0] >= '0' && text[0] <= '0' + kMaxTemperatureOrder) {
    order = text[0] - '0';
    return "";
  }
  return "\"" + text + "\" is neither `auto` nor an order from 0 to 3";
}

std::string read_use_range(const std::string& text, ChebyshevSpan& use_degc) {
  const std::size_t comma = text.find(',');
  ChebyshevSpan read;
  const std::size_t second = comma == std::string::npos ? comma : text.find_first_not_of(' ', comma + 1);
  if (second == std::string::npos || !number(text, 0, comma, read.lowest) ||
      !number(text, second, text.size(), read.highest)) {
    return "\"" + text + "\" is not two temperatures in degC: write for example 20,150";
  }
  if (read.lowest < kPlausibleMin_degc || read.highest > kPlausibleMax_degc) {
    return fmt::format("\"{}\" exceeds {:g} to {:g} degC, the range of accelerometers: give it in degC", text,
                       kPlausibleMin_degc, kPlausibleMax_degc);
  }
  if (!(read.lowest < read.highest))
    return "\"" + text + "\" is in descending order: write the lower temperature first";
  if (!(read.highest - read.lowest >= kLevelsApart_degc))
    return fmt::format("\"{}\" must span {:g} degC or more", text, kLevelsApart_degc);
  use_degc = read;
  return "";
}

}  // namespace session
}  // namespace PLUMB_ABI
}  // namespace plumb
