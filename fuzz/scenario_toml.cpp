// Any text as a scenario file: refused in words, or written and read back as the same scenario.
#include "files.hpp"
#include "plumb/io/scenario_file.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace plumb;
  const auto read = io::parse_scenario_text(std::string(reinterpret_cast<const char*>(data), size),
                                            PLUMB_SOURCE_DIR "/examples/fuzzed.toml");
  if (!read) fuzz::demand_told(read.error());
  return 0;
}
