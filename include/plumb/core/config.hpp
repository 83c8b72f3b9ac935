/// Build-wide settings of plumb. Every public header of layers 1 to 4 includes this one. The number of sensors that fit
/// (the *capacity*) is part of every type: it selects an inline namespace, so that a mixture of two fails to link. So
/// is what a build omits to spare an instrument's memory, and single precision (docs/embedding.md).
#pragma once

#ifndef PLUMB_CAPACITY
#define PLUMB_CAPACITY 8
#endif

#if defined(__cplusplus) && __cplusplus < 201703L
#error "plumb needs C++17: compile with -std=c++17 or later"
#elif defined(__FAST_MATH__) || (defined(__FINITE_MATH_ONLY__) && __FINITE_MATH_ONLY__)
#error "remove -ffast-math: it removes the NaN checks that keep a broken channel out of a sum"
#endif

// NOLINTBEGIN(cppcoreguidelines-macro-usage): the preprocessor decides by them, and a namespace is named by them
#ifndef PLUMB_RECALIBRATION
#define PLUMB_RECALIBRATION 1
#endif
#ifndef PLUMB_FIRST_CALIBRATION
#define PLUMB_FIRST_CALIBRATION PLUMB_RECALIBRATION
#endif

#if PLUMB_CAPACITY != 4 && PLUMB_CAPACITY != 8 && PLUMB_CAPACITY != 16 && PLUMB_CAPACITY != 24
#error "PLUMB_CAPACITY must be 4, 8, 16 or 24"
#endif
#define PLUMB_JOIN_(a, b, c, d) a##b##c##d
#define PLUMB_JOIN(a, b, c, d) PLUMB_JOIN_(a, b, c, d)

// The type of what runs at every sample; everything else is double in either build (docs/embedding.md).
#ifndef PLUMB_SCALAR
#define PLUMB_SCALAR double
#endif
#define PLUMB_SCALAR_IS_double 1
#define PLUMB_SCALAR_IS_float 2
#if PLUMB_JOIN(PLUMB_SCALAR_IS_, PLUMB_SCALAR, , ) == 1
#define PLUMB_SINGLE 0
#define PLUMB_SCALAR_NAME
#elif PLUMB_JOIN(PLUMB_SCALAR_IS_, PLUMB_SCALAR, , ) == 2
#define PLUMB_SINGLE 1
#define PLUMB_SCALAR_NAME _float
#else
#error "PLUMB_SCALAR must be double or float"
#endif
#if PLUMB_SINGLE && PLUMB_CAPACITY > 8
#error "PLUMB_SCALAR=float needs PLUMB_CAPACITY 4 or 8: its block sums are bounded for 32 samples"
#endif

#if PLUMB_FIRST_CALIBRATION && !PLUMB_RECALIBRATION
#error "PLUMB_FIRST_CALIBRATION=1 needs PLUMB_RECALIBRATION=1: set PLUMB_FIRST_CALIBRATION=0"
#elif PLUMB_FIRST_CALIBRATION
#define PLUMB_ABI PLUMB_JOIN(cap, PLUMB_CAPACITY, , PLUMB_SCALAR_NAME)
#elif PLUMB_RECALIBRATION
#define PLUMB_ABI PLUMB_JOIN(cap, PLUMB_CAPACITY, _held, PLUMB_SCALAR_NAME)
#else
#define PLUMB_ABI PLUMB_JOIN(cap, PLUMB_CAPACITY, _fixed, PLUMB_SCALAR_NAME)
#endif
// NOLINTEND(cppcoreguidelines-macro-usage)

namespace plumb {
inline namespace PLUMB_ABI {

/// Largest number of sensors of one array.
inline constexpr int kCapacity = PLUMB_CAPACITY;

/// Whether a monitor estimates biases and scales anew in service, and whether it can make its very first calibration.
inline constexpr bool kRecalibrates = PLUMB_RECALIBRATION != 0;
inline constexpr bool kCalibratesItself = PLUMB_FIRST_CALIBRATION != 0;

/// Largest number of sensors for which the confirmed isolation grade is decided (docs/theory.md, section 5.1).
inline constexpr int kStrictCapacity = kCapacity < 16 ? kCapacity : 16;

/// Fault sets of up to this many members are scanned one by one.
inline constexpr int kScanDepth = 3;

/// Longest sliding window, in samples.
inline constexpr int kWindowCapacity = kCapacity <= 8 ? 32 : 256;

/// Number of triples of n sensors, eq (13).
constexpr int triple_count_of(int n) noexcept { return n * (n - 1) * (n - 2) / 6; }

inline constexpr int kTripleCapacity = triple_count_of(kCapacity);

/// What a sample differs by from the first of its block, and what is added up of it.
using Scalar = PLUMB_SCALAR;
inline constexpr bool kSingle = PLUMB_SINGLE != 0;

}  // namespace PLUMB_ABI
}  // namespace plumb
