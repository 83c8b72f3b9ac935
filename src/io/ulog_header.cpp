#include "ulog_header.hpp"

#include <libdeflate.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "little_endian.hpp"
#include "plumb/core/version.hpp"
#include "text_tools.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace io {
namespace {

constexpr const char* kRowTopic = "plumb_row";
constexpr const char* kBlockTopic = "plumb_block";
constexpr std::string_view kBlockFormat =
    "plumb_block:uint64_t timestamp;uint64_t first_row;uint32_t rows;uint32_t crc32;";
constexpr std::size_t kRowMessage = 0;
constexpr std::size_t kBlockMessage = 1;

constexpr const char* kLayoutKey = "plumb_log_version";
constexpr const char* kBlockRowsKey = "plumb_block_rows";
constexpr const char* kRateKey = "plumb_rate_hz";
constexpr const char* kColumnKey = "plumb_column_";      // ... and a field: the column in the array file
constexpr const char* kUnitKey = "plumb_unit_";          // ... and a field
constexpr const char* kConstantKey = "plumb_constant_";  // ... and a number: the column of one text
constexpr const char* kTextKey = "plumb_constant_text_";
constexpr std::string_view kSumKey = "uint32_t plumb_header_crc32";
constexpr std::size_t kSumSize = 4;
/// What a key and the name in front of it leave in 255 bytes.
constexpr std::size_t kLongestField = 160;

const char* const kByContract = "let the recorder write the layout of docs/array-file.md";
const char* const kWriteAnew = "copy the file again, or write it anew (plumb convert)";

tl::unexpected<FileError> refuse(const std::string& path, std::string what, std::string remedy) {
  return tl::unexpected<FileError>(FileError{path, 0, "header", std::move(what), std::move(remedy)});
}

const unsigned char* bytes_of(std::string_view text) noexcept {
  return reinterpret_cast<const unsigned char*>(text.data());
}

bool is_letter(char c) noexcept { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }
bool is_figure(char c) noexcept { return c >= '0' && c <= '9'; }

/// In letters, figures and '_', the first a letter: so it is none of the padding either.
std::string as_identifier(const std::string& name) {
  std::string out = name.substr(0, kLongestField);
  for (char& c : out) {
    if (!is_letter(c) && !is_figure(c)) c = '_';
  }
  return !out.empty() && is_letter(out[0]) ? out : "c" + out;
}

std::string text_message(const std::string& name, const std::string& text) {
  return ulog_key_message('I', "char[" + std::to_string(text.size()) + "] " + name, text);
}
std::string u32_message(const std::string& name, std::uint32_t value) {
  std::string bytes;
  put_u32(bytes, value);
  return ulog_key_message('I', "uint32_t " + name, bytes);
}
std::string double_message(const std::string& name, double value) {
  std::string bytes;
  put_double(bytes, value);
  return ulog_key_message('I', "double " + name, bytes);
}

std::string version_text() {
  return std::to_string(kLibraryVersion >> 16U) + "." + std::to_string(kLibraryVersion >> 8U & 0xFFU) + "." +
         std::to_string(kLibraryVersion & 0xFFU);
}

std::string row_format(const UlogHeader& header) {
  std::string out = std::string(kRowTopic) + ":uint64_t timestamp;uint64_t present;";
  for (const UlogColumn& column : header.columns) {
    if (!column.constant) out += "double " + column.field + ";";
  }
  return out;
}

std::string subscription(std::size_t message, const char* topic) {
  std::string payload(1, '\0');  // the only one of its topic
  put_u16(payload, message);
  return ulog_message('A', payload + topic);
}

/// The definitions of a log as they were read.
class Definitions {
 public:
  /// What is wrong with them, or empty.
  std::string read(std::string_view bytes) {
    for (std::size_t at = 0; at < bytes.size();) {
      if (bytes.size() - at < kUlogMessageHeader) return "ends within a message";
      const std::size_t size = u16_at(bytes_of(bytes) + at);
      const char type = bytes[at + 2];
      at += kUlogMessageHeader;
      if (bytes.size() - at < size) return "ends within a message";
      const std::string_view payload = bytes.substr(at, size);
      at += size;
      blocks_ = blocks_ || (type == 'F' && payload == kBlockFormat);
      const std::string wrong = type == 'F' ? formats_.define(payload) : type == 'I' ? note(payload) : "";
      if (!wrong.empty()) return wrong;
    }
    return "";
  }

  const std::vector<UlogField>* row_fields() const { return formats_.fields(kRowTopic); }
  bool has_blocks() const noexcept { return blocks_; }
  std::string text(const std::string& name) const {
    const auto found = notes_.find(name);
    return found != notes_.end() && found->second.type == UlogType::character ? found->second.bytes : "";
  }
  /// 0 where there is none.
  std::uint64_t whole(const std::string& name) const {
    const auto found = notes_.find(name);
    return found == notes_.end() ? 0 : ulog_whole(bytes_of(found->second.bytes), {found->second.type, 0});
  }
  double number(const std::string& name) const {
    const auto found = notes_.find(name);
    return found == notes_.end() || ulog_size(found->second.type) == 0
               ? 0.0
               : ulog_number(bytes_of(found->second.bytes), {found->second.type, 0});
  }

 private:
  struct Note {
    UlogType type;
    std::string bytes;
  };
  std::string note(std::string_view payload) {
    UlogKey key;
    if (!ulog_key(payload, key)) return "holds information without a name";
    if (key.value.size() != std::size_t{ulog_size(key.field.type)} * key.field.count)
      return "says of " + in_quotes(key.field.name) + " what is not of its type";
    const bool first = notes_.emplace(key.field.name, Note{key.field.type, std::string(key.value)}).second;
    return first ? "" : "says twice what " + in_quotes(key.field.name) + " is";
  }

  UlogFormats formats_;
  std::map<std::string, Note> notes_;
  bool blocks_ = false;
};

/// The columns that the format of a row has; false where it is none of plumb's.
bool read_columns(const Definitions& definitions, UlogHeader& out) {
  const std::vector<UlogField>* const fields = definitions.row_fields();
  if (fields == nullptr || fields->size() < 3 || fields->size() > 2 + kUlogColumns) return false;
  for (std::size_t k = 0; k < fields->size(); ++k) {
    const UlogField& field = (*fields)[k];
    if (field.count != 1 || field.type != (k < 2 ? UlogType::uint64 : UlogType::float64)) return false;
    if (k < 2) continue;
    const std::string name = definitions.text(kColumnKey + field.name);
    out.columns.push_back(
        {field.name, name.empty() ? field.name : name, false, definitions.text(kUnitKey + field.name)});
  }
  for (std::size_t k = 0; k < kUlogColumns; ++k) {
    const std::string number = std::to_string(k);
    const std::string name = definitions.text(kConstantKey + number);
    if (name.empty()) break;
    out.columns.push_back({"", name, true, definitions.text(kTextKey + number)});
  }
  return out.columns.size() <= kUlogColumns;
}

}  // namespace

std::uint32_t crc32_of(const void* data, std::size_t size, std::uint32_t before) noexcept {
  return ::libdeflate_crc32(before, data, size);
}

std::size_t UlogHeader::numbers() const noexcept {
  return static_cast<std::size_t>(
      std::count_if(columns.begin(), columns.end(), [](const UlogColumn& c) { return !c.constant; }));
}

void UlogHeader::add_numbers(const std::string& wanted, const std::string& name, const std::string& unit) {
  const std::string plain = as_identifier(wanted);
  const auto taken = [this](const std::string& field) {
    return field == "timestamp" || field == "present" ||
           std::any_of(columns.begin(), columns.end(), [&](const UlogColumn& c) { return c.field == field; });
  };
  std::string field = plain;
  for (std::size_t k = 2; taken(field); ++k) field = plain + "_" + std::to_string(k);
  columns.insert(columns.begin() + static_cast<std::ptrdiff_t>(numbers()), UlogColumn{field, name, false, unit});
}

std::string ulog_row_head(std::size_t numbers) {
  std::string payload;
  put_u16(payload, kRowMessage);
  return ulog_message('D', payload.append(16 + 8 * numbers, '\0')).substr(0, kUlogDataHead);
}

std::string ulog_block_head() {
  std::string payload;
  put_u16(payload, kBlockMessage);
  return ulog_message('D', payload.append(kUlogBlockSize - kUlogDataHead, '\0')).substr(0, kUlogDataHead);
}

UlogBlock ulog_block(const unsigned char* at) noexcept {
  return UlogBlock{u64_at(at + kUlogDataHead + 8), u32_at(at + kUlogDataHead + 16), u32_at(at + kUlogBlockSum)};
}

std::string ulog_beginning() {
  std::string out(reinterpret_cast<const char*>(kUlogMagic.data()), kUlogMagic.size());
  out += static_cast<char>(kNewestUlog);
  put_u64(out, 0);  // times count from where the log's own do
  out += ulog_message('B', std::string(kUlogFlagBytes, '\0'));
  return out + text_message("sys_name", "plumb");
}

std::string ulog_misfit(const UlogHeader& header) {
  const std::size_t columns = header.columns.size();
  if (columns > kUlogColumns) {
    return "a ULog of plumb has at most " + std::to_string(kUlogColumns) + " columns, but the array file needs " +
           std::to_string(columns);
  }
  constexpr std::size_t kLongestText = 65000;  // of a message, its key left out
  bool fits = true;
  for (const UlogColumn& c : header.columns) fits = fits && c.name.size() + c.text.size() <= kLongestText;
  if (!fits || ulog_header_bytes(header).size() > kUlogLongestHeader)
    return "the column names are too long for the header of a ULog";
  return "";
}

std::string ulog_header_bytes(const UlogHeader& header) {
  std::string out = ulog_beginning();
  out += text_message("ver_sw", version_text());
  out += u32_message(kLayoutKey, kUlogLayoutVersion);
  out += u32_message(kBlockRowsKey, header.block_rows);
  if (header.rate_hz > 0.0) out += double_message(kRateKey, header.rate_hz);
  std::size_t constants = 0;
  for (const UlogColumn& column : header.columns) {
    const std::string place = column.constant ? std::to_string(constants++) : column.field;
    out += text_message((column.constant ? kConstantKey : kColumnKey) + place, column.name);
    if (!column.text.empty()) out += text_message((column.constant ? kTextKey : kUnitKey) + place, column.text);
  }
  out += ulog_message('F', row_format(header));
  out += ulog_message('F', kBlockFormat);
  std::string sum;
  put_u32(sum, crc32_of(out.data(), out.size()));
  return out + ulog_key_message('I', kSumKey, sum) + ulog_subscriptions();
}

bool ulog_ends_definitions(std::string_view message) noexcept {
  return message.size() == kUlogMessageHeader + 1 + kSumKey.size() + kSumSize && message[2] == 'I' &&
         message.substr(kUlogMessageHeader + 1, kSumKey.size()) == kSumKey;
}

const std::string& ulog_subscriptions() {
  static const std::string both = subscription(kRowMessage, kRowTopic) + subscription(kBlockMessage, kBlockTopic);
  return both;
}

FileExpected<UlogHeader> ulog_header_of(std::string_view bytes, const std::string& path) {
  const std::size_t end = bytes.size() - ulog_subscriptions().size();
  const std::size_t summed = end - kUlogMessageHeader - 1 - kSumKey.size() - kSumSize;
  if (crc32_of(bytes.data(), summed) != u32_at(bytes_of(bytes) + end - kSumSize) ||
      bytes.substr(end) != ulog_subscriptions())
    return refuse(path, "its check sum is wrong: the header is damaged", kWriteAnew);
  const std::size_t begin = ulog_beginning().size();
  Definitions definitions;
  if (const std::string wrong = definitions.read(bytes.substr(begin, summed - begin)); !wrong.empty())
    return refuse(path, wrong, kByContract);
  const std::uint64_t version = definitions.whole(kLayoutKey);
  if (version != kUlogLayoutVersion) {
    return refuse(
        path,
        "is of version " + std::to_string(version) + ", this plumb reads version " + std::to_string(kUlogLayoutVersion),
        "convert it to CSV with the version of plumb that wrote it (plumb convert)");
  }
  UlogHeader header;
  if (!read_columns(definitions, header))
    return refuse(path, "the format of its rows is none of plumb's (1 to 64 columns, each a double)", kByContract);
  if (!definitions.has_blocks()) return refuse(path, "the format of its blocks is none of plumb's", kByContract);
  const std::uint64_t rows = definitions.whole(kBlockRowsKey);
  if (rows < 1 || rows > kUlogBlockRows) {
    return refuse(path, "allows no row in a block, or more than " + std::to_string(kUlogBlockRows),
                  "let the recorder write shorter blocks");
  }
  header.block_rows = static_cast<std::uint32_t>(rows);
  header.rate_hz = definitions.number(kRateKey);
  if (!std::isfinite(header.rate_hz) || header.rate_hz < 0.0)
    return refuse(path, "its rate is negative or not a number", kByContract);
  return header;
}

}  // namespace io
}  // namespace PLUMB_ABI
}  // namespace plumb
