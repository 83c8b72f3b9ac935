#include "unpack.hpp"

#include <lz4frame.h>
#include <zstd.h>

#include <algorithm>
#include <memory>

namespace plumb {
inline namespace PLUMB_ABI {
namespace logs {
namespace {

constexpr std::size_t kFirst = 1U << 16U;
/// Of memory for what zstd may refer back to: 128 MiB, what its own tool allows.
constexpr int kLargestWindowLog = 27;

struct FreeZstd {
  void operator()(ZSTD_DCtx* context) const noexcept { ZSTD_freeDCtx(context); }
};
struct FreeLz4 {
  void operator()(LZ4F_dctx* context) const noexcept { LZ4F_freeDecompressionContext(context); }
};

}  // namespace

/// Until where there is room now; what was unpacked fills it where `most` is reached.
std::size_t Unpacker::room(std::size_t most) {
  if (size_ == out_.size() && size_ < most) out_.resize(std::min(most, std::max(kFirst, 2 * out_.size())));
  return std::min(out_.size(), most);
}

Unpacker::Outcome Unpacker::zstd(const unsigned char* packed, std::size_t size, std::size_t most) {
  const std::unique_ptr<ZSTD_DCtx, FreeZstd> context(ZSTD_createDCtx());
  if (context == nullptr || ZSTD_isError(ZSTD_DCtx_setParameter(context.get(), ZSTD_d_windowLogMax, kLargestWindowLog)))
    return Outcome::failed;
  ZSTD_inBuffer in = {packed, size, 0};
  while (true) {
    const std::size_t end = room(most);
    ZSTD_outBuffer out = {out_.data(), end, size_};
    const std::size_t read_before = in.pos;
    const std::size_t left = ZSTD_decompressStream(context.get(), &out, &in);
    if (ZSTD_isError(left)) return Outcome::damaged;
    const bool stands_still = out.pos == size_ && in.pos == read_before;
    size_ = out.pos;
    if (left == 0 && in.pos == in.size) return Outcome::whole;
    if (!stands_still) continue;
    return size_ < end ? Outcome::cut : Outcome::too_long;
  }
}

Unpacker::Outcome Unpacker::lz4(const unsigned char* packed, std::size_t size, std::size_t most) {
  LZ4F_dctx* made = nullptr;
  if (LZ4F_isError(LZ4F_createDecompressionContext(&made, LZ4F_VERSION))) return Outcome::failed;
  const std::unique_ptr<LZ4F_dctx, FreeLz4> context(made);
  std::size_t at = 0;
  while (true) {
    const std::size_t end = room(most);
    std::size_t wrote = end - size_;
    std::size_t read = size - at;
    const std::size_t left = LZ4F_decompress(context.get(), out_.data() + size_, &wrote, packed + at, &read, nullptr);
    if (LZ4F_isError(left)) return Outcome::damaged;
    size_ += wrote;
    at += read;
    if (left == 0 && at == size) return Outcome::whole;
    if (wrote > 0 || read > 0) continue;
    return size_ < end ? Outcome::cut : Outcome::too_long;
  }
}

Unpacker::Outcome Unpacker::unpack(std::string_view method, const unsigned char* packed, std::size_t size,
                                   std::size_t most) {
  size_ = 0;
  if (method == "zstd") return zstd(packed, size, most);
  if (method == "lz4") return lz4(packed, size, most);
  return Outcome::unknown;
}

}  // namespace logs
}  // namespace PLUMB_ABI
}  // namespace plumb
