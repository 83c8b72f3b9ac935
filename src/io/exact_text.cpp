#include "plumb/io/exact_text.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace io {

std::string exact_text(Quantity quantity, double si, std::initializer_list<const char*> units) {
  std::string best;
  for (const char* unit : units) {
    const FileExpected<std::string> text = format_quantity(quantity, si, unit);
    if (!text) continue;
    const FileExpected<double> back = parse_quantity(quantity, *text);
    if (back && *back == si && (best.empty() || text->size() < best.size())) best = *text;
  }
  return best;
}

}  // namespace io
}  // namespace PLUMB_ABI
}  // namespace plumb
