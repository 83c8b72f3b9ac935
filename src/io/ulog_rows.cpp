#include "ulog_rows.hpp"

#include <algorithm>
#include <cstring>
#include <utility>

#include "plumb/io/hash.hpp"
#include "plumb/scenario/count_text.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace io {
namespace {

std::string_view text_of(const unsigned char* bytes, std::size_t count) noexcept {
  return {reinterpret_cast<const char*>(bytes), count};
}

tl::unexpected<FileError> refuse(const std::string& path, const std::string& what, const std::string& remedy) {
  return tl::unexpected<FileError>(FileError{path, 0, "header", what, remedy});
}

tl::unexpected<FileError> short_header(const std::string& path) {
  return refuse(path, "the log ends within its header", "copy the file again: the copy is incomplete");
}

/// That the log begins as all of plumb's do. No more is asked for than one of another program may have.
FileExpected<void> check_beginning(LineSource& source, const std::string& path) {
  const std::string begin = ulog_beginning();
  for (std::size_t k = 1; k <= begin.size(); ++k) {
    const unsigned char* const at = source.peek(k);
    if (at == nullptr) return short_header(path);
    if (text_of(at, k) == std::string_view(begin).substr(0, k)) continue;
    return refuse(path, "is a ULog that plumb did not write, as flight controllers (PX4) write them",
                  "make an array file and a CSV of it first: plumb import LOG --out DIR");
  }
  return {};
}

/// How many bytes come before the first block. Each message is looked at for its size, then for what it is.
FileExpected<std::size_t> header_size(LineSource& source, const std::string& path) {
  std::size_t at = ulog_beginning().size();
  for (;;) {
    const unsigned char* bytes = source.peek(at + kUlogMessageHeader);
    if (bytes == nullptr) return short_header(path);
    const std::size_t size = kUlogMessageHeader + u16_at(bytes + at);
    if (at + size > kUlogLongestHeader) {
      return refuse(path, "is longer than " + std::to_string(kUlogLongestHeader) + " bytes: the header is damaged",
                    "copy the file again, or write it anew (plumb convert)");
    }
    bytes = source.peek(at + size);
    if (bytes == nullptr) return short_header(path);
    at += size;
    if (ulog_ends_definitions(text_of(bytes + at - size, size))) return at + ulog_subscriptions().size();
  }
}

}  // namespace

UlogRows::UlogRows(LineSource& source, UlogHeader header, std::string header_bytes)
    : source_(&source),
      header_(std::move(header)),
      header_bytes_(std::move(header_bytes)),
      numbers_(header_.numbers()),
      row_bytes_(header_.row_bytes()),
      row_head_(ulog_row_head(numbers_)),
      block_head_(ulog_block_head()),
      offset_(header_bytes_.size()) {}

FileExpected<UlogRows> UlogRows::open(LineSource& source, const std::string& path) {
  if (const FileExpected<void> ours = check_beginning(source, path); !ours)
    return tl::unexpected<FileError>(ours.error());
  const FileExpected<std::size_t> size = header_size(source, path);
  if (!size) return tl::unexpected<FileError>(size.error());
  const unsigned char* const at = source.peek(*size);
  if (at == nullptr) return short_header(path);
  FileExpected<UlogHeader> header = ulog_header_of(text_of(at, *size), path);
  if (!header) return tl::unexpected<FileError>(header.error());
  std::string bytes(text_of(at, *size));
  source.skip(*size);
  return UlogRows(source, *std::move(header), std::move(bytes));
}

void UlogRows::map(const std::string& path) { mapped_ = map_.open(path); }

void UlogRows::hash_bytes() {
  hashing_ = true;
  hash_ = fnv1a(header_bytes_.data(), header_bytes_.size());
}

/// Null where there are no more that many bytes.
const unsigned char* UlogRows::peek(std::size_t count) {
  return mapped_ ? map_.at(offset_, count) : source_->peek(count);
}

void UlogRows::consume(const unsigned char* bytes, std::size_t count) {
  if (hashing_) hash_ = fnv1a(bytes, count, hash_);
  if (!mapped_) source_->skip(count);
  offset_ += count;
}

UlogRows::Status UlogRows::lose(std::string what) {
  what_ = std::move(what) + "; " + count_text(row_number_, "row") + (row_number_ == 1 ? " comes" : " come") + " before";
  ended_ = true;
  return Status::lost;
}

UlogRows::Status UlogRows::cut_short(std::size_t wanted) {
  if (source_->stopped()) return Status::end;
  if (!mapped_ && source_->error_number() != 0) return Status::failed;
  return lose("the log is cut off: a block begins at byte " + std::to_string(offset_) + " that is " +
              std::to_string(wanted) + " bytes long or more, and the file ends before");
}

UlogRows::Status UlogRows::end_mark(const unsigned char* at, const UlogBlock& block) {
  if (block.crc != crc32_of(at, kUlogBlockSum))
    return lose("the check sum of the end mark at byte " + std::to_string(offset_) + " is wrong");
  if (block.first_row != row_number_) {
    return lose("the end mark at byte " + std::to_string(offset_) + " states " + count_text(block.first_row, "row") +
                ", but the log has " + std::to_string(row_number_));
  }
  consume(at, kUlogBlockSize);
  if (!source_->following() && peek(1) != nullptr) {
    return lose("bytes follow the end mark at byte " + std::to_string(offset_ - kUlogBlockSize) +
                "; the file may hold two logs");
  }
  ended_ = true;
  return Status::end;
}

UlogRows::Status UlogRows::damage(const unsigned char* at, std::size_t size, std::uint32_t rows, const char* what) {
  what_ = std::string(what) + " of the block at byte " + std::to_string(offset_) + " is wrong (rows " +
          std::to_string(row_number_ + 1) + " to " + std::to_string(row_number_ + rows) + ")";
  rows_lost_ = rows;
  row_number_ += rows;
  consume(at, size);
  return Status::damaged;
}

/// That each is the message which its place says it is: other tools go by that.
bool UlogRows::are_rows(const unsigned char* at, std::uint32_t rows) const noexcept {
  bool sound = true;
  for (; rows > 0; --rows, at += row_bytes_) sound = sound && std::memcmp(at, row_head_.data(), kUlogDataHead) == 0;
  return sound;
}

UlogRows::Status UlogRows::next_block() {
  if (ended_ || source_->stopped()) return Status::end;
  const unsigned char* at = peek(kUlogBlockSize);
  if (at == nullptr) return cut_short(kUlogBlockSize);
  if (text_of(at, kUlogDataHead) != block_head_)
    return lose("no block begins at byte " + std::to_string(offset_) + ", where one must");
  const UlogBlock block = ulog_block(at);
  if (block.rows == 0) return end_mark(at, block);
  if (block.rows > header_.block_rows) {
    return lose("the block at byte " + std::to_string(offset_) + " states " + count_text(block.rows, "row") +
                ", but the header allows " + std::to_string(header_.block_rows));
  }
  const std::size_t size = kUlogBlockSize + block.rows * row_bytes_;
  at = peek(size);
  if (at == nullptr) return cut_short(size);
  const unsigned char* const rows = at + kUlogBlockSize;
  if (block.crc != crc32_of(rows, size - kUlogBlockSize, crc32_of(at, kUlogBlockSum)))
    return damage(at, size, block.rows, "the check sum");
  if (block.first_row != row_number_) {
    return lose("the block at byte " + std::to_string(offset_) + " begins with row " +
                std::to_string(block.first_row + 1) + ", row " + std::to_string(row_number_ + 1) + " is expected");
  }
  if (!are_rows(rows, block.rows)) return damage(at, size, block.rows, "a message");
  consume(at, size);
  row_ = rows;
  left_ = block.rows - 1;
  ++row_number_;
  present_ = u64_at(row_ + kUlogRowMarks);
  return Status::row;
}

}  // namespace io
}  // namespace PLUMB_ABI
}  // namespace plumb
