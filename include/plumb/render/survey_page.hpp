/// A survey as one page, with the checks station by station, for whoever has to accept it.
#pragma once

#include <string>
#include <vector>

#include "plumb/render/survey_report.hpp"
#include "plumb/render/verification_page.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace render {

/// What makes a page repeatable.
struct SurveyIdentity {
  Json inputs = Json::array();  ///< `input_json` of each file; without "sha256" where the bytes were not kept
  std::string command;          ///< that makes the page again
  std::string time, host;
};

/// One self-contained file: verdict, references, stations, path, error tests, what was withheld or refused, identity.
/// Every station is a row, with its differences and their limits; every azimuth is under the name of its north.
std::string survey_html(const SurveyReport& report, const SurveyIdentity& identity, const PagePictures& pictures);

/// Data and one gnuplot program, kSurveyScript: the three checks against depth with their limits as bands, and the path
/// from above and from the side.
std::vector<PlotFile> survey_plot_files(const SurveyReport& report);
inline constexpr const char* kSurveyScript = "survey.gp";
inline constexpr const char* kSurveyChecksPicture = "survey-checks.svg";
inline constexpr const char* kSurveyPathPicture = "survey-path.svg";
/// Those that the program draws: a path of one station is not drawn.
std::vector<std::string> survey_picture_names(const SurveyReport& report);

}  // namespace render
}  // namespace PLUMB_ABI
}  // namespace plumb
