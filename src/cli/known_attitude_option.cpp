#include "known_attitude_option.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace cli {
namespace {

std::string wrong_attitude(const std::string& text) {
  const tl::expected<io::KnownAttitude, std::string> read = io::parse_known_attitude(text);
  return read ? "" : read.error();
}

}  // namespace

void add_known_attitude_option(const Options& command, std::vector<std::string>& list) {
  command
      .add_option("--known-attitude", list,
                  "a station of the calibration log whose inclination and toolface are known, in deg, with the "
                  "tolerance of the direction (5 deg where none is given): it excludes wirings that gravity cannot "
                  "see; may be given several times")
      .check(wrong_attitude)
      .type_name("STATION:INC,TF[,TOL]");
}

void take_known_attitudes(const std::vector<std::string>& list, io::ArrayFile& array) {
  std::vector<io::KnownAttitude> read;
  for (const std::string& text : list) {
    if (const tl::expected<io::KnownAttitude, std::string> one = io::parse_known_attitude(text)) read.push_back(*one);
  }
  io::add_known(read, array.input.known_attitudes);
}

}  // namespace cli
}  // namespace PLUMB_ABI
}  // namespace plumb
