#include "trace.hpp"

#include <fmt/format.h>

#include <cmath>
#include <fstream>
#include <sstream>

#include "plumb/io/hash.hpp"

namespace plumb_replay {

const char* to_string(Part part) noexcept {
  constexpr const char* kNames[] = {"inputs", "answers", "verdicts", "events", "snapshots"};
  return kNames[static_cast<std::size_t>(part)];
}

bool Words::read(const std::string& path) {
  std::ifstream in(path);
  if (!in) return false;
  for (std::string line; std::getline(in, line);) {
    std::istringstream fields(line);
    std::string before, after;
    if (fields >> before >> after && before[0] != '#') new_of_[before] = after;
  }
  return true;
}

std::string Words::renamed(const char* word) const {
  const auto found = new_of_.find(word);
  return found == new_of_.end() ? word : found->second;
}

Trace::Trace(const Words& words, std::FILE* text) : words_(words), text_(text) {
  for (Lane& lane : lane_) lane.hash = plumb::io::kFnvStart;
}

void Trace::flush(Lane& lane) {
  lane.hash = plumb::io::fnv1a(lane.figures.data(), lane.waiting * sizeof(lane.figures[0]), lane.hash);
  lane.waiting = 0;
}

std::uint64_t Trace::digest(Part part) {
  Lane& lane = lane_[static_cast<std::size_t>(part)];
  flush(lane);
  return lane.hash;
}

std::uint64_t Trace::hash_of(const char* word) {
  const auto [at, is_new] = hashes_.try_emplace(word, 0);
  if (is_new) {
    const std::string name = words_.renamed(word);
    at->second = plumb::io::fnv1a(name.data(), name.size());
  }
  return at->second;
}

void Trace::bytes(const char* label, const std::uint8_t* bytes, std::size_t size) {
  put(size);
  const std::uint64_t hash = plumb::io::fnv1a(bytes, size);
  put(hash);
  if (text_ != nullptr) tell(label, -1, fmt::format("{} bytes {:016x}", size, hash));
}

/// The shortest text that reads back as the same number; of what is none, the bits.
std::string Trace::text_of(double value) {
  if (!std::isnan(value)) return fmt::format("{}", value);
  std::uint64_t bits = 0;
  std::memcpy(&bits, &value, sizeof bits);
  return fmt::format("nan:{:016x}", bits);
}

void Trace::tell(const char* label, int index, const std::string& value) {
  const char* part = to_string(static_cast<Part>(part_));
  const std::string name = index < 0 ? fmt::format("{} {}", part, label) : fmt::format("{} {}[{}]", part, label, index);
  std::string& last = last_[name];
  if (last == value) return;
  last = value;
  fmt::print(text_, "row {} t {} {} {}\n", row_, time_s_, name, value);
}

}  // namespace plumb_replay
