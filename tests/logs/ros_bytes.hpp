/// Messages of ROS 2 in CDR, for tests: written by hand from the rules of OMG, not from the reader.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>

namespace ros_bytes {

struct Imu {
  std::int32_t sec = 1700000000;
  std::uint32_t nanosec = 250000000;
  std::string frame_id = "imu_link";
  std::array<double, 3> rate = {0.01, -0.02, 0.03};
  std::array<double, 3> force = {0.5, -0.25, 9.75};
  double orientation_covariance = -1.0;  ///< the first element of each; the others of the diagonal are the same
  double rate_covariance = 0.0;
  double force_covariance = 0.0;
};

enum class Cdr : unsigned char { big = 0, little = 1, big_2 = 6, little_2 = 7 };

/// Numbers one behind the other, each at a multiple of its size.
class CdrWriter {
 public:
  explicit CdrWriter(Cdr kind) : kind_(kind) {}

  template <class T>
  CdrWriter& put(T value) {
    const bool second = kind_ == Cdr::big_2 || kind_ == Cdr::little_2;
    const std::size_t step = second && sizeof value > 4 ? 4 : sizeof value;
    while (body_.size() % step != 0) body_ += '\0';
    std::array<char, sizeof value> bytes{};
    std::memcpy(bytes.data(), &value, sizeof value);  // tests run on little-endian machines
    const bool is_big = kind_ == Cdr::big || kind_ == Cdr::big_2;
    for (std::size_t k = 0; k < bytes.size(); ++k) body_ += bytes[is_big ? bytes.size() - 1 - k : k];
    return *this;
  }
  CdrWriter& text(const std::string& value) {
    put(static_cast<std::uint32_t>(value.size() + 1));
    body_ += value + '\0';
    return *this;
  }
  CdrWriter& covariance(double first, double rest) {
    for (int k = 0; k < 9; ++k) put(k == 0 ? first : k % 4 == 0 ? rest : 0.0);
    return *this;
  }
  std::string bytes() const { return std::string{'\0', static_cast<char>(kind_), '\0', '\0'} + body_; }

 private:
  Cdr kind_;
  std::string body_;
};

inline std::string imu(const Imu& m, Cdr kind = Cdr::little) {
  CdrWriter out(kind);
  out.put(m.sec).put(m.nanosec).text(m.frame_id);
  out.put(0.0).put(0.0).put(0.0).put(1.0).covariance(m.orientation_covariance, m.orientation_covariance);
  for (const double x : m.rate) out.put(x);
  out.covariance(m.rate_covariance, m.rate_covariance);
  for (const double x : m.force) out.put(x);
  out.covariance(m.force_covariance, m.force_covariance);
  return out.bytes();
}

/// At rest, `k` hundredths of a second later.
inline Imu imu_at(int k, double z = 9.75) {
  Imu out;
  out.sec += (25 + k) / 100;
  out.nanosec = static_cast<std::uint32_t>((25 + k) % 100) * 10000000U;
  out.force[2] = z;
  return out;
}

}  // namespace ros_bytes
