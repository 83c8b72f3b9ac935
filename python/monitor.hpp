/// The monitor at rest behind `plumb.Monitor`, for the monitor in motion too, which may run beside it.
#pragma once

#include <atomic>

#include "module.hpp"
#include "verdict_row.hpp"

namespace plumb_python {

/// Of that array: else its axes and coefficients are those of other sensors, which may even be as many.
const plumb::Calibration* made_for(const plumb::io::ArrayFile& array, const Calibration& calibration);

/// As a monitor is set up from it, with what is known of the alignment. Null: the axes are the datasheet's.
plumb::io::ArrayFile aligned(const plumb::io::ArrayFile& array, const Calibration* calibration);

/// Sensors by their ids; refuses what is not one of the array.
plumb::SensorSet set_of(const Array& array, const std::vector<std::string>& ids);

/// One thread at a time: a run lets all others go on.
class Turnstile {
 public:
  /// Asked with the interpreter's lock held.
  void must_be_free() const {
    if (occupied_)
      refuse("the monitor runs in another thread", "wait until run returns, or give each thread a monitor of its own");
  }
  struct Inside {
    explicit Inside(Turnstile& turnstile) : through(turnstile) { through.occupied_ = true; }
    ~Inside() { through.occupied_ = false; }
    Inside(const Inside&) = delete;
    Inside& operator=(const Inside&) = delete;
    Turnstile& through;
  };

 private:
  std::atomic<bool> occupied_{false};
};

class Monitor {
 public:
  Monitor(Array array, const Calibration& calibration, const std::optional<py::bytes>& snapshot, double days);

  py::array_t<VerdictRow> run(const Log& log);
  /// One row of a log, of a monitor that is `idle`. Touches no Python object.
  static const plumb::Verdict& step(plumb::HealthMonitor& monitor, const Log::View& view, py::ssize_t row);
  py::bytes snapshot() const;
  std::string verdict_json() const;
  void done(const plumb::Expected<void>& result) const;

  const Array& array() const { return array_; }
  Turnstile& turnstile() { return turnstile_; }
  /// What it was made from, without the gravity that was set since.
  const plumb::MonitorSetup& setup() const noexcept { return *setup_; }
  /// The monitor, while no other thread is in `run`.
  plumb::HealthMonitor& idle() const {
    turnstile_.must_be_free();
    return *monitor_;
  }

 private:
  Turnstile turnstile_;
  Array array_;
  std::unique_ptr<plumb::HealthMonitor> monitor_;
  std::unique_ptr<plumb::MonitorSetup> setup_;
};

}  // namespace plumb_python
