// Stand-in for the base class that FPP generates from a component with these ports, channels and events. It records
// what the component sends, and calls the handlers as the framework does.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "plumb/core/sample.hpp"
#include "plumb/core/vec3.hpp"

namespace fprime_stub {

class PlumbMonitorComponentBase {
 public:
  using U8 = std::uint8_t;
  using U32 = std::uint32_t;
  using PortIndex = std::int16_t;  // FwIndexType

  virtual ~PlumbMonitorComponentBase() = default;
  void sampleIn(const plumb::Sample& sample) { sampleIn_handler(0, sample); }
  void pingIn(U32 key) { pingIn_handler(0, key); }

  U8 sent_state = 255, sent_validity = 255;
  U32 sent_in_service = 0;
  std::vector<std::string> events;
  std::vector<U32> pings;
  std::vector<plumb::Vec3> vectors;

 protected:
  virtual void sampleIn_handler(PortIndex port, const plumb::Sample& sample) = 0;
  virtual void pingIn_handler(PortIndex port, U32 key) = 0;
  void tlmWrite_State(U8 value) { sent_state = value; }
  void tlmWrite_Validity(U8 value) { sent_validity = value; }
  void tlmWrite_InService(U32 value) { sent_in_service = value; }
  void log_ACTIVITY_HI_Healthy(const char* s, const char* c) {
    events.push_back(std::string("healthy ") + s + " " + c);
  }
  void log_WARNING_LO_Doubt(const char* s, const char* c) { events.push_back(std::string("doubt ") + s + " " + c); }
  void log_WARNING_HI_Lost(const char* s, const char* c, U32 excluded) {
    events.push_back(std::string("lost ") + s + " " + c + " " + std::to_string(excluded));
  }
  void log_WARNING_HI_NotConfigured(const char* why) { events.push_back(std::string("not configured ") + why); }
  void pingOut_out(PortIndex, U32 key) { pings.push_back(key); }
  void gravityOut_out(PortIndex, const plumb::Vec3& vector, const plumb::Mat3&) { vectors.push_back(vector); }
};

}  // namespace fprime_stub
