#include "figures.hpp"

#include <cmath>

#include "plumb/io/json_fields.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace cli {

Json finite_or_null(double value) { return std::isfinite(value) ? Json(value) : Json(); }

}  // namespace cli
}  // namespace PLUMB_ABI
}  // namespace plumb
