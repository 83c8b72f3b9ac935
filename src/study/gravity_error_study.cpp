#include "plumb/study/gravity_error_study.hpp"

#include <algorithm>
#include <cmath>

namespace plumb {
inline namespace PLUMB_ABI {
namespace study {

double rms_of(const std::vector<double>& values) noexcept {
  double sum = 0.0;
  for (const double v : values) sum += v * v;
  return values.empty() ? 0.0 : std::sqrt(sum / static_cast<double>(values.size()));
}

double largest_of(const std::vector<double>& values) noexcept {
  double most = 0.0;
  for (const double v : values) most = std::max(most, std::abs(v));
  return most;
}

StudyExpected<GravityErrorStudy> gravity_error_study(const Fits& fits, const scenario::Tool& tool, std::uint64_t seed,
                                                     int attitudes) {
  const StudyExpected<Survey> survey = record(survey_run(tool, seed, Part::validation, attitudes, 1));
  if (!survey) return tl::unexpected<std::string>(survey.error());
  const SensorModel nominal_model = fits.datasheet.model();
  const double g_mps2 = study_gravity().g_mps2;
  GravityErrorStudy out;
  for (const SensorSet used : fits.combinations()) {
    GravityErrors errors;
    errors.used = used;
    const LeastSquares nominal = least_squares(fits.nominal, used);
    const LeastSquares own = least_squares(fits.own->array, used);
    for (const std::vector<Sample>& samples : survey->attitude) {
      const Sample& s = samples.front();
      const Readings before = nominal_model.apply(s.raw, s.temperature_degc, used);
      const Readings after = fits.own->model.apply(s.raw, s.temperature_degc, used);
      const Vec3 paper = paper_vector(fits.nominal, fits.paper_fit(used), s.raw, s.temperature_degc);
      errors.datasheet_mps2.push_back(norm(nominal.estimate(before)) - g_mps2);
      errors.paper_mps2.push_back(norm(paper) - g_mps2);
      errors.own_mps2.push_back(norm(own.estimate(after)) - g_mps2);
    }
    out.combination.push_back(std::move(errors));
  }
  return out;
}

}  // namespace study
}  // namespace PLUMB_ABI
}  // namespace plumb
