/// The check sum of zlib, which is all that plumb takes of libdeflate, by Boost.CRC: among Debian's packages there is
/// no libdeflate for WebAssembly.
#pragma once

#include <boost/crc.hpp>
#include <cstddef>
#include <cstdint>

/// `before`: of the bytes that came before, 0 at first.
inline std::uint32_t libdeflate_crc32(std::uint32_t before, const void* data, std::size_t size) {
  constexpr std::uint32_t kPolynomial = 0x04C11DB7;
  // Boost takes the remainder before its bits are reflected.
  std::uint32_t start = 0;
  for (unsigned k = 0; k < 32; ++k) start |= ((~before >> k) & 1U) << (31U - k);
  boost::crc_optimal<32, kPolynomial, 0xFFFFFFFF, 0xFFFFFFFF, true, true> crc(start);
  crc.process_bytes(data, size);
  return crc.checksum();
}
