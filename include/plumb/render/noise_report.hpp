/// What a log at rest tells of the noise of its sensors: text, JSON, page, plots, and the lines for the array file.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "plumb/noise/axis_study.hpp"
#include "plumb/noise/load_log.hpp"
#include "plumb/render/verification_page.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace render {

inline constexpr const char* kNoiseSchema = "plumb-noise";
inline constexpr int kNoiseVersion = 1;

struct NoiseAxis {
  noise::AxisStudy study;
  noise::ColumnUnit unit;
  std::optional<double> declared;  ///< by the array file, in the unit of the readings
};

struct NoiseReport {
  std::string log;
  std::string array;        ///< empty: none
  std::size_t block = 32;   ///< samples that a monitor averages
  std::string time_column;  ///< empty: by the rate
  std::vector<std::string> left_out;
  std::uint64_t rows_bad = 0;
  bool complete = true;
  std::vector<NoiseAxis> axes;
};

/// Something in the way of a good answer: what, where, what to do.
struct NoiseRemark {
  std::string axis;  ///< empty: of the log
  std::string what;
  std::string remedy;
};
std::vector<NoiseRemark> noise_remarks(const NoiseReport& report);

/// The keys `id` and `noise` of each [[sensor]], as the array file takes them, with what they rest on as comments.
/// Empty where no column of a sensor could be judged.
std::string noise_lines(const NoiseReport& report);

std::string noise_text(const NoiseReport& report);
Json noise_json(const NoiseReport& report);
/// One page with a section for each column; pictures are those of kNoiseScript.
std::string noise_html(const NoiseReport& report, const PagePictures& pictures);

/// Data and one gnuplot program, kNoiseScript: for each column that was judged the Allan deviation with the fitted
/// slopes, and the spectrum with its peaks.
std::vector<PlotFile> noise_plot_files(const NoiseReport& report);
inline constexpr const char* kNoiseScript = "noise.gp";
std::vector<std::string> noise_picture_names(const NoiseReport& report);
/// "noise-allan-2.svg", of column k counted from 0.
std::string allan_picture_name(std::size_t k);
std::string spectrum_picture_name(std::size_t k);

}  // namespace render
}  // namespace PLUMB_ABI
}  // namespace plumb
