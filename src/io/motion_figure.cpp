#include "motion_figure.hpp"

#include <string>

#include "text_tools.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace io {

double read_figure(const TomlTable& table, const Figure& figure) {
  const TomlNode& value = *table.find(figure.key);
  const std::string form = std::string("write a number") +
                           (*figure.unit != '\0' ? std::string(" in ") + figure.unit + ", without quotes" : "") + ": " +
                           figure.key + " = " + figure.example;
  const bool ratio = *figure.unit == '\0' && value.kind == TomlNode::Kind::text;
  const bool number = value.kind == TomlNode::Kind::number || value.kind == TomlNode::Kind::integer;
  if (!ratio && !number)
    table.fail(value.line, figure.key, std::string("is ") + value.kind_name() + ", must be a number", form);
  const double given = ratio ? table.quantity(Quantity::ratio, figure.key, 0.0) : value.number;
  if (given >= figure.least && given <= figure.most) return given;
  const std::string unit = *figure.unit != '\0' ? std::string(" ") + figure.unit : "";
  table.fail(value.line, figure.key, "is " + brief(given) + unit + ", out of range",
             "give a value from " + brief(figure.least) + " to " + brief(figure.most) + unit + ", for example " +
                 figure.key + " = " + figure.example);
}

void read_into(const TomlTable& table, const Figure& figure, std::optional<double>& out) {
  if (table.has(figure.key)) out = read_figure(table, figure);
}

void read_into(const TomlTable& table, const Figure& figure, double& out) {
  if (table.has(figure.key)) out = read_figure(table, figure);
}

}  // namespace io
}  // namespace PLUMB_ABI
}  // namespace plumb
