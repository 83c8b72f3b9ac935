/// Writes DataFlash logs for the tests, message by message.
#pragma once

#include <cstdint>
#include <cstring>
#include <map>
#include <string>
#include <vector>

namespace dataflash_bytes {

/// One value of a message: a number, or the text of n, N and Z.
struct Value {
  // NOLINTBEGIN(*-explicit-*): a row reads as a list of numbers and texts
  Value(double n) : number(n) {}
  Value(const char* t) : text(t) {}
  // NOLINTEND(*-explicit-*)
  double number = 0.0;
  std::string text;
};

class Log {
 public:
  /// `length` 0: what the letters need.
  Log& fmt(std::uint8_t type, const std::string& name, const std::string& letters, const std::string& labels,
           int length = 0) {
    letters_[type] = letters;
    head(128);
    byte(type);
    byte(static_cast<std::uint8_t>(length > 0 ? length : 3 + size_of(letters)));
    padded(name, 4);
    padded(letters, 16);
    padded(labels, 64);
    return *this;
  }
  Log& message(std::uint8_t type, const std::vector<Value>& values) {
    head(type);
    const std::string& letters = letters_.at(type);
    for (std::size_t k = 0; k < letters.size(); ++k) put(letters[k], values.at(k));
    return *this;
  }
  Log& raw(const std::string& bytes) {
    bytes_ += bytes;
    return *this;
  }
  const std::string& bytes() const { return bytes_; }
  std::size_t size() const { return bytes_.size(); }

  static int size_of(const std::string& letters) {
    int size = 0;
    for (const char letter : letters) {
      static const std::map<char, int> kSizes = {{'a', 64}, {'b', 1}, {'B', 1}, {'h', 2}, {'H', 2},  {'i', 4},
                                                 {'I', 4},  {'f', 4}, {'d', 8}, {'n', 4}, {'N', 16}, {'Z', 64},
                                                 {'c', 2},  {'C', 2}, {'e', 4}, {'E', 4}, {'L', 4},  {'M', 1},
                                                 {'q', 8},  {'Q', 8}, {'g', 2}};
      size += kSizes.at(letter);
    }
    return size;
  }

 private:
  void byte(std::uint8_t value) { bytes_ += static_cast<char>(value); }
  void head(std::uint8_t type) {
    byte(0xA3);
    byte(0x95);
    byte(type);
  }
  void padded(std::string text, std::size_t size) {
    text.resize(size, '\0');
    bytes_ += text;
  }
  template <class T>
  void little(T value) {  // the machines the tests run on are little-endian, as the log is
    char raw[sizeof(T)];
    std::memcpy(raw, &value, sizeof(T));
    bytes_.append(raw, sizeof(T));
  }
  void put(char letter, const Value& value) {
    const double number = value.number;
    switch (letter) {
      case 'b': little(static_cast<std::int8_t>(number)); return;
      case 'B':
      case 'M': little(static_cast<std::uint8_t>(number)); return;
      case 'h':
      case 'c': little(static_cast<std::int16_t>(number)); return;
      case 'H':
      case 'C':
      case 'g': little(static_cast<std::uint16_t>(number)); return;
      case 'i':
      case 'e':
      case 'L': little(static_cast<std::int32_t>(number)); return;
      case 'I':
      case 'E': little(static_cast<std::uint32_t>(number)); return;
      case 'q': little(static_cast<std::int64_t>(number)); return;
      case 'Q': little(static_cast<std::uint64_t>(number)); return;
      case 'f': little(static_cast<float>(number)); return;
      case 'd': little(number); return;
      default: padded(value.text, static_cast<std::size_t>(size_of(std::string(1, letter)))); return;
    }
  }

  std::string bytes_;
  std::map<std::uint8_t, std::string> letters_;
};

constexpr std::uint8_t kImu = 10;
constexpr std::uint8_t kAcc = 11;
constexpr std::uint8_t kVibe = 12;
constexpr std::uint8_t kParm = 13;
constexpr std::uint8_t kUnit = 14;
constexpr std::uint8_t kMult = 15;
constexpr std::uint8_t kFmtu = 16;
constexpr std::uint8_t kOther = 17;
constexpr std::uint8_t kDsf = 18;

constexpr const char* kImuLetters = "QBffffffIIfBBHH";
constexpr const char* kImuLabels = "TimeUS,I,GyrX,GyrY,GyrZ,AccX,AccY,AccZ,EG,EA,T,GH,AH,GHz,AHz";

/// The FMTs of a log of ArduPilot 4.
inline Log new_log() {
  Log log;
  log.fmt(128, "FMT", "BBnNZ", "Type,Length,Name,Format,Columns");
  log.fmt(kImu, "IMU", kImuLetters, kImuLabels);
  log.fmt(kAcc, "ACC", "QBQfff", "TimeUS,I,SampleUS,AccX,AccY,AccZ");
  log.fmt(kVibe, "VIBE", "QBfffI", "TimeUS,IMU,VibeX,VibeY,VibeZ,Clip");
  log.fmt(kParm, "PARM", "QNff", "TimeUS,Name,Value,Default");
  log.fmt(kUnit, "UNIT", "QbZ", "TimeUS,Id,Label");
  log.fmt(kMult, "MULT", "Qbd", "TimeUS,Id,Mult");
  log.fmt(kFmtu, "FMTU", "QBNN", "TimeUS,FmtType,UnitIds,MultIds");
  log.fmt(kOther, "ATT", "Qccc", "TimeUS,Roll,Pitch,Yaw");
  log.fmt(kDsf, "DSF", "QIBHIIII", "TimeUS,Dp,IErr,Blk,Bytes,FMn,FMx,FAv");
  return log;
}

/// Of instance 0, at 1 s, where not said otherwise.
struct Imu {
  double time_us = 1e6;
  int instance = 0;
  std::vector<double> rate = {0.125, -0.25, 0.5};
  std::vector<double> force = {0.75, -1.5, -9.75};
  double gyro_errors = 0;
  double force_errors = 0;
  double temperature = 41.5;
};

inline void imu(Log& log, const Imu& m) {
  log.message(kImu, {m.time_us, static_cast<double>(m.instance), m.rate[0], m.rate[1], m.rate[2], m.force[0],
                     m.force[1], m.force[2], m.gyro_errors, m.force_errors, m.temperature, 1.0, 1.0, 1000.0, 1000.0});
}
inline void imu_at(Log& log, double time_us, int instance = 0) {
  Imu m;
  m.time_us = time_us;
  m.instance = instance;
  imu(log, m);
}

}  // namespace dataflash_bytes
