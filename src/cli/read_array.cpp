#include "read_array.hpp"

#include <fmt/format.h>

#include <filesystem>

#include "plumb/geomagnetic/field_reference.hpp"
#include "plumb/io/file_error.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace cli {

std::string array_file_of(const std::string& path) {
  const std::size_t mark = path.rfind('#');
  return mark == std::string::npos || std::filesystem::exists(path) ? path : path.substr(0, mark);
}

std::string columns_left_out(const io::ArrayFile& array, const std::string& out) {
  if (array.groups.empty() && array.group.empty()) return "";
  return "plumb: note: " + out + " holds the columns of " +
         (array.group.empty() ? "the accelerometers" : "group " + array.group) +
         " alone; those of the tool's other groups are left out.\n";
}

io::FileExpected<io::ArrayFile> read_array(const std::string& path, const char* command, Serves serves) {
  io::FileExpected<io::ArrayFile> array = io::read_array_file(path, geomagnetic::lookup);
  if (!array) return array;
  const io::FieldKind field = array->field;
  const bool served = serves == Serves::all || field == io::FieldKind::gravity ||
                      (serves == Serves::lengths && field == io::FieldKind::magnetic);
  if (served) return array;
  const bool rate = field == io::FieldKind::rate, calibrates = std::string(command) == "plumb calibrate";
  return tl::unexpected<io::FileError>(
      io::FileError{path, 0, "",
                    fmt::format("{} does not serve a group of {}s{}", command, io::units_of(field).sensor,
                                rate && calibrates ? " by --log" : ""),
                    !rate || serves == Serves::gravity
                        ? "name the array file alone, without #" + array->group + ", for its accelerometers"
                    : calibrates ? "a rate has no length to calibrate by: give a log in motion, --motion LOG.csv"
                                 : "plumb monitor --array " + array_file_of(path) + " --group " + array->group +
                                       " watches gyros beside the accelerometers",
                    io::ExitCode::usage});
}

io::FileExpected<io::ArrayFile> read_accelerometers(const std::string& path, const char* command, const char* instead) {
  io::FileExpected<io::ArrayFile> array = io::read_array_file(path, geomagnetic::lookup);
  if (!array || array->field == io::FieldKind::gravity) return array;
  return tl::unexpected<io::FileError>(io::FileError{
      path, 0, "", fmt::format("{} does not serve a group of {}s", command, io::units_of(array->field).sensor),
      fmt::format(fmt::runtime(instead), io::shell_word(path)) +
          "; for the accelerometers name the array file without #" + array->group,
      io::ExitCode::usage});
}

}  // namespace cli
}  // namespace PLUMB_ABI
}  // namespace plumb
