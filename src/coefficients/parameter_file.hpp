/// The parameters of an autopilot as ground stations write them to files (private to src/coefficients).
#pragma once

#include <map>
#include <string>
#include <string_view>

#include "../io/refusal.hpp"
#include "plumb/coefficients/coefficient_file.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace coefficients {

/// Those that say something of accelerometers, by name.
class Parameters {
 public:
  struct Value {
    double number = 0.0;
    int line = 0;  ///< 0: of a log
  };

  explicit Parameters(std::string path) : path_(std::move(path)) {}

  /// Throws a Refusal where the name stands there already with another value, or where there are too many.
  void add(std::string_view name, double number, int line);
  bool empty() const noexcept { return values_.empty(); }
  bool has(const std::string& name) const { return values_.find(name) != values_.end(); }
  /// Throws a Refusal where it is missing.
  double need(const std::string& name) const;
  double value_or(const std::string& name, double otherwise) const;
  /// Throws a Refusal that names the parameter with its line.
  [[noreturn]] void refuse(const std::string& name, const std::string& what, const std::string& remedy) const;

 private:
  std::string path_;
  std::map<std::string, Value> values_;
};

/// Whether an autopilot of this form has such a parameter of an accelerometer.
bool is_parameter_of(Form form, std::string_view name) noexcept;

/// `NAME VALUE`, `NAME,VALUE`, or QGroundControl's five columns a line; `#` begins a comment. Throws a Refusal.
Parameters parse_parameters(const std::string& text, const std::string& path, Form form);

/// How an accelerometer is called in the names of its parameters: "CAL_ACC0", "INS_ACC", "INS_ACC2", "INS4_ACC".
std::string parameter_prefix(Form form, int instance);

/// As before any calibration.
inline constexpr const char* kUntouched = " has offsets 0 and scales 1, as before any calibration";
bool is_untouched(const ChipCoefficients& chip) noexcept;

/// The chips of them; what is not taken over goes to `notes`. Throw a Refusal.
std::vector<ChipCoefficients> px4_chips(const Parameters& parameters, std::vector<std::string>& notes);
std::vector<ChipCoefficients> ardupilot_chips(const Parameters& parameters, std::vector<std::string>& notes);

}  // namespace coefficients
}  // namespace PLUMB_ABI
}  // namespace plumb
