// What a case of the corpus came to: five digests, and on request every figure as text. Plain numbers and words, so
// that the players of several capacities tell into one trace.
#pragma once

#include <array>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <map>
#include <string>
#include <unordered_map>
#include <vector>

namespace plumb_replay {

/// What is told, and compared apart from the rest.
enum class Part : std::uint8_t {
  inputs,     ///< setups and samples: what the monitor was given. Where they differ, the corpus has changed
  answers,    ///< what the host asked for, and what it was answered
  verdicts,   ///< every field of the verdict at every sample
  events,     ///< transition records
  snapshots,  ///< bytes, header and check sum left out: comparable as long as their format is the same
};
inline constexpr int kParts = 5;
const char* to_string(Part part) noexcept;

/// Words that another commit calls otherwise. A word is digested by its new name, never by its number: an enumeration
/// may be put in another order, and its words renamed, as long as the list says so.
class Words {
 public:
  /// A file of lines "old new"; empty lines and those that begin with # count for nothing. False where it cannot be
  /// read.
  bool read(const std::string& path);
  std::string renamed(const char* word) const;

 private:
  std::map<std::string, std::string> new_of_;
};

class Trace {
 public:
  /// `text`: where every figure goes that is not what it was before; null for digests alone.
  Trace(const Words& words, std::FILE* text);

  /// What is told from here on belongs to that part.
  void in(Part part) noexcept { part_ = static_cast<std::size_t>(part); }
  /// What is told from here on belongs to that sample; for the text.
  void at(std::uint64_t row, double time_s) noexcept {
    row_ = row;
    time_s_ = time_s;
  }

  // The label names a figure in the text and stays as it is when the field in the code is renamed. `index` < 0: no
  // array.
  void number(const char* label, double value, int index = -1) {
    std::uint64_t bits = 0;
    std::memcpy(&bits, &value, sizeof bits);
    put(bits);
    if (text_ != nullptr) tell(label, index, text_of(value));
  }
  void integer(const char* label, std::uint64_t value, int index = -1) {
    put(value);
    if (text_ != nullptr) tell(label, index, std::to_string(value));
  }
  void word(const char* label, const char* value, int index = -1) {
    put(hash_of(value));
    if (text_ != nullptr) tell(label, index, words_.renamed(value));
  }
  template <class List>
  void numbers(const char* label, const List& values, int count) {
    for (int i = 0; i < count; ++i) number(label, static_cast<double>(values[static_cast<std::size_t>(i)]), i);
  }
  void bytes(const char* label, const std::uint8_t* bytes, std::size_t size);

  std::uint64_t digest(Part part);
  /// Figures told so far.
  std::uint64_t told(Part part) const noexcept { return lane_[static_cast<std::size_t>(part)].told; }

 private:
  struct Lane {
    std::uint64_t hash = 0;
    std::uint64_t told = 0;
    std::size_t waiting = 0;
    std::array<std::uint64_t, 256> figures{};
  };
  void put(std::uint64_t figure) {
    Lane& lane = lane_[part_];
    lane.figures[lane.waiting++] = figure;
    ++lane.told;
    if (lane.waiting == lane.figures.size()) flush(lane);
  }
  static void flush(Lane& lane);
  std::uint64_t hash_of(const char* word);
  static std::string text_of(double value);
  void tell(const char* label, int index, const std::string& value);

  const Words& words_;
  std::FILE* text_;
  std::size_t part_ = 0;
  std::uint64_t row_ = 0;
  double time_s_ = 0.0;
  std::array<Lane, kParts> lane_{};
  std::unordered_map<const char*, std::uint64_t> hashes_;  ///< by address: the words are literals
  std::map<std::string, std::string> last_;                ///< of the text, by part and label
};

}  // namespace plumb_replay
