#include "plog_rows.hpp"

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

FileError short_header(const std::string& path) {
  return FileError{path, 0, "header", "the log ends within its header", "copy the file again: the copy is incomplete"};
}

}  // namespace

PlogRows::PlogRows(LineSource& source, PlogHeader header, std::string header_bytes)
    : source_(&source),
      header_(std::move(header)),
      header_bytes_(std::move(header_bytes)),
      numbers_(header_.numbers()),
      row_bytes_(header_.row_bytes()),
      offset_(header_bytes_.size()) {}

FileExpected<PlogRows> PlogRows::open(LineSource& source, const std::string& path) {
  const unsigned char* at = source.peek(kPlogFixedSize);
  if (at == nullptr) return tl::unexpected<FileError>(short_header(path));
  const FileExpected<std::size_t> size = plog_header_size(text_of(at, kPlogFixedSize), path);
  if (!size) return tl::unexpected<FileError>(size.error());
  at = source.peek(*size);
  if (at == nullptr) return tl::unexpected<FileError>(short_header(path));
  FileExpected<PlogHeader> header = plog_header_of(text_of(at, *size), path);
  if (!header) return tl::unexpected<FileError>(header.error());
  std::string bytes(text_of(at, *size));
  source.skip(*size);
  return PlogRows(source, *std::move(header), std::move(bytes));
}

void PlogRows::map(const std::string& path) { mapped_ = map_.open(path); }

void PlogRows::hash_bytes() {
  hashing_ = true;
  hash_ = fnv1a(header_bytes_.data(), header_bytes_.size());
}

/// Null where there are no more that many bytes.
const unsigned char* PlogRows::peek(std::size_t count) {
  return mapped_ ? map_.at(offset_, count) : source_->peek(count);
}

void PlogRows::consume(const unsigned char* bytes, std::size_t count) {
  if (hashing_) hash_ = fnv1a(bytes, count, hash_);
  if (!mapped_) source_->skip(count);
  offset_ += count;
}

PlogRows::Status PlogRows::lose(std::string what) {
  what_ = std::move(what);
  ended_ = true;
  return Status::lost;
}

PlogRows::Status PlogRows::cut_short(std::size_t wanted) {
  if (source_->stopped()) return Status::end;
  if (!mapped_ && source_->error_number() != 0) return Status::failed;
  return lose("the log is cut off: a block begins at byte " + std::to_string(offset_) + " that is " +
              std::to_string(wanted) + " bytes long or more, and the file ends before");
}

PlogRows::Status PlogRows::end_mark(const unsigned char* at) {
  const PlogBlockHead head = plog_block_head(at);
  if (head.crc != crc32_of(at + 4, kPlogBlockHead - 4)) {
    return lose("the check sum of the end mark at byte " + std::to_string(offset_) + " is wrong");
  }
  if (head.first_row != row_number_) {
    return lose("the end mark states " + count_text(head.first_row, "row") + ", but the log has " +
                std::to_string(row_number_));
  }
  consume(at, kPlogBlockHead);
  if (!source_->following() && peek(1) != nullptr) {
    return lose("bytes follow the end mark at byte " + std::to_string(offset_ - kPlogBlockHead) +
                "; the file may hold two logs");
  }
  ended_ = true;
  return Status::end;
}

PlogRows::Status PlogRows::next_block() {
  if (ended_ || source_->stopped()) return Status::end;
  const unsigned char* at = peek(kPlogBlockHead);
  if (at == nullptr) return cut_short(kPlogBlockHead);
  const PlogBlockHead head = plog_block_head(at);
  if (head.rows == 0) return end_mark(at);
  if (head.rows > header_.block_rows) {
    return lose("the block at byte " + std::to_string(offset_) + " states " + count_text(head.rows, "row") +
                ", but the header allows " + std::to_string(header_.block_rows));
  }
  const std::size_t size = kPlogBlockHead + head.rows * row_bytes_;
  at = peek(size);
  if (at == nullptr) return cut_short(size);
  if (head.crc != crc32_of(at + 4, size - 4)) {
    what_ = "the check sum of the block at byte " + std::to_string(offset_) + " is wrong (rows " +
            std::to_string(row_number_ + 1) + " to " + std::to_string(row_number_ + head.rows) + ")";
    rows_lost_ = head.rows;
    row_number_ += head.rows;
    consume(at, size);
    return Status::damaged;
  }
  if (head.first_row != row_number_) {
    return lose("the block at byte " + std::to_string(offset_) + " begins with row " +
                std::to_string(head.first_row + 1) + ", row " + std::to_string(row_number_ + 1) + " is expected");
  }
  consume(at, size);
  row_ = at + kPlogBlockHead;
  left_ = head.rows - 1;
  ++row_number_;
  present_ = u64_at(row_);
  return Status::row;
}

}  // namespace io
}  // namespace PLUMB_ABI
}  // namespace plumb
