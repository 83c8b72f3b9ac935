/// The paper's B_i, SF_i and m_ij from a calibration in common-frame form, and back. Exact both ways: the two say the
/// same of every reading that some acceleration causes, at every temperature.
///
/// Common-frame form: V_i/SF'_i(T) - B'_i(T) = h'_i . g with calibrated unit axes h'_i and no cross terms.
/// Paper form: (I - M)(V/SF(T) - B(T)) = H g with the nominal axes H.
/// They agree iff (I - M) diag(d) H' = H with SF_i = SF'_i/d_i and B_i = d_i B'_i, all orders of temperature alike.
/// n = 3: I - M = P diag(P)^-1 with P = H H'^-1 and d = diag(P), unique. n = 4: the paper has four numbers more than
/// readings can show; d = 1 (SF_i = SF0_i |W_i|) fixes them, and row i follows from the 3x3 system
/// sum_{k != i} m_ik h'_k = h'_i - h_i. n > 4: infinitely many m_ij say the same, so there is no such form to state.
#pragma once

#include <array>

#include "plumb/array/sensor_array.hpp"
#include "plumb/calibration/sensor_model.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

/// Three axes with a smaller |det|, or a diagonal of H H'^-1 below it, are refused: cross terms would exceed a thousand
/// times the axis errors that they state.
inline constexpr double kMinPaperDet = 1e-3;

/// Calibrated axes in the tool frame with the coefficients that belong to them; misalignment zero.
struct CommonFrameForm {
  SensorModel model;
  std::array<Vec3, kCapacity> axis{};  ///< unit vectors
};

/// The paper form of `common`. `nominal` and `calibrated` hold the same sensors in the same order.
/// Errors: out_of_range (index 0: sizes differ, 1: `common` has cross terms); not_unique (value = n, limit = 4);
/// axes_rank_deficient (index = sensor whose row needs the other three, -1 for n = 3; value = |det|);
/// not_invertible (index = sensor, value = diagonal of H H'^-1: it lies across its nominal direction).
Expected<SensorModel> paper_form(const SensorArray& nominal, const SensorArray& calibrated,
                                 const SensorModel& common) noexcept;

/// The common-frame form of a model with misalignments over the axes of `nominal`, any n. For n = 4 a model whose rows
/// (I - M)^-1 H are not of unit length comes back from `paper_form` with its scale factors in the form above.
/// Errors: out_of_range (index 0: sizes differ, 1: a diagonal m_ii that is not zero); not_invertible (I - M singular,
/// or index = sensor whose row vanishes).
Expected<CommonFrameForm> common_frame_form(const SensorArray& nominal, const SensorModel& paper) noexcept;

}  // namespace PLUMB_ABI
}  // namespace plumb
