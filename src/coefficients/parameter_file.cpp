#include "parameter_file.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "../io/csv.hpp"
#include "../io/text_tools.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace coefficients {
namespace {

/// Some 200 parameters of an autopilot concern accelerometers.
constexpr std::size_t kMostParameters = 2000;

bool starts_with(std::string_view text, std::string_view with) noexcept { return text.substr(0, with.size()) == with; }

/// The first words of a line; more than are needed are not kept.
struct Words {
  std::array<std::string_view, 6> word;
  std::size_t count = 0;
};

Words words_of(std::string_view line) {
  constexpr std::string_view kSeparators = " \t,=\r";
  Words out;
  line = line.substr(0, line.find('#'));
  while (out.count < out.word.size()) {
    const std::size_t begin = line.find_first_not_of(kSeparators);
    if (begin == std::string_view::npos) break;
    line.remove_prefix(begin);
    const std::size_t end = std::min(line.find_first_of(kSeparators), line.size());
    out.word[out.count++] = line.substr(0, end);
    line.remove_prefix(end);
  }
  return out;
}

bool is_whole(std::string_view word) {
  std::int64_t ignored = 0;
  return io::parse_whole(word, ignored) == io::CellKind::number;
}

std::string wrong_value(const Words& words, std::size_t at) {
  if (words.count <= at + 1) return "has no value";
  double number = 0.0;
  const std::string value = io::in_quotes(words.word[at + 1]);
  const bool is_number = io::parse_cell(words.word[at + 1], number) == io::CellKind::number && std::isfinite(number);
  return is_number ? "has more than the value " + value : value + " is not a number";
}

}  // namespace

void Parameters::add(std::string_view name, double number, int line) {
  const auto [at, fresh] = values_.try_emplace(std::string(name), Value{number, line});
  const bool same = fresh || at->second.number == number;
  if (!same)
    throw io::Refusal(io::FileError{path_, line, std::string(name),
                                    "is " + io::shortest(number) + ", and " + io::shortest(at->second.number) +
                                        " in line " + std::to_string(at->second.line),
                                    "give the parameters of one vehicle, each once"});
  if (values_.size() > kMostParameters)
    throw io::Refusal(io::FileError{
        path_, line, "", "has more than " + std::to_string(kMostParameters) + " parameters of accelerometers",
        "give the parameter file of one vehicle"});
}

double Parameters::need(const std::string& name) const {
  const auto found = values_.find(name);
  if (found == values_.end())
    throw io::Refusal(io::FileError{path_, 0, name, "is missing",
                                    "save all parameters of the vehicle to a file and give that, or state the "
                                    "coefficients as csv"});
  return found->second.number;
}

double Parameters::value_or(const std::string& name, double otherwise) const {
  const auto found = values_.find(name);
  return found == values_.end() ? otherwise : found->second.number;
}

void Parameters::refuse(const std::string& name, const std::string& what, const std::string& remedy) const {
  const auto found = values_.find(name);
  throw io::Refusal(io::FileError{path_, found == values_.end() ? 0 : found->second.line, name, what, remedy});
}

bool is_parameter_of(Form form, std::string_view name) noexcept {
  if (form == Form::px4) return starts_with(name, "CAL_ACC") || starts_with(name, "TC_A");
  return starts_with(name, "INS_ACC") || starts_with(name, "INS_TCAL") || starts_with(name, "INS4_") ||
         starts_with(name, "INS5_");
}

std::string parameter_prefix(Form form, int instance) {
  const std::string number = std::to_string(instance);
  if (form == Form::px4) return "CAL_ACC" + number;
  // The first three instances came before the others, and have names of another kind.
  if (instance > 3) return "INS" + number + "_ACC";
  return "INS_ACC" + (instance > 1 ? number : "");
}

bool is_untouched(const ChipCoefficients& chip) noexcept { return chip.offset[0] == Vec3{} && chip.matrix == kNoTurn; }

Parameters parse_parameters(const std::string& text, const std::string& path, Form form) {
  Parameters out(path);
  int line = 0;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    const Words words = words_of(std::string_view(text).substr(begin, end - begin));
    begin = end + 1;
    ++line;
    const bool of_ground_station = words.count >= 5 && is_whole(words.word[0]) && is_whole(words.word[1]);
    const std::size_t at = of_ground_station ? 2 : 0;
    if (words.count <= at || !is_parameter_of(form, words.word[at])) continue;
    const std::string name(words.word[at]);
    double number = 0.0;
    const bool told = words.count > at + 1 && io::parse_cell(words.word[at + 1], number) == io::CellKind::number;
    // What follows a value is its type, or a mark of ArduPilot's default files; else a decimal comma has cut it in two.
    const bool whole = words.count <= (of_ground_station ? 5 : 2) || words.word[at + 2].front() == '@';
    if (!told || !std::isfinite(number) || !whole)
      throw io::Refusal(io::FileError{path, line, io::in_quotes(name), wrong_value(words, at),
                                      "correct the line: name and value with a decimal point, or the five columns of "
                                      "QGroundControl"});
    out.add(name, number, line);
  }
  return out;
}

}  // namespace coefficients
}  // namespace PLUMB_ABI
}  // namespace plumb
