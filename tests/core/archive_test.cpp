#include "plumb/core/detail/archive.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cstring>
#include <limits>
#include <vector>

namespace archive_test {
namespace {

using namespace plumb;

enum class Colour : std::uint8_t { red, green, blue };

struct Inner {
  std::uint16_t small = 0;
  double figure = 0.0;
  static constexpr auto fields() noexcept { return field_list(&Inner::small, &Inner::figure); }
};

class Outer {
 public:
  Outer() = default;
  Outer(bool flag, int number, Colour colour, SensorSet set)
      : flag_(flag), number_(number), colour_(colour), set_(set) {}
  int used() const noexcept { return used_; }
  bool flagged() const noexcept { return flag_; }
  std::uint32_t sum() const noexcept { return sum_; }

  bool flag_ = false;
  int number_ = 0;
  Colour colour_ = Colour::red;
  SensorSet set_;
  std::array<double, kCapacity> each_{};
  int used_ = 0;
  std::array<std::uint32_t, 4> list_{};
  double free_ = 0.0;
  Inner inner_;
  std::uint64_t configured_ = 77;

 private:
  std::uint32_t sum_ = 0;
  friend struct plumb::FieldsOf;
  void rebuild() noexcept {
    sum_ = 0;
    for (int k = 0; k < used_; ++k) sum_ += list_[static_cast<std::size_t>(k)];
  }
  bool plausible() const noexcept { return sum_ != 13; }
  static constexpr auto fields() noexcept {
    using O = Outer;
    return field_list(&O::flag_, within(&O::number_, -5, 1000), up_to(&O::colour_, Colour::blue), &O::set_,
                      per_sensor(&O::each_), within(&O::used_, 0, 4), counted(&O::list_, &O::used), any(&O::free_),
                      only_when(&O::inner_, &O::flagged), not_stored(&O::configured_), not_stored(&O::sum_));
  }
};
static_assert(stored_size_max<Inner>() == 10);
static_assert(stored_size_max<Outer>() == 1 + 4 + 1 + 4 + 8 * kCapacity + 4 + 16 + 8 + 10);

constexpr int kSensors = 3;

std::vector<std::uint8_t> written(const Outer& object) {
  ArchiveWriter counter(nullptr, 0, kSensors);
  counter.put(object);
  std::vector<std::uint8_t> bytes(counter.used());
  ArchiveWriter out(bytes.data(), bytes.size(), kSensors);
  out.put(object);
  EXPECT_EQ(out.crc(), counter.crc());
  return bytes;
}

bool reads(const std::vector<std::uint8_t>& bytes, Outer& object) {
  ArchiveReader in(bytes.data(), bytes.size(), kSensors);
  in.get(object);
  return in.sound() && in.left() == 0;
}

Outer example() {
  Outer object(true, -2, Colour::green, SensorSet(5));
  object.each_ = {1.5, -0.0, 2.0, 99.0};  // the fourth belongs to no sensor
  object.used_ = 2;
  object.list_ = {3, 0x01020304, 55, 66};
  object.free_ = std::numeric_limits<double>::quiet_NaN();
  object.inner_ = {0xABCD, 4.0};
  return object;
}

/// As many of its list as it says, which no archive believes.
struct Boaster {
  std::int64_t wide = 0;
  int says = 0;
  std::array<std::uint8_t, 4> list{};
  int count() const noexcept { return says; }
  static constexpr auto fields() noexcept {
    return field_list(within(&Boaster::wide, -5'000'000'000, 5'000'000'000), within(&Boaster::says, -9, 9),
                      counted(&Boaster::list, &Boaster::count));
  }
};

TEST(Archive, ACountThatIsNoneIsNotFollowed) {
  for (const int says : {-1, 0, 3, 4, 5, 9}) {
    Boaster boaster;
    boaster.wide = -4'999'999'999;
    boaster.says = says;
    std::array<std::uint8_t, 64> bytes{};
    ArchiveWriter out(bytes.data(), bytes.size(), kSensors);
    out.put(boaster);
    EXPECT_EQ(out.used(), 12U + (says >= 0 && says <= 4 ? static_cast<std::size_t>(says) : 0U)) << says;
    Boaster back;
    ArchiveReader in(bytes.data(), bytes.size(), kSensors);
    in.get(back);
    EXPECT_EQ(back.wide, -4'999'999'999);
    EXPECT_EQ(in.sound(), says >= 0 && says <= 4) << says;
  }
}

TEST(Archive, BytesAreLittleEndianIeeeWithoutGaps) {
  const std::vector<std::uint8_t> expected = {
      1,                                         // flag
      0xFE, 0xFF, 0xFF, 0xFF,                    // -2
      1,                                         // green
      5,    0,    0,    0,                       // set
      0,    0,    0,    0,    0, 0, 0xF8, 0x3F,  // 1.5
      0,    0,    0,    0,    0, 0, 0,    0x80,  // -0.0
      0,    0,    0,    0,    0, 0, 0,    0x40,  // 2.0
      2,    0,    0,    0,                       // used
      3,    0,    0,    0,                       // list
      4,    3,    2,    1,                       //
      0,    0,    0,    0,    0, 0, 0xF8, 0x7F,  // NaN
      0xCD, 0xAB,                                // inner
      0,    0,    0,    0,    0, 0, 0x10, 0x40,  // 4.0
  };
  EXPECT_EQ(written(example()), expected);
}

TEST(Archive, ReadsBackAndDerivesTheRest) {
  Outer back;
  back.configured_ = 5;
  ASSERT_TRUE(reads(written(example()), back));
  EXPECT_EQ(written(back), written(example()));
  EXPECT_EQ(back.sum(), 3U + 0x01020304U);
  EXPECT_EQ(back.configured_, 5U);
}

TEST(Archive, WhatBreaksItsRuleIsNeitherStoredNorReadOver) {
  const std::vector<std::uint8_t> good = written(example());
  struct Lie {
    std::size_t offset;
    std::uint8_t byte;
  };
  // A bool of 2, a number of 1022 and one below -5, the fourth of three colours, a sensor that is not there, infinity,
  // five of four.
  for (const Lie lie : {Lie{0, 2}, Lie{2, 3}, Lie{1, 0xFA}, Lie{5, 3}, Lie{6, 8}, Lie{17, 0xFF}, Lie{34, 5}}) {
    std::vector<std::uint8_t> bytes = good;
    bytes[lie.offset] = lie.byte;
    if (lie.offset == 2) bytes[3] = bytes[4] = 0;
    if (lie.offset == 17) bytes[16] = 0xF0;
    if (lie.offset == 17) bytes[17] = 0x7F;
    Outer back;
    EXPECT_FALSE(reads(bytes, back)) << lie.offset;
    EXPECT_EQ(back.inner_.small, 0) << "read on behind the error at " << lie.offset;
  }
}

TEST(Archive, AnImplausibleWholeIsRefused) {
  Outer object = example();
  object.list_ = {6, 7, 0, 0};
  Outer back;
  EXPECT_FALSE(reads(written(object), back));
  object.list_ = {6, 8, 0, 0};
  EXPECT_TRUE(reads(written(object), back));
}

TEST(Archive, TooFewBytesAreRefusedAtEveryLength) {
  const std::vector<std::uint8_t> good = written(example());
  for (std::size_t length = 0; length < good.size(); ++length) {
    Outer back;
    EXPECT_FALSE(reads({good.begin(), good.begin() + static_cast<std::ptrdiff_t>(length)}, back)) << length;
  }
}

TEST(Archive, WritesNoByteBeyondItsStorage) {
  std::vector<std::uint8_t> bytes(20, 0xEE);
  ArchiveWriter out(bytes.data(), 10, kSensors);
  out.put(example());
  EXPECT_EQ(out.used(), written(example()).size());
  for (std::size_t k = 10; k < bytes.size(); ++k) EXPECT_EQ(bytes[k], 0xEE);
}

/// The check value that every description of CRC-64/XZ gives.
TEST(Crc64, HasTheCheckValueOfItsName) {
  Crc64 crc;
  const char* text = "123456789";
  for (int k = 0; k < 9; ++k) crc.add(static_cast<std::uint8_t>(text[k]));
  EXPECT_EQ(crc.value(), 0x995DC9BBDF1939FAULL);
}

/// The promise of a cyclic code: no change within 64 bits in a row goes unseen.
RC_GTEST_PROP(Crc64Law, SeesEveryBurstOfSixtyFourBits, ()) {
  auto bytes = *rc::gen::container<std::vector<std::uint8_t>>(200, rc::gen::arbitrary<std::uint8_t>());
  const auto burst = *rc::gen::nonZero<std::uint64_t>();
  const auto at = *rc::gen::inRange<std::size_t>(0, 191);
  const auto shift = *rc::gen::inRange(0, 8);
  Crc64 before;
  before.add(bytes.data(), bytes.size());
  for (std::size_t k = 0; k < 64; ++k) {
    if ((burst >> k & 1U) == 0) continue;
    const std::size_t bit = k + static_cast<std::size_t>(shift);
    bytes[at + bit / 8] = static_cast<std::uint8_t>(bytes[at + bit / 8] ^ (1U << (bit % 8)));
  }
  Crc64 after;
  after.add(bytes.data(), bytes.size());
  RC_ASSERT(before.value() != after.value());
}

}  // namespace
}  // namespace archive_test
