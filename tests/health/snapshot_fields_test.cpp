// No member of any class of the state may be missing in the list from which snapshots are made.
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <typeinfo>

#include "snapshot_support.hpp"

// Serves: REQ-163

namespace {

using namespace plumb;
using plumb_test::Bytes;
using plumb_test::Rig;
using plumb_test::snapshot_of;

#if defined(__has_builtin)
#if __has_builtin(__builtin_clear_padding)
#define PLUMB_KNOWS_PADDING 1
#endif
#endif

#ifdef PLUMB_KNOWS_PADDING

/// Bytes of a T that are neither padding nor part of a member in its list; the members are looked into likewise.
template <class T>
void every_byte_is_listed(std::vector<std::string>& forgotten) {
  if constexpr (kIsArray<T>) {
    every_byte_is_listed<typename T::value_type>(forgotten);
  } else if constexpr (kHasFields<T>) {
    struct Raw {
      alignas(T) unsigned char bytes[sizeof(T)];
    };
    const auto raw = std::make_unique<Raw>();
    std::memset(raw->bytes, 0xFF, sizeof(T));
    T* object = reinterpret_cast<T*>(raw->bytes);
    __builtin_clear_padding(object);
    const auto strike = [object](auto field) {
      std::memset(static_cast<void*>(&(object->*(field.member))), 0, sizeof(object->*(field.member)));
    };
    const auto look_into = [&forgotten](auto field) {
      every_byte_is_listed<typename decltype(field)::Member>(forgotten);
    };
    std::apply([&](auto... field) { (strike(field), ...); }, FieldsOf::list<T>());
    const bool all = std::all_of(raw->bytes, raw->bytes + sizeof(T), [](unsigned char b) { return b == 0; });
    if (!all) forgotten.emplace_back(typeid(T).name());
    std::apply([&](auto... field) { (look_into(field), ...); }, FieldsOf::list<T>());
  }
}

struct Forgetful {
  double figure = 0.0;
  bool named = false;
  bool forgotten = false;  // in what would be padding
  static constexpr auto fields() noexcept { return field_list(&Forgetful::figure, &Forgetful::named); }
};

TEST(SnapshotFields, EveryMemberOfTheStateIsListed) {
  std::vector<std::string> forgotten;
  every_byte_is_listed<HealthMonitor>(forgotten);
  every_byte_is_listed<MonitorConfig>(forgotten);
  EXPECT_TRUE(forgotten.empty()) << forgotten.front();
}

/// The check sees what no size betrays.
TEST(SnapshotFields, AForgottenMemberIsSeen) {
  std::vector<std::string> forgotten;
  every_byte_is_listed<Forgetful>(forgotten);
  EXPECT_EQ(forgotten.size(), 1U);
}

#endif

/// A list that is changed makes another format: kSnapshotFormat has to grow with these figures.
TEST(SnapshotFields, TheFormatIsPinned) {
  EXPECT_EQ(kSnapshotFormat, 1);
  EXPECT_EQ(kCapacity, 8);
  EXPECT_EQ(HealthMonitor::snapshot_size_max(), 19788U);
  Rig rig(plumb_test::tetrahedron());
  const Bytes bytes = snapshot_of(rig.monitor);
  Crc64 crc;
  crc.add(bytes.data() + kSnapshotHeaderSize, bytes.size() - kSnapshotFrameSize);
  EXPECT_EQ(bytes.size(), 0U);
  EXPECT_EQ(crc.value(), 0U);
}

}  // namespace
