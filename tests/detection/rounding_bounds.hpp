/// Bounds on the rounding of the detection kernel, each proved for all inputs in its range; the proof names the same
/// number (proofs/check_consistency.sh compares). The tests hold the compiled code against them.
#pragma once

namespace plumb_test {

/// Error of the six-term form, in units of 2^-53 times the sum of the sizes of its terms: any coefficients, readings
/// up to 1024 m/s^2. proofs/rounding/Rounding.v, theorem form_error.
inline constexpr double kFormError_u = 7.1;
/// The same in (m/s^2)^2 for readings up to 160 m/s^2 and a triple that votes. proofs/form.g.
inline constexpr double kFormErrorInRange_m2ps4 = 0x1.35p-25;
/// An integer of the window against |error| / unit with the error as computed, below the clamp. proofs/units.g.
inline constexpr double kUnitsError_units = 0x1.000004p-1;
/// An integer of the window against the exact error of a sample: form, root, difference and conversion together.
/// Range of form.g, lengths 4 to 300 m/s^2, gravity 9 to 10 m/s^2. proofs/sample.g.
inline constexpr double kSampleError_units = 0x1.0ap-1;
/// PLUMB_SCALAR=float: what a squared length changes by, in (m/s^2)^2, for differences up to 1/8 m/s^2 and a triple
/// that votes. proofs/near_form.g.
inline constexpr double kNearFormError_m2ps4 = 0x1.1fp-14;
/// The same up to the integer of the window, for lengths of 8 to 12 m/s^2. proofs/near_sample.g.
inline constexpr double kNearSampleError_units = 0x1.46p4;

}  // namespace plumb_test
