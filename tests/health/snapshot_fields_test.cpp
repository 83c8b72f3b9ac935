// No member of any class of the state may be missing in the list from which snapshots are made.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <fstream>
#include <memory>
#include <new>
#include <sstream>
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

// ---- What a snapshot holds, in words: one line per member that is stored, in the order in which the archive meets
// them, with its type and how much of it. Neither values nor the bounds within which they are read stand in it.

/// The last name of a constant: of &Class::member the member's.
template <auto Constant>
std::string name_of() {
  const std::string text = __PRETTY_FUNCTION__;  // "... [Constant = &plumb::Class::member]", or "; ..." after it
  const std::size_t end = std::min(text.find(';'), text.rfind(']')), colons = text.rfind("::", end);
  return text.substr(colons + 2, end - colons - 2);
}

template <class T>
std::string scalar_name() {
  const std::string kind = std::is_same_v<T, SensorSet>  ? "set"
                           : std::is_same_v<T, bool>     ? "bool"
                           : std::is_enum_v<T>           ? "enum"
                           : std::is_floating_point_v<T> ? "float"
                           : std::is_signed_v<T>         ? "int"
                                                         : "uint";
  return kind + std::to_string(8 * sizeof(T));
}

template <class T>
void describe_members(int depth, std::string& out);

/// The type of a member; the members of a class follow, one step further in.
template <class T>
void describe_type(int depth, const std::string& before, std::string& out) {
  if constexpr (kIsArray<T>) {
    const std::string times = before + std::to_string(std::tuple_size_v<T>) + " x ";
    describe_type<typename T::value_type>(depth, times, out);
  } else if constexpr (kHasFields<T>) {
    out += before + "class\n";
    describe_members<T>(depth + 1, out);
  } else {
    out += before + scalar_name<T>() + "\n";
  }
}

template <class T, std::size_t I>
void describe_member(int depth, std::string& out) {
  constexpr auto kField = field_detail::Listed<T, I>::kField;
  using Extent = std::remove_cv_t<decltype(kField.extent)>;
  if constexpr (!std::is_same_v<Extent, NotStored>) {
    std::string line(static_cast<std::size_t>(2 * depth), ' ');
    line += name_of<kField.member>() + ": ";
    if constexpr (std::is_same_v<Extent, Leading>) {
      line += "(";
      for (int n = 3; n <= kCapacity; ++n) line += (n > 3 ? " " : "") + std::to_string(kField.extent.count(n));
      line += " with 3 to 8 sensors) of ";
    } else if constexpr (std::is_same_v<Extent, Counted<T>>) {
      line += name_of<kField.extent.count>() + "() of ";
    } else if constexpr (std::is_same_v<Extent, OnlyWhen<T>>) {
      line += "if " + name_of<kField.extent.holds>() + "(): ";
    }
    describe_type<typename decltype(kField)::Member>(depth, line, out);
  }
}

template <class T, std::size_t... I, class... F>
void describe_each(int depth, std::string& out, const FieldList<std::index_sequence<I...>, F...>*) {
  (describe_member<T, I>(depth, out), ...);
}
template <class T>
void describe_members(int depth, std::string& out) {
  constexpr field_detail::ListOf<T>* kList = nullptr;
  describe_each<T>(depth, out, kList);
}
template <class T>
std::string description() {
  std::string out;
  describe_members<T>(0, out);
  return out;
}

/// A list that is changed makes another format: kSnapshotFormat has to grow, and with it
/// tests/health/snapshot_format.txt. Where a member has another name and nothing else is new, the text alone is written
/// anew.
TEST(SnapshotFields, TheFormatIsPinned) {
  ASSERT_EQ(kCapacity, 8);
  EXPECT_EQ(kSnapshotHeaderSize, 28U);
  EXPECT_EQ(kSnapshotFrameSize, 36U);
  EXPECT_EQ(HealthMonitor::snapshot_size_max(), 24602U);
  std::ifstream file(std::string(PLUMB_SOURCE_DIR) + "/tests/health/snapshot_format.txt");
  std::istringstream now("format " + std::to_string(kSnapshotFormat) + "\n" + description<HealthMonitor>());
  std::string pinned, found;
  int line = 1;
  for (; std::getline(now, found); ++line) {
    const bool more = static_cast<bool>(std::getline(file, pinned));
    if (more && pinned == found) continue;
    const std::string path = testing::TempDir() + "snapshot_format.txt";
    std::ofstream(path) << now.str();
    FAIL() << "tests/health/snapshot_format.txt:" << line << " has \"" << (more ? pinned : "nothing more")
           << "\", the lists have \"" << found << "\"; all of it is in " << path;
  }
  EXPECT_FALSE(std::getline(file, pinned)) << "no longer stored: " << pinned;
  EXPECT_GT(line, 100) << "what is pinned must be the whole monitor";
}

enum class Colour : std::uint8_t { red, green };
struct Pinned {
  double first = 0.0, second = 0.0;
  Colour colour = Colour::red;
  std::array<float, 8> each{};
  static constexpr auto fields() noexcept {
    return field_list(&Pinned::first, &Pinned::second, up_to(&Pinned::colour, Colour::red), per_sensor(&Pinned::each));
  }
};
struct OtherBound : Pinned {
  static constexpr auto fields() noexcept {
    return field_list(&Pinned::first, any(&Pinned::second), up_to(&Pinned::colour, Colour::green),
                      per_sensor(&Pinned::each));
  }
};
struct Fewer : Pinned {
  static constexpr auto fields() noexcept {
    return field_list(&Pinned::first, not_stored(&Pinned::second), up_to(&Pinned::colour, Colour::red),
                      per_sensor(&Pinned::each));
  }
};
struct Swapped : Pinned {
  static constexpr auto fields() noexcept {
    return field_list(&Pinned::second, &Pinned::first, up_to(&Pinned::colour, Colour::red), per_sensor(&Pinned::each));
  }
};
struct Retyped : Pinned {
  float second = 0.0F;
  static constexpr auto fields() noexcept {
    return field_list(&Pinned::first, &Retyped::second, up_to(&Pinned::colour, Colour::red), per_sensor(&Pinned::each));
  }
};
struct WholeArray : Pinned {
  static constexpr auto fields() noexcept {
    return field_list(&Pinned::first, &Pinned::second, up_to(&Pinned::colour, Colour::red), &Pinned::each);
  }
};

/// The text tells what would be read back as something else, and nothing that would not.
TEST(SnapshotFields, TheFormatChangesWithMembersAndNotWithBounds) {
  const std::string pinned = description<Pinned>();
  EXPECT_EQ(pinned,
            "first: float64\nsecond: float64\ncolour: enum8\neach: (3 4 5 6 7 8 with 3 to 8 sensors) of 8 x float32\n");
  EXPECT_EQ(description<OtherBound>(), pinned);
  EXPECT_NE(description<Fewer>(), pinned);
  EXPECT_NE(description<Swapped>(), pinned);
  EXPECT_NE(description<Retyped>(), pinned);
  EXPECT_NE(description<WholeArray>(), pinned);
}

}  // namespace
}  // namespace snapshot_fields_test
