// Laws of the snapshot: transparent wherever it is taken, refused whatever happens to it.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>

#include "snapshot_support.hpp"

namespace snapshot_laws_test {
namespace {

using namespace plumb;
using plumb_test::bits_of;
using plumb_test::Bytes;
using plumb_test::Life;
using plumb_test::Noise;
using plumb_test::Rig;
using plumb_test::seal;
using plumb_test::snapshot_of;

/// Property S18: a monitor that was another one a moment ago takes up the snapshot and goes on as the one that wrote
/// it.
// Verifies: REQ-163
RC_GTEST_PROP(SnapshotLaw, IsTransparentAtAnyStepOfAnyLife, ()) {
  const int n = *rc::gen::inRange(4, kCapacity + 1);
  const auto seed = *rc::gen::arbitrary<std::uint64_t>();
  const auto other_seed = *rc::gen::arbitrary<std::uint64_t>();
  const int every = *rc::gen::inRange(15, 400);
  Life life(n, seed);
  Life other(n, other_seed);
  HealthMonitor& monitor = life.tool.rig.monitor;
  auto stranger = std::make_unique<HealthMonitor>(other.tool.rig.monitor);
  for (int k = 0; k < 800; ++k) stranger->step(other.next({stranger.get()}));
  auto twin = std::make_unique<HealthMonitor>(monitor);
  std::uint32_t seen = 0;
  for (int k = 0; k < 2500; ++k) {
    if (k % every == 0) {
      const Bytes bytes = snapshot_of(monitor);
      *twin = *stranger;
      const Expected<void> taken = twin->restore(life.tool.rig.setup, bytes.data(), bytes.size());
      RC_ASSERT(taken.has_value());
      RC_ASSERT(bits_of(twin->verdict()) == bits_of(monitor.verdict()));
      RC_ASSERT(snapshot_of(*twin) == bytes);
    }
    const Sample sample = life.next({&monitor, twin.get()});
    const Verdict& v = monitor.step(sample);
    const Verdict& w = twin->step(sample);
    RC_ASSERT(bits_of(v) == bits_of(w));
    seen |= 1U << static_cast<unsigned>(v.state);
  }
  RC_ASSERT(snapshot_of(*twin) == snapshot_of(monitor));
  for (unsigned s = 0; s < kStateCount; ++s) {
    if ((seen >> s & 1U) != 0) RC_TAG(to_string(static_cast<HealthState>(s)));
  }
}

/// Life before the snapshot, so that there is something to remember.
void live(Life& life, int samples) {
  HealthMonitor& monitor = life.tool.rig.monitor;
  for (int k = 0; k < samples; ++k) monitor.step(life.next({&monitor}));
}

/// A refusal leaves what a configuration leaves, with the reason beside it.
bool is_fresh_but_for(const HealthMonitor& monitor, const MonitorSetup& setup, Errc cause) {
  auto fresh = std::make_unique<HealthMonitor>();
  if (!fresh->configure(setup)) return false;
  Verdict verdict = monitor.verdict();
  const bool told = verdict.snapshot_refusal == cause && verdict.cause == Cause::snapshot_refused;
  verdict.snapshot_refusal = Errc::ok;
  verdict.cause = fresh->verdict().cause;
  if (!told || bits_of(verdict) != bits_of(fresh->verdict())) return false;
  Bytes a = snapshot_of(monitor);
  Bytes b = snapshot_of(*fresh);
  // The cause, in the state and in the verdict, and the refusal as the last field of the last member are all that
  // differ.
  int different = 0;
  if (a.size() != b.size()) return false;
  for (std::size_t k = 0; k + 8 < a.size(); ++k) different += a[k] != b[k] ? 1 : 0;
  return different == 3;
}

// Negative: REQ-163
RC_GTEST_PROP(SnapshotLaw, AnyDamageIsDetectedAndLeavesTheMonitorNotYetValidated, ()) {
  Life life(*rc::gen::inRange(4, kCapacity + 1), *rc::gen::arbitrary<std::uint64_t>());
  live(life, *rc::gen::inRange(0, 1500));
  HealthMonitor& monitor = life.tool.rig.monitor;
  Bytes bytes = snapshot_of(monitor);
  const auto at = *rc::gen::inRange<std::size_t>(0, bytes.size());
  const int bit = *rc::gen::inRange(0, 8);
  bytes[at] = static_cast<std::uint8_t>(bytes[at] ^ (1U << static_cast<unsigned>(bit)));
  const Expected<void> taken = monitor.restore(life.tool.rig.setup, bytes.data(), bytes.size());
  RC_ASSERT(!taken.has_value());
  // Only a flip in the size may look like bytes that are missing.
  const bool in_size = at >= 24 && at < 28;
  RC_ASSERT(taken.error().code == Errc::snapshot_damaged ||
            (in_size && taken.error().code == Errc::snapshot_truncated));
  RC_ASSERT(is_fresh_but_for(monitor, life.tool.rig.setup, taken.error().code));
  RC_ASSERT((monitor.verdict().qualifiers & Qualifier::not_yet_validated) != 0);
}

// Negative: REQ-163
RC_GTEST_PROP(SnapshotLaw, WhatWasCutOffIsMissed, ()) {
  Life life(*rc::gen::inRange(4, kCapacity + 1), *rc::gen::arbitrary<std::uint64_t>());
  live(life, 300);
  const Bytes bytes = snapshot_of(life.tool.rig.monitor);
  const auto length = *rc::gen::inRange<std::size_t>(0, bytes.size());
  const Bytes cut(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(length));
  const Expected<void> taken = life.tool.rig.monitor.restore(life.tool.rig.setup, cut.data(), cut.size());
  RC_ASSERT(!taken.has_value() && taken.error().code == Errc::snapshot_truncated);
  RC_ASSERT(is_fresh_but_for(life.tool.rig.monitor, life.tool.rig.setup, Errc::snapshot_truncated));
}

/// Not drawn but all of them: each bit of a snapshot from the middle of an episode, each shorter length.
// Negative: REQ-163
TEST(Snapshot, EverySingleBitAndEveryLengthIsCovered) {
  Life life(4, 12);
  live(life, 4000);
  const Bytes bytes = snapshot_of(life.tool.rig.monitor);
  ASSERT_TRUE(life.tool.rig.monitor.restore(life.tool.rig.setup, bytes.data(), bytes.size()).has_value());
  auto monitor = std::make_unique<HealthMonitor>();
  const auto answer = [&](const Bytes& given, std::size_t size) {
    const Expected<void> taken = monitor->restore(life.tool.rig.setup, given.data(), size);
    const bool not_yet_validated = (monitor->verdict().qualifiers & Qualifier::not_yet_validated) != 0;
    return taken.has_value() || !not_yet_validated ? Errc::ok : taken.error().code;
  };
  Bytes hurt = bytes;
  for (std::size_t bit = 0; bit < 8 * bytes.size(); ++bit) {
    const auto mask = static_cast<std::uint8_t>(1U << (bit % 8));
    hurt[bit / 8] = static_cast<std::uint8_t>(hurt[bit / 8] ^ mask);
    const Errc code = answer(hurt, hurt.size());
    const bool in_size = bit / 8 >= 24 && bit / 8 < 28;
    ASSERT_TRUE(code == Errc::snapshot_damaged || (in_size && code == Errc::snapshot_truncated)) << "bit " << bit;
    hurt[bit / 8] = static_cast<std::uint8_t>(hurt[bit / 8] ^ mask);
  }
  for (std::size_t size = 0; size < bytes.size(); ++size)
    ASSERT_EQ(answer(bytes, size), Errc::snapshot_truncated) << size << " bytes";
  EXPECT_TRUE(monitor->restore(life.tool.rig.setup, bytes.data(), bytes.size()).has_value()) << "and whole it is taken";
}

/// Overwrites a few places with what does most harm.
void forge(Bytes& bytes, Noise& noise) {
  constexpr double kSpecials[] = {std::numeric_limits<double>::quiet_NaN(),
                                  std::numeric_limits<double>::infinity(),
                                  1e308,
                                  -1e308,
                                  5e-324,
                                  -1.0,
                                  0.0,
                                  1e18};
  const std::size_t first = kSnapshotHeaderSize;
  const std::size_t room = bytes.size() - kSnapshotFrameSize;
  const int places = 1 + static_cast<int>(4.0 * noise.uniform());
  for (int k = 0; k < places; ++k) {
    const auto at = first + static_cast<std::size_t>(noise.uniform() * static_cast<double>(room));
    const double pick = noise.uniform();
    if (pick < 0.4) {
      bytes[at] = static_cast<std::uint8_t>(256.0 * noise.uniform());
    } else if (pick < 0.7) {
      const double value = kSpecials[static_cast<int>(noise.uniform() * 8)];
      std::memcpy(&bytes[at], &value, std::min<std::size_t>(8, bytes.size() - 8 - at));
    } else {
      const auto value = static_cast<std::uint8_t>(noise.uniform() < 0.5 ? 0xFF : 0x7F);
      for (std::size_t j = at; j < std::min(at + 4, bytes.size() - 8); ++j) bytes[j] = value;
    }
  }
}

/// Bytes that pass the check sum and are nonsense: refused as a whole, or such that no step can be led astray by them.
// Negative: REQ-163
RC_GTEST_PROP(SnapshotLaw, AbsurdContentsDoNoHarm, ()) {
  const auto seed = *rc::gen::arbitrary<std::uint64_t>();
  const int age = *rc::gen::inRange(0, 4000);
  Life life(*rc::gen::inRange(4, kCapacity + 1), seed);
  Noise noise(seed + 1);
  live(life, age);
  const Bytes good = snapshot_of(life.tool.rig.monitor);
  const MonitorSetup& setup = life.tool.rig.setup;
  auto victim = std::make_unique<HealthMonitor>();
  int accepted = 0;
  for (int round = 0; round < 8; ++round) {
    Bytes bytes = good;
    forge(bytes, noise);
    seal(bytes);
    const Expected<void> taken = victim->restore(setup, bytes.data(), bytes.size());
    if (!taken) {
      RC_ASSERT(taken.error().code == Errc::snapshot_implausible);
      RC_ASSERT(is_fresh_but_for(*victim, setup, Errc::snapshot_implausible));
      continue;
    }
    ++accepted;
    for (int k = 0; k < 100; ++k) {
      const Verdict& v = victim->step(life.next({victim.get()}));
      RC_ASSERT((v.in_service | v.provisionally_excluded | v.excluded | v.absent) == v.configured);
      RC_ASSERT(v.in_service.size() + v.provisionally_excluded.size() + v.excluded.size() + v.absent.size() ==
                setup.array.size());
      if (v.state == HealthState::failed) RC_ASSERT(v.validity == Validity::invalid);
      if (v.validity == Validity::valid) RC_ASSERT(v.protection_available && !v.alert);
    }
  }
  RC_TAG(accepted > 0 ? "some accepted" : "all refused");
}

/// Not even bytes that were never a snapshot.
// Negative: REQ-163
RC_GTEST_PROP(SnapshotLaw, NoiseWithAValidCheckSumIsRefused, ()) {
  const auto seed = *rc::gen::arbitrary<std::uint64_t>();
  Rig rig(plumb_test::cone_array(*rc::gen::inRange(3, kCapacity + 1)));
  Noise noise(seed);
  Bytes bytes = snapshot_of(rig.monitor);
  bytes.resize(kSnapshotFrameSize + static_cast<std::size_t>(noise.uniform() * 9000.0));
  for (std::size_t k = kSnapshotHeaderSize; k < bytes.size(); ++k) {
    bytes[k] = static_cast<std::uint8_t>(256.0 * noise.uniform());
  }
  seal(bytes);
  const Expected<void> taken = rig.monitor.restore(rig.setup, bytes.data(), bytes.size());
  RC_ASSERT(!taken.has_value() && taken.error().code == Errc::snapshot_implausible);
}

}  // namespace
}  // namespace snapshot_laws_test
