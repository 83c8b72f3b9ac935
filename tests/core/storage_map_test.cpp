#include "plumb/core/detail/storage_map.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cstddef>
#include <cstring>
#include <memory>
#include <vector>

#include "plumb/health/health_monitor.hpp"

namespace plumb {
namespace storage_map_test {
namespace {

/// A member of every size, padding in the middle of a word and at its end, words without a member.
struct Small {
  std::uint8_t byte = 1;
  std::uint32_t word = 2;
  std::uint16_t half = 3;
  double number = 4.0;
  std::array<std::uint64_t, 11> many{};
  std::array<std::uint64_t, 2> left_out{};
  std::array<std::uint8_t, 3> three{};
  double last = 5.0;

  static constexpr auto changing() noexcept { return field_list(&Small::left_out); }
  static constexpr auto fields() noexcept {
    using S = Small;
    return field_list(&S::byte, &S::word, &S::half, &S::number, &S::many, &S::left_out, &S::three, &S::last);
  }
};

/// Whether byte by byte the runs of a part say that it is a member.
template <class T, StoragePart kPart>
std::vector<bool> members() {
  std::vector<bool> out(sizeof(T));
  for (const auto& run : kStorageRuns<T, kPart>) {
    for (std::size_t k = 0; k < run.size; ++k) out[run.first + k] = true;
  }
  return out;
}

/// The sum by words, which a 32-bit target makes, changes with every bit of every member and with no other.
template <class T, StoragePart kPart>
void every_bit_of_a_member_counts(unsigned char fill) {
  struct alignas(8) Bytes {
    std::array<unsigned char, sizeof(T)> at;
  };
  auto bytes = std::make_unique<Bytes>();
  bytes->at.fill(fill);
  const std::uint64_t before = sum_of_words(bytes->at.data(), kStoragePlan<T, kPart>);
  const std::vector<bool> is_member = members<T, kPart>();
  for (std::size_t k = 0; k < sizeof(T); ++k) {
    for (unsigned bit = 0; bit < 8; ++bit) {
      bytes->at[k] = static_cast<unsigned char>(fill ^ (1U << bit));
      const bool changed = sum_of_words(bytes->at.data(), kStoragePlan<T, kPart>) != before;
      ASSERT_EQ(changed, is_member[k]) << "byte " << k << " bit " << bit;
    }
    bytes->at[k] = fill;
  }
}

TEST(StorageMap, TheSumByWordsChangesWithEveryBitOfAMemberAndWithNoPadding) {
  for (const std::uint8_t fill : {std::uint8_t{0x00}, std::uint8_t{0xFF}, std::uint8_t{0x5A}}) {
    every_bit_of_a_member_counts<Small, StoragePart::steady>(fill);
    every_bit_of_a_member_counts<SensorArray, StoragePart::steady>(fill);
  }
}

TEST(StorageMap, TheWordsOfAMonitorAreTheBytesOfItsRuns) {
  const StoragePlan& plan = kStoragePlan<HealthMonitor, StoragePart::steady>;
  std::vector<bool> covered(sizeof(HealthMonitor));
  const auto cover = [&covered](std::size_t at) {
    EXPECT_FALSE(covered[at]) << "byte " << at << " is in it twice";
    covered[at] = true;
  };
  for (std::size_t k = 0; k < plan.stretches; ++k) {
    for (std::size_t byte = 0; byte < 8U * plan.stretch[k].count; ++byte) cover(8U * plan.stretch[k].first + byte);
  }
  const std::uint16_t* word = plan.word;
  for (std::size_t k = 0; k < plan.groups; ++k) {
    for (unsigned left = plan.group[k].count; left != 0; --left, ++word) {
      for (unsigned byte = 0; byte < 8; ++byte) {
        if ((plan.group[k].bytes >> byte & 1U) != 0) cover(8U * *word + byte);
      }
    }
  }
  EXPECT_EQ(covered, (members<HealthMonitor, StoragePart::steady>()));
}

TEST(StorageMap, WhateverChangesWithinOneWordChangesTheSumByWords) {
  alignas(8) std::array<unsigned char, sizeof(Small)> bytes{};
  const auto sum = [&bytes] { return sum_of_words(bytes.data(), kStoragePlan<Small, StoragePart::steady>); };
  const std::uint64_t before = sum();
  // Up in one half and down in the other, and what a carry between the halves would make of it.
  for (const std::uint64_t value : {0x0000'0001'0000'0000ULL, 0x0000'0000'FFFF'FFFFULL, 0x0000'0001'FFFF'FFFFULL,
                                    0xFFFF'FFFF'0000'0001ULL, 0xFFFF'FFFF'FFFF'FFFFULL, 0x8000'0000'8000'0000ULL}) {
    std::memcpy(&bytes[offsetof(Small, many) + 8], &value, sizeof value);
    EXPECT_NE(sum(), before) << value;
  }
}

}  // namespace
}  // namespace storage_map_test
}  // namespace plumb
