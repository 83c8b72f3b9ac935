// No member of any class of the state may be missing in the list from which snapshots are made.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <memory>
#include <new>
#include <string>
#include <type_traits>
#include <typeinfo>
#include <vector>

#include "snapshot_support.hpp"

// Serves: REQ-163

namespace snapshot_fields_test {
namespace {

using namespace plumb;
using plumb_test::Bytes;
using plumb_test::Rig;
using plumb_test::snapshot_of;

template <class T>
T* construct(void* at) {
  if constexpr (std::is_same_v<T, Calibrator>) {
    return new (at) T(Datasheet{}, GravityReference{}, FitOptions{});
  } else {
    return new (at) T;
  }
}

/// True where a byte of a T belongs to neither a member in its list nor padding. A constructor writes every member
/// (they all have initial values) and leaves padding as it finds it, so padding is what still tells two fillings apart.
template <class T>
bool has_unlisted_byte() {
  struct Raw {
    alignas(T) unsigned char bytes[sizeof(T)];
  };
  const auto ones = std::make_unique<Raw>();
  const auto zeros = std::make_unique<Raw>();
  std::memset(ones->bytes, 0xFF, sizeof(T));
  std::memset(zeros->bytes, 0, sizeof(T));
  T* object = construct<T>(ones->bytes);
  construct<T>(zeros->bytes);
  std::array<bool, sizeof(T)> written{};
  for (std::size_t k = 0; k < sizeof(T); ++k) written[k] = ones->bytes[k] == zeros->bytes[k];
  const auto strike = [&](auto field) {
    const auto* first = reinterpret_cast<const unsigned char*>(&(object->*(field.member)));
    const auto offset = static_cast<std::size_t>(first - ones->bytes);
    std::fill_n(written.begin() + static_cast<std::ptrdiff_t>(offset), sizeof(object->*(field.member)), false);
  };
  FieldsOf::list<T>().each(strike);
  return std::any_of(written.begin(), written.end(), [](bool b) { return b; });
}

/// The classes with such a byte: T, those of its members, and so on.
template <class T>
void find_forgotten(std::vector<std::string>& out) {
  if constexpr (kIsArray<T>) {
    find_forgotten<typename T::value_type>(out);
  } else if constexpr (kHasFields<T>) {
    if (has_unlisted_byte<T>()) out.emplace_back(typeid(T).name());
    const auto look_into = [&out](auto field) { find_forgotten<typename decltype(field)::Member>(out); };
    FieldsOf::list<T>().each(look_into);
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
  find_forgotten<HealthMonitor>(forgotten);
  find_forgotten<MonitorConfig>(forgotten);
  EXPECT_TRUE(forgotten.empty()) << forgotten.front();
}

/// The check sees what no size betrays.
TEST(SnapshotFields, AForgottenMemberIsSeen) {
  std::vector<std::string> forgotten;
  find_forgotten<Forgetful>(forgotten);
  EXPECT_EQ(forgotten.size(), 1U);
}

/// A list that is changed makes another format: kSnapshotFormat has to grow with these figures.
TEST(SnapshotFields, TheFormatIsPinned) {
  EXPECT_EQ(kSnapshotFormat, 5);
  EXPECT_EQ(kCapacity, 8);
  EXPECT_EQ(HealthMonitor::snapshot_size_max(), 24006U);
  Rig rig(plumb_test::tetrahedron());
  const Bytes bytes = snapshot_of(rig.monitor);
  Crc64 crc;
  crc.add(bytes.data() + kSnapshotHeaderSize, bytes.size() - kSnapshotFrameSize);
  EXPECT_EQ(bytes.size(), 4532U);
  EXPECT_EQ(crc.value(), 17148807039111526851ULL);
}

}  // namespace
}  // namespace snapshot_fields_test
