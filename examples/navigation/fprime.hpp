// plumb as a passive F Prime component: samples come in by a port, verdicts go out as telemetry and events, and
// Svc.Health gets its pings back. In a deployment the base class is what FPP generates from the component's model; here
// it is stub/fprime_component.hpp.
//
// Events are told on change only, once each, so a fault does not flood the ground. The ping is answered only while
// samples come: a component that answers without having run hides that its driver is dead.
#pragma once

#include "plumb/health/health_monitor.hpp"

namespace Nav {

template <class Base>
class PlumbMonitor : public Base {
 public:
  using Base::Base;

  /// Once, before the first sample. False: `plumb::describe(error.code)` goes out as an event.
  bool configure(const plumb::MonitorSetup& setup) {
    const plumb::Expected<void> ready = monitor_.configure(setup);
    if (!ready) this->log_WARNING_HI_NotConfigured(plumb::describe(ready.error().code));
    return ready.has_value();
  }

 protected:
  /// Port of the driver: one sample of all channels.
  void sampleIn_handler(typename Base::PortIndex, const plumb::Sample& sample) override {
    const plumb::Verdict& v = monitor_.step(sample);
    sample_since_ping_ = true;
    this->tlmWrite_State(static_cast<typename Base::U8>(v.state));
    this->tlmWrite_Validity(static_cast<typename Base::U8>(v.validity));
    this->tlmWrite_InService(v.in_service.bits);
    if (v.transition.sequence != 0 && v.transition.from != v.transition.to) report(v);
    if (v.tick && (v.validity == plumb::Validity::valid || v.validity == plumb::Validity::degraded)) {
      this->gravityOut_out(0, v.gravity_mps2, v.covariance);
    }
  }

  /// Svc.Health asks whether this component lives.
  void pingIn_handler(typename Base::PortIndex port, typename Base::U32 key) override {
    if (!sample_since_ping_) return;  // Health counts the silence: its limits warn, then stop
    sample_since_ping_ = false;
    this->pingOut_out(port, key);
  }

 private:
  void report(const plumb::Verdict& v) {
    const char* const state = plumb::to_string(v.state);
    const char* const cause = plumb::to_string(v.cause);
    switch (v.state) {
      case plumb::HealthState::nominal: this->log_ACTIVITY_HI_Healthy(state, cause); break;
      case plumb::HealthState::isolated:
      case plumb::HealthState::suspect:
      case plumb::HealthState::recalibrating: this->log_WARNING_LO_Doubt(state, cause); break;
      case plumb::HealthState::degraded_3_sensor:
      case plumb::HealthState::failed: this->log_WARNING_HI_Lost(state, cause, v.excluded.bits); break;
    }
  }

  plumb::HealthMonitor monitor_;
  bool sample_since_ping_ = false;
};

}  // namespace Nav
