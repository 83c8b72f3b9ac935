/// What distinguishes the three kinds of calibration that `Recalibration` carries out: a fit in flight, the first
/// calibration, one that the host offers. Each answers the same questions; the order of events is the same for all.
///
///   stations_due   stations to be entered before it is tried
///   proves         whether a station is held out of the fit, and proves it
///   prior          of a sensor's parameters; `kHoldsAxes`: its axis is no parameter
///   collect        another sample while stations are collected: begins the fit, or judges where nothing is fitted
///   iterate        one iteration of the fit
///   judge          of a fit that has ended
///   apply          writes what was accepted into model and array
///   resume         after the state has been read back: whether it can have come about
#pragma once

#include "plumb/health/recalibration.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

/// A parameter is observed where the stations, not what was known before, give at least this share of its information:
/// half the sigma of the datasheet, or of the drift.
inline constexpr double kLeastDataShare = 0.75;
/// How seldom the residuals of a good fit may be so large. A refusal costs time only.
inline constexpr double kLeastProbability = 1e-4;

/// Biases and scales of the sensors in service, with the axes held (recalibration_in_flight.cpp).
struct Recalibration::InFlight {
  static constexpr bool kHoldsAxes = true;
  static int stations_due(const Recalibration& r) noexcept { return stations_needed(r.sensors_.size()); }
  static bool proves(int station) noexcept { return StationStore::held_out(station); }
  static Prior prior(const Recalibration& r, const SensorArray&, int i) noexcept {
    return {r.bounds_.sigma(i).bias_mps2, r.bounds_.sigma(i).scale, 0.0, {}, {}};
  }
  static Outcome collect(Recalibration& r, const InForce& in_force, double time_s) noexcept;
  static void iterate(Recalibration& r) noexcept;
  static Outcome judge(Recalibration& r, const InForce& in_force, double time_s) noexcept;
  static void apply(Recalibration& r, const Adoption& into) noexcept;
  static bool resume(Recalibration& r, const InForce& in_force) noexcept;

 protected:
  /// Do the attitudes on record tell bias from scale for every sensor? If not, which sensors ask for others. Of so many
  /// stations the last is held out of the fit; 0: none is.
  static bool ready(Recalibration& r, const InForce& in_force, int held_out) noexcept;

 private:
  static bool uncertainty(const Recalibration& r, const SensorArray& array, const GravityReference& gravity,
                          int held_out, RowUncertainty& out, SensorSet& lacking) noexcept;
  static Error read_fit(Recalibration& r, const InForce& in_force) noexcept;
  static Error try_fit(const Recalibration& r, const InForce& in_force) noexcept;
};

/// All parameters, the datasheet as prior: nothing has been accepted before (recalibration_first.cpp).
struct Recalibration::First {
  static constexpr bool kHoldsAxes = false;
  static int stations_due(const Recalibration& r) noexcept { return first_stations_needed(r.sensors_.size()); }
  static bool proves(int station) noexcept { return StationStore::held_out(station); }
  static Prior prior(const Recalibration&, const SensorArray& array, int i) noexcept { return prior_in(array, i); }
  static Outcome collect(Recalibration& r, const InForce& in_force, double time_s) noexcept;
  static void iterate(Recalibration& r) noexcept;
  static Outcome judge(Recalibration& r, const InForce& in_force, double time_s) noexcept;
  static void apply(Recalibration& r, const Adoption& into) noexcept;
  static bool resume(Recalibration& r, const InForce& in_force) noexcept;

 private:
  static int copy_stations(const Recalibration& r, Stations& out) noexcept;
  static bool attitudes_suffice(Recalibration& r, const SensorArray& array) noexcept;
  static Error check(Recalibration& r, const InForce& in_force) noexcept;
  static Error check_figures(Recalibration& r, const FitReport& report) noexcept;
  static Expected<Calibration> finish(const Recalibration& r) noexcept;
  static Error try_fit(const Recalibration& r, const InForce& in_force, const Calibration& fit) noexcept;
};

/// Biases and scales from elsewhere, held against stations that none of them was made from: nothing is fitted, and
/// every station is a proof (recalibration_offer.cpp).
struct Recalibration::Offered : Recalibration::InFlight {
  static int stations_due(const Recalibration&) noexcept { return kOfferStations; }
  static bool proves(int) noexcept { return true; }
  static Outcome collect(Recalibration& r, const InForce& in_force, double time_s) noexcept;
  static void iterate(Recalibration&) noexcept {}  // there is no fit
  static Outcome judge(Recalibration& r, const InForce& in_force, double time_s) noexcept;
  static void apply(Recalibration& r, const Adoption& into) noexcept;
  static bool resume(Recalibration& r, const InForce& in_force) noexcept;

 private:
  static Error try_offer(const Recalibration& r, const InForce& in_force) noexcept;
};

/// Where an offer is as a fit in flight: both hold the axes.
template <class F>
auto Recalibration::by_parameters(F&& f) const noexcept {
  return first() ? f(First{}) : f(InFlight{});
}

template <class F>
auto Recalibration::by_kind(F&& f) const noexcept {
  if (first()) return f(First{});
  return offered() ? f(Offered{}) : f(InFlight{});
}

}  // namespace PLUMB_ABI
}  // namespace plumb
