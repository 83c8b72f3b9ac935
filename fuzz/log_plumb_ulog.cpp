// Any bytes as a ULog that plumb wrote of the paper's tool, mapped and through a pipe, under both policies for bad
// rows. Half of the inputs get true check sums first, so that what lies behind them is reached too.
#include <unistd.h>

#include <algorithm>
#include <cstring>
#include <string>
#include <vector>

#include "../src/io/little_endian.hpp"
#include "../src/io/ulog_header.hpp"
#include "log_reading.hpp"

namespace {

using namespace plumb;

void put_sum(std::string& log, std::size_t at, std::uint32_t sum) {
  std::string bytes;
  io::put_u32(bytes, sum);
  log.replace(at, bytes.size(), bytes);
}

const unsigned char* bytes_at(const std::string& log, std::size_t at) {
  return reinterpret_cast<const unsigned char*>(log.data()) + at;
}

/// Behind the definitions, under a true check sum; 0 where they do not end.
std::size_t mend_header(std::string& log) {
  for (std::size_t at = io::ulog_beginning().size(); at + io::kUlogMessageHeader <= log.size();) {
    const std::size_t size = io::kUlogMessageHeader + io::u16_at(bytes_at(log, at));
    if (size > log.size() - at) return 0;
    if (io::ulog_ends_definitions(std::string_view(log).substr(at, size))) {
      put_sum(log, at + size - 4, io::crc32_of(log.data(), at));
      return at + size + io::ulog_subscriptions().size();
    }
    at += size;
  }
  return 0;
}

/// True check sums wherever the heads of the blocks say that there are some.
void mend(std::string& log) {
  const std::size_t header = mend_header(log);
  if (header == 0 || header > log.size()) return;
  const auto read = io::ulog_header_of(std::string_view(log).substr(0, header), "");
  if (!read) return;
  for (std::size_t at = header; log.size() - at >= io::kUlogBlockSize;) {
    const std::size_t size = io::ulog_block(bytes_at(log, at)).rows * read->row_bytes();
    if (size > log.size() - at - io::kUlogBlockSize) return;
    const std::uint32_t head = io::crc32_of(bytes_at(log, at), io::kUlogBlockSum);
    put_sum(log, at + io::kUlogBlockSum, io::crc32_of(bytes_at(log, at + io::kUlogBlockSize), size, head));
    at += io::kUlogBlockSize + size;
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::string log(data, data + size);
  if (size % 2 == 0) mend(log);
  const fuzz::MemoryFile file(reinterpret_cast<const std::uint8_t*>(log.data()), log.size());
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
