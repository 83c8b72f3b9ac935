/// Which bytes of an object are members and which are padding, known at compile time by the `fields()` of its classes,
/// and a sum over some of them: it tells whether storage has changed though no program wrote to it.
///
/// Beside `fields()` a class may have two lists of members, private where those are:
///
///   changing()  members that a step may write to without a new sum being made
///   core()      members that are compared in every step; of a member whose class has such a list, what is in that
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <type_traits>

#include "plumb/core/detail/fields.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

/// Bytes of an object that are all members.
template <class Offset>
struct StorageRun {
  Offset first = 0, size = 0;
};

/// Which members a sum is over: those in core(), or all but those in changing().
enum class StoragePart : std::uint8_t { core, steady };

namespace storage_detail {

template <class T, class = void>
inline constexpr bool kHasChanging = false;
template <class T>
inline constexpr bool kHasChanging<T, std::void_t<decltype(FieldsOf::changing<T>())>> = true;
template <class T, class = void>
inline constexpr bool kHasCore = false;
template <class T>
inline constexpr bool kHasCore<T, std::void_t<decltype(FieldsOf::core<T>())>> = true;

template <class Member, class List>
constexpr bool lists(const List& list, Member member) noexcept {
  bool found = false;
  list.each([&found, member](auto field) {
    if constexpr (std::is_same_v<decltype(field.member), Member>) found = found || field.member == member;
  });
  return found;
}

template <class T, class Sink>
constexpr void cover(Sink& sink, std::size_t offset, StoragePart part) noexcept;

template <class T, class Sink, class Member>
constexpr void cover_member(Sink& sink, std::size_t offset, StoragePart part, Member T::*member) noexcept {
  if (part == StoragePart::core) {
    if constexpr (kHasCore<T>) {
      if (!lists(FieldsOf::core<T>(), member)) return;
      if constexpr (kHasCore<Member>) return cover<Member>(sink, offset, part);
    }
    return cover<Member>(sink, offset, StoragePart::steady);
  }
  if constexpr (kHasChanging<T>) {
    if (lists(FieldsOf::changing<T>(), member)) return;
  }
  cover<Member>(sink, offset, part);
}

template <class T, class Sink>
constexpr void cover(Sink& sink, std::size_t offset, StoragePart part) noexcept {
  if constexpr (kIsArray<T>) {
    using Element = typename T::value_type;
    if constexpr (kHasFields<Element> || kIsArray<Element>) {
      for (std::size_t k = 0; k < std::tuple_size_v<T>; ++k) cover<Element>(sink, offset + k * sizeof(Element), part);
    } else {
      sink.add(offset, sizeof(T));
    }
  } else if constexpr (kHasFields<T>) {
    std::size_t end = 0;
    FieldsOf::list<T>().each([&sink, &end, offset, part](auto field) {
      using Member = typename decltype(field)::Member;
      end = field_detail::rounded_up(end, alignof(Member));
      cover_member<T>(sink, offset + end, part, field.member);
      end += sizeof(Member);
    });
  } else {
    static_assert(std::is_arithmetic_v<T> || std::is_enum_v<T> || std::is_same_v<T, SensorSet>, "has no fields()");
    sink.add(offset, sizeof(T));
  }
}

/// Joins what lies side by side.
template <class Run, std::size_t kRoom>
struct RunSink {
  std::array<Run, kRoom> run{};
  std::size_t count = 0;
  std::size_t end = 0;
  constexpr void add(std::size_t first, std::size_t size) noexcept {
    if (count == 0 || end != first) {
      if (count < kRoom) run[count].first = static_cast<decltype(Run::first)>(first);
      ++count;
    }
    end = first + size;
    if (count <= kRoom) run[count - 1].size = static_cast<decltype(Run::size)>(end - run[count - 1].first);
  }
};
struct RunCounter {
  std::size_t count = 0, end = 0;
  constexpr void add(std::size_t first, std::size_t size) noexcept {
    if (count == 0 || end != first) ++count;
    end = first + size;
  }
};

template <class T>
constexpr std::size_t run_count(StoragePart part) noexcept {
  RunCounter counter;
  cover<T>(counter, 0, part);
  return counter.count;
}
template <class T, StoragePart kPart>
constexpr auto runs() noexcept {
  using Offset = std::conditional_t<sizeof(T) <= 0xFFFF, std::uint16_t, std::uint32_t>;
  RunSink<StorageRun<Offset>, run_count<T>(kPart)> sink;
  cover<T>(sink, 0, kPart);
  return sink.run;
}

}  // namespace storage_detail

/// The runs of a part, in order.
template <class T, StoragePart kPart>
inline constexpr auto kStorageRuns = storage_detail::runs<T, kPart>();

/// Sum modulo 2^64 of the words of eight bytes, and of what is left behind the last one, by four, two and one.
std::uint64_t sum_of_bytes(const unsigned char* from, std::size_t size) noexcept;

/// Words of eight bytes side by side, counted from the beginning of the object, that are members from end to end.
struct StorageStretch {
  std::uint16_t first = 0, count = 0;
};
/// So many words of which the same bytes are members: bit k for byte k.
struct StorageGroup {
  std::uint8_t bytes = 0, count = 0;
};
/// A part by aligned words instead of by runs: on a processor of 32 bits seventy runs of a few bytes cost as much as
/// all the words between them.
struct StoragePlan {
  const StorageStretch* stretch = nullptr;
  std::size_t stretches = 0;
  const StorageGroup* group = nullptr;
  std::size_t groups = 0;
  const std::uint16_t* word = nullptr;  ///< those of the groups, one group after the other
};

/// Upper and lower halves of the words of a plan, each added up by itself modulo 2^32; bytes that are no members are
/// taken for zero. The object is aligned to eight bytes, and the processor puts the lowest byte of a word first.
std::uint64_t sum_of_words(const unsigned char* object, const StoragePlan& plan) noexcept;

namespace storage_detail {

/// Which bytes of every word of an object a part covers.
template <class T, StoragePart kPart>
constexpr auto bytes_of_words() noexcept {
  std::array<std::uint8_t, (sizeof(T) + 7) / 8> out{};
  for (const auto& run : kStorageRuns<T, kPart>) {
    const std::size_t end = std::size_t{run.first} + run.size;
    for (std::size_t at = run.first; at < end; at = (at / 8 + 1) * 8) {
      const std::size_t last = end - at / 8 * 8;
      const unsigned below = last < 8 ? (1U << last) - 1 : 0xFFU;
      out[at / 8] = static_cast<std::uint8_t>(out[at / 8] | (below >> (at % 8) << (at % 8)));
    }
  }
  return out;
}

struct PlanSizes {
  std::size_t stretches = 0, groups = 0, words = 0;
};

/// Counts what the tables below have to hold.
template <std::size_t kWords>
constexpr PlanSizes plan_sizes(const std::array<std::uint8_t, kWords>& bytes) noexcept {
  PlanSizes out;
  std::array<bool, 256> seen{};
  for (std::size_t k = 0; k < kWords; ++k) {
    if (bytes[k] == 0xFF && (k == 0 || bytes[k - 1] != 0xFF)) ++out.stretches;
    if (bytes[k] == 0 || bytes[k] == 0xFF) continue;
    ++out.words;
    if (!seen[bytes[k]]) ++out.groups;
    seen[bytes[k]] = true;
  }
  return out;
}

template <class T, StoragePart kPart>
struct PlanTables {
  static constexpr auto kBytes = bytes_of_words<T, kPart>();
  static constexpr PlanSizes kSizes = plan_sizes(kBytes);
  static_assert(sizeof(T) <= 0xFFFF && kSizes.words <= 0xFF, "the tables hold no more");

  std::array<StorageStretch, kSizes.stretches> stretch{};
  std::array<StorageGroup, kSizes.groups> group{};
  std::array<std::uint16_t, kSizes.words> word{};

  constexpr PlanTables() noexcept {
    std::size_t stretches = 0, groups = 0, words = 0;
    for (std::size_t k = 0; k < kBytes.size(); ++k) {
      if (kBytes[k] != 0xFF) continue;
      if (k == 0 || kBytes[k - 1] != 0xFF) stretch[stretches++].first = static_cast<std::uint16_t>(k);
      ++stretch[stretches - 1].count;
    }
    // Counted first and placed then: one search per pattern takes more steps than a compiler allows.
    std::array<std::size_t, 256> count{}, next{};
    for (const std::uint8_t bytes : kBytes) ++count[bytes];
    for (std::size_t bytes = 1; bytes < 0xFF; ++bytes) {
      if (count[bytes] == 0) continue;
      group[groups].bytes = static_cast<std::uint8_t>(bytes);
      group[groups++].count = static_cast<std::uint8_t>(count[bytes]);
      next[bytes] = words;
      words += count[bytes];
    }
    for (std::size_t k = 0; k < kBytes.size(); ++k) {
      const std::uint8_t bytes = kBytes[k];
      if (bytes != 0 && bytes != 0xFF) word[next[bytes]++] = static_cast<std::uint16_t>(k);
    }
  }
};

template <class T, StoragePart kPart>
inline constexpr PlanTables<T, kPart> kPlanTables{};

}  // namespace storage_detail

/// The plan of a part of an object of less than 64 kB.
template <class T, StoragePart kPart>
inline constexpr StoragePlan kStoragePlan = {
    storage_detail::kPlanTables<T, kPart>.stretch.data(), storage_detail::kPlanTables<T, kPart>.stretch.size(),
    storage_detail::kPlanTables<T, kPart>.group.data(), storage_detail::kPlanTables<T, kPart>.group.size(),
    storage_detail::kPlanTables<T, kPart>.word.data()};

/// A sum in half the room. A change of the sum by a power of two, as one flipped bit makes it, changes this too.
inline constexpr std::uint64_t kFold = 0x9E3779B97F4A7C15ULL;
constexpr std::uint32_t folded(std::uint64_t sum) noexcept { return static_cast<std::uint32_t>((sum * kFold) >> 32U); }
namespace storage_detail {
/// What is added below the cut carries at most one into what is kept.
constexpr bool every_bit_is_kept() noexcept {
  for (unsigned b = 0; b < 64; ++b) {
    const std::uint64_t up = std::uint64_t{1} << b;
    for (const std::uint64_t change : {up, ~up + 1}) {
      if (folded(change) == 0 || folded(change) == 0xFFFF'FFFFU) return false;
    }
  }
  return true;
}
static_assert(every_bit_is_kept());
}  // namespace storage_detail

namespace storage_detail {

template <class Word>
std::uint64_t word_at(const unsigned char* from) noexcept {
  Word word;
  std::memcpy(&word, from, sizeof word);
  return word;
}

/// Of a run whose size is known: without a loop where it is short.
template <std::size_t kSize>
std::uint64_t sum_of_run(const unsigned char* from) noexcept {
  if constexpr (kSize >= 64) {
    return sum_of_bytes(from, kSize);
  } else if constexpr (kSize >= 8) {
    return word_at<std::uint64_t>(from) + sum_of_run<kSize - 8>(from + 8);
  } else if constexpr (kSize >= 4) {
    return word_at<std::uint32_t>(from) + sum_of_run<kSize - 4>(from + 4);
  } else if constexpr (kSize >= 2) {
    return word_at<std::uint16_t>(from) + sum_of_run<kSize - 2>(from + 2);
  } else if constexpr (kSize == 1) {
    return *from;
  } else {
    return 0;
  }
}

template <class T, StoragePart kPart, std::size_t... I>
std::uint64_t sum_in_line(const unsigned char* bytes, std::index_sequence<I...>) noexcept {
  return (std::uint64_t{0} + ... + sum_of_run<kStorageRuns<T, kPart>[I].size>(bytes + kStorageRuns<T, kPart>[I].first));
}

}  // namespace storage_detail

/// Sum over the runs of a part. Whatever changes within one of its words changes the sum. In line where they are few,
/// or many and the processor is one to which code is cheap.
template <StoragePart kPart, class T>
std::uint64_t storage_sum(const T& object) noexcept {
  constexpr std::size_t kCount = kStorageRuns<T, kPart>.size();
  const auto* bytes = static_cast<const unsigned char*>(static_cast<const void*>(&object));
  if constexpr (kCount <= 16 || (kCount <= 256 && sizeof(void*) >= 8)) {
    return storage_detail::sum_in_line<T, kPart>(bytes, std::make_index_sequence<kCount>());
  } else if constexpr (sizeof(void*) < 8 && __BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__ && alignof(T) % 8 == 0 &&
                       sizeof(T) <= 0xFFFF) {
    return sum_of_words(bytes, kStoragePlan<T, kPart>);
  } else {
    std::uint64_t sum = 0;
    for (const auto& run : kStorageRuns<T, kPart>) sum += sum_of_bytes(bytes + run.first, run.size);
    return sum;
  }
}

}  // namespace PLUMB_ABI
}  // namespace plumb
