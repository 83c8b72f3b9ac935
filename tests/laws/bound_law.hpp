/// What laws 11 and 12 ask of a tool under an influence that its limits allow for: at station after station nobody
/// healthy is blamed, a healthy tool raises no alarm, and where a vector is published it is within its protection
/// level.
#pragma once

#include <algorithm>
#include <string>

#include "laws/law_run.hpp"

namespace plumb_test {
inline namespace PLUMB_ABI {

/// Alarms as rare as rejections: noise of the laws is shorter than every limit, so that none alarms by itself.
inline plumb::MonitorConfig as_rare_as_rejections() {
  plumb::MonitorConfig config;
  config.false_alarm_rate = config.rejection_rate;
  return config;
}

class BoundLaw {
 public:
  /// Of which vectors the bound is put to the test: those that may be used, or the unconfirmed ones too.
  enum class Tried { usable, unconfirmed_too };

  explicit BoundLaw(Tried tried) : tried_(tried) {}

  /// Six stations of one case: `read(direction)` is what the sensors say there, `influence` is how a broken case calls
  /// what they are under.
  template <class Read>
  LawOutcome visit(Watch& watch, const LawTool& tool, const LawCase& c, TrialNoise& noise, const std::string& influence,
                   Read&& read) {
    bool published = false;
    for (int k = 0; k < 6; ++k) {
      const plumb::Vec3 direction = noise.direction();
      const plumb::Verdict& v = watch.station(read(direction));
      published = published || is_tried(v);
      const std::string wrong = wrong_with(v, tool, c.faulty(), direction);
      if (wrong.empty()) continue;
      return LawOutcome{
          true,
          "of " + std::to_string(tool.n()) + " sensors " + influence + ": " + wrong + "; station " + std::to_string(k),
          {tool.n(), c.faulty().size(), k}};
    }
    published_ += published ? 1U : 0U;
    return LawOutcome{};
  }

  /// That no case is broken, that at least `share` of them published a vector, and that the influence reached `reach`
  /// of a bound: a law over cases that are far from it shows nothing.
  void conclude(int law, const LawCount& count, double share, double reach) const {
    std::printf(
        "law %d: published in %llu cases, the bound put to the test at %llu stations; the largest error was %.4f "
        "of its bound\n",
        law, static_cast<unsigned long long>(published_), static_cast<unsigned long long>(stations_), nearest_);
    EXPECT_EQ(count.broken, 0U);
    if (count.cases < 100) return;  // PLUMB_LAW_CASE asks for one
    EXPECT_GT(static_cast<double>(published_), share * static_cast<double>(count.cases))
        << "what is never published is within every bound";
    EXPECT_GT(nearest_, reach) << "the influence must reach what the bound allows for";
  }

 private:
  bool is_tried(const plumb::Verdict& v) const {
    if (!v.protection_available) return false;
    using plumb::Validity;
    if (v.validity == Validity::unconfirmed) return tried_ == Tried::unconfirmed_too;
    return v.validity == Validity::valid || v.validity == Validity::degraded;
  }

  /// Who is blamed that is healthy, or how far the vector is beyond its level; else empty.
  std::string wrong_with(const plumb::Verdict& v, const LawTool& tool, plumb::SensorSet faulty,
                         const plumb::Vec3& direction) {
    const int faults = faulty.size();
    if (!faulty.contains(v.excluded)) return names_of(v.excluded) + " are out";
    if (faults <= tool.parity() && !faulty.contains(v.provisionally_excluded))
      return names_of(v.provisionally_excluded) + " are provisionally excluded";
    if (faults == 0 && !(v.margin >= 0.0)) return std::string("an alarm, ") + plumb::to_string(v.cause);
    if (!is_tried(v) || faults > 1) return "";  // the level is of one fault, by the priors of the default configuration
    ++stations_;
    const double error = plumb::angle_between_rad(v.gravity_mps2, direction);
    nearest_ = std::max(nearest_, error / v.protection_level_calibrated_axes_rad);
    if (error <= v.protection_level_calibrated_axes_rad) return "";
    return "tilted by " + std::to_string(1e3 * error) + " mrad, bound " +
           std::to_string(1e3 * v.protection_level_calibrated_axes_rad);
  }

  Tried tried_;
  std::uint64_t published_ = 0;  ///< cases with a vector that was tried
  std::uint64_t stations_ = 0;   ///< at which one was
  double nearest_ = 0.0;         ///< largest error in parts of its bound
};

}  // namespace PLUMB_ABI
}  // namespace plumb_test
