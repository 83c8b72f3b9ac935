// imu_tk: misalignment T (3x3), scale K (3x3, diagonal) and bias b, row by row with blank lines between, and
// a = T K (reading - b) (CalibratedTriad_::load, save and unbiasNormalize).
#include "imu_tk.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "../io/csv.hpp"
#include "../io/refusal.hpp"
#include "../io/text_tools.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace coefficients {
namespace {

constexpr std::string_view kBetween = " \t\r\n";
/// Of three axes at right angles the determinant is 1; of a chip it is within some percent of that.
constexpr double kLeastDeterminant = 0.1;

struct Number {
  double value = 0.0;
  int line = 0;
};

/// The numbers of the text, one more than a file has at most. Nothing where a word is no number.
struct Numbers {
  std::vector<Number> number;
  std::string_view wrong;  ///< the first word that is none
  int wrong_line = 0;
};

Numbers numbers_of(std::string_view text) {
  Numbers out;
  int line = 1;
  while (out.number.size() <= kImuTkNumbers) {
    const std::size_t begin = std::min(text.find_first_not_of(kBetween), text.size());
    line += static_cast<int>(std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(begin), '\n'));
    text.remove_prefix(begin);
    if (text.empty()) break;
    const std::size_t end = std::min(text.find_first_of(kBetween), text.size());
    Number one{0.0, line};
    if (io::parse_cell(text.substr(0, end), one.value) != io::CellKind::number) {
      out.wrong = text.substr(0, end);
      out.wrong_line = line;
      break;
    }
    out.number.push_back(one);
    text.remove_prefix(end);
  }
  return out;
}

std::string matrix_text(const Mat3& m) {
  std::string out;
  for (std::size_t k = 0; k < 9; ++k) out += io::shortest(m[k]) + (k % 3 == 2 ? "\n" : " ");
  return out;
}

}  // namespace

bool looks_like_imu_tk(const std::string& text) {
  const Numbers found = numbers_of(text);
  return found.wrong.empty() && found.number.size() == kImuTkNumbers;
}

ChipCoefficients parse_imu_tk(const std::string& text, const std::string& path, int number) {
  const auto refuse = [&path](int line, const std::string& field, const std::string& what) {
    throw io::Refusal(io::FileError{path, line, field, what,
                                    "give the file that imu_tk wrote for the accelerometers: misalignment and scale "
                                    "of three rows each, and three biases"});
  };
  const Numbers found = numbers_of(text);
  if (!found.wrong.empty()) refuse(found.wrong_line, "", io::in_quotes(found.wrong) + " is not a number");
  if (found.number.size() != kImuTkNumbers)
    refuse(0, "",
           "holds " + std::string(found.number.size() > kImuTkNumbers ? "more" : "fewer") +
               " than the 21 numbers of an imu_tk file");
  Mat3 misalignment{}, scale{};
  for (std::size_t k = 0; k < kImuTkNumbers; ++k) {
    if (!std::isfinite(found.number[k].value)) refuse(found.number[k].line, "", "holds a number that is not finite");
  }
  for (std::size_t k = 0; k < 9; ++k) {
    misalignment[k] = found.number[k].value;
    scale[k] = found.number[9 + k].value;
    const int line = found.number[9 + k].line;
    if (k % 4 == 0 && scale[k] == 0.0) refuse(line, "scale matrix", "has a 0 on its diagonal");
    if (k % 4 != 0 && scale[k] != 0.0) refuse(line, "scale matrix", "is not diagonal");
  }
  const double det =
      det3({misalignment[0], misalignment[1], misalignment[2]}, {misalignment[3], misalignment[4], misalignment[5]},
           {misalignment[6], misalignment[7], misalignment[8]});
  if (!(std::fabs(det) >= kLeastDeterminant) || !std::isfinite(det))
    refuse(found.number[0].line, "misalignment matrix", "has the determinant " + io::brief(det) + ", must be near 1");
  ChipCoefficients out;
  out.instance = number;
  out.name = path;
  out.unit = ReadingUnit::log;
  for (std::size_t k = 0; k < 9; ++k) out.matrix[k] = misalignment[k] * scale[4 * (k % 3)];
  for (std::size_t k = 0; k < 3; ++k) out.offset[0][k] = found.number[18 + k].value;
  return out;
}

std::string imu_tk_text(const ChipCoefficients& chip) {
  Mat3 misalignment{}, scale{};
  for (std::size_t k = 0; k < 9; ++k) {
    misalignment[k] = chip.matrix[k] / chip.matrix[4 * (k % 3)];
    if (k % 4 == 0) scale[k] = chip.matrix[k];
  }
  std::string bias;
  for (std::size_t k = 0; k < 3; ++k) bias += io::shortest(chip.offset[0][k]) + "\n";
  return matrix_text(misalignment) + "\n" + matrix_text(scale) + "\n" + bias;
}

}  // namespace coefficients
}  // namespace PLUMB_ABI
}  // namespace plumb
