/// How a flight moves, from instant to instant: smooth courses, tones, broadband vibration, shocks (private to
/// src/scenario).
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include "flight_random.hpp"
#include "plumb/core/config.hpp"
#include "plumb/core/vec3.hpp"
#include "plumb/scenario/flight.hpp"
#include "plumb/scenario/portable_math.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace scenario {

/// A course from level to level: to the next one within `glide_s` along a polynomial of degree five, at rest at both
/// ends in its first two derivatives; there it stays for `hold_s`.
struct GlideStep {
  Vec3 level{};
  double glide_s = 1.0;
  double hold_s = 0.0;
};

class Glide {
 public:
  using Law = std::function<GlideStep(std::uint64_t number, Draws& draws)>;
  /// At `start` until `start_s` [s], then by the law.
  Glide(const Vec3& start, double start_s, const Stream& stream, Law law);

  struct Place {
    Vec3 value{};
    Vec3 slope{};  ///< per second
  };
  /// Times must not decrease from call to call.
  Place at(double time_s);

 private:
  Draws draws_;
  Law law_;
  std::uint64_t number_ = 0;
  Vec3 from_, way_{};
  double begin_s_ = 0.0, glide_s_ = 1.0, end_s_;
};

/// A sine along `amplitude`. Where it wanders, its frequency does so within 6 %, by steps between blocks of instants.
struct Tone {
  Vec3 amplitude{};
  double frequency_hz = 100.0;
  bool wanders = true;
};

/// Half-sines.
struct ShockLaw {
  bool any = false;
  std::array<double, 2> gap_s{}, duration_s{}, peak_mps2{};
  Vec3 shape{1.0, 1.0, 1.0};  ///< how much of a random direction goes along each axis
};

/// What is drawn once per flight.
struct MotionLaw {
  bool gravity = false;    ///< the force is on top of gravity, which turns in the tool frame
  Vec3 up{0.0, 0.0, 1.0};  ///< at the start
  Vec3 force_mps2{};       ///< at the start
  Glide::Law force;
  Vec3 rate_radps{};  ///< at the start
  Glide::Law rate;
  double level = 0.3;               ///< of the vibration, at the start
  Glide::Law vibration;             ///< its level, 0 to 1, stands in the first component
  std::vector<Tone> tones;          ///< amplitudes in m/s^2, at level 1
  std::vector<Tone> angular_tones;  ///< of the angular rate, in rad/s, at level 1
  Vec3 broadband_mps2{};            ///< rms by axis, at level 1
  std::array<double, 2> band_hz{30.0, 400.0};
  ShockLaw shocks;
};
MotionLaw draw_motion(FlightKind kind, std::uint64_t seed);

/// The motion of the reference point and of the tool at one instant, tool frame.
struct MotionInstant {
  Vec3 specific_force_mps2{};
  Vec3 rate_radps{};
  Vec3 angular_acceleration_radps2{};
};

class Motion {
 public:
  /// Instants `step_s` apart; the moderate beginning ends between 1 and 2 s after `start_s`. `vibration`: factor on all
  /// of it.
  Motion(FlightKind kind, std::uint64_t seed, double step_s, double start_s, double vibration);
  MotionInstant next();

 private:
  struct Turning {
    Tone tone;
    NormalSource wander_draws;
    double wander = 0.0, phase_rad = 0.0, step_rad = 0.0;
    SinCos now{}, step{};  ///< of the phase, and of its change per instant
  };
  class Band {
   public:
    Band(const Stream& stream, double rms, const std::array<double, 2>& band_hz, double step_s);
    double next() noexcept;

   private:
    NormalSource draws_;
    double gain_, fast_share_, slow_share_;
    double fast_ = 0.0, slow_ = 0.0;
  };
  struct Shock {
    double begin_s = 0.0, end_s = 0.0;
    Vec3 peak_mps2{};
  };

  void start_block() noexcept;
  void draw_shock(double after_s) noexcept;
  void turn_gravity(const Vec3& rate_radps) noexcept;
  Vec3 vibration_force(double time_s, double level);

  double step_s_;
  double factor_;
  MotionLaw law_;
  Glide force_, rate_, level_;
  std::vector<Turning> tones_, angular_tones_;
  std::vector<Band> bands_;
  Draws shock_draws_;
  Shock shock_;
  Vec3 up_;
  Vec3 last_rate_radps_;
  std::uint64_t instant_ = 0;
};

}  // namespace scenario
}  // namespace PLUMB_ABI
}  // namespace plumb
