/// The way of the rows from the tool to the monitor: rows are lost, come twice, in another order, with other times.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <vector>

#include "plumb/core/config.hpp"
#include "plumb/core/sample.hpp"
#include "plumb/health/rotation.hpp"
#include "plumb/motion/motion_clocks.hpp"
#include "plumb/scenario/fault.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace scenario {

/// Takes rows in the order in which they were measured and gives them in the order in which they arrive. Faults that
/// are not of the delivery are passed over, so the whole list of a scenario may be given.
class Delivery {
 public:
  /// What a row of a log says beside its sample.
  struct Beside {
    double depth_m = std::numeric_limits<double>::quiet_NaN();  ///< measured depth; NaN: not said
    Rotation rotation;
    Rotation second_rotation{};  ///< by the second gyro
    /// By the clocks of chips that have their own, one a [[clock]] of the array file; it means nothing here.
    std::array<double, static_cast<std::size_t>(kMotionClocks)> clock_s{};
  };
  struct Parcel {
    Sample sample;
    std::uint64_t row = 0;  ///< as measured, counted from 0
    Beside beside;
  };

  Delivery() = default;
  Delivery(std::vector<Fault> faults, std::uint64_t seed);

  /// False: what goes in comes out, one by one.
  bool any() const noexcept { return any_; }

  /// `now` is where in the log the row was measured.
  void push(const Sample& sample, const Moment& now) { push(sample, now, Beside{}); }
  void push(const Sample& sample, const Moment& now, const Beside& beside);
  /// After the last row: what is still held back will not get any later.
  void finish();
  /// The next row that arrives; false where there is none yet.
  bool pop(Parcel& parcel);

  /// Delivery faults that no row has shown yet, as positions in the list.
  std::vector<int> without_effect() const;

 private:
  struct Held {
    Parcel parcel;
    std::uint64_t wait = 0;  ///< rows to come before it
  };
  std::vector<Fault> faults_;
  std::vector<bool> effective_;
  std::uint64_t seed_ = 0;
  bool any_ = false;
  bool first_of_pair_ = true;
  std::vector<Held> held_;
  std::vector<Parcel> ready_;
  std::size_t taken_ = 0;
};

}  // namespace scenario
}  // namespace PLUMB_ABI
}  // namespace plumb
