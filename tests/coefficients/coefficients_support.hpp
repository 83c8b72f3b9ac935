/// Arrays and calibrations for tests of known coefficients.
#pragma once

#include <gtest/gtest.h>

#include <unistd.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <optional>
#include <string>
#include <vector>

#include "plumb/coefficients/adoption.hpp"
#include "plumb/coefficients/calibration_export.hpp"

namespace coefficients_test {

namespace pc = plumb::coefficients;

inline std::string sensor_toml(const std::string& id, const std::string& axis, const std::string& more = "") {
  return "\n[[sensor]]\nid = \"" + id + "\"\naxis = " + axis + "\nnoise = \"0.5 mg\"\n" + more;
}

/// `chips` parallel triads x1, y1, z1, x2 ... in the unit of the log, each one a package.
inline std::string drone_toml(int chips, const std::string& input = "unit = \"m/s^2\"",
                              const std::string& of_sensor = "", bool packages = true) {
  std::string out =
      "name = \"drone\"\n[gravity]\nmodel = \"value\"\nvalue = \"9.81 m/s^2\"\n\n[input]\nreads = "
      "\"specific-force\"\ntime = \"t_s\"\n" +
      input + "\n";
  for (int chip = 1; chip <= chips; ++chip) {
    const std::string number = std::to_string(chip);
    const std::string package = packages ? "package = \"imu" + number + "\"\n" : "";
    out += sensor_toml("x" + number, "[1, 0, 0]", package + of_sensor);
    out += sensor_toml("y" + number, "[0, 1, 0]", package + of_sensor);
    out += sensor_toml("z" + number, "[0, 0, 1]", package + of_sensor);
  }
  return out;
}

inline plumb::io::ArrayFile array_of(const std::string& toml) {
  auto read = plumb::io::parse_array_text(toml, "array.toml");
  EXPECT_TRUE(read.has_value()) << (read ? "" : read.error().text());
  return read ? *std::move(read) : plumb::io::ArrayFile{};
}
inline plumb::io::ArrayFile drone(int chips = 1) { return array_of(drone_toml(chips)); }

inline const pc::Uncertainty kUsual{0.05, 1e-3, 0.01};

inline pc::AdoptionChoice usual_choice() {
  pc::AdoptionChoice out;
  out.usual = kUsual;
  return out;
}

inline plumb::io::FileExpected<pc::Adoption> adopted(const plumb::io::ArrayFile& array, const std::string& text,
                                                     const pc::AdoptionChoice& choice = usual_choice(),
                                                     std::optional<pc::Form> form = std::nullopt) {
  const auto file = pc::parse_coefficients(text, "known.txt", array, form);
  if (!file) return tl::unexpected<plumb::io::FileError>(file.error());
  return pc::adopt(array, {*file}, choice);
}

/// The acceleration that the calibration makes of log values, in the sense of the sensors.
inline double felt(const plumb::SensorModel& model, int sensor, double raw, double temperature_degc = 25.0) {
  return raw / model.scale_at(sensor, temperature_degc) - model.bias_at(sensor, temperature_degc);
}

/// One chip of PX4 with its parameters in the order x, y, z.
inline std::string px4_text(int instance, const std::array<double, 3>& offset, const std::array<double, 3>& scale,
                            const std::string& more = "") {
  const std::string chip = "CAL_ACC" + std::to_string(instance) + "_";
  std::string out = chip + "ID 131" + std::to_string(instance) + "\n";
  for (std::size_t k = 0; k < 3; ++k) {
    const std::string axis(1, "XYZ"[k]);
    out += chip + axis + "OFF " + plumb::io::shortest(offset[k]) + "\n";
    out += chip + axis + "SCALE " + plumb::io::shortest(scale[k]) + "\n";
  }
  return out + more;
}

/// Refused, with these words in what is wrong, and a remedy.
template <class T>
::testing::AssertionResult refused_with(const plumb::io::FileExpected<T>& result, const std::string& words) {
  if (result) return ::testing::AssertionFailure() << "not refused";
  const std::string text = result.error().text();
  if (text.find(words) == std::string::npos) return ::testing::AssertionFailure() << text;
  if (result.error().remedy.empty()) return ::testing::AssertionFailure() << "no remedy: " << text;
  return ::testing::AssertionSuccess();
}

/// A file of a test, removed with it.
class ScratchFile {
 public:
  explicit ScratchFile(const std::string& text = "") {
    std::string name = ::testing::TempDir() + "plumb-coefficients-XXXXXX";
    const int descriptor = ::mkstemp(name.data());
    EXPECT_GE(descriptor, 0);
    if (descriptor >= 0) ::close(descriptor);
    path_ = name;
    if (!text.empty()) std::ofstream(path_, std::ios::binary) << text;
  }
  ~ScratchFile() { std::remove(path_.c_str()); }
  ScratchFile(const ScratchFile&) = delete;
  ScratchFile& operator=(const ScratchFile&) = delete;
  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

/// As plumb monitor reads it.
inline plumb::io::CalibrationFile through_file(const pc::Adoption& adoption, const plumb::io::ArrayFile& array) {
  const ScratchFile file;
  const auto saved = pc::save_adoption(file.path(), adoption, array, "2026-03-31", "0042");
  EXPECT_TRUE(saved.has_value()) << (saved ? "" : saved.error().text());
  auto read = plumb::io::read_calibration(file.path(), array);
  EXPECT_TRUE(read.has_value()) << (read ? "" : read.error().text());
  return read ? *std::move(read) : plumb::io::CalibrationFile{};
}

}  // namespace coefficients_test
