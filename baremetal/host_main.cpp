// The replay on the host: metal_host RECORDING EXACT FIGURES
#include <cstdio>
#include <fstream>
#include <iterator>
#include <vector>

#include "replay.hpp"

namespace {

constexpr std::size_t kRoom = std::size_t{1} << 20U;  // words

bool write(const char* path, const std::vector<std::uint64_t>& words, const metal::WordWriter& writer) {
  std::ofstream out(path, std::ios::binary);
  out.write(reinterpret_cast<const char*>(words.data()), static_cast<std::streamsize>(writer.used() * 8));
  out.close();
  return static_cast<bool>(out);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 4) {
    std::fputs("usage: metal_host RECORDING EXACT FIGURES\n", stderr);
    return 2;
  }
  std::ifstream in(argv[1], std::ios::binary);
  const std::vector<char> bytes((std::istreambuf_iterator<char>(in)), std::istreambuf_iterator<char>());
  std::vector<std::uint64_t> recording(bytes.size() / 8);  // the first says how many follow
  if (recording.empty()) {
    std::fprintf(stderr, "%s: not read, or empty\n", argv[1]);
    return 2;
  }
  std::memcpy(recording.data(), bytes.data(), recording.size() * 8);
  std::vector<std::uint64_t> exact(kRoom), figures(kRoom);
  metal::Answers answers = {{exact.data(), kRoom}, {figures.data(), kRoom}};
  const int wrong = metal::replay(recording.data() + 1, recording.size() - 1, answers, nullptr, nullptr);
  if (wrong != 0) {
    std::fprintf(stderr, "the replay ended with %d\n", wrong);
    return 1;
  }
  const bool written = write(argv[2], exact, answers.exact) && write(argv[3], figures, answers.figures);
  return written ? 0 : 1;
}
