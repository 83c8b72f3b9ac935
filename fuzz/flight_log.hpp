/// A log of a flight controller read to its end, with what holds of all that is told.
#pragma once

#include <cmath>
#include <string>

#include "files.hpp"
#include "plumb/logs/flight_log.hpp"

namespace fuzz {

/// Demands what `plumb::logs::LogSink` promises whoever listens.
class Listener final : public plumb::logs::LogSink {
 public:
  explicit Listener(std::size_t size) : size_(size) {}

  void source(std::size_t number, const plumb::logs::ImuSource& source) override {
    demand(number == sources_, "sources are numbered as they come");
    demand(!source.name.empty(), "a source has a name");
    ++sources_;
  }
  void record(std::size_t number, const plumb::logs::ImuRecord& record) override {
    demand(number < sources_, "a source comes before its records");
    for (const double x : record.specific_force_mps2) demand(!std::isinf(x), "a specific force is a number, or absent");
    ++records_;
  }
  void parameter(const std::string& name, double) override { demand(!name.empty(), "a parameter has a name"); }
  void note(std::uint64_t offset, const std::string& what) override {
    demand(offset <= size_, "a note is on a place in the log");
    demand(!what.empty() && what.size() < 4000, "a note can be read");
    // io::printable_line leaves the tab alone.
    for (const char c : what)
      demand(static_cast<unsigned char>(c) >= 0x20 || c == '\t', "a note has no control characters");
    demand(++notes_ < 400, "notes are few");
  }

  void judge(const plumb::io::FileExpected<plumb::logs::LogExtent>& extent) const {
    if (!extent) {
      demand_told(extent.error());
      return;
    }
    demand(extent->bytes == size_ && extent->read_bytes <= extent->bytes, "the extent is that of the log");
    demand(extent->records == records_, "the records are counted");
  }

 private:
  std::size_t size_;
  std::size_t sources_ = 0;
  std::uint64_t records_ = 0;
  int notes_ = 0;
};

}  // namespace fuzz
