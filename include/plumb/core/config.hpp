/// Build-wide settings of plumb. Every public header of floors 1 to 4 includes this one.
///
/// The number of sensors that fit (the *capacity*) is part of every type: it selects an inline
/// namespace, so that objects of two capacities can never be mixed: a mismatch fails to link.
#pragma once

#ifndef PLUMB_CAPACITY
#define PLUMB_CAPACITY 8
#endif

#if defined(__FAST_MATH__)
#error "plumb refuses -ffast-math: it removes the NaN checks that keep a broken channel out of a sum"
#endif

#if PLUMB_CAPACITY == 4
#define PLUMB_ABI cap4
#elif PLUMB_CAPACITY == 8
#define PLUMB_ABI cap8
#elif PLUMB_CAPACITY == 16
#define PLUMB_ABI cap16
#elif PLUMB_CAPACITY == 24
#define PLUMB_ABI cap24
#else
#error "PLUMB_CAPACITY is 4, 8, 16 or 24"
#endif

namespace plumb {
inline namespace PLUMB_ABI {

/// Largest number of sensors of one array.
inline constexpr int kCapacity = PLUMB_CAPACITY;

/// Largest number of sensors for which the strict isolation grade is decided (design, section 2).
inline constexpr int kStrictCapacity = kCapacity < 16 ? kCapacity : 16;

/// Longest sliding window, in samples.
inline constexpr int kWindowCapacity = kCapacity <= 8 ? 32 : 256;

/// Number of triples of n sensors, eq (13).
constexpr int triple_count_of(int n) noexcept { return n * (n - 1) * (n - 2) / 6; }

inline constexpr int kTripleCapacity = triple_count_of(kCapacity);

}  // namespace PLUMB_ABI
}  // namespace plumb
