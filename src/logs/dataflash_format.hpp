/// How the messages of a DataFlash log are laid out: what its FMT, FMTU, UNIT and MULT messages say, worked out once
/// so that a message takes no search.
/// https://github.com/ArduPilot/ardupilot/blob/master/libraries/AP_Logger/README.md
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "dataflash_notes.hpp"
#include "plumb/core/config.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace logs {

constexpr unsigned char kHead1 = 0xA3;
constexpr unsigned char kHead2 = 0x95;
constexpr std::size_t kHeadBytes = 3;  // the two, and the type
constexpr std::uint8_t kFmtType = 128;
constexpr std::uint8_t kFmtLength = 89;
constexpr std::size_t kMaxFields = 16;

/// A number or text in a message: where, and what the number is to be multiplied with.
struct Field {
  std::uint8_t offset = 0;  ///< from the beginning of the message
  char letter = 0;          ///< of the format; 0: the message has no such column
  double factor = 1.0;

  bool present() const noexcept { return letter != 0; }
};

/// NaN where the column is absent, or is no number.
double number_at(const unsigned char* message, const Field& field) noexcept;
/// Empty where the column is absent, or is no text.
std::string_view text_at(const unsigned char* message, const Field& field) noexcept;

enum class Family : std::uint8_t { other, imu, acc, vibe, parm, unit, mult, fmtu, dsf };

/// The columns that are read; which of them a message has depends on its family and the age of the log.
struct Columns {
  Field time;
  Field sample_time;
  Field instance;
  std::array<Field, 3> force;
  std::array<Field, 3> rate;
  Field temperature;
  Field gyro_errors;
  Field force_errors;
  Field force_health;  ///< 0: the autopilot takes the accelerometer for failed
  std::array<Field, 3> vibration;
  std::array<Field, 3> clips;  ///< VIBE: of the instance, or of the instances 0 to 2 where it has no instance
  Field name;                  ///< PARM: Name, UNIT: Label
  Field value;                 ///< PARM: Value, MULT: Mult, DSF: Dp
  Field id;                    ///< UNIT and MULT: Id, FMTU: FmtType
  Field unit_ids;
  Field multiplier_ids;
};

struct Layout {
  std::uint8_t length = 0;  ///< of the whole message; 0: no FMT yet
  Family family = Family::other;
  int instance = -1;  ///< by the name: IMU2 is 1; -1: a column says
  bool settled = false;
  bool usable = false;
  bool faults_told = false;
  bool units_told = false;
  std::array<char, 4> name{};
  std::array<char, kMaxFields> letters{};
  std::array<char, 64> labels{};
  Columns columns;

  std::string name_text() const;
};

class DataflashFormats {
 public:
  explicit DataflashFormats(DataflashNotes& notes);

  const Layout& of(std::uint8_t type) const noexcept { return layouts_[type]; }
  /// With its columns found; what they lack is noted once.
  const Layout& settled(std::uint8_t type, std::uint64_t offset) {
    Layout& layout = layouts_[type];
    if (!layout.settled) settle(type, layout, offset);
    return layout;
  }
  void fmt(const unsigned char* message, std::uint64_t offset);
  void fmtu(const unsigned char* message, const Columns& columns);
  void unit(const unsigned char* message, const Columns& columns);
  void multiplier(const unsigned char* message, const Columns& columns);

 private:
  enum class Quantity : std::uint8_t { none, time, force, rate, temperature };
  struct UnitChars {
    std::array<char, kMaxFields> units{};
    std::array<char, kMaxFields> multipliers{};
  };
  using UnitLabel = std::array<char, 16>;

  void settle(std::uint8_t type, Layout& layout, std::uint64_t offset);
  void find_columns(std::uint8_t type, Layout& layout, std::uint64_t offset);
  void find_reading(std::uint8_t type, Layout& layout, std::uint64_t offset);
  Field find(std::uint8_t type, Layout& layout, std::string_view label, Quantity quantity, std::uint64_t offset);
  double factor(std::uint8_t type, Layout& layout, std::size_t index, std::string_view label, Quantity quantity,
                std::uint64_t offset);
  void unsettle() noexcept;

  DataflashNotes& notes_;
  std::array<Layout, 256> layouts_{};
  std::array<UnitChars, 256> unit_chars_{};
  std::array<UnitLabel, 256> unit_labels_{};
  std::array<double, 256> multipliers_{};  ///< 0: says nothing, negative: never heard of
};

}  // namespace logs
}  // namespace PLUMB_ABI
}  // namespace plumb
