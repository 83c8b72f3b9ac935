#include "plumb/geomagnetic/field_reference.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string_view>
#include <system_error>
#include <utility>

#include "plumb/core/units.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace geomagnetic {
namespace {

constexpr double kNtPerTesla = 1e9;
constexpr double kTeslaPerNt = 1e-9;
constexpr double kLeast_nt = 15e3;
constexpr double kMost_nt = 80e3;

double declination_sigma_rad(const ErrorTerms& terms, double horizontal_tesla) noexcept {
  const double h_nt = horizontal_tesla * kNtPerTesla;
  if (terms.declination_deg_nt > 0.0 && !(h_nt > terms.declination_deg_nt / 180.0)) return kPi;
  const double falls = terms.declination_deg_nt > 0.0 ? terms.declination_deg_nt / h_nt : 0.0;
  return std::min(kPi, rad_from_deg(std::hypot(terms.declination_deg, falls)));
}

io::FileExpected<void> within(const char* field, double value, double least, double most, const char* unit,
                              const char* remedy) {
  if (value >= least && value <= most) return {};
  return tl::unexpected<io::FileError>(
      io::FileError{"", 0, field, fmt::format("is {} {}, must be from {} to {} {}", value, unit, least, most, unit),
                    remedy, io::ExitCode::invalid_input});
}

}  // namespace

const ErrorModel& wmm2025_errors() {
  static const ErrorModel model{"WMM2025 error model", {138.0, 0.20, 0.26, 5417.0}, {}};
  return model;
}

const ErrorModel& iscwsa_errors() {
  static const ErrorModel model{
      "ISCWSA MWD rev. 5, standard resolution", {130.0, 0.20, 0.36, 5000.0}, {60.0, 0.08, 0.10, 3000.0}};
  return model;
}

FieldReference reference_of(const EarthField& field, const ErrorModel& errors) {
  FieldReference out;
  out.source = field.model + ", " + errors.name;
  out.year = field.year;
  out.total_tesla = field.value.total_tesla;
  out.dip_rad = field.value.dip_rad;
  out.total_tesla_sigma = {errors.common.total_nt * kTeslaPerNt, errors.random.total_nt * kTeslaPerNt};
  out.dip_rad_sigma = {rad_from_deg(errors.common.dip_deg), rad_from_deg(errors.random.dip_deg)};
  out.declination_known = !field.north_undefined;
  out.declination_rad = field.value.declination_rad;
  out.declination_rad_sigma = {declination_sigma_rad(errors.common, field.value.horizontal_tesla),
                               declination_sigma_rad(errors.random, field.value.horizontal_tesla)};
  if (field.north_undefined)
    out.declination_note = "at a pole of rotation there is no true north";
  else if (field.zone != FieldZone::usual)
    out.declination_note = fmt::format("{}: the horizontal field is {:.0f} nT, too weak to rely on its direction",
                                       to_string(field.zone), field.value.horizontal_tesla / kTeslaPerNt);
  return out;
}

io::FileExpected<FieldReference> stated_reference(const StatedField& stated) {
  struct Bound {
    const char* field;
    double value, least, most;
    const char* unit;
    const char* remedy;
  };
  const char* const sigma_remedy = "state 1 sigma of what you know; the ISCWSA's is 130 nT, 0.2 deg and 0.4 deg";
  const Bound bounds[] = {
      {"total field", stated.total_nt, kLeast_nt, kMost_nt, "nT", "give nanotesla: 1 G is 100000 nT, 1 uT is 1000 nT"},
      {"sigma of the total field", stated.total_sigma_nt, 0.1, 0.1 * kMost_nt, "nT", sigma_remedy},
      {"dip", stated.dip_deg, -90.0, 90.0, "deg", "give the angle of the field below the horizontal"},
      {"sigma of the dip", stated.dip_sigma_deg, 1e-4, 10.0, "deg", sigma_remedy},
  };
  for (const Bound& b : bounds) {
    if (auto fits = within(b.field, b.value, b.least, b.most, b.unit, b.remedy); !fits)
      return tl::unexpected<io::FileError>(fits.error());
  }
  if (stated.declination_known) {
    const Bound two[] = {
        {"declination", stated.declination_deg, -180.0, 180.0, "deg", "give it from true north, east positive"},
        {"sigma of the declination", stated.declination_sigma_deg, 1e-4, 180.0, "deg", sigma_remedy}};
    for (const Bound& b : two) {
      if (auto fits = within(b.field, b.value, b.least, b.most, b.unit, b.remedy); !fits)
        return tl::unexpected<io::FileError>(fits.error());
    }
  }
  FieldReference out;
  out.source = "stated";
  out.total_tesla = stated.total_nt * kTeslaPerNt;
  out.dip_rad = rad_from_deg(stated.dip_deg);
  out.total_tesla_sigma = {stated.total_sigma_nt * kTeslaPerNt, 0.0};
  out.dip_rad_sigma = {rad_from_deg(stated.dip_sigma_deg), 0.0};
  out.declination_known = stated.declination_known;
  if (stated.declination_known) {
    out.declination_rad = rad_from_deg(stated.declination_deg);
    out.declination_rad_sigma = {rad_from_deg(stated.declination_sigma_deg), 0.0};
  }
  return out;
}

io::FileExpected<io::MagneticReference> lookup(const io::MagneticPlace& place) {
  const auto refused = [](io::FileError error, const char* key) {
    error.field = key;
    return tl::unexpected<io::FileError>(std::move(error));
  };
  const io::FileExpected<double> year = decimal_year(place.date);
  if (!year) return refused(year.error(), "date");
  const io::FileExpected<EarthField> field =
      field_at(wmm2025(), {place.latitude_deg, place.longitude_deg, place.height_m}, *year);
  if (!field) return tl::unexpected<io::FileError>(field.error());
  const FieldReference found = reference_of(*field, iscwsa_errors());
  io::MagneticReference out;
  out.source = found.source;
  out.total_ut = 1e6 * found.total_tesla;
  out.total_sigma_ut = 1e6 * std::hypot(found.total_tesla_sigma.common, found.total_tesla_sigma.random);
  out.dip_known = true;
  out.dip_rad = found.dip_rad;
  out.dip_sigma_rad = std::hypot(found.dip_rad_sigma.common, found.dip_rad_sigma.random);
  return out;
}

io::FileExpected<double> parse_field(std::string_view text) {
  struct Unit {
    std::string_view name;
    double tesla;
  };
  constexpr Unit units[] = {{"nT", 1e-9}, {"uT", 1e-6}, {"mG", 1e-7}, {"G", 1e-4}, {"T", 1.0}};
  double value = 0.0;
  const char* const end = text.data() + text.size();
  const auto read = std::from_chars(text.data(), end, value);
  std::string_view unit(read.ptr, static_cast<std::size_t>(end - read.ptr));
  while (!unit.empty() && unit.front() == ' ') unit.remove_prefix(1);
  for (const Unit& known : units) {
    if (read.ec == std::errc() && std::isfinite(value) && unit == known.name) return value * known.tesla;
  }
  return tl::unexpected<io::FileError>(io::FileError{"", 0, "", "is no magnetic field: a number and nT, uT, mG, G or T",
                                                     "write it as in \"50123 nT\"", io::ExitCode::usage});
}

}  // namespace geomagnetic
}  // namespace PLUMB_ABI
}  // namespace plumb
