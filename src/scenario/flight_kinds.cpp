#include <cmath>

#include "flight_motion.hpp"
#include "plumb/core/units.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace scenario {
namespace {

/// Share of the mean square of the vibration that stands in tones, their number, and their frequencies.
struct Spectrum {
  double in_tones = 0.8;
  int tones = 4;
  double low_hz = 60.0, high_hz = 250.0;
  Vec3 shape{1.0, 1.0, 1.0};  ///< of the directions
};

/// A wandering tone leaves its frequency by up to 6 %.
constexpr double kWander = 1.06;

Vec3 shaped_direction(Draws& draws, const Vec3& shape) {
  const Vec3 way = draws.direction();
  const Vec3 v = {way[0] * shape[0], way[1] * shape[1], way[2] * shape[2]};
  const double length = norm(v);
  return length > 0.0 ? scaled(v, 1.0 / length) : Vec3{1.0, 0.0, 0.0};
}

/// Tones and broadband noise whose vectors together have this root of the mean square.
void add_vibration(MotionLaw& law, Draws& draws, double rms_mps2, const Spectrum& spectrum) {
  std::vector<double> share;
  double sum = 0.0;
  for (int k = 0; k < spectrum.tones; ++k) {
    share.push_back(draws.uniform(0.2, 1.0));
    sum += share.back();
  }
  for (const double part : share) {
    Tone tone;
    const double amplitude = rms_mps2 * std::sqrt(2.0 * spectrum.in_tones * part / sum);
    tone.frequency_hz = draws.log_uniform(spectrum.low_hz * kWander, spectrum.high_hz / kWander);
    tone.amplitude = scaled(shaped_direction(draws, spectrum.shape), amplitude);
    law.tones.push_back(tone);
  }
  law.broadband_mps2 = scaled(spectrum.shape, rms_mps2 * std::sqrt(1.0 - spectrum.in_tones) / norm(spectrum.shape));
}

/// Angular vibration that shakes a sensor at 30 mm with this rms at most.
void add_angular_vibration(MotionLaw& law, Draws& draws, double rms_at_30mm_mps2, double low_hz, double high_hz) {
  Tone tone;
  tone.wanders = false;
  tone.frequency_hz = draws.uniform(low_hz, high_hz);
  const double rms_radps2 = rms_at_30mm_mps2 / 0.03;
  const double amplitude = std::sqrt(2.0) * rms_radps2 / (2.0 * kPi * tone.frequency_hz);
  tone.amplitude = scaled(draws.direction(), amplitude);
  law.angular_tones.push_back(tone);
}

/// A slow rocking about one horizontal axis of the tool.
void add_rocking(MotionLaw& law, Draws& draws, std::size_t axis, double angle_rad, double low_hz, double high_hz) {
  Tone tone;
  tone.wanders = false;
  tone.frequency_hz = draws.uniform(low_hz, high_hz);
  tone.amplitude[axis] = 2.0 * kPi * tone.frequency_hz * angle_rad;
  law.angular_tones.push_back(tone);
}

Glide::Law levels(double low, double high) {
  return [low, high](std::uint64_t, Draws& draws) {
    return GlideStep{{draws.uniform(low, high), 0.0, 0.0}, draws.uniform(0.3, 1.0), draws.uniform(0.0, 2.0)};
  };
}

/// Turns about random axes, up to a rate.
Glide::Law turns(double most_radps, double shortest_s, double longest_s) {
  return [=](std::uint64_t, Draws& draws) {
    const double rate = most_radps * std::sqrt(draws.uniform(0.0, 1.0));
    return GlideStep{scaled(draws.direction(), rate), draws.uniform(shortest_s, longest_s), draws.uniform(0.0, 0.3)};
  };
}

MotionLaw draw_drone(Draws& draws) {
  MotionLaw law;
  law.force_mps2 = {0.0, 0.0, kG0_mps2};
  law.force = [](std::uint64_t, Draws& d) {
    const double thrust = d.log_uniform(0.32, 2.45) * kG0_mps2;
    const double side = 0.15 * kG0_mps2;
    const Vec3 level = {d.uniform(-side, side), d.uniform(-side, side), thrust};
    return GlideStep{level, d.uniform(0.15, 0.8), d.uniform(0.0, 0.5)};
  };
  const double most_radps = rad_from_deg(draws.uniform(60.0, 290.0));
  law.rate_radps = scaled(draws.direction(), 0.1 * most_radps);
  law.rate = turns(most_radps, 0.2, 0.8);
  law.vibration = levels(0.7, 1.0);
  const double rms_mps2 = draws.log_uniform(0.7, 5.0) * kG0_mps2;
  Spectrum spectrum;
  spectrum.in_tones = draws.uniform(0.6, 0.95);
  spectrum.tones = 3 + static_cast<int>(draws.uniform(0.0, 3.999));
  add_vibration(law, draws, rms_mps2, spectrum);
  add_angular_vibration(law, draws, draws.uniform(0.0, 0.12) * kG0_mps2, 110.0, 250.0);
  return law;
}

MotionLaw draw_drilling(Draws& draws) {
  MotionLaw law;
  law.gravity = true;
  law.up = draws.direction();
  const double most_radps = draws.uniform(60.0, 180.0) * 2.0 * kPi / 60.0;
  law.rate_radps = {0.0, 0.0, 0.2 * most_radps};
  law.rate = [most_radps](std::uint64_t, Draws& d) {
    const bool stops = d.uniform(0.0, 1.0) < 0.2;
    const double rate = stops ? 0.0 : d.uniform(0.3, 1.0) * most_radps;
    return GlideStep{{0.0, 0.0, rate}, d.uniform(0.5, 2.0), d.uniform(0.5, 3.0)};
  };
  law.force = [](std::uint64_t, Draws& d) {
    return GlideStep{{0.0, 0.0, d.uniform(-0.2, 0.2) * kG0_mps2}, d.uniform(0.3, 1.0), d.uniform(0.0, 2.0)};
  };
  law.vibration = levels(0.3, 1.0);
  Spectrum spectrum;
  spectrum.in_tones = draws.uniform(0.3, 0.7);
  spectrum.low_hz = 10.0;
  spectrum.shape = {1.0, 1.0, 0.3};
  add_vibration(law, draws, draws.log_uniform(1.0, 3.0) * kG0_mps2, spectrum);
  for (const std::size_t axis : {std::size_t{0}, std::size_t{1}}) {
    add_rocking(law, draws, axis, rad_from_deg(draws.uniform(0.0, 0.1)), 2.0, 10.0);
  }
  law.shocks = {true, {0.05, 1.0}, {0.5e-3, 2e-3}, {5.0 * kG0_mps2, 30.0 * kG0_mps2}, {1.0, 1.0, 0.3}};
  return law;
}

MotionLaw draw_car(Draws& draws) {
  MotionLaw law;
  law.gravity = true;
  law.force = [](std::uint64_t, Draws& d) {
    const Vec3 way = shaped_direction(d, {1.0, 1.0, 0.0});
    const double size = kG0_mps2 * std::sqrt(d.uniform(0.0, 1.0));
    return GlideStep{scaled(way, size), d.uniform(0.3, 1.5), d.uniform(0.0, 2.0)};
  };
  const double most_radps = rad_from_deg(draws.uniform(10.0, 36.0));
  law.rate = [most_radps](std::uint64_t, Draws& d) {
    return GlideStep{{0.0, 0.0, d.uniform(-most_radps, most_radps)}, d.uniform(0.5, 2.0), d.uniform(0.0, 2.0)};
  };
  law.vibration = levels(0.5, 1.0);
  Spectrum spectrum;
  spectrum.in_tones = draws.uniform(0.2, 0.6);
  spectrum.low_hz = 20.0;
  spectrum.high_hz = 120.0;
  add_vibration(law, draws, draws.log_uniform(0.04, 0.3) * kG0_mps2, spectrum);
  for (const std::size_t axis : {std::size_t{0}, std::size_t{1}}) {
    add_rocking(law, draws, axis, rad_from_deg(draws.uniform(0.1, 0.5)), 0.5, 2.0);
  }
  law.shocks = {true, {0.3, 4.0}, {10e-3, 60e-3}, {0.5 * kG0_mps2, 2.0 * kG0_mps2}, {0.2, 0.2, 1.0}};
  return law;
}

/// Stage after stage: ignition, the burn in which the force rises, the fall at its end.
MotionLaw draw_launch(Draws& draws) {
  MotionLaw law;
  law.force_mps2 = {0.0, 0.0, kG0_mps2};
  law.force = [](std::uint64_t number, Draws& d) {
    const double side = 0.2 * kG0_mps2;
    Vec3 level = {d.uniform(-side, side), d.uniform(-side, side), 0.0};
    if (number % 3 == 0) {
      level[2] = d.uniform(1.2, 2.0) * kG0_mps2;
      return GlideStep{level, d.uniform(0.3, 0.8), 0.0};
    }
    if (number % 3 == 1) {
      level[2] = d.uniform(5.0, 8.0) * kG0_mps2;
      return GlideStep{level, d.uniform(4.0, 10.0), d.uniform(0.0, 1.0)};
    }
    level[2] = d.uniform(0.1, 0.5) * kG0_mps2;
    return GlideStep{level, d.uniform(0.1, 0.4), d.uniform(0.5, 1.5)};
  };
  const double roll_radps = rad_from_deg(draws.uniform(20.0, 175.0));
  law.rate = [roll_radps](std::uint64_t, Draws& d) {
    const double side = rad_from_deg(10.0);
    const Vec3 level = {d.uniform(-side, side), d.uniform(-side, side), d.uniform(-roll_radps, roll_radps)};
    return GlideStep{level, d.uniform(0.5, 2.0), d.uniform(0.0, 3.0)};
  };
  law.vibration = levels(0.5, 1.0);
  Spectrum spectrum;
  spectrum.in_tones = draws.uniform(0.2, 0.6);
  spectrum.low_hz = 20.0;
  add_vibration(law, draws, draws.log_uniform(1.0, 5.0) * kG0_mps2, spectrum);
  add_angular_vibration(law, draws, draws.uniform(0.0, 0.06) * kG0_mps2, 110.0, 250.0);
  law.shocks = {true, {2.0, 8.0}, {0.5e-3, 2e-3}, {10.0 * kG0_mps2, 30.0 * kG0_mps2}, {1.0, 1.0, 1.0}};
  return law;
}

}  // namespace

MotionLaw draw_motion(FlightKind kind, std::uint64_t seed) {
  Draws draws(flight_stream_of(seed, flight_stream::kCourse));
  switch (kind) {
    case FlightKind::drone: return draw_drone(draws);
    case FlightKind::drilling: return draw_drilling(draws);
    case FlightKind::car: return draw_car(draws);
    case FlightKind::launch: return draw_launch(draws);
  }
  return draw_drone(draws);
}

const char* to_string(FlightKind kind) noexcept {
  switch (kind) {
    case FlightKind::drone: return "drone";
    case FlightKind::drilling: return "drilling";
    case FlightKind::car: return "car";
    case FlightKind::launch: return "launch";
  }
  return "?";
}

}  // namespace scenario
}  // namespace PLUMB_ABI
}  // namespace plumb
