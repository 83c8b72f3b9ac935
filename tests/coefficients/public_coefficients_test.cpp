// Coefficients that others published, and the recordings that they belong to.
#include <iostream>
#include <map>

#include "coefficients_support.hpp"
#include "plumb/logs/flight_log.hpp"
#include "support/recording.hpp"

namespace public_coefficients_test {
namespace {

using namespace coefficients_test;

/// The certificate of the maker as a table, and as imu_tk would write it.
std::string as_csv(const plumb_test::Recording& factory) {
  std::string out = "id,scale,bias\n";
  for (const char* axis : {"x", "y", "z"})
    out += std::string("a") + axis + "," + plumb::io::shortest(factory.at(0, axis)) + " count/(m/s^2)," +
           plumb::io::shortest(factory.at(1, axis)) + " count\n";
  return out;
}
std::string as_imu_tk(const plumb_test::Recording& factory) {
  std::string scale, bias;
  for (std::size_t k = 0; k < 9; ++k)
    scale += (k % 4 == 0 ? plumb::io::shortest(1.0 / factory.at(0, std::string(1, "xyz"[k / 4]))) : "0") + " ";
  for (const char* axis : {"x", "y", "z"}) bias += plumb::io::shortest(factory.at(1, axis)) + "\n";
  return "1 0 0\n0 1 0\n0 0 1\n\n" + scale + "\n\n" + bias;
}

TEST(PublicCoefficients, TheCertificateOfAnXsensMeasuresGravity) {
  PLUMB_RECORDING(factory, "imutk_xsens_factory.csv")
  PLUMB_RECORDING(means, "imutk_xsens_static_means.csv")
  const auto array = plumb::io::read_array_file(std::string(PLUMB_SOURCE_DIR) + "/examples/xsens.toml");
  ASSERT_TRUE(array.has_value()) << array.error().text();
  const auto table = adopted(*array, as_csv(factory));
  ASSERT_TRUE(table.has_value()) << table.error().text();
  const auto matrices = adopted(*array, as_imu_tk(factory));
  ASSERT_TRUE(matrices.has_value()) << matrices.error().text();
  double square = 0.0, nominal = 0.0;
  for (std::size_t k = 0; k < means.rows.size(); ++k) {
    plumb::Vec3 a{}, by_nominal{};
    for (int i = 0; i < 3; ++i) {
      const auto at = static_cast<std::size_t>(i);
      const double raw = means.at(k, std::string("a") + "xyz"[at] + "_cnt");
      a[at] = felt(table->calibration.model, i, raw);
      by_nominal[at] = felt(array->datasheet.model(), i, raw);
      EXPECT_NEAR(a[at], felt(matrices->calibration.model, i, raw), 1e-11);
    }
    square += std::pow(plumb::norm(a) - array->gravity.g_mps2, 2.0);
    nominal += std::pow(plumb::norm(by_nominal) - array->gravity.g_mps2, 2.0);
  }
  ASSERT_GE(means.rows.size(), 30U);
  const auto rms_mg0 = [&means](double sum) {
    return 1e3 * plumb::g0_from_mps2(std::sqrt(sum / static_cast<double>(means.rows.size())));
  };
  std::cout << "[ measured ] length of gravity by the certificate: " << rms_mg0(square)
            << " mg0 rms, by the array file: " << rms_mg0(nominal) << " mg0\n";
  EXPECT_LT(rms_mg0(square), 5.0);
  EXPECT_GT(rms_mg0(nominal), 10.0 * rms_mg0(square));
}

class ParametersOnly : public plumb::logs::LogSink {
 public:
  void source(std::size_t, const plumb::logs::ImuSource&) override {}
  void record(std::size_t, const plumb::logs::ImuRecord&) override {}
  void parameter(const std::string& name, double value) override { parameters[name] = value; }
  void note(std::uint64_t, const std::string&) override {}
  std::map<std::string, double> parameters;
};

TEST(PublicCoefficients, ThoseInLogsOfRealAutopilotsAreTaken) {
  int read = 0;
  for (const char* name :
       {"logs/sample_appended_multiple.ulg", "logs/sample_log_small.ulg", "logs/sample_px4_events.ulg"}) {
    ParametersOnly sink;
    if (!plumb::logs::read_ulog(plumb_test::recording_path(name), sink)) continue;
    ++read;
    const auto file = pc::coefficients_of(sink.parameters, pc::Form::px4, name);
    ASSERT_TRUE(file.has_value()) << file.error().text();
    const auto array = drone(static_cast<int>(file->chips.size()));
    const auto found = pc::adopt(array, {*file}, usual_choice());
    ASSERT_TRUE(found.has_value()) << found.error().text();
    for (std::size_t chip = 0; chip < file->chips.size(); ++chip) {
      const auto& c = file->chips[chip];
      std::cout << "[ measured ] " << name << " " << c.name << ": offset " << c.offset[0][0] << ", " << c.offset[0][1]
                << ", " << c.offset[0][2] << " m/s^2, scale " << c.matrix[0] << ", " << c.matrix[4] << ", "
                << c.matrix[8] << "\n";
      const int z = static_cast<int>(3 * chip + 2);
      EXPECT_NEAR(felt(found->calibration.model, z, -9.8), (-9.8 - c.offset[0][2]) * c.matrix[8], 1e-12);
    }
  }
  if (read == 0) GTEST_SKIP() << "no logs of PX4 in " << plumb_test::recording_path("logs");
}

}  // namespace
}  // namespace public_coefficients_test
