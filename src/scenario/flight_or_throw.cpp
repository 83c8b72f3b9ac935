// The one constructor that throws: apart from the rest, which is built without exceptions too (web/).
#include <stdexcept>
#include <utility>

#include "plumb/scenario/flight.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace scenario {
namespace {

Flight flown_or_thrown(const FlightSpec& spec) {
  tl::expected<Flight, std::string> made = Flight::make(spec);
  if (!made) throw std::invalid_argument(made.error());
  return *std::move(made);
}

}  // namespace

Flight::Flight(const FlightSpec& spec) : Flight(flown_or_thrown(spec)) {}

}  // namespace scenario
}  // namespace PLUMB_ABI
}  // namespace plumb
