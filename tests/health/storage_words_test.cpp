// Every word of a monitor's storage exchanged for what does most harm where it is a size, a count or a place.
#include <gtest/gtest.h>

#include <cstring>
#include <functional>
#include <iterator>
#include <limits>
#include <memory>
#include <vector>

#include "recalibration_support.hpp"

#if defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(undefined_behavior_sanitizer)
#define PLUMB_CLANG_SANITIZES
#endif
#endif

namespace storage_words_test {
namespace {

using namespace plumb;
using plumb_test::direction_at;
using plumb_test::Rig;

#if defined(__SANITIZE_ADDRESS__) || defined(PLUMB_CLANG_SANITIZES)
// The sanitizer ends a test that reads a bool of another value than 0 or 1: only such bytes are put there.
constexpr std::int32_t kWords[] = {0, 1, 0x00010001, 0x01000000, 0x01010101};
#else
constexpr std::int32_t kWords[] = {
    std::numeric_limits<std::int32_t>::min(), -1, 0, 1, 2, 3, kCapacity + 1, 32, 33, 139, 1 << 30};
#endif

/// Calls `ask` with a copy of the monitor of which one word is another one, for every word.
void exchange_words(const HealthMonitor& sound,
                    const std::function<void(HealthMonitor&, std::size_t, std::int32_t)>& ask) {
  const auto hurt = std::make_unique<HealthMonitor>();
  for (const std::int32_t word : kWords) {
    for (std::size_t place = 0; place + sizeof word <= sizeof(HealthMonitor); place += sizeof word) {
      *hurt = sound;
      unsigned char* const at = reinterpret_cast<unsigned char*>(hurt.get()) + place;
      if (std::memcmp(at, &word, sizeof word) == 0) continue;
      std::memcpy(at, &word, sizeof word);
      ask(*hurt, place, word);
    }
  }
}

bool is_reported(const Verdict& v) {
  return v.cause == Cause::memory && v.state == HealthState::failed && v.validity == Validity::invalid;
}

/// In the middle of a block: what would be an index too large is told by the very next sample, and no request is taken.
// Negative: REQ-166
TEST(StorageWords, AnotherNumberOfSensorsIsReportedBeforeTheNextReadingIsTaken) {
  if (kCapacity > 8) GTEST_SKIP() << "every word takes a copy of the monitor, which is too large here";
  Rig rig(plumb_test::tetrahedron());
  rig.prove();
  for (int k = 0; k < 11; ++k) rig.step(rig.sample(direction_at(20, 20), kG0_mps2));
  const Sample next = rig.sample(direction_at(20, 20), kG0_mps2);
  int sizes = 0;
  exchange_words(rig.monitor, [&](HealthMonitor& hurt, std::size_t place, std::int32_t word) {
    if (hurt.array().size() == 4 && hurt.model().size == 4) return;
    ++sizes;
    EXPECT_FALSE(hurt.request_recalibration().has_value()) << place << ": " << word;
    EXPECT_TRUE(is_reported(hurt.step(next))) << place << ": " << word;
  });
  EXPECT_EQ(sizes, 2 * static_cast<int>(std::size(kWords)));
}

/// From the last sample of a block on: it is reported within a block, or a block ends and says what it would have said,
/// or what is published is not called valid. A block that never ends would leave the last word standing for good. What
/// would be reported takes no request either.
// Verifies: REQ-166
TEST(StorageWords, AtTheEndOfABlockAnyIsReportedOrDoesNoHarm) {
  if (kCapacity > 8) GTEST_SKIP() << "every word takes a copy of the monitor, which is too large here";
  Rig rig(plumb_test::tetrahedron());
  rig.prove();
  for (int k = 1; k < rig.setup.config.window; ++k) rig.step(rig.sample(direction_at(20, 20), kG0_mps2));
  std::vector<Sample> next;
  for (int k = 0; k <= rig.setup.config.window; ++k) next.push_back(rig.sample(direction_at(20, 20), kG0_mps2));
  const auto unhurt = std::make_unique<HealthMonitor>(rig.monitor);
  const Verdict& sound = unhurt->step(next.front());
  ASSERT_TRUE(sound.tick);
  ASSERT_EQ(sound.validity, Validity::valid);
  const auto asked = std::make_unique<HealthMonitor>(rig.monitor);
  ASSERT_TRUE(asked->request_recalibration().has_value());
  int reported = 0;
  exchange_words(rig.monitor, [&](HealthMonitor& hurt, std::size_t place, std::int32_t word) {
    *asked = hurt;
    for (const Sample& sample : next) {
      hurt.step(sample);
      if (hurt.verdict().tick || is_reported(hurt.verdict())) break;
    }
    const Verdict& v = hurt.verdict();
    if (is_reported(v)) {
      ++reported;
      EXPECT_FALSE(asked->request_recalibration().has_value())
          << place << ": " << word << ": sealed as if it were true";
    } else if (v.validity == Validity::valid) {
      EXPECT_TRUE(v.tick) << place << ": " << word;
      EXPECT_EQ(v.state, sound.state) << place << ": " << word;
      EXPECT_EQ(v.excluded, sound.excluded) << place << ": " << word;
      EXPECT_LT(norm(minus(v.gravity_mps2, sound.gravity_mps2)), 1e-2) << place << ": " << word;
    }
  });
  EXPECT_GT(reported, 5000);
}

/// One write over all of it, as from a stray memset: the three places that hold the number of sensors then agree, on
/// a number that may lie beyond every index.
// Negative: REQ-166
TEST(StorageWords, OneByteWrittenOverAllOfItIsNeverValid) {
#if defined(__SANITIZE_ADDRESS__) || defined(PLUMB_CLANG_SANITIZES)
  constexpr int kBytes = 2;
#else
  constexpr int kBytes = 256;
#endif
  Rig rig(plumb_test::tetrahedron());
  rig.prove();
  const Sample next = rig.sample(direction_at(20, 20), kG0_mps2);
  const auto hurt = std::make_unique<HealthMonitor>();
  for (int byte = 0; byte < kBytes; ++byte) {
    *hurt = rig.monitor;
    std::memset(reinterpret_cast<unsigned char*>(hurt.get()), byte, sizeof(HealthMonitor));
    EXPECT_FALSE(hurt->request_recalibration().has_value()) << byte;
    for (int k = 0; k < 40; ++k) EXPECT_EQ(hurt->step(next).validity, Validity::invalid) << byte;
  }
}

}  // namespace
}  // namespace storage_words_test
