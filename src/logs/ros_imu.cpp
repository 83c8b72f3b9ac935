#include "ros_imu.hpp"

#include <cmath>
#include <cstring>

namespace plumb {
inline namespace PLUMB_ABI {
namespace logs {
namespace {

constexpr std::size_t kEncapsulation = 4;

/// Bytes of numbers one behind the other. A read past the end gives 0 and is remembered.
class Cdr {
 public:
  Cdr(const unsigned char* bytes, std::size_t size, bool big, std::size_t alignment)
      : bytes_(bytes), size_(size), big_(big), alignment_(alignment) {}

  std::uint32_t u32() noexcept { return static_cast<std::uint32_t>(whole(4, 4)); }
  double f64() noexcept {
    const std::uint64_t bits = whole(8, alignment_);
    double out = 0.0;
    std::memcpy(&out, &bits, sizeof out);
    return out;
  }
  template <std::size_t n>
  std::array<double, n> numbers() noexcept {
    std::array<double, n> out{};
    for (double& x : out) x = f64();
    return out;
  }
  /// Its length counts the zero at its end.
  std::string_view text() noexcept {
    const std::uint32_t count = u32();
    if (ended_ || count > size_ - at_) {
      ended_ = true;
      return {};
    }
    const char* begin = reinterpret_cast<const char*>(bytes_ + at_);  // NOLINT(*-reinterpret-cast): bytes as text
    at_ += count;
    const std::string_view out(begin, count);
    return out.substr(0, out.find('\0'));
  }
  bool ended() const noexcept { return ended_; }

 private:
  std::uint64_t whole(std::size_t count, std::size_t alignment) noexcept {
    const std::size_t from = (at_ + alignment - 1) / alignment * alignment;
    if (ended_ || from > size_ || count > size_ - from) {
      ended_ = true;
      return 0;
    }
    std::uint64_t out = 0;
    for (std::size_t k = 0; k < count; ++k) out = out << 8U | bytes_[from + (big_ ? k : count - 1 - k)];
    at_ = from + count;
    return out;
  }

  const unsigned char* bytes_;
  std::size_t size_;
  bool big_;
  std::size_t alignment_;  ///< of eight bytes: 8, and 4 from version 2 on
  std::size_t at_ = 0;
  bool ended_ = false;
};

/// "If one of the data elements is not estimated, set element 0 of its covariance to -1."
bool is_estimated(const std::array<double, 9>& covariance) noexcept { return !(std::abs(covariance[0] + 1.0) <= 0.0); }

/// All zeros mean that it is not known.
Axes diagonal(const std::array<double, 9>& covariance) noexcept {
  const Axes out = {covariance[0], covariance[4], covariance[8]};
  for (const double x : out) {
    if (!(x > 0.0) || !std::isfinite(x)) return kAbsentAxes;
  }
  return out;
}

}  // namespace

std::string_view parse_ros_imu(const unsigned char* bytes, std::size_t size, RosImu& out) noexcept {
  if (size < kEncapsulation) return "the message is shorter than its head of 4 bytes";
  const unsigned kind = static_cast<unsigned>(bytes[0]) << 8U | bytes[1];
  const bool first_version = kind <= 1;
  const bool second_version = kind == 6 || kind == 7;
  if (!first_version && !second_version) return "the message is in an encoding of CDR that is not read here";
  Cdr cdr(bytes + kEncapsulation, size - kEncapsulation, (kind & 1U) == 0, first_version ? 8 : 4);
  out.sec = static_cast<std::int32_t>(cdr.u32());
  out.nanosec = cdr.u32();
  out.frame_id = cdr.text();
  (void)cdr.numbers<4>();  // the orientation and its covariance
  (void)cdr.numbers<9>();
  out.rate_radps = cdr.numbers<3>();
  const auto rate_covariance = cdr.numbers<9>();
  out.specific_force_mps2 = cdr.numbers<3>();
  const auto force_covariance = cdr.numbers<9>();
  if (cdr.ended()) return "the message is shorter than sensor_msgs/msg/Imu";
  if (!is_estimated(rate_covariance)) out.rate_radps = kAbsentAxes;
  out.has_force = is_estimated(force_covariance);
  out.variance_m2ps4 = diagonal(force_covariance);
  return {};
}

}  // namespace logs
}  // namespace PLUMB_ABI
}  // namespace plumb
