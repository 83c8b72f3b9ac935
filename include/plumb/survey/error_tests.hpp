/// Gross errors among many stations: the G, B and dip error tests.
///
/// After Ekseth et al., High-Integrity Wellbore Surveys (SPE 103734): residuals of gravity, field and dip are compared
/// with what the error model of the tool and of the references allows, correlation between stations included. With
/// C = diag(random variances) + W P W' + sigma_ref^2 1 1' the covariance of the residuals r of one kind:
///   all together   r' C^-1 r, chi-square of as many degrees as stations
///   one station    w_i = (C^-1 r)_i / sqrt((C^-1)_ii), normal (Baarda's test for one gross error)
///   all alike      m = 1' C^-1 r / 1' C^-1 1 with sigma 1 / sqrt(1' C^-1 1)
/// The paper's text was not to be had: the tests are derived from their definition.
#pragma once

#include <vector>

#include "plumb/survey/terms.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace survey {

struct ErrorTestSettings {
  ToolErrors tool = iscwsa_tool();
  double false_alarm = 0.0027;  ///< of each of the three tests of each kind; that of one station is shared among them
};

/// [m/s^2], [tesla] or [rad].
struct ErrorTest {
  std::vector<double> residual;    ///< measured minus reference
  std::vector<double> normalised;  ///< w_i
  double one_limit = 0.0;
  int worst = 0;  ///< station of the largest |w_i|
  double chi_square = 0.0, chi_square_limit = 0.0;
  double mean = 0.0, mean_sigma = 0.0, mean_limit = 0.0;

  bool one_passed() const noexcept;
  bool all_passed() const noexcept { return chi_square <= chi_square_limit; }
  bool mean_passed() const noexcept;
  bool passed() const noexcept { return one_passed() && all_passed() && mean_passed(); }
};

struct ErrorTests {
  ErrorTest gravity, field, dip;
};

/// Refuses no station, numbers that are not finite, and a station without random errors.
io::FileExpected<ErrorTests> error_tests(const std::vector<ReferencedStation>& stations,
                                         const ErrorTestSettings& settings);

}  // namespace survey
}  // namespace PLUMB_ABI
}  // namespace plumb
