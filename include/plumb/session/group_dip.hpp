/// Gravity and the magnetic field of one tool, held against the dip that is expected where it is, block by block.
///
/// Where both groups check themselves their directions are compared (docs/theory.md, section 1.7). Where three
/// accelerometers are left the dip is their second reference beside the length of gravity (T16, `DipWatch`).
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "plumb/health/dip_watch.hpp"
#include "plumb/session/group_track.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace session {

/// Standard deviations of the reference that are allowed: two-sided, 1e-5.
inline constexpr double kDipSigmas = 4.42;

/// Of a run: |asin(g.b) - dip| <= bound of g + bound of b + kDipSigmas sigma.
struct DipCheck {
  int checked = 0;                         ///< blocks of the field that met one of gravity, both directions usable
  int disagreeing = 0;                     ///< of those: further off than is allowed
  double least_rad = 0.0, most_rad = 0.0;  ///< the dips measured
  double worst_excess_rad = 0.0;           ///< beyond what is allowed
  double widest_allowed_rad = 0.0;
  double first_s = 0.0;  ///< of the first that disagrees

  /// Takes the block in. True: it disagrees; so does a direction that is not a number.
  bool add(const TrackPoint& gravity, const TrackPoint& field, const io::MagneticReference& reference);
};

/// Of a run: what the dip said of three accelerometers.
struct DipOfThree {
  int judged = 0, faulty = 0;  ///< blocks; of those with no explanation without a fault
  int protected_by_dip = 0;    ///< blocks whose bound is made with the dip
  double first_fault_s = 0.0;
  SensorSet named;  ///< at any time
  DipReport last;   ///< of the last block that was judged
};

enum class DipEventKind : std::uint8_t { disagree, agree, judged };

/// Something that the dip says has changed at this block.
struct DipEvent {
  DipEventKind kind = DipEventKind::agree;
  double time_s = 0.0;
  double dip_rad = 0.0, allowed_rad = 0.0;  ///< of `disagree` and `agree`
  DipAnswer answer;                         ///< of `judged`
};

class GroupDip final : public VerdictNote {
 public:
  using Sink = std::function<io::FileExpected<void>(const DipEvent&)>;

  /// `group` states a dip. Neither is copied.
  GroupDip(const io::ArrayFile& tool, const io::ArrayFile& group);
  /// Three accelerometers are judged too: those of this monitor, which outlives this.
  void judge(const HealthMonitor& monitor, std::unique_ptr<MonitorSetup> setup);
  void tell(Sink sink) { sinks_.push_back(std::move(sink)); }

  /// Blocks of gravity and of the field, as they end; those of one time in either order.
  TrackListener& gravity() noexcept { return gravity_side_; }
  TrackListener& field() noexcept { return field_side_; }
  void append(const Verdict& verdict, std::string& object) const override;

  const io::ArrayFile& group() const noexcept { return group_; }
  const DipCheck& check() const noexcept { return check_; }
  const DipOfThree& of_three() const noexcept { return three_; }
  /// Why neither direction is to be relied on; empty: nothing.
  std::string doubt() const;

 private:
  struct Side final : TrackListener {
    explicit Side(GroupDip& all, bool is_field) : dip(all), field(is_field) {}
    io::FileExpected<void> rested(const TrackPoint& block) override { return dip.take(block, field); }
    GroupDip& dip;
    bool field;
  };

  io::FileExpected<void> take(const TrackPoint& block, bool is_field);
  io::FileExpected<void> compare();
  io::FileExpected<void> judge_three(const TrackPoint& gravity);
  io::FileExpected<void> put(const DipEvent& event);

  const io::ArrayFile& tool_;
  const io::ArrayFile& group_;
  Side gravity_side_{*this, false}, field_side_{*this, true};
  std::vector<Sink> sinks_;
  std::optional<TrackPoint> last_gravity_, last_field_;
  bool waiting_ = false;  ///< the last block of the field has met none of gravity yet
  bool disagree_ = false;
  DipCheck check_;
  const HealthMonitor* monitor_ = nullptr;
  std::unique_ptr<MonitorSetup> setup_;
  DipWatch watch_;
  double now_s_ = 0.0;
  DipOfThree three_;
};

/// One line of JSON, without a newline.
std::string dip_event_json(const DipEvent& event, const io::ArrayFile& group, const SensorArray& accelerometers);

}  // namespace session
}  // namespace PLUMB_ABI
}  // namespace plumb
