// A window whose storage memory has damaged: it says so before one of its figures is an index.
#include <gtest/gtest.h>

#include <cstring>
#include <memory>

#include "plumb/detection/combination_mae.hpp"
#include "support/simulated_tool.hpp"

namespace combination_mae_damage_test {
namespace {

using namespace plumb;

constexpr int kTriples = 4, kWindow = 8;

const SensorArray kArray = plumb_test::tetrahedron(2e-4 * kG0_mps2);

void add_sample(CombinationMae& window) {
  Readings y{};
  for (int i = 0; i < kArray.size(); ++i) y[static_cast<std::size_t>(i)] = kArray.axis(i)[2] * kG0_mps2 + 0.01 * i;
  const Vec3 down = {0.0, 0.0, kG0_mps2};
  window.add(kArray, y, kArray.all(), &down, kG0_mps2);
}

/// Calls `ask` with a window that has `value` in one place of its storage, for every place where one may stand.
template <class Value, class Ask>
void damage_everywhere(Value value, const Ask& ask) {
  const auto sound = std::make_unique<CombinationMae>();
  sound->configure(kTriples, kWindow);
  for (int k = 0; k < kWindow + 3; ++k) add_sample(*sound);
  const auto damaged = std::make_unique<CombinationMae>();
  for (std::size_t place = 0; place + sizeof value <= sizeof(CombinationMae); place += sizeof value) {
    *damaged = *sound;
    std::memcpy(reinterpret_cast<unsigned char*>(damaged.get()) + place, &value, sizeof value);
    ask(*damaged, place);
  }
}

/// More triples or samples than there is room for fit no window, whatever stands in its storage.
// Negative: REQ-166
TEST(CombinationMaeDamage, AWindowBeyondItsRoomNeverFits) {
  constexpr std::uint16_t kBeyond = 60000;
  damage_everywhere(kBeyond, [](const CombinationMae& damaged, std::size_t place) {
    ASSERT_FALSE(damaged.fits(kBeyond, kWindow)) << place;
    ASSERT_FALSE(damaged.fits(kTriples, kBeyond)) << place;
  });
}

/// The next sample goes to a place that the storage names. One outside of the window is found before it is written to:
/// else the sums would count what the window does not hold.
// Negative: REQ-166
TEST(CombinationMaeDamage, AWindowThatFitsAndHoldsDoesSoAfterTheNextSample) {
  for (const int value : {-1, kWindow, kWindow + 1}) {
    int damages = 0, found = 0;
    damage_everywhere(value, [&](CombinationMae& damaged, std::size_t place) {
      ++damages;
      if (!damaged.fits(kTriples, kWindow) || !damaged.holds()) {
        ++found;
        return;
      }
      add_sample(damaged);
      ASSERT_TRUE(damaged.fits(kTriples, kWindow) && damaged.holds()) << value << " at " << place;
    });
    EXPECT_GT(found, 0) << value;
    EXPECT_LT(found, damages) << value << ": what is not in use may hold anything";
  }
}

// Negative: REQ-166
TEST(CombinationMaeDamage, OfOtherSizesItIsAnotherWindow) {
  const auto window = std::make_unique<CombinationMae>();
  window->configure(kTriples, kWindow);
  EXPECT_TRUE(window->fits(kTriples, kWindow));
  EXPECT_FALSE(window->fits(kTriples - 1, kWindow));
  EXPECT_FALSE(window->fits(kTriples, kWindow - 1));
}

}  // namespace
}  // namespace combination_mae_damage_test
