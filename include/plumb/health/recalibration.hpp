/// In-flight recalibration: biases and scales of the sensors in service are estimated anew in the shadow of
/// the calibration in force; axes and temperature coefficients are held. Axes stay those of the commissioning
/// calibration because gravity cannot tell a common turn of the axes from none: a fit that is free to turn them
/// launders a shifted mount, one with frozen axes shows it in the parity residual (docs/theory.md, section 9.8).
/// A calibration that the host brings goes the same way, with its biases and scales in the place of the fitted ones.
///
/// The first calibration of a monitor that was given none goes the same way too, but is a full fit: axes, scales and
/// biases, the datasheet as prior, the axes turned onto the datasheet's (recalibration_first.cpp). What it cannot see
/// is reported in docs/guide.md: a constant error of a sensor is what it takes off.
#pragma once

#include <array>
#include <cstdint>

#include "plumb/calibration/calibration.hpp"
#include "plumb/detection/set_test.hpp"
#include "plumb/health/detail/drift_bounds.hpp"
#include "plumb/health/detail/offered_calibration.hpp"
#include "plumb/health/detail/station_store.hpp"
#include "plumb/health/recalibration_progress.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

class Recalibration {
 public:
  /// What the fit is made and judged with: the calibration in force.
  struct InForce {
    const SensorModel& model;
    const SensorArray& array;
    const GravityReference& gravity;
    const TestLimits& limits;
  };
  enum class Outcome : std::uint8_t { none, accepted, rejected };

  static constexpr int kHeldOutNeeded = 2;
  /// A calibration that was offered is tried at so many stations, all of them visited after the offer: none can have
  /// made it from them.
  static constexpr int kOfferStations = 8;

  /// The first calibration: part of what the datasheet leaves open that the stations must have settled, for every
  /// parameter; how far a parameter may be from the datasheet [its sigmas]; how well the attitudes must tell the nine
  /// harmonics apart (`excitation_of`: 0.01 for a half sphere, below 2e-4 for a band of 5 deg about one plane).
  static constexpr double kFirstSigmas = 5.0;
  static constexpr double kFirstExcitation = 2e-3;
  /// The uncertainty of a datasheet is taken for small: tests and covariances are linear in it.
  static constexpr double kLeastOpen = 1e-6;  ///< m/s^2, relative, rad: less is no prior but a claim to know
  static constexpr Prior kMostOpen = {0.1 * kG0_mps2, 0.1, 0.1, {}, {}};

  /// Remembers the commissioning calibration. Empties everything. `first`: there is none, `commissioning` is the
  /// datasheet; the calibration that is adopted first becomes the commissioning one.
  void configure(const SensorModel& commissioning, const std::array<DriftSigmas, kCapacity>& drift,
                 double same_attitude_rad, bool first = false) noexcept;

  // ---- The store
  /// A block that was clean, of a station that has just begun or goes on. Ignored while a fit runs over the store.
  void add_block(const StationMean& block, bool station_begins) noexcept;
  void drop_last() noexcept { store_.drop_last(); }
  void forget() noexcept;  ///< every station, and the fit over them
  const StationStore& store() const noexcept { return store_; }

  // ---- What the host offers
  /// Not while a fit is made. Takes biases and scales of `sensors` from another calibration, for the next `start` to
  /// try in place of a fit. Axes and temperature coefficients stay those in force, at whose reference temperatures it
  /// is read. Errors: not_calibrated (its size, or misalignment terms in the model); implausible (index = sensor,
  /// value, limit): an axis further off than `OfferedCalibration::kAxis_rad` says [rad], a bias or a scale beyond the
  /// bounds of a fit [drift sigmas], a sigma of either that is not above zero or beyond the drift sigma [drift sigmas].
  Expected<void> offer(const InForce& in_force, const SensorModel& model, const SensorArray& array, SensorSet sensors,
                       double time_s) noexcept;
  /// An offer that has not been started lapses; `last_refusal` is then wrong_state.
  void withdraw_offer() noexcept;
  bool offered() const noexcept { return kRecalibrates && offer_.any(); }  ///< waiting or on trial

  // ---- The fit
  void start(SensorSet sensors) noexcept;
  void stop() noexcept;  ///< discards the fit and every station: none is tried twice
  /// At most one Calibrator iteration, or one judgement. `accepted` is repeated until `apply` or `stop`, `rejected`
  /// until the next `start`.
  Outcome step(const InForce& in_force, double time_s) noexcept;
  /// Writes the accepted fit into model and array, both those that were in force when it was made: coefficients of the
  /// fitted sensors, and the uncertainty that the fit and the held axes leave. `doubted`: the fit was asked for because
  /// the length of gravity was off, and the sensors need not be faulty; then the whole change counts as one more
  /// uncertainty, of 1 sigma, so that limits and protection level cover both readings of it. Of an offer the part of
  /// the change that parity cannot see counts so: the length alone has tried it. Stops.
  void apply(SensorModel& model, SensorArray& array, const GravityReference& gravity, double time_s,
             bool doubted) noexcept;

  SensorSet sensors() const noexcept { return sensors_; }
  bool first() const noexcept { return kCalibratesItself && first_; }  ///< no calibration has been accepted yet
  bool adopted() const noexcept { return bounds_.adopted(); }  ///< a fit in flight, since the commissioning calibration
  bool collects(SensorSet sensors) const noexcept { return phase_ != RecalibrationPhase::idle && sensors_ == sensors; }
  const DriftBounds& bounds() const noexcept { return bounds_; }
  /// Started, and its end has not been heard: a step will tell it.
  bool under_way() const noexcept { return phase_ != RecalibrationPhase::idle || refusal_.code != Errc::ok; }
  RecalibrationProgress progress(const SensorArray& array) const noexcept;
  std::uint32_t iterations() const noexcept { return iterations_; }  ///< of all fits since `configure`
  /// Stations to be entered before a fit over n sensors is tried, those held out among them.
  static int stations_needed(int n) noexcept;

  /// After its state has been read back. False where it cannot have come about under `in_force`, which must then not be
  /// used: coefficients beyond the bounds of a fit, or a fit over nothing.
  bool resume(const InForce& in_force) noexcept;

  /// Stations to be entered before the first fit over n sensors is tried, those held out among them.
  static int first_stations_needed(int n) noexcept;
  /// How far one calibration is from a datasheet with that array's uncertainty: `implausible` (index = sensor) beyond
  /// kFirstSigmas of a bias, a scale or an axis.
  static Error off_datasheet(const SensorModel& datasheet, const SensorArray& uncertain, const SensorModel& model,
                             const SensorArray& array, SensorSet sensors) noexcept;

 private:
  struct ReadingError {
    double noise_mps2_sq = 0.0, total_mps2_sq = 0.0;
  };
  using Stations = std::array<Station, StationStore::kMax>;

  /// The three kinds: each answers the same questions (src/health/recalibration_kinds.hpp).
  struct InFlight;
  struct First;
  struct Offered;
  template <class F>
  auto by_kind(F&& f) const noexcept;
  template <class F>
  auto by_parameters(F&& f) const noexcept;
  /// Where an accepted calibration goes.
  struct Adoption {
    SensorModel& model;
    SensorArray& array;
    const GravityReference& gravity;
    double time_s;
    bool doubted;
  };

  int stations_due() const noexcept;
  bool stations_suffice() const noexcept { return sensors_.size() >= 3 && store_.size() >= stations_due(); }
  StationList fit_stations() const noexcept;
  void begin_fit(const InForce& in_force, const FitOptions& options) noexcept;
  Datasheet datasheet(const InForce& in_force) const noexcept;
  ReadingError reading_error(const SensorArray& array, const GravityReference& gravity, int i) const noexcept;
  Outcome accept() noexcept;
  Outcome reject(const Error& why) noexcept;
  Error check_stations(const InForce& candidate, const RowUncertainty& uncertainty) const noexcept;
  Error try_change(const InForce& in_force, const RowUncertainty& uncertainty) const noexcept;
  Error check_bounds(const SensorModel& model, double time_s) const noexcept {
    return bounds_.check(change_, sensors_, model, time_s);
  }
  /// After it has been read back: within the bounds at some time, and its covariance not made smaller.
  bool change_is_sound(const SensorModel& model) const noexcept;
  void adopt_change(const Adoption& into, const RowUncertainty& uncertainty) noexcept;
  Vec3 wanted_direction(const SensorArray& array) const noexcept;

  StationStore store_;
  DriftBounds bounds_;
  CoefficientChange change_;  ///< fitted or offered, of `sensors_`
  double inflation_ = 1.0;    ///< of the fit's covariance: chi^2 per degree of freedom and F, at least 1
  bool untried_ = false;      ///< the store has changed since the last fit
  bool first_ = false;
  RecalibrationPhase phase_ = RecalibrationPhase::idle;
  SensorSet sensors_, lacking_;
  std::uint32_t iterations_ = 0;
  Error refusal_;
  OfferedCalibration offer_;
  Calibrator calibrator_;

  friend struct FieldsOf;
  bool fitting() const noexcept { return phase_ == RecalibrationPhase::fitting; }
  bool keeps_fit() const noexcept { return fitting() || (first() && phase_ == RecalibrationPhase::accepted); }
  static constexpr auto fields() noexcept {
    using R = Recalibration;
    return field_list(&R::store_, &R::bounds_, &R::change_, any(&R::inflation_), &R::untried_, &R::first_,
                      up_to(&R::phase_, RecalibrationPhase::accepted), &R::sensors_, &R::lacking_, &R::iterations_,
                      &R::refusal_, &R::offer_, stored_if<kRecalibrates>(only_when(&R::calibrator_, &R::keeps_fit)));
  }
};

}  // namespace PLUMB_ABI
}  // namespace plumb
