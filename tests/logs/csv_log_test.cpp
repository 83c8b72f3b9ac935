// Tables of readings as people have them: how they are laid out is found out, and said.
#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

#include "csv_told.hpp"
#include "support/recording.hpp"

namespace csv_log_test {
namespace {

using namespace csv_told;

constexpr double kG_mps2 = 9.80665;

/// Three rows of 0, 0.01 and 0.02 s with (0.5, -0.25, 9.5) m/s^2.
void expect_three(const Told& told, const std::string& what, double tolerance_mps2 = 1e-12) {
  ASSERT_EQ(told.sources.size(), 1U) << what;
  ASSERT_EQ(told.records.size(), 3U) << what << "\n" << told.all_notes();
  for (std::size_t k = 0; k < 3; ++k) {
    const ImuRecord& record = told.records[k].second;
    EXPECT_NEAR(record.time_s, 0.01 * static_cast<double>(k), 1e-12) << what;
    EXPECT_NEAR(record.specific_force_mps2[0], 0.5, tolerance_mps2) << what;
    EXPECT_NEAR(record.specific_force_mps2[1], -0.25, tolerance_mps2) << what;
    EXPECT_NEAR(record.specific_force_mps2[2], 9.5, tolerance_mps2) << what;
  }
}

TEST(CsvLog, SeparatorsDecimalMarksPreamblesAndCommentsAreFoundOut) {
  struct Case {
    std::string text;
    std::string understood;
  };
  const std::vector<Case> cases = {
      {"time_s,ax [m/s^2],ay [m/s^2],az [m/s^2]\n0,0.5,-0.25,9.5\n0.01,0.5,-0.25,9.5\n0.02,0.5,-0.25,9.5\n",
       "separated by ',', header in line 1"},
      {"time_s;ax [m/s^2];ay [m/s^2];az [m/s^2]\n0;0.5;-0.25;9.5\n0.01;0.5;-0.25;9.5\n0.02;0.5;-0.25;9.5\n",
       "separated by ';', header"},
      {"Zeit [s];ax [m/s^2];ay [m/s^2];az [m/s^2]\r\n0;0,5;-0,25;9,5\r\n0,01;0,5;-0,25;9,5\r\n0,02;0,5;-0,25;9,5\r\n",
       "separated by ';', decimal comma"},
      {"time_s\tax_mps2\tay_mps2\taz_mps2\n0\t0,5\t-0,25\t9,5\n0,01\t0,5\t-0,25\t9,5\n0,02\t0,5\t-0,25\t9,5\n",
       "separated by tabs, decimal comma"},
      {"time_s ax_mps2 ay_mps2 az_mps2\n 0.00  0.5 -0.25   9.5\n 0.01  0.5 -0.25   9.5\n 0.02\t0.5 -0.25 9.5  \n",
       "separated by blanks"},
      {"time_s|ax_mps2|ay_mps2|az_mps2\n0|0.5|-0.25|9.5\n0.01|0.5|-0.25|9.5\n0.02|0.5|-0.25|9.5", "separated by '|'"},
      {"# made by a logger\n# time_s ax_mps2 ay_mps2 az_mps2\n0,0.5,-0.25,9.5\n# pause\n\n0.01,0.5,-0.25,9.5\n"
       "0.02,0.5,-0.25,9.5\n",
       "separated by ',', header in line 2"},
      {"Logger 3000;V1.2\nSerial: 0012\nStart, "
       "12:00\n\nt;ax;ay;az\ns;m/s\xC2\xB2;m/s\xC2\xB2;m/s\xC2\xB2\n0;0.5;-0.25;9.5\n"
       "0.01;0.5;-0.25;9.5\n0.02;0.5;-0.25;9.5\n",
       "header in line 5"},
      {"\"time_s\",\"ax_mps2\",\"ay_mps2\",\"az_mps2\",\"what, if any\"\n\"0\",\"0.5\",\"-0.25\",\"9.5\",\"a, b\"\n"
       "\"0.01\",\"0.5\",\"-0.25\",\"9.5\",\"\"\n\"0.02\",\"0.5\",\"-0.25\",\"9.5\",x\n",
       "separated by ','"},
      {"time_s,ax_mps2,ay_mps2,az_mps2\n0,0.5,-0.25,9.5,\n0.01,0.5,-0.25,9.5,\n0.02,0.5,-0.25,9.5,\n",
       "separated by ','"},
      {"time_s,ax_mps2,ay_mps2,az_mps2\r0,0.5,-0.25,9.5\r0.01,+0.5,-2.5e-1,95E-1\r0.02,0.5,-0.25,9.5\r",
       "separated by ','"},
  };
  for (const Case& one : cases) {
    const Told told = told_of_table(one.text.back() == '5' ? one.text + "\n" : one.text);
    EXPECT_NE(told.understood.find(one.understood), std::string::npos) << told.understood;
    EXPECT_EQ(told.all_notes(), "") << one.text;
    expect_three(told, one.text);
  }
}

TEST(CsvLog, EveryEncodingIsRead) {
  const std::string text =
      "time_s;ax_mps2;ay_mps2;az_mps2\r\n0;0,5;-0,25;9,5\r\n0,01;0,5;-0,25;9,5\r\n0,02;0,5;-0,25;9,5\r\n";
  for (const std::string& bytes : {"\xEF\xBB\xBF" + text, "\xFF\xFE" + utf16(text, false),
                                   "\xFE\xFF" + utf16(text, true), utf16(text, false), utf16(text, true)}) {
    expect_three(told_of_table(bytes), text);
  }
  EXPECT_NE(told_of_table("\xFE\xFF" + utf16(text, true)).understood.find("UTF-16 (big-endian)"), std::string::npos);
}

TEST(CsvLog, UnitsInNamesAreRead) {
  struct Case {
    std::string x, y, z;
    double unit_mps2;
  };
  const std::vector<Case> cases = {
      {"acc_x [m/s^2]", "acc_y [m/s^2]", "acc_z [m/s^2]", 1.0},
      {"ax_g", "ay_g", "az_g", kG_mps2},
      {"accelerometer_m_s2[0]", "accelerometer_m_s2[1]", "accelerometer_m_s2[2]", 1.0},
      {"Accel-X (g)", "Accel-Y (g)", "Accel-Z (g)", kG_mps2},
      {"Acceleration x (m/s^2)", "Acceleration y (m/s^2)", "Acceleration z (m/s^2)", 1.0},
      {"accelerometerAccelerationX(G)", "accelerometerAccelerationY(G)", "accelerometerAccelerationZ(G)", kG_mps2},
      {"gFx", "gFy", "gFz", kG_mps2},
      {"a_RS_S_x [m s^-2]", "a_RS_S_y [m s^-2]", "a_RS_S_z [m s^-2]", 1.0},
      {"AccX_mg", "AccY_mg", "AccZ_mg", 1e-3 * kG_mps2},
      {"x_acc_mps2", "y_acc_mps2", "z_acc_mps2", 1.0},
      {"field.linear_acceleration.x", "field.linear_acceleration.y", "field.linear_acceleration.z", 1.0},
      {"ax [ft/s2]", "ay [ft/s2]", "az [ft/s2]", 0.3048},
      {"Accel_LN_X_CAL m/(s^2)", "Accel_LN_Y_CAL m/(s^2)", "Accel_LN_Z_CAL m/(s^2)", 1.0},
      {"Gx (g)", "Gy (g)", "Gz (g)", kG_mps2},
      {"x [Gal]", "y [Gal]", "z [Gal]", 0.01},
  };
  for (const Case& one : cases) {
    std::string text = "time_s," + one.x + "," + one.y + "," + one.z + "\n";
    for (const char* time : {"0", "0.01", "0.02"})
      text += std::string(time) + "," + std::to_string(0.5 / one.unit_mps2) + "," +
              std::to_string(-0.25 / one.unit_mps2) + "," + std::to_string(9.5 / one.unit_mps2) + "\n";
    expect_three(told_of_table(text), one.x, 1e-4);
  }
}

TEST(CsvLog, AUnitThatNoNameSaysIsToldByTheLengthOfGravityWithANote) {
  struct Case {
    double gravity;
    std::string words;
  };
  for (const Case& one : {Case{9.81, "taken for m/s^2"}, Case{0.98, "0.980, taken for g"}, Case{1001.0, "taken for mg"},
                          Case{16500.0, "counts of 1/16384 g"}, Case{4100.0, "counts of 1/4096 g"}}) {
    std::string text = "t;ax;ay;az\n";
    for (int k = 0; k < 20; ++k) text += std::to_string(0.01 * k) + ";0;0;" + std::to_string(-one.gravity) + "\n";
    const Told told = told_of_table(text);
    ASSERT_EQ(told.records.size(), 20U);
    EXPECT_NEAR(told.records[0].second.specific_force_mps2[2], -kG_mps2, 0.3) << one.words;
    EXPECT_EQ(told.notes.size(), 1U) << told.all_notes();
    EXPECT_TRUE(told.noted(one.words)) << told.all_notes();
  }
  EXPECT_NE(refusal_of_table("t_s;ax;ay;az\n0;0;0;77\n1;0;0;77\n").what.find("a length of 77.000 tells none"),
            std::string::npos);
  CsvHints hints;
  hints.force_unit_mps2 = 0.1;
  EXPECT_DOUBLE_EQ(told_of_table("t_s;ax;ay;az\n0;0;0;77\n1;0;0;77\n", hints).records[0].second.specific_force_mps2[2],
                   7.7);
}

TEST(CsvLog, TimesAreReadInEveryForm) {
  struct Case {
    std::string name, first, second, note;
  };
  const std::vector<Case> cases = {
      {"time_s", "1.5", "1.51", ""},
      {"time [ms]", "1500", "1510", ""},
      {"TimeUS", "1500000", "1510000", ""},
      {"timestamp [ns]", "1500000000", "1510000000", ""},
      {"t", "1.5", "1.51", ""},
      {"t", "1500", "1510", "steps of 10.000 are taken for milliseconds"},
      {"timestamp", "1500000", "1510000", "taken for microseconds"},
      {"timestamp", "1500000000", "1510000000", "taken for nanoseconds"},
      {"timestamp", "1700000001500000000", "1700000001510000000", "taken for nanoseconds"},
      {"timestamp", "1700000001500000", "1700000001510000", "taken for microseconds"},
      {"timestamp", "1700000001500", "1700000001510", "taken for milliseconds"},
      {"timestamp", "1700000001.5", "1700000001.51", ""},
      {"date", "2023-11-14T22:13:21.5Z", "2023-11-14T22:13:21.51Z", ""},
      {"date", "2023-11-15 00:13:21.5+02:00", "2023-11-15 00:13:21.510+02:00", ""},
      {"Datum date", "14.11.2023 22:13:21.500", "14.11.2023 22:13:21.510", ""},
      {"date", "11/14/2023 22:13:21.500", "11/14/2023 22:13:21.510", ""},
      {"time", "00:00:01.5", "00:00:01.51", ""},
  };
  for (const Case& one : cases) {
    const Told told =
        told_of_table(one.name + ",ax_mps2,ay_mps2,az_mps2\n" + one.first + ",1,2,3\n" + one.second + ",1,2,3\n");
    ASSERT_EQ(told.records.size(), 2U) << one.first << told.all_notes();
    const bool is_since_1970 = !told.parameters.empty();
    EXPECT_DOUBLE_EQ(told.records[0].second.time_s, is_since_1970 ? 0.5 : 1.5) << one.first;
    EXPECT_DOUBLE_EQ(told.records[1].second.time_s, is_since_1970 ? 0.51 : 1.51) << one.second;
    if (is_since_1970) {
      EXPECT_EQ(told.parameters[0].second, 1700000001.0) << one.first;
    }
    EXPECT_EQ(told.notes.empty(), one.note.empty()) << told.all_notes();
    EXPECT_TRUE(one.note.empty() || told.noted(one.note)) << told.all_notes();
  }
}

TEST(CsvLog, ATimeMayStandInTwoColumnsOrBesideADate) {
  const Told stamps = told_of_table(
      "header.stamp.sec,header.stamp.nanosec,header.frame_id,linear_acceleration.x,linear_acceleration.y,"
      "linear_acceleration.z,angular_velocity.x,angular_velocity.y,angular_velocity.z\n"
      "1700000001,500000000,imu,0.5,-0.25,9.5,1,2,3\n1700000002,10000000,imu,0.5,-0.25,9.5,1,2,3\n");
  ASSERT_EQ(stamps.records.size(), 2U) << stamps.understood << stamps.all_notes();
  EXPECT_DOUBLE_EQ(stamps.records[0].second.time_s, 0.5);
  EXPECT_DOUBLE_EQ(stamps.records[1].second.time_s, 1.01);
  EXPECT_EQ(stamps.records[0].second.rate_radps, (Axes{1.0, 2.0, 3.0}));
  EXPECT_EQ(stamps.all_notes(), "");
  const Told clock = told_of_table("Datum;Uhrzeit;IMUAccX [g];IMUAccY [g];IMUAccZ [g]\n29.02.2024;12:00:00,5;0;0;1\n");
  ASSERT_EQ(clock.records.size(), 1U) << clock.understood;
  EXPECT_DOUBLE_EQ(clock.records[0].second.time_s, 43200.5);
  EXPECT_EQ(clock.sources[0].name, "imu");
  const Told plotted = told_of_table(
      "__time,/imu/linear_acceleration/x,/imu/linear_acceleration/y,/imu/linear_acceleration/z\n"
      "1700000001.25,0.5,-0.25,9.5\n");
  ASSERT_EQ(plotted.records.size(), 1U);
  EXPECT_DOUBLE_EQ(plotted.records[0].second.time_s, 0.25);
}

TEST(CsvLog, SeveralChipsRatesAndTemperatures) {
  const Told told = told_of_table(
      "time_s,imu0_ax_g,imu0_ay_g,imu0_az_g,imu0_gx_dps,imu0_gy_dps,imu0_gz_dps,imu0_temp_degC,"
      "imu1_ax_g,imu1_ay_g,imu1_az_g,imu1_gx_dps,imu1_gy_dps,imu1_gz_dps,imu1_temp_degC\n"
      "0,0,0,1,180,0,0,25.5,0,1,0,0,90,0,30\n1,,,,,,,,0,1,0,0,90,0,\n");
  ASSERT_EQ(told.sources.size(), 2U);
  EXPECT_EQ(told.sources[0].name, "imu0");
  EXPECT_EQ(told.sources[1].name, "imu1");
  ASSERT_EQ(told.records.size(), 3U) << "a row may have the readings of one chip alone";
  EXPECT_DOUBLE_EQ(told.records[0].second.specific_force_mps2[2], kG_mps2);
  EXPECT_NEAR(told.records[0].second.rate_radps[0], 3.14159265, 1e-8);
  EXPECT_DOUBLE_EQ(told.records[0].second.temperature_degc, 25.5);
  EXPECT_NEAR(told.records[1].second.rate_radps[1], 1.57079633, 1e-8);
  EXPECT_TRUE(std::isnan(told.records[2].second.temperature_degc));
  EXPECT_EQ(told.all_notes(), "");
  const Told numbered =
      told_of_table("t_s,a1x,a1y,a1z,ax2,ay2,az2,wx,wy,wz\n0,0,0,9.8,0,0,9.8,1,1,1\n1,0,0,9.8,0,0,9.8,1,1,1\n");
  ASSERT_EQ(numbered.sources.size(), 2U) << numbered.understood;
  EXPECT_EQ(numbered.sources[0].name, "acc1");
  EXPECT_EQ(numbered.sources[1].name, "acc2");
}

TEST(CsvLog, ARateWithoutAUnitIsLeftOutAndThatIsSaid) {
  const Told told = told_of_table("t_s,ax_mps2,ay_mps2,az_mps2,gx,gy,gz\n0,0,0,9.8,1,1,1\n");
  ASSERT_EQ(told.records.size(), 1U);
  EXPECT_TRUE(std::isnan(told.records[0].second.rate_radps[0]));
  EXPECT_TRUE(told.noted("\"gx\" says no unit of a rate")) << told.all_notes();
}

TEST(CsvLog, FilesOfUlog2csvAreAlignedByTheirTime) {
  const std::string head =
      "timestamp,timestamp_sample,device_id,x,y,z,temperature,error_count,clip_counter[0],samples\n";
  const Told first =
      told_of_table(head + "1500007,1500000,2752522,0.5,-0.25,-9.75,31.5,0,0,1\n", {}, "log_3_sensor_accel_0.csv");
  const Told second =
      told_of_table(head + "1500307,1500300,3670050,0.5,-0.25,-9.5,32.5,0,0,1\n", {}, "log_3_sensor_accel_1.csv");
  ASSERT_EQ(first.records.size(), 1U);
  ASSERT_EQ(second.records.size(), 1U);
  EXPECT_EQ(first.sources[0].name, "sensor_accel[0]");
  EXPECT_EQ(second.sources[0].name, "sensor_accel[1]");
  EXPECT_EQ(second.sources[0].device_id, 3670050U);
  EXPECT_DOUBLE_EQ(first.records[0].second.time_s, 1.5);
  EXPECT_DOUBLE_EQ(second.records[0].second.time_s, 1.5003);
  EXPECT_DOUBLE_EQ(second.records[0].second.temperature_degc, 32.5);
  EXPECT_EQ(second.sources[0].instance, 1);
  EXPECT_TRUE(second.sources[0].uncalibrated);
  EXPECT_EQ(first.notes_with("x, y, z"), 0U) << first.all_notes();
  const Told combined = told_of_table(
      "timestamp,gyro_rad[0],gyro_rad[1],gyro_rad[2],accelerometer_timestamp_relative,"
      "accelerometer_m_s2[0],accelerometer_m_s2[1],accelerometer_m_s2[2]\n"
      "2000000,1,2,3,0,0.5,-0.25,-9.75\n",
      {}, "log_3_sensor_combined_0.csv");
  ASSERT_EQ(combined.records.size(), 1U);
  EXPECT_EQ(combined.sources[0].name, "sensor_combined[0]");
  EXPECT_FALSE(combined.sources[0].uncalibrated);
  EXPECT_EQ(combined.records[0].second.rate_radps, (Axes{1.0, 2.0, 3.0}));
  EXPECT_DOUBLE_EQ(combined.records[0].second.time_s, 2.0);
}

TEST(CsvLog, ArduPilotsTableHasAColumnOfInstances) {
  const Told told = told_of_table(
      "timestamp,TimeUS,I,GyrX,GyrY,GyrZ,AccX,AccY,AccZ,EG,EA,T\n"
      "1700000000.5,1000000,0,0.1,0.2,0.3,0.5,-0.25,-9.5,0,0,40\n"
      "1700000000.5,1000100,1,0.1,0.2,0.3,0.5,-0.25,-9.75,0,0,41\n"
      "1700000000.5,1000100,99,0.1,0.2,0.3,0.5,-0.25,-9.75,0,0,41\n");
  ASSERT_EQ(told.sources.size(), 2U) << told.all_notes();
  EXPECT_EQ(told.sources[1].name, "IMU[1]");
  EXPECT_EQ(told.sources[1].instance, 1);
  EXPECT_DOUBLE_EQ(told.records[1].second.time_s, 1.0001);
  EXPECT_EQ(told.records[1].second.rate_radps, (Axes{0.1, 0.2, 0.3}));
  EXPECT_EQ(told.notes_with("no chip has this instance"), 1U) << told.all_notes();
}

TEST(CsvLog, ArduPilotsLongFormIsRead) {
  const std::string format =
      "FMT, 128, 89, FMT, BBnNZ, Type,Length,Name,Format,Columns\n"
      "FMT, 140, 60, IMU, QBffffffIIfBBHH, TimeUS,I,GyrX,GyrY,GyrZ,AccX,AccY,AccZ,EG,EA,T,GH,AH,GHz,AHz\n";
  const std::string rows =
      "PARM, 100000, INS_ACCOFFS_X, 0.25, 0\n"
      "IMU, 1000000, 0, 0.1, 0.2, 0.3, 0.5, -0.25, -9.5, 0, 0, 40, 1, 1, 1000, 1000\n"
      "GPS, 1000050, 3, 1, 2\n"
      "IMU, 1000100, 1, 0.1, 0.2, 0.3, 0.5, -0.25, -9.75, 0, 0, 41, 1, 1, 1000, 1000\n";
  const std::string header = "IMU, TimeUS, I, GyrX, GyrY, GyrZ, AccX, AccY, AccZ, EG, EA, T\n";
  const std::string printed =
      "2024-05-01 12:00:00.00: PARM {TimeUS : 100000, Name : INS_ACCOFFS_X, Value : 0.25}\n"
      "2024-05-01 12:00:00.01: IMU {TimeUS : 1000000, I : 0, GyrX : 0.1, GyrY : 0.2, GyrZ : 0.3, AccX : 0.5, AccY : "
      "-0.25, AccZ : -9.5, T : 40}\n"
      "2024-05-01 12:00:00.01: IMU {TimeUS : 1000100, I : 1, GyrX : 0.1, GyrY : 0.2, GyrZ : 0.3, AccX : 0.5, AccY : "
      "-0.25, AccZ : -9.75, T : 41}\n";
  for (const std::string& text : {format + rows, header + rows, rows, printed}) {
    const Told told = told_of_table(text);
    ASSERT_EQ(told.records.size(), 2U) << text << told.all_notes();
    EXPECT_EQ(told.sources[0].name, "IMU[0]");
    EXPECT_EQ(told.sources[1].name, "IMU[1]");
    EXPECT_DOUBLE_EQ(told.records[1].second.time_s, 1.0001);
    EXPECT_EQ(told.records[1].second.specific_force_mps2, (Axes{0.5, -0.25, -9.75}));
    EXPECT_EQ(told.records[0].second.rate_radps, (Axes{0.1, 0.2, 0.3}));
    if (text != rows) {
      EXPECT_DOUBLE_EQ(told.records[0].second.temperature_degc, 40.0) << text;
    }
    ASSERT_EQ(told.parameters.size(), 1U) << text;
    EXPECT_EQ(told.parameters[0], (std::pair<std::string, double>("INS_ACCOFFS_X", 0.25)));
    EXPECT_EQ(told.notes.size(), text == rows ? 1U : 0U) << told.all_notes();
  }
  const Told older = told_of_table(
      "IMU, 1000000, 0.1, 0.2, 0.3, 0.5, -0.25, -9.5, 0, 0, 40\nIMU2, 1000000, 0.1, 0.2, 0.3, 0.5, -0.25, -9.5, 0, 0, "
      "40\n"
      "ACC1, 1000000, 999000, 0.5, -0.25, -9.5\n");
  ASSERT_EQ(older.sources.size(), 3U) << older.all_notes();
  EXPECT_EQ(older.sources[1].name, "IMU[1]");
  EXPECT_EQ(older.sources[2].name, "ACC[0]");
}

TEST(CsvLog, HintsTakeThePlaceOfWhatIsFoundOut) {
  CsvHints hints;
  hints.header = {"time", "-", "ax", "ay", "az"};
  hints.time_unit_s = 1e-3;
  hints.force_unit_mps2 = kG_mps2;
  const Told told = told_of_table("1500;7;0;0;1\n1510;7;0;0;1\n", hints);
  ASSERT_EQ(told.records.size(), 2U) << told.all_notes();
  EXPECT_DOUBLE_EQ(told.records[1].second.time_s, 1.51);
  EXPECT_DOUBLE_EQ(told.records[1].second.specific_force_mps2[2], kG_mps2);
  EXPECT_EQ(told.all_notes(), "");
  CsvHints rate;
  rate.rate_hz = 100.0;
  const Told timeless = told_of_table("ax_mps2,ay_mps2,az_mps2\n1,2,3\n1,2,3\n1,2,3\n", rate);
  ASSERT_EQ(timeless.records.size(), 3U);
  EXPECT_DOUBLE_EQ(timeless.records[2].second.time_s, 0.02);
  CsvHints separator;
  separator.separator = ';';
  EXPECT_NE(refusal_of_table("t_s,ax_g,ay_g,az_g\n0,0,0,1\n", separator).what.find("no rows"), std::string::npos);
}

TEST(CsvLogRecordings, TablesOfRealRecordingsAreRead) {
  const std::string path = plumb_test::recording_path("quadrotor_flight5.csv");
  if (!std::ifstream(path)) GTEST_SKIP() << "recording not found: " << path << " (set PLUMB_DATA_DIR)";
  Told told;
  const auto extent = read_log(path, told);
  ASSERT_TRUE(extent.has_value()) << extent.error().text();
  EXPECT_EQ(told.all_notes(), "");
  ASSERT_EQ(told.sources.size(), 4U);
  EXPECT_EQ(told.records.size(), 15460U);
  EXPECT_NEAR(told.records[0].second.rate_radps[0], -18.337 * 0.017453292519943295, 1e-9);
  EXPECT_EQ(told.records[0].second.specific_force_mps2, (Axes{-1.9476, 0.2129, 14.5961}));
}

}  // namespace
}  // namespace csv_log_test
