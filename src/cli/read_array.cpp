#include "read_array.hpp"

#include <fmt/format.h>

#include "plumb/geomagnetic/field_reference.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace cli {

io::FileExpected<io::ArrayFile> read_array(const std::string& path, const char* command, Serves serves) {
  io::FileExpected<io::ArrayFile> array = io::read_array_file(path, geomagnetic::lookup);
  if (!array) return array;
  const io::FieldKind field = array->field;
  const bool served = serves == Serves::all || field == io::FieldKind::gravity ||
                      (serves == Serves::lengths && field == io::FieldKind::magnetic);
  if (served) return array;
  const bool rate = field == io::FieldKind::rate;
  return tl::unexpected<io::FileError>(io::FileError{
      path, 0, "", fmt::format("{} does not serve a group of {}s", command, io::units_of(field).sensor),
      serves == Serves::lengths && rate
          ? "a rate has no length that a calibration could go by: plumb monitor watches gyros, plumb noise studies them"
          : "name the array file alone, without #" + array->group + ", for its accelerometers",
      io::ExitCode::usage});
}

}  // namespace cli
}  // namespace PLUMB_ABI
}  // namespace plumb
