#include "tool.hpp"

#include <sys/utsname.h>
#include <unistd.h>

#include <ctime>
#include <fstream>

namespace plumb {
inline namespace PLUMB_ABI {
namespace cli {

std::string now_utc() {
  const std::time_t now = std::time(nullptr);
  std::tm parts{};
  gmtime_r(&now, &parts);
  char text[32] = {};
  std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", &parts);
  return text;
}

std::string host_name() {
  char text[256] = {};
  return ::gethostname(text, sizeof text - 1) == 0 ? text : "unknown";
}

std::string machine_name() {
  utsname system{};
  std::string out = ::uname(&system) == 0 ? std::string(system.machine) + ", " + system.sysname + " " + system.release
                                          : std::string("unknown");
  std::ifstream processors("/proc/cpuinfo");
  std::string line;
  while (std::getline(processors, line)) {
    const std::size_t colon = line.find(": ");
    if (line.rfind("model name", 0) == 0 && colon != std::string::npos) return line.substr(colon + 2) + ", " + out;
  }
  return out;
}

}  // namespace cli
}  // namespace PLUMB_ABI
}  // namespace plumb
