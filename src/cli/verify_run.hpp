/// From the options of `plumb verify` to the master report. Nothing is written here.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "plumb/findings/detection_sizes.hpp"
#include "plumb/io/array_file.hpp"
#include "plumb/io/json_fields.hpp"
#include "plumb/render/geometry_plot.hpp"
#include "plumb/verification/replayed.hpp"
#include "plumb/verification/verdict.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace cli {

using Json = nlohmann::ordered_json;

struct VerifyOptions {
  std::string array, limits, calibration, stations, out = "verification", compare, test_results, assurance,
                                                    traceability, analysis, resources;
  std::vector<std::string> known_attitudes;  ///< as written
  std::vector<std::string> reuse;            ///< finished results of the campaigns, larger than those played here
  std::uint64_t seed = 1;
  std::optional<std::uint64_t>
      scenarios;  ///< of each campaign; by default fewer for larger arrays, so that it takes minutes
  double days_since_calibration = 0.0;
  int threads = 0;  ///< 0: one per processor
  bool json = false, pdf = false;
};

inline constexpr std::uint64_t kThoroughScenarios = 1000000;
/// Of each campaign, played a second time by other code.
inline constexpr std::uint64_t kReplayed = 200;

/// All that is known when everything has been played, and what has to be written beside the report.
struct Verification {
  io::ArrayFile array;
  Json report;        ///< as of accelerometers, whatever the sensors measure: what pages are made of
  Json told;          ///< the master report, in the units and the words of the field
  Json traceability;  ///< as it was read
  render::GeometryPictures geometry;
  findings::SizeTable sizes;
  verification::Facts facts;
  verification::Report verdict;  ///< on them
  std::optional<verification::Trials> healthy, faults;
  std::optional<verification::Replayed> replayed;
  std::string healthy_toml, faults_toml;  ///< to be played in the directory of the report
};

/// Names of files in the directory of the report.
inline constexpr const char* kArrayCopy = "array.toml";
inline constexpr const char* kFaultsFile = "faults.toml";
inline constexpr const char* kHealthyFile = "healthy.toml";

/// Errors: what cannot be read, and an interruption.
io::FileExpected<Verification> verify(const VerifyOptions& options);

}  // namespace cli
}  // namespace PLUMB_ABI
}  // namespace plumb
