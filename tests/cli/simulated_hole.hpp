/// A hole as `plumb survey` reads it, and the options that say what its gravity and field are.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tool_runner.hpp"

namespace survey_command_test {

using namespace plumb_test;  // NOLINT(google-build-using-namespace)

/// A directory of its own, with nothing in it.
class Desk : public Directory {
 public:
  void put(const char* name, const std::string& text) const { write_text(*this / name, text); }
  std::string text(const char* name) const { return read_text(*this / name); }
};

inline constexpr double kRad = 3.14159265358979323846 / 180.0;
inline constexpr double kGravity_mps2 = 9.81912;
inline constexpr double kField_nt = 51000.0;
inline constexpr double kDip_deg = 73.0;

/// A hole from vertical to 80 degrees on 120 degrees magnetic, the tool turned at every station.
struct Hole {
  double interference_nt = 0.0;
  double turned_deg = 0.0;  ///< magnetometers about z
  bool exchanged = false;
  double unit_nt = 1.0;
  double full_scale_nt = 1e9;
  std::string header = "md_m,gx_mps2,gy_mps2,gz_mps2,bx_nT,by_nT,bz_nT\n";

  std::string csv() const {
    std::string out = header;
    for (int k = 0; k < 21; ++k) {
      const double i = 4.0 * k * kRad, a = 120.0 * kRad, t = 50.0 * k * kRad;
      const double bn = kField_nt * std::cos(kDip_deg * kRad), bd = kField_nt * std::sin(kDip_deg * kRad);
      const double high = bn * std::cos(i) * std::cos(a) - bd * std::sin(i), right = bn * std::sin(a);
      double b[3] = {high * std::sin(t) + right * std::cos(t), high * std::cos(t) - right * std::sin(t),
                     bn * std::sin(i) * std::cos(a) + bd * std::cos(i) + interference_nt};
      for (double& component : b) component = std::fmax(-full_scale_nt, std::fmin(component, full_scale_nt));
      const double c = std::cos(turned_deg * kRad), s = std::sin(turned_deg * kRad), bx = b[0], by = b[1];
      b[0] = c * bx + s * by;
      b[1] = c * by - s * bx;
      if (exchanged) std::swap(b[0], b[1]);
      char line[200];
      std::snprintf(line, sizeof line, "%.1f,%.7f,%.7f,%.7f,%.6f,%.6f,%.6f\n", 1500.0 + 30.0 * k,
                    -kGravity_mps2 * std::sin(i) * std::sin(t), -kGravity_mps2 * std::sin(i) * std::cos(t),
                    kGravity_mps2 * std::cos(i), b[0] / unit_nt, b[1] / unit_nt, b[2] / unit_nt);
      out += line;
    }
    return out;
  }
};

inline std::vector<std::string> stated(std::vector<std::string> more = {}) {
  std::vector<std::string> out{"survey",   "run.csv", "--gravity", "9.81912 m/s^2", "--field",
                               "51000 nT", "--dip",   "73 deg",    "--declination", "-2.5 deg"};
  out.insert(out.end(), more.begin(), more.end());
  return out;
}

inline nlohmann::json survey_json_of(const Outcome& outcome) {
  return nlohmann::json::parse(outcome.out, nullptr, false);
}

}  // namespace survey_command_test
