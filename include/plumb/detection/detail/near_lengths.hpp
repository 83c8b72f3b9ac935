/// Lengths of gravity from what readings differ by from the first of their block: the part of a step that is made in
/// single precision where PLUMB_SCALAR is float. What is large is known in double, once a block; what is small is made
/// in float at every sample, so that its rounding is relative to the noise and not to gravity.
#pragma once

#include "plumb/detection/stationarity.hpp"

#if PLUMB_SINGLE

namespace plumb {
inline namespace PLUMB_ABI {

/// A difference beyond this is not taken in single precision [m/s^2].
inline constexpr float kNearReach_mps2 = 1.0F;

/// By how much the squared length of a triple changes where its readings change by a, b and c, from its slope and its
/// six coefficients, left to right: proofs/near_form.g bounds the rounding of exactly this order. [(m/s^2)^2]
inline float near_change(const std::array<float, 3>& slope, const std::array<float, 6>& q, float a, float b,
                         float c) noexcept {
  return a * (slope[0] + q[0] * a + q[3] * b + q[4] * c) + b * (slope[1] + q[1] * b + q[5] * c) +
         c * (slope[2] + q[2] * c);
}

/// One length at the first reading of a block, and its error of any reading near it.
class NearLength {
 public:
  void take(double square_m2ps4, double g_mps2) noexcept;
  /// |length - g| in units of kMaeUnit_mps2, to the nearest, where the square has changed by so much; -1 where that is
  /// too far for single precision, or NaN.
  std::int32_t units(float change_m2ps4) const noexcept;

 private:
  float square_m2ps4_ = 0.0F;
  float length_mps2_ = 0.0F;
  float reach_m2ps4_ = -1.0F;    ///< largest change of the square; negative: none
  float fraction_units_ = 0.0F;  ///< length - g as a whole number of units and this
  std::int32_t whole_units_ = 0;

  friend struct FieldsOf;
  static constexpr auto fields() noexcept {
    using L = NearLength;
    return field_list(&L::square_m2ps4_, &L::length_mps2_, &L::reach_m2ps4_, &L::fraction_units_, &L::whole_units_);
  }
};

/// All lengths of one block: those of the triples, and that of the estimate of the sensors in service. A function of
/// the block's first readings and of what `take` is given, so that it need not be remembered over a power cycle.
class NearLengths {
 public:
  /// To be called where array, map, frame, gravity or the first readings of the block are others.
  void forget() noexcept { known_ = SensorSet{}; }
  /// Makes it that of a block with these first readings.
  void take(const SensorArray& array, const LeastSquares& map, const Mat3& frame, const BlockAccumulator& block,
            double g_mps2) noexcept;
  /// Whether it was made for the channels that the block has seen.
  bool is_of(const BlockAccumulator& block) const noexcept { return known_ == block.seen(); }
  /// Channels of `usable` whose differences may be taken in single precision.
  static SensorSet near(const Differences& d, SensorSet usable) noexcept;

  /// Error of the length of triple k, whose members have to be near; -1 where single precision does not do.
  std::int32_t triple_units(const SensorArray& array, int k, const Differences& d) const noexcept;

  struct Estimate {
    Vec3 framed_mps2{};       ///< of the sensors in service, in the frame of the output
    std::int32_t units = -1;  ///< error of its length; -1 where single precision does not do
  };
  /// All sensors in service have to be near.
  Estimate estimate(const Differences& d, SensorSet in_service) const noexcept;
  /// Whether all is as `take` left it.
  bool holds() const noexcept;

 private:
  struct Form {
    std::array<float, 6> square{};  ///< of array.form
    std::array<float, 3> slope{};   ///< of the square, at the first readings
    NearLength length;
    static constexpr auto fields() noexcept { return field_list(&Form::square, &Form::slope, &Form::length); }
  };
  std::uint64_t check() const noexcept;

  std::array<Form, kTripleCapacity> triple_{};
  std::array<std::array<float, 3>, kCapacity> column_{};  ///< of the map
  std::array<float, 9> frame_{};
  std::array<float, 3> twice_{};  ///< twice the estimate at the first readings
  NearLength length_;             ///< of that
  SensorSet known_;               ///< channels that the block had seen
  Vec3 framed_mps2_{};            ///< the estimate, in the frame of the output
  std::uint64_t check_ = 0;       ///< sum of the bytes of the others

  friend struct FieldsOf;
  static constexpr auto fields() noexcept {
    using L = NearLengths;
    return field_list(&L::triple_, &L::column_, &L::frame_, &L::twice_, &L::length_, &L::known_, &L::framed_mps2_,
                      &L::check_);
  }
};

}  // namespace PLUMB_ABI
}  // namespace plumb

#endif
