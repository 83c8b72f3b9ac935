// "bias=5 mg, scale=1000 ppm, axis=0.5 deg".
#include <algorithm>

#include "../io/text_tools.hpp"
#include "plumb/coefficients/coefficient_file.hpp"
#include "plumb/io/units.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace coefficients {
namespace {

constexpr const char* kExample = "write for example --uncertainty \"bias=5 mg, scale=1000 ppm, axis=0.5 deg\", 1 sigma";

tl::unexpected<io::FileError> refuse_uncertainty(const std::string& what, const std::string& remedy = kExample) {
  return tl::unexpected<io::FileError>(io::FileError{"--uncertainty", 0, "", what, remedy, io::ExitCode::usage});
}

struct Key {
  const char* name;
  io::Quantity quantity;
  double most;
  const char* unit;
  std::optional<double> Uncertainty::*value;
};
constexpr Key kKeys[] = {{"bias", io::Quantity::acceleration, kMostSigmaBias_mps2, " m/s^2", &Uncertainty::bias_mps2},
                         {"scale", io::Quantity::ratio, kMostSigmaScale, "", &Uncertainty::scale},
                         {"axis", io::Quantity::angle, kMostSigmaAxis_rad, " rad", &Uncertainty::axis_rad}};

}  // namespace

io::FileExpected<Uncertainty> parse_uncertainty(std::string_view text) {
  Uncertainty out;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    const std::string_view part = io::trimmed(text.substr(begin, end - begin));
    begin = end + 1;
    const std::size_t equals = part.find('=');
    if (equals == std::string_view::npos) return refuse_uncertainty(io::in_quotes(part) + " has no \"=\"");
    const std::string_view name = io::trimmed(part.substr(0, equals));
    const Key* key = nullptr;
    for (const Key& one : kKeys) key = name == one.name ? &one : key;
    if (key == nullptr) return refuse_uncertainty(io::in_quotes(name) + " is none of bias, scale and axis");
    if (out.*key->value) return refuse_uncertainty(std::string(key->name) + " stands there twice");
    const io::FileExpected<double> value = io::parse_quantity(key->quantity, part.substr(equals + 1));
    if (!value) return refuse_uncertainty(std::string(key->name) + ": " + value.error().what, value.error().remedy);
    if (!(*value > 0.0 && *value <= key->most))
      return refuse_uncertainty(
          std::string(key->name) + " is " + io::brief(*value) + key->unit + ", must be above 0 and at most " +
              io::brief(key->most) + key->unit,
          "state 1 sigma of what the coefficients may be off by: nothing is known exactly, and every limit "
          "of a monitor rests on it");
    out.*key->value = *value;
  }
  return out;
}

}  // namespace coefficients
}  // namespace PLUMB_ABI
}  // namespace plumb
