#include "log_magic.hpp"

#include <algorithm>
#include <array>
#include <filesystem>
#include <string>
#include <system_error>
#include <utility>

namespace plumb {
inline namespace PLUMB_ABI {
namespace logs {
namespace {

using namespace std::string_view_literals;

constexpr const char* kAsText = "export the readings as CSV";
constexpr const char* kOfFlight = "give the log that the flight controller wrote";

// clang-format off
constexpr std::array<KnownFile, 46> kKnownFiles = {{
    // Behind the header and the flags: what plumb's own begin with.
    {62, "\x10""char[5] sys_nameplumb"sv, FileKind::own, "is a ULog that plumb wrote, the log of one array",
     "give it to plumb monitor, calibrate or convert with its array file; plumb convert makes a CSV of it"},
    {0, "ULog\x01\x12\x35"sv, FileKind::ulog, "is a ULog, the log of PX4", "read it as a ULog"},
    {0, "\xA3\x95\x80"sv, FileKind::dataflash, "is a DataFlash log of ArduPilot", "read it as a DataFlash log"},
    {0, "\x89MCAP0\r\n"sv, FileKind::mcap, "is an MCAP file", "read it as MCAP"},
    {0, "SQLite format 3\0"sv, FileKind::sqlite, "is an SQLite database (perhaps a bag of ROS 2)", "read it as a bag"},
    {0, "#ROSBAG V"sv, FileKind::foreign, "is a bag of ROS 1", "convert it to a bag of ROS 2 (rosbags-convert)"},
    {0, "\x89PLOG\r\n"sv, FileKind::foreign, "is a .plog, the binary log of plumb before it wrote ULog",
     "write it as CSV with the plumb that wrote it (plumb convert)"},
    // Packed.
    {0, "\x1F\x8B"sv, FileKind::foreign, "is packed with gzip", "unpack it with gunzip"},
    {0, "\x28\xB5\x2F\xFD"sv, FileKind::foreign, "is packed with zstd", "unpack it with unzstd"},
    {0, "\xFD""7zXZ\0"sv, FileKind::foreign, "is packed with xz", "unpack it with unxz"},
    {4, "1AY&SY"sv, FileKind::foreign, "is packed with bzip2", "unpack it with bunzip2"},
    {0, "\x04\x22\x4D\x18"sv, FileKind::foreign, "is packed with lz4", "unpack it with unlz4"},
    {0, "\x1F\x9D"sv, FileKind::foreign, "is packed with compress", "unpack it with gunzip"},
    {0, "PK\x03\x04"sv, FileKind::foreign, "is a zip archive, as spreadsheets (.xlsx, .ods) are",
     "unpack it; save a spreadsheet as CSV"},
    {0, "PK\x05\x06"sv, FileKind::foreign, "is a zip archive without content", kOfFlight},
    {0, "7z\xBC\xAF\x27\x1C"sv, FileKind::foreign, "is a 7z archive", "unpack it"},
    {0, "Rar!\x1A\x07"sv, FileKind::foreign, "is a RAR archive", "unpack it"},
    {257, "ustar"sv, FileKind::foreign, "is a tar archive", "unpack it with tar"},
    // Recordings of other kinds.
    {0, "H Product:Blackbox"sv, FileKind::foreign, "is a Blackbox log of Betaflight or INAV",
     "turn it into CSV with blackbox_decode"},
    {0, "PAR1\x15"sv, FileKind::foreign, "is a Parquet file", kAsText},
    {0, "ARROW1\0\0"sv, FileKind::foreign, "is an Arrow file", kAsText},
    {0, "FEA1"sv, FileKind::foreign, "is a Feather file", kAsText},
    {0, "\x89HDF\r\n"sv, FileKind::foreign, "is an HDF5 file", kAsText},
    {0, "CDF\x01"sv, FileKind::foreign, "is a NetCDF file", kAsText},
    {0, "CDF\x02"sv, FileKind::foreign, "is a NetCDF file", kAsText},
    {0, "MATLAB 5.0 MAT-file"sv, FileKind::foreign, "is a MATLAB file", kAsText},
    {0, "\x93NUMPY"sv, FileKind::foreign, "is an array of NumPy", kAsText},
    {0, "MDF     "sv, FileKind::foreign, "is a measurement data file (MDF)", kAsText},
    {0, "UnFinMF "sv, FileKind::foreign, "is a measurement data file (MDF) that was not closed", kAsText},
    {0, "TDSm"sv, FileKind::foreign, "is a TDMS file", kAsText},
    {8, "WAVEfmt "sv, FileKind::foreign, "is a recording of sound (WAV)", kOfFlight},
    {0, "\xD4\xC3\xB2\xA1"sv, FileKind::foreign, "is a capture of a network (pcap)", kOfFlight},
    {0, "\x0A\x0D\x0D\x0A"sv, FileKind::foreign, "is a capture of a network (pcapng)", kOfFlight},
    // Documents, pictures, programs.
    {0, "%PDF-"sv, FileKind::foreign, "is a PDF document", kOfFlight},
    {0, "{\\rtf"sv, FileKind::foreign, "is a document in RTF", "save it as plain text"},
    {0, "\xD0\xCF\x11\xE0\xA1\xB1\x1A\xE1"sv, FileKind::foreign, "is a spreadsheet or document of an old Office",
     "save it as CSV"},
    {0, "\x89PNG"sv, FileKind::foreign, "is a picture (PNG)", kOfFlight},
    {0, "\xFF\xD8\xFF"sv, FileKind::foreign, "is a picture (JPEG)", kOfFlight},
    {0, "GIF89a"sv, FileKind::foreign, "is a picture (GIF)", kOfFlight},
    {4, "ftyp"sv, FileKind::foreign, "is a film (MP4)", kOfFlight},
    {0, "\x7F""ELF"sv, FileKind::foreign, "is a program (ELF)", kOfFlight},
    {0, "MZ\x90\0"sv, FileKind::foreign, "is a program of Windows", kOfFlight},
    {0, "<?xml"sv, FileKind::foreign, "is XML", kAsText},
    {0, "<!DOCTYPE"sv, FileKind::foreign, "is a page of the web", "download the log itself"},
    {0, "<html"sv, FileKind::foreign, "is a page of the web", "download the log itself"},
    {0, "version https://git-lfs"sv, FileKind::foreign, "is the pointer that Git LFS keeps in place of a file",
     "fetch the file with git lfs pull"},
}};
// clang-format on

bool is_control(char c) noexcept {
  const auto byte = static_cast<unsigned char>(c);
  return (byte < 0x20 && c != '\t' && c != '\n' && c != '\r' && c != '\f') || byte == 0x7F;
}

}  // namespace

const KnownFile* known_file(std::string_view begin) noexcept {
  const auto* const found = std::find_if(kKnownFiles.begin(), kKnownFiles.end(), [begin](const KnownFile& file) {
    return begin.size() >= file.offset && begin.substr(file.offset, file.bytes.size()) == file.bytes;
  });
  return found == kKnownFiles.end() ? nullptr : found;
}

TextWidth text_width(std::string_view begin) noexcept {
  if (begin.substr(0, 2) == "\xFF\xFE"sv) return TextWidth::wide_le;
  if (begin.substr(0, 2) == "\xFE\xFF"sv) return TextWidth::wide_be;
  const std::size_t pairs = std::min(begin.size(), kMagicBytes) / 2;
  std::size_t even = 0, odd = 0;
  for (std::size_t k = 0; k < 2 * pairs; k += 2) {
    even += begin[k] == 0 ? 1U : 0U;
    odd += begin[k + 1] == 0 ? 1U : 0U;
  }
  if (pairs >= 4 && odd * 10 >= pairs * 9 && even == 0) return TextWidth::wide_le;
  if (pairs >= 4 && even * 10 >= pairs * 9 && odd == 0) return TextWidth::wide_be;
  return TextWidth::bytes;
}

bool is_text(std::string_view begin) noexcept {
  if (text_width(begin) != TextWidth::bytes) return true;
  if (begin.find('\0') != std::string_view::npos) return false;
  const auto controls = static_cast<std::size_t>(std::count_if(begin.begin(), begin.end(), is_control));
  return controls * 50 <= begin.size();
}

io::FileExpected<void> open_log(const std::string& path, const char* give, io::MappedFile& file) {
  const auto refuse = [&path](std::string what, std::string remedy) {
    return tl::make_unexpected(io::FileError{path, 0, "", std::move(what), std::move(remedy)});
  };
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status(path, error);
  if (!std::filesystem::exists(status))
    return refuse("cannot be opened" + (error ? ": " + error.message() : std::string()), "check the path");
  if (std::filesystem::is_directory(status))
    return refuse("is a directory", "name the log in it; of a bag of ROS 2 each .mcap or .db3 file");
  if (!std::filesystem::is_regular_file(status)) return refuse("is no regular file", give);
  const std::uintmax_t size = std::filesystem::file_size(path, error);
  if (!error && size == 0) return refuse("is empty: it has 0 bytes", "copy the log again");
  if (!file.open(path)) return refuse("cannot be read", "check the permissions of the file");
  if (file.at(0, 1) == nullptr) return refuse("cannot be read at byte 0", "copy the log again");
  return {};
}

std::string_view first_bytes(io::MappedFile& file, std::size_t count) {
  const auto there = static_cast<std::size_t>(std::min<std::uint64_t>(file.size(), count));
  const unsigned char* bytes = file.at(0, there);
  if (bytes == nullptr) return {};
  return {reinterpret_cast<const char*>(bytes), there};  // NOLINT(*-reinterpret-cast): bytes of a file as text
}

}  // namespace logs
}  // namespace PLUMB_ABI
}  // namespace plumb
