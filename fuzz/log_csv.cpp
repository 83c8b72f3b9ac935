// Any bytes as a log of the paper's tool, under both policies for bad rows: what is delivered is in order and finite
// where it must be, what is not is counted and named.
#include "files.hpp"
#include "plumb/io/log_reader.hpp"

namespace {

void read_under(const std::string& path, plumb::io::BadRowPolicy policy) {
  using namespace plumb;
  auto log = io::LogReader::open(path, fuzz::paper_tool(), policy);
  if (!log) {
    fuzz::demand_told(log.error());
    return;
  }
  Sample s;
  bool first = true;
  double last_s = 0.0;
  std::uint64_t rows = 0;
  for (;;) {
    const io::LogReader::Next next = log->next(s);
    if (next == io::LogReader::Next::end) break;
    if (next == io::LogReader::Next::error) {
      fuzz::demand_told(log->error());
      break;
    }
    fuzz::demand(s.time_s - s.time_s == 0.0 && (first || s.time_s > last_s), "time is finite and increases");
    fuzz::demand((s.delivered - fuzz::paper_tool().array.all()).empty(), "only sensors that there are");
    fuzz::demand(s.temperature_degc - s.temperature_degc == 0.0, "a temperature that can be used");
    first = false;
    last_s = s.time_s;
    ++rows;
  }
  fuzz::demand(log->statistics().rows == rows, "rows are counted");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const fuzz::MemoryFile file(data, size);
  read_under(file.path(), plumb::io::BadRowPolicy::stop);
  read_under(file.path(), plumb::io::BadRowPolicy::skip);
  return 0;
}
