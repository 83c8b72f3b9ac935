#include "plumb/coefficients/coefficient_file.hpp"

#include <algorithm>
#include <exception>
#include <filesystem>

#include "../io/text_tools.hpp"
#include "imu_tk.hpp"
#include "parameter_file.hpp"
#include "plumb/io/hash.hpp"
#include "plumb/io/output_file.hpp"
#include "sensor_table.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace coefficients {
namespace {

[[noreturn]] void refuse_file(const std::string& path, const std::string& what, const std::string& remedy) {
  throw io::Refusal(io::FileError{path, 0, "", what, remedy});
}

constexpr const char* kWhatIsRead =
    "give parameters of PX4 (CAL_ACC...) or ArduPilot (INS_ACC...), a file of imu_tk, or a table of coefficients (csv, "
    "json), and name the form with --form";

/// Neither text nor a table: what a log or an archive looks like.
bool is_binary(const std::string& text) {
  return std::any_of(text.begin(), text.end(),
                     [](unsigned char c) { return c < ' ' && c != '\t' && c != '\n' && c != '\r'; });
}

Form detected(const std::string& text, const std::string& path) {
  const std::size_t first = text.find_first_not_of(" \t\r\n");
  if (first == std::string::npos) refuse_file(path, "the file is empty", kWhatIsRead);
  if (is_binary(text)) refuse_file(path, "is binary, and files of coefficients are text", kWhatIsRead);
  if (text[first] == '{') return Form::json;
  if (looks_like_imu_tk(text)) return Form::imu_tk;
  const bool px4 = !parse_parameters(text, path, Form::px4).empty();
  const bool ardupilot = !parse_parameters(text, path, Form::ardupilot).empty();
  if (px4 && ardupilot)
    refuse_file(path, "holds parameters of PX4 and of ArduPilot",
                "give the parameter file of one vehicle, or name --form");
  if (px4) return Form::px4;
  if (ardupilot) return Form::ardupilot;
  for (std::size_t begin = first; begin < text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    const std::string_view line = io::trimmed(std::string_view(text).substr(begin, end - begin));
    begin = end + 1;
    if (line.empty() || line.front() == '#') continue;
    if (line.find("scale") != std::string_view::npos) return Form::csv;
    break;
  }
  refuse_file(path, "holds no coefficients of accelerometers", kWhatIsRead);
}

CoefficientFile of_parameters(const Parameters& parameters, Form form, const std::string& path) {
  CoefficientFile out;
  out.path = path;
  out.form = form;
  out.chips = form == Form::px4 ? px4_chips(parameters, out.notes) : ardupilot_chips(parameters, out.notes);
  if (out.chips.empty())
    refuse_file(path,
                std::string("holds no calibrated accelerometer: no ") +
                    (form == Form::px4 ? "CAL_ACCn_ID" : "INS_ACCn_ID") + " but 0",
                "save the parameters after the accelerometers have been calibrated, and of the vehicle itself");
  out.notes.push_back(std::string("they correct readings before any correction: ") +
                      (form == Form::px4 ? "sensor_accel, not vehicle_imu or sensor_combined"
                                         : "the messages IMU and ACC of ArduPilot's logs are corrected already"));
  return out;
}

CoefficientFile parsed(const std::string& bytes, const std::string& path, const io::ArrayFile& array,
                       std::optional<Form> stated, int file_number) {
  constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf";
  const bool marked = bytes.compare(0, kByteOrderMark.size(), kByteOrderMark) == 0;
  const std::string text = marked ? bytes.substr(kByteOrderMark.size()) : bytes;
  const Form form = stated ? *stated : detected(text, path);
  CoefficientFile out;
  if (form == Form::px4 || form == Form::ardupilot) {
    out = of_parameters(parse_parameters(text, path, form), form, path);
  } else if (form == Form::imu_tk) {
    out.chips.push_back(parse_imu_tk(text, path, file_number));
  } else {
    out.sensors = statements_of(form == Form::csv ? csv_rows(text, path) : json_rows(text, path), path, array);
  }
  out.path = path;
  out.form = form;
  out.bytes = bytes.size();
  out.hash = io::fnv1a(bytes.data(), bytes.size());
  return out;
}

/// What may be thrown becomes a value.
template <class Work>
auto told(const std::string& path, Work&& work) -> io::FileExpected<decltype(work())> {
  try {
    return work();
  } catch (const io::Refusal& refusal) {
    io::FileError error = refusal.error();
    if (error.file.empty()) error.file = path;
    return tl::unexpected<io::FileError>(error);
  } catch (const std::exception& error) {
    return tl::unexpected<io::FileError>(io::FileError{path, 0, "", error.what(), kWhatIsRead});
  }
}

}  // namespace

const char* to_string(Form form) noexcept {
  switch (form) {
    case Form::px4: return "px4";
    case Form::ardupilot: return "ardupilot";
    case Form::imu_tk: return "imu_tk";
    case Form::csv: return "csv";
    case Form::json: return "json";
  }
  return "?";
}

std::optional<Form> form_of(std::string_view word) noexcept {
  for (const Form form : kForms) {
    if (word == to_string(form)) return form;
  }
  return std::nullopt;
}

io::FileExpected<CoefficientFile> read_coefficients(const std::string& path, const io::ArrayFile& array,
                                                    std::optional<Form> form, int file_number) {
  std::error_code unknown;
  const std::uintmax_t size = std::filesystem::file_size(path, unknown);
  if (!unknown && size > kLargestFile)
    return tl::unexpected<io::FileError>(
        io::FileError{path, 0, "", "is larger than 16 MiB, and no file of coefficients is", kWhatIsRead});
  const io::FileExpected<std::string> text = io::read_file(path);
  if (!text) return tl::unexpected<io::FileError>(text.error());
  return parse_coefficients(*text, path, array, form, file_number);
}

io::FileExpected<CoefficientFile> parse_coefficients(const std::string& text, const std::string& path,
                                                     const io::ArrayFile& array, std::optional<Form> form,
                                                     int file_number) {
  return told(path, [&] { return parsed(text, path, array, form, file_number); });
}

io::FileExpected<CoefficientFile> coefficients_of(const std::map<std::string, double>& parameters, Form form,
                                                  const std::string& path) {
  return told(path, [&] {
    Parameters kept(path);
    for (const auto& [name, value] : parameters) {
      if (is_parameter_of(form, name)) kept.add(name, value, 0);
    }
    return of_parameters(kept, form, path);
  });
}

}  // namespace coefficients
}  // namespace PLUMB_ABI
}  // namespace plumb
