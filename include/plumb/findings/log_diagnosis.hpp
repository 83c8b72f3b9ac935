/// Why a log has no still stretch: what its rows look like against what the array file declares.
#pragma once

#include <vector>

#include "plumb/array/geometry.hpp"
#include "plumb/core/sample.hpp"
#include "plumb/findings/finding.hpp"
#include "plumb/io/array_file.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace findings {

/// Watches the samples of a log go by, block by block of 32 rows (what the search for stations uses); remembers the
/// first 4096 blocks.
class LogDiagnosis {
 public:
  explicit LogDiagnosis(const io::ArrayFile& array) : array_(&array) {}

  void add(const Sample& sample, const Readings& y_mps2, SensorSet usable);

  /// What is wrong, most telling first. Never empty: where nothing stands out it says so.
  std::vector<Finding> findings() const;

 private:
  void end_block();
  void judge_noise(std::vector<Finding>& out) const;
  bool judge_length(std::vector<Finding>& out) const;  ///< whether it names another unit
  void judge_time(std::vector<Finding>& out) const;

  const io::ArrayFile* array_;
  std::vector<std::vector<double>> scatter_mps2_ = std::vector<std::vector<double>>(kCapacity);  ///< by sensor, block
  std::vector<double> length_mps2_;                                                              ///< of the block means
  std::vector<double> step_s_;                                                                   ///< mean, by block
  Readings origin_{}, sum_{}, square_{};
  SensorSet usable_;
  double begin_s_ = 0.0, last_s_ = 0.0;
  int in_block_ = 0;
  std::uint64_t rows_ = 0;
};

}  // namespace findings
}  // namespace PLUMB_ABI
}  // namespace plumb
