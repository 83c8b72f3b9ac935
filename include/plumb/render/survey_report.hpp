/// What a survey came to, for people and for programs.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "plumb/survey/survey_run.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace render {

struct SurveyReport {
  std::string file;
  std::string gravity_unit, field_unit;  ///< of the columns
  std::uint64_t rows_left_out = 0;
  std::string array;  ///< that stated the references; empty: none
  survey::SurveySettings settings;
  survey::Reference first, last;  ///< references of the first and of the last station
  double noise_mps2 = 0.0, noise_tesla = 0.0;
  survey::Survey survey;
};

/// A line a station, then what holds for all of them. Every azimuth is under the name of its north.
std::string survey_text(const SurveyReport& report);

/// The same with all figures in the units of the keys; null where there is none, beside the reason.
nlohmann::ordered_json survey_json(const SurveyReport& report);

}  // namespace render
}  // namespace PLUMB_ABI
}  // namespace plumb
