#include "table_options.hpp"

#include <string>
#include <utility>
#include <vector>

#include "plumb/io/units.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace cli {
namespace {

std::string reason_of(const io::FileError& error) { return error.what + "; " + error.remedy; }

/// What one of the unit is, of a text that names the unit alone.
command::TextReader unit_reader(io::Quantity quantity, double& value) {
  return [quantity, &value](const std::string& text) -> std::string {
    const io::FileExpected<double> one = io::parse_quantity(quantity, "1 " + text);
    if (!one) return reason_of(one.error());
    value = *one;
    return "";
  };
}

std::string read_rate(const std::string& text, double& rate_hz) {
  const io::FileExpected<double> rate = io::parse_quantity(io::Quantity::rate, text);
  if (!rate) return reason_of(rate.error());
  if (!(*rate > 0.0)) return "a rate is above 0 Hz";
  rate_hz = *rate;
  return "";
}

/// Names between commas; an empty one is a column that is passed over.
std::string read_header(const std::string& text, std::vector<std::string>& names) {
  names.clear();
  std::size_t begin = 0;
  for (std::size_t end = text.find(','); end != std::string::npos; end = text.find(',', begin)) {
    names.push_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  names.push_back(text.substr(begin));
  return names.size() > 1 ? "" : "name each column: \"t_s,ax [g],ay [g],az [g]\"";
}

}  // namespace

void add_table_options(const Options& command, logs::CsvHints& hints) {
  command.add_option("--table-separator", hints.separator,
                     {{"comma", ','}, {"semicolon", ';'}, {"tab", '\t'}, {"bar", '|'}, {"blank", ' '}},
                     "Of a table of text: what stands between cells (default: found out, as all of these)");
  command.add_option("--table-decimal", hints.decimal, {{"point", '.'}, {"comma", ','}}, "Its decimal mark");
  command
      .add_option("--table-time", unit_reader(io::Quantity::time, hints.time_unit_s),
                  "Unit of its column of time, without which times are judged by their steps")
      .type_name("s|ms|us");
  command
      .add_option("--table-unit", unit_reader(io::Quantity::acceleration, hints.force_unit_mps2),
                  "Unit of its readings, without which the length of gravity tells it")
      .type_name("m/s^2|g0|mg");
  command
      .add_option(
          "--table-rate", [&hints](const std::string& text) { return read_rate(text, hints.rate_hz); },
          "Rows a second, where it has no column of time")
      .type_name("\"100 Hz\"");
  command
      .add_option(
          "--table-header", [&hints](const std::string& text) { return read_header(text, hints.header); },
          "Names of its columns, where it has none or others")
      .type_name("\"t_s,ax [g],ay [g],az [g]\"");
}

}  // namespace cli
}  // namespace PLUMB_ABI
}  // namespace plumb
