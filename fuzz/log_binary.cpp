// Any bytes as a binary log of the paper's tool, mapped and through a pipe, under both policies for bad rows. Half of
// the inputs get true check sums first, so that what lies behind them is reached too.
#include <unistd.h>

#include <algorithm>
#include <cstring>
#include <vector>

#include "../src/io/plog_format.hpp"
#include "log_reading.hpp"

namespace {

using namespace plumb;

void put_crc(std::vector<std::uint8_t>& log, std::size_t at, std::size_t begin, std::size_t end) {
  std::string crc;
  io::put_u32(crc, io::crc32_of(log.data() + begin, end - begin));
  std::memcpy(log.data() + at, crc.data(), crc.size());
}

/// True check sums wherever the header and the heads of the blocks say that there are some.
void mend(std::vector<std::uint8_t>& log) {
  if (log.size() < io::kPlogFixedSize) return;
  const std::size_t header = io::u32_at(log.data() + 16);
  if (header < io::kPlogFixedSize + 4 || header > log.size()) return;
  put_crc(log, header - 4, 0, header - 4);
  const std::string text(log.begin(), log.begin() + static_cast<std::ptrdiff_t>(header));
  const auto read = io::plog_header_of(text, "");
  if (!read) return;
  for (std::size_t at = header; log.size() - at >= io::kPlogBlockHead;) {
    const std::size_t rows = io::u32_at(log.data() + at + 4);
    const std::size_t size = io::kPlogBlockHead + rows * read->row_bytes();
    if (size > log.size() - at) return;
    put_crc(log, at, at + 4, at + size);
    at += size;
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::vector<std::uint8_t> log(data, data + size);
  if (size % 2 == 0) mend(log);
  const fuzz::MemoryFile file(log.data(), log.size());
  fuzz::read_under(file.path(), io::BadRowPolicy::skip);
  const fuzz::Outcome mapped = fuzz::read_under(file.path(), io::BadRowPolicy::stop);
  int ends[2];
  fuzz::demand(pipe(ends) == 0, "a pipe");
  if (log.size() < 60000) {  // what a pipe holds without a reader
    fuzz::demand(write(ends[1], log.data(), log.size()) == static_cast<ssize_t>(log.size()), "the pipe takes it");
    close(ends[1]);
    const fuzz::Outcome piped = fuzz::read_under("/proc/self/fd/" + std::to_string(ends[0]), io::BadRowPolicy::stop);
    fuzz::demand(piped.rows == mapped.rows && piped.rows_bad == mapped.rows_bad && piped.hash == mapped.hash,
                 "a pipe gives what a file gives");
  } else {
    close(ends[1]);
  }
  close(ends[0]);
  return 0;
}
