/// Puts faults into samples: simulated ones and recorded logs alike.
#pragma once

#include <cstdint>
#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "plumb/calibration/datasheet.hpp"
#include "plumb/calibration/sensor_model.hpp"
#include "plumb/core/config.hpp"
#include "plumb/core/sample.hpp"
#include "plumb/scenario/fault.hpp"
#include "plumb/scenario/noise.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace scenario {

/// Faults are applied in the order of the list: two on one sensor add up, and what comes later in the
/// list acts on what comes earlier. A changed channel is digitised again (resolution, full scale), except
/// in station means (`Sample::count` > 1), which are not codes. Channels that did not deliver stay so.
///
/// Delivery faults (rows lost, doubled, out of order, times) are not acted out here but by `Delivery`, which comes
/// after.
///
/// Kinds that speak of gravity (turned, ghost, mirror) take it from the least squares over all channels as they are
/// before any fault; late, slow and exchange likewise take older rows and other channels from before any fault.
/// A sensor that is stuck at its last value keeps the last finite one from before the onset, other faults
/// included; with none, the value at the onset.
class Injector {
 public:
  /// Raw value of a channel at an older row (counted from 0), before any fault: for late and slow channels.
  class Past {
   public:
    virtual double raw(int sensor, std::uint64_t row) const noexcept = 0;

   protected:
    ~Past() = default;
  };

  /// `model` gives the scale factors: of the truth in a simulation, of the datasheet for a recorded log.
  /// The axes of `datasheet` are those that faults of direction mean. Refuses faults that `check` refuses; the text
  /// says which.
  static tl::expected<Injector, std::string> make(const Datasheet& datasheet, const SensorModel& model,
                                                  std::vector<Fault> faults, std::uint64_t seed,
                                                  const NoiseLaw& converter = {});

  /// Row by row over a log, from its first row on. Stations are counted by changes of the tag. Returns the
  /// sensors that were in fault at this row.
  SensorSet apply(Sample& sample) noexcept;

  const std::vector<Fault>& faults() const noexcept { return faults_; }
  /// Where in the log the row was that `apply` saw last.
  const Moment& now() const noexcept { return last_; }
  /// Positions in the list of the faults that no row has shown yet. After the last row: those outside the
  /// log's time, by station in a log without tags, or on a channel that did not deliver.
  std::vector<int> without_effect() const;

  /// For simulators, which know where they are and may jump: the faults at one moment, with the memory as
  /// it stands. `remember` must have been called for every stuck or drifting fault in effect.
  SensorSet inject(Sample& sample, const Moment& now, const Past& past) const noexcept;
  void remember(int fault, const FaultMemory& memory) noexcept;

  /// For engines that play one scenario after another: room for so many faults, and then other faults in the place of
  /// those before, without allocation. They must be such as `check` takes.
  void reserve(std::size_t faults);
  void pose(const Datasheet& datasheet, const SensorModel& model, const Fault* faults, int count,
            std::uint64_t seed) noexcept;

 private:
  Injector(const Datasheet& datasheet, const SensorModel& model, std::vector<Fault> faults, std::uint64_t seed,
           const NoiseLaw& converter);

  /// The last rows of a log, as they came in.
  class Ring final : public Past {
   public:
    double raw(int sensor, std::uint64_t row) const noexcept override;
    void keep(const Sample& sample, std::uint64_t row);

   private:
    std::vector<std::array<double, kCapacity>> rows_;
    std::uint64_t next_ = 0;
  };
  struct Scene;  // one sample before any fault
  void disturb(Sample& sample, const Fault& fault, const Moment& now, const Stream& stream) const noexcept;
  double faulty_value(std::size_t k, const Sample& sample, const Moment& now, const Scene& scene, const Past& past,
                      const Stream& stream) const noexcept;

  Datasheet datasheet_;
  SensorModel model_;
  std::vector<Fault> faults_;
  std::vector<FaultMemory> memory_;
  std::uint64_t seed_;
  NoiseLaw converter_;
  Moment now_;
  Moment last_;
  std::uint32_t tag_ = 0;
  Ring ring_;
  bool looks_back_ = false;  ///< some channel is late or slow
};

}  // namespace scenario
}  // namespace PLUMB_ABI
}  // namespace plumb
