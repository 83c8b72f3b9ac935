/// The errors of a tool, and the axial interference of the drill string, from many stations together.
///
/// What is known is the length of gravity, the length of the field and its dip; every station adds three residuals
/// (Brooks, Gurden and Noy, SPE 49060; Nyrnes, Torkildsen and Nahavandchi, SPWLA 2005-G; for the limits of the method
/// Nyrnes, Torkildsen and Wilson, SPE 125677). With x the terms and d what the three references are off by,
///   r_i = totals((G_i - b) / (1 + s), (B_i - b) / (1 + s)) - reference_i - d
/// is minimised, by Gauss-Newton steps, as
///   sum r_i' R_i^-1 r_i + sum (x_j / sigma_j)^2 over the terms that are not asked for + sum (d_k / sigma_k)^2,
/// R_i the covariance of the three totals from the random errors of that station and of its reference. A term that is
/// asked for has no prior; all others, and the references, take part with theirs, so that the covariance of an estimate
/// holds what they may have put into it.
#pragma once

#include <string>
#include <vector>

#include "plumb/survey/terms.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace survey {

struct MultiStationSettings {
  std::vector<Term> terms;           ///< what to estimate, each once
  ToolErrors tool = iscwsa_tool();   ///< stated sizes: priors of the others, yardstick of those that are asked for
  double max_correlation = 0.4;      ///< between two terms that are asked for
  double misfit_false_alarm = 1e-6;  ///< of the chi-square of the residuals
};

enum class NoEstimate : std::uint8_t {
  nothing_asked,     ///< no term, or one twice
  too_few_stations,  ///< `value` of them, `limit` needed
  not_finite,        ///< station `value`
  no_random_error,   ///< station `value` states no noise: it cannot be weighed
  not_converged,
  not_observable,  ///< the stations do not tell `direction` from the other errors: see below
  correlated,      ///< `first` and `second`, by `value`; at most `limit`
  misfit,          ///< chi-square `value`, at most `limit`: another error is in the data
};

/// Why there is none.
struct EstimateRefusal {
  NoEstimate why = NoEstimate::nothing_asked;
  double value = 0.0;
  double limit = 0.0;
  Term first = Term::accelerometer_bias_x, second = Term::accelerometer_bias_x;
  /// not_observable: the combination of terms, in units of their stated sigmas, whose own sigma is `value` times what
  /// the tool's stated errors already say, were the references unknown. An estimate that only the reference
  /// corroborates is an error of the reference by another name.
  TermValues direction{};

  std::string text() const;
};

struct Estimate {
  std::vector<Term> terms;  ///< as asked for
  TermValues value{};       ///< of all terms: those that were not asked for are near their prior, 0
  TermValues sigma{};
  std::array<double, kTermCount * kTermCount> covariance{};                          ///< of all terms, row-major
  double gravity_offset_mps2 = 0.0, field_offset_tesla = 0.0, dip_offset_rad = 0.0;  ///< of the references
  double largest_correlation = 0.0;            ///< between terms that were asked for
  double largest_reference_correlation = 0.0;  ///< of one of them with a reference: told, and held by the covariance
  double chi_square = 0.0;
  int freedom = 0;
  double chance = 1.0;  ///< of a chi-square as large
  int steps = 0;
};

tl::expected<Estimate, EstimateRefusal> estimate_terms(const std::vector<ReferencedStation>& stations,
                                                       const MultiStationSettings& settings);

/// Bias of the z magnetometer alone, interference of the drill string included.
tl::expected<Estimate, EstimateRefusal> estimate_axial_interference(const std::vector<ReferencedStation>& stations,
                                                                    const ToolErrors& tool);

/// The station with the estimate taken off, and the covariance that is left: random, and that of the estimate.
struct CorrectedStation {
  Measurement measured;
  Covariance6 total{};
};
CorrectedStation corrected(const Measurement& station, const Estimate& estimate);

/// The station judged by what is left. Its checks use the data that the estimate came from: they show a misfit, and no
/// longer test the reference.
SurveyStation judge_corrected(const CorrectedStation& station, const Reference& reference,
                              const StationSettings& settings);

}  // namespace survey
}  // namespace PLUMB_ABI
}  // namespace plumb
