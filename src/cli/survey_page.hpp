// The page of a survey: pictures drawn, inputs hashed, written.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "plumb/io/file_error.hpp"
#include "plumb/render/survey_report.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace cli {

/// `inputs`: role and path of each file that was read, "-" for standard input. A page without pictures, where gnuplot
/// cannot draw, says so in their place.
io::FileExpected<void> write_survey_page(const std::string& path, const render::SurveyReport& found,
                                         const std::vector<std::pair<const char*, std::string>>& inputs,
                                         const std::string& command);

}  // namespace cli
}  // namespace PLUMB_ABI
}  // namespace plumb
