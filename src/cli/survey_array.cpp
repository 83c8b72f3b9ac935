// plumb survey --array: gravity and field as the array file of the tool states them.
#include <fmt/format.h>

#include <cmath>
#include <functional>

#include "plumb/geomagnetic/field_reference.hpp"
#include "read_array.hpp"
#include "survey_reference.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace cli {
namespace {

constexpr double kSamePlace_deg = 1e-7;     // what printing and reading rounds, a centimetre
constexpr double kSameLatitude_deg = 0.05;  // 5 mGal, a thirtieth of the usual sigma

/// What the options say goes before what the file says; told where the two differ.
class Choice {
 public:
  Choice(std::string file, std::string& notes) : file_(std::move(file)), notes_(notes) {}

  /// `same`: of two texts. True where the option says something else than the file.
  template <class Same>
  bool over(const char* option, std::string& text, const std::string& of_file, const Same& same) {
    if (text.empty()) {
      text = of_file;
      return false;
    }
    if (same(text, of_file)) return false;
    note(fmt::format("{} \"{}\" overrides \"{}\" of {}", option, text, of_file, file_));
    return true;
  }
  void note(const std::string& text) { notes_ += "plumb: note: " + text + "\n"; }
  const std::string& file() const { return file_; }

 private:
  std::string file_;
  std::string& notes_;
};

bool same_number(const io::FileExpected<double>& a, const io::FileExpected<double>& b) {
  return !a || !b || std::fabs(*a - *b) <= 1e-9 * std::fabs(*b);  // what is no number is refused where it is used
}

auto same_quantity(io::Quantity quantity) {
  return [quantity](const std::string& a, const std::string& b) {
    return same_number(io::parse_quantity(quantity, a), io::parse_quantity(quantity, b));
  };
}

bool same_field(const std::string& a, const std::string& b) {
  return same_number(geomagnetic::parse_field(a), geomagnetic::parse_field(b));
}

bool same_place(const std::string& a, const std::string& b) {
  ReferenceOptions one, other;
  one.place = a;
  other.place = b;
  const auto first = place_of(one), second = place_of(other);
  return !first || !second ||
         (std::fabs(first->latitude_deg - second->latitude_deg) < kSamePlace_deg &&
          std::fabs(first->longitude_deg - second->longitude_deg) < kSamePlace_deg);
}

std::string degrees(double rad) { return fmt::format("{:.10g} deg", deg_from_rad(rad)); }
std::string nanotesla(double ut) { return fmt::format("{:.10g} nT", 1e3 * ut); }

tl::unexpected<io::FileError> refused(const std::string& file, const std::string& what, const std::string& remedy) {
  return tl::unexpected<io::FileError>(io::FileError{file, 0, "group", what, remedy, io::ExitCode::usage});
}

/// The group of that name, or the only magnetic one.
io::FileExpected<const io::ArrayFile*> magnetic_group(const io::ArrayFile& tool, const std::string& asked) {
  const std::string name = asked.size() > tool.path.size() ? asked.substr(tool.path.size() + 1) : "";
  const io::ArrayFile* found = nullptr;
  for (const io::ArrayFile& group : tool.groups) {
    if (!name.empty() ? group.group != name : group.field != io::FieldKind::magnetic) continue;
    if (found != nullptr)
      return refused(tool.path, "there are several magnetic groups",
                     "name one: --array " + tool.path + "#" + found->group);
    found = &group;
  }
  if (found == nullptr)
    return refused(tool.path, name.empty() ? "there is no magnetic group" : "there is no group " + name,
                   "name a [[group]] with field = \"magnetic\", or state the field by options");
  if (found->field != io::FieldKind::magnetic)
    return refused(tool.path, "group " + name + " is not magnetic", "name the group of the magnetometers");
  return found;
}

void take_sigmas(const io::ArrayFile& group, bool always, Choice& choice, ReferenceOptions& out) {
  const io::MagneticReference& magnetic = group.magnetic;
  if (magnetic.total_sigma_ut > 0.0 && (group.basis.total_sigma_stated || always))
    choice.over("--field-sigma", out.field_sigma, nanotesla(magnetic.total_sigma_ut), same_field);
  if (group.basis.dip_sigma_stated || (always && magnetic.dip_known))
    choice.over("--dip-sigma", out.dip_sigma, degrees(magnetic.dip_sigma_rad), same_quantity(io::Quantity::angle));
}

/// True where another place is given than that of the file.
bool take_field(const io::ArrayFile& group, Choice& choice, ReferenceOptions& out) {
  const io::MagneticReference& magnetic = group.magnetic;
  if (group.basis.place) {
    const io::MagneticPlace& at = *group.basis.place;
    const bool moved = choice.over("--place", out.place,
                                   fmt::format("{:.10g}, {:.10g}", at.latitude_deg, at.longitude_deg), same_place);
    choice.over("--height", out.height, fmt::format("{:.10g} m", at.height_m), same_quantity(io::Quantity::length));
    choice.over("--date", out.date, at.date, std::equal_to<std::string>());
    if (out.field.empty() && out.dip.empty())
      take_sigmas(group, false, choice, out);
    else
      choice.note("--field and --dip override the model of the field of " + choice.file());
    return moved;
  }
  if (out.field.empty() && !out.place.empty() && !out.date.empty()) {
    choice.note("--place and --date override the field of " + choice.file());
    return true;
  }
  choice.over("--field", out.field, nanotesla(magnetic.total_ut), same_field);
  if (magnetic.dip_known) choice.over("--dip", out.dip, degrees(magnetic.dip_rad), same_quantity(io::Quantity::angle));
  take_sigmas(group, true, choice, out);
  return !out.place.empty();
}

void take_gravity(const io::ArrayFile& tool, Choice& choice, ReferenceOptions& out) {
  if (tool.basis.normal_gravity && out.gravity.empty()) {
    out.normal_gravity = tool.basis.normal_gravity;
  } else {
    const bool other = choice.over("--gravity", out.gravity, fmt::format("{:.10g} m/s^2", tool.gravity.g_mps2),
                                   same_quantity(io::Quantity::acceleration));
    if (other) return;  // the file's sigma is of another value
  }
  if (tool.gravity.sigma_mps2 > 0.0)
    choice.over("--gravity-sigma", out.gravity_sigma, fmt::format("{:.10g} m/s^2", tool.gravity.sigma_mps2),
                same_quantity(io::Quantity::acceleration));
}

}  // namespace

io::FileExpected<ReferenceOptions> with_array(const ReferenceOptions& options, std::string& notes) {
  if (options.array.empty()) return options;
  const io::FileExpected<io::ArrayFile> tool =
      read_array(array_file_of(options.array), "plumb survey", Serves::gravity);
  if (!tool) return tl::unexpected<io::FileError>(tool.error());
  const io::FileExpected<const io::ArrayFile*> group = magnetic_group(*tool, options.array);
  if (!group) return tl::unexpected<io::FileError>(group.error());
  const std::optional<io::MagneticPlace>& place = (*group)->basis.place;
  ReferenceOptions out = options;
  Choice choice((*group)->path, notes);
  if (take_field(**group, choice, out)) {
    choice.note("gravity is that of --place, or of --gravity, not of [gravity] in " + tool->path);
    return out;
  }
  Choice of_gravity(tool->path, notes);
  take_gravity(*tool, of_gravity, out);
  if (!out.normal_gravity) return out;
  if (!options.height.empty()) {
    const auto height = quantity_option(io::Quantity::length, "--height", options.height);
    if (!height) return tl::unexpected<io::FileError>(height.error());
    out.normal_gravity->elevation_m = *height;
  }
  const double latitude_deg = out.normal_gravity->latitude_deg;
  if (place && std::fabs(latitude_deg - place->latitude_deg) > kSameLatitude_deg)
    of_gravity.note(
        fmt::format("{} contradicts itself: latitude {:.6g} deg in [gravity], {:.6g} deg in [group.reference]; "
                    "each is used for its own field",
                    tool->path, latitude_deg, place->latitude_deg));
  return out;
}

}  // namespace cli
}  // namespace PLUMB_ABI
}  // namespace plumb
