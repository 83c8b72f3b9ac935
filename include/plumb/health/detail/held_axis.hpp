/// What a fit of biases and scales leaves where the axes are held: its own noise, and what the error of the held
/// axes does to it.
#pragma once

#include <array>

#include "plumb/array/sensor_array.hpp"
#include "plumb/core/detail/station_mean.hpp"
#include "plumb/gravity/gravity.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

/// 1 sigma of what was known of a sensor before the fit.
struct HeldPrior {
  double bias_mps2 = 0.0;
  double scale = 0.0;  ///< relative
};

struct HeldAxisFit {
  SensorSet sensors;                     ///< the fitted ones
  const StationMean* station = nullptr;  ///< those of the fit, for their directions of gravity
  int count = 0;
  int left_out = 0;                            ///< of so many stations the last is no part of the fit; 0: all are
  std::array<double, kCapacity> sigma_mps2{};  ///< of a station's reading, per sensor of the array: gave the weights
  double noise_share = 1.0;  ///< of sigma^2 that is drawn anew at every station, at most; the rest are the held axes
  std::array<HeldPrior, kCapacity> prior{};  ///< bias and scale that went into the fit; both above zero
  double inflation = 1.0;                    ///< of the fit's own covariance
};

/// New uncertainty = T old T' + fit. T keeps the part of every axis error across its axis, drops the old bias and
/// scale, and adds how far a wrong held axis bends the fitted ones: -(F'MF + P)^-1 F'M A with F and A the rows of
/// fitted and held parameters, M the information of a station less the two directions that gravity itself takes
/// (consider covariance: Schmidt 1966, Bierman 1977 ch. VIII). A wrong length of gravity is a common scale,
/// but for what the prior keeps of the old one; that part ends in the biases and turns the vector. The old length may
/// have been wrong too, independently. `data_share[i]`: the lesser share of what bias and scale of sensor i owe to the
/// stations, 1 = all, 0 = all from the prior. False where the information is not positive definite; `uncertainty` is
/// then left alone; it must not be the array's own.
bool held_axis_uncertainty(const SensorArray& array, const GravityReference& gravity, const HeldAxisFit& fit,
                           RowUncertainty& uncertainty, std::array<double, kCapacity>& data_share) noexcept;

}  // namespace PLUMB_ABI
}  // namespace plumb
