#include "survey_reference.hpp"

#include <fmt/format.h>

#include <charconv>
#include <optional>

#include "plumb/geomagnetic/coefficient_file.hpp"
#include "plumb/survey/survey_run.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace cli {
namespace {

constexpr const char* kUsualFieldSigma = "130 nT";
constexpr const char* kUsualDipSigma = "0.2 deg";
constexpr const char* kUsualDeclinationSigma = "0.4 deg";

io::FileError option_error(const char* option, io::FileError error) {
  error.file = option;
  error.code = io::ExitCode::usage;
  return error;
}

tl::unexpected<io::FileError> refuse(const char* option, std::string what, std::string remedy) {
  return tl::unexpected<io::FileError>(
      io::FileError{option, 0, "", std::move(what), std::move(remedy), io::ExitCode::usage});
}

/// Where the tool is and when, and by which model.
struct Where {
  geomagnetic::Place place;
  geomagnetic::FieldModel model;
  std::optional<double> year;
};

io::FileExpected<std::optional<Where>> where_of(const ReferenceOptions& options) {
  if (options.place.empty()) {
    for (const auto& [option, text] : {std::pair<const char*, const std::string*>{"--date", &options.date},
                                       {"--height", &options.height},
                                       {"--coefficients", &options.coefficients}}) {
      if (!text->empty()) return refuse(option, "is given without a place", "give --place as well");
    }
    return std::optional<Where>();
  }
  Where out;
  const io::FileExpected<geomagnetic::Place> place = place_of(options);
  if (!place) return tl::unexpected<io::FileError>(place.error());
  out.place = *place;
  if (!options.date.empty()) {
    const io::FileExpected<double> year = geomagnetic::decimal_year(options.date);
    if (!year) return tl::unexpected<io::FileError>(option_error("--date", year.error()));
    out.year = *year;
  }
  out.model = geomagnetic::wmm2025();
  if (!options.coefficients.empty()) {
    io::FileExpected<geomagnetic::FieldModel> model = geomagnetic::read_coefficients(options.coefficients);
    if (!model) return tl::unexpected<io::FileError>(model.error());
    out.model = *std::move(model);
  }
  return out;
}

/// Stated instead of a model: length and dip together, the declination or none.
io::FileExpected<std::optional<geomagnetic::FieldReference>> stated_field(const ReferenceOptions& options) {
  if (options.field.empty() && options.dip.empty() && options.declination.empty())
    return std::optional<geomagnetic::FieldReference>();
  if (options.field.empty() || options.dip.empty())
    return refuse(options.field.empty() ? "--field" : "--dip",
                  "is missing: a stated field needs its length and its dip",
                  "state both, or give --place and --date instead");
  geomagnetic::StatedField stated;
  stated.declination_known = !options.declination.empty();
  const auto or_usual = [](const std::string& text, const char* usual) { return text.empty() ? usual : text; };
  const auto field = field_option("--field", options.field),
             field_sigma = field_option("--field-sigma", or_usual(options.field_sigma, kUsualFieldSigma));
  const auto dip = quantity_option(io::Quantity::angle, "--dip", options.dip);
  const auto dip_sigma =
      quantity_option(io::Quantity::angle, "--dip-sigma", or_usual(options.dip_sigma, kUsualDipSigma));
  const auto declination = quantity_option(io::Quantity::angle, "--declination",
                                           stated.declination_known ? options.declination : std::string("0 deg"));
  const auto declination_sigma = quantity_option(io::Quantity::angle, "--declination-sigma",
                                                 or_usual(options.declination_sigma, kUsualDeclinationSigma));
  for (const auto* read : {&field, &field_sigma, &dip, &dip_sigma, &declination, &declination_sigma}) {
    if (!*read) return tl::unexpected<io::FileError>(read->error());
  }
  stated.total_nt = *field * 1e9;
  stated.total_sigma_nt = *field_sigma * 1e9;
  stated.dip_deg = deg_from_rad(*dip);
  stated.dip_sigma_deg = deg_from_rad(*dip_sigma);
  stated.declination_deg = deg_from_rad(*declination);
  stated.declination_sigma_deg = deg_from_rad(*declination_sigma);
  const io::FileExpected<geomagnetic::FieldReference> out = geomagnetic::stated_reference(stated);
  if (!out) return tl::unexpected<io::FileError>(out.error());
  return std::optional<geomagnetic::FieldReference>(*out);
}

io::FileExpected<std::optional<GravityReference>> stated_gravity(const ReferenceOptions& options) {
  if (options.gravity.empty()) return std::optional<GravityReference>();
  const auto value = quantity_option(io::Quantity::acceleration, "--gravity", options.gravity);
  if (!value) return tl::unexpected<io::FileError>(value.error());
  double sigma_mps2 = kDefaultGravitySigma_mps2;
  if (!options.gravity_sigma.empty()) {
    const auto sigma = quantity_option(io::Quantity::acceleration, "--gravity-sigma", options.gravity_sigma);
    if (!sigma) return tl::unexpected<io::FileError>(sigma.error());
    sigma_mps2 = *sigma;
  }
  const Expected<GravityReference> out = given_gravity(*value, sigma_mps2);
  if (!out) return tl::unexpected<io::FileError>(option_error("--gravity", io::from_error(out.error())));
  return std::optional<GravityReference>(*out);
}

/// 1 sigma that is stated instead of the model's, common to all stations; 0: not stated.
struct StatedSigmas {
  double gravity_mps2 = 0.0, field_tesla = 0.0, dip_rad = 0.0, declination_rad = 0.0;
};

io::FileExpected<StatedSigmas> stated_sigmas(const ReferenceOptions& options) {
  StatedSigmas out;
  const auto read = [](const char* option, const std::string& text, const auto& parse,
                       double& value) -> io::FileExpected<void> {
    if (text.empty()) return {};
    const io::FileExpected<double> found = parse(option, text);
    if (!found) return tl::unexpected<io::FileError>(found.error());
    if (!(*found > 0.0)) return refuse(option, "must be above 0", "state 1 sigma of the reference, or leave it out");
    value = *found;
    return {};
  };
  const auto angle = [](const char* option, const std::string& text) {
    return quantity_option(io::Quantity::angle, option, text);
  };
  const auto acceleration = [](const char* option, const std::string& text) {
    return quantity_option(io::Quantity::acceleration, option, text);
  };
  for (const io::FileExpected<void>& one :
       {read("--gravity-sigma", options.gravity_sigma, acceleration, out.gravity_mps2),
        read("--field-sigma", options.field_sigma, field_option, out.field_tesla),
        read("--dip-sigma", options.dip_sigma, angle, out.dip_rad),
        read("--declination-sigma", options.declination_sigma, angle, out.declination_rad)}) {
    if (!one) return tl::unexpected<io::FileError>(one.error());
  }
  return out;
}

io::FileExpected<GravityReference> gravity_at(const Where& where, const ReferenceOptions& options,
                                              const StatedSigmas& sigmas, double depth_m) {
  NormalGravityInput input;
  if (options.normal_gravity) {
    input = *options.normal_gravity;
  } else {
    input.latitude_deg = where.place.latitude_deg;
    input.elevation_m = where.place.height_m;
  }
  if (sigmas.gravity_mps2 > 0.0) input.sigma_mps2 = sigmas.gravity_mps2;
  input.depth_m = depth_m > 0.0 ? depth_m : 0.0;
  const Expected<GravityReference> gravity = normal_gravity(input);
  if (!gravity) return tl::unexpected<io::FileError>(option_error("--place", io::from_error(gravity.error())));
  return *gravity;
}

io::FileExpected<geomagnetic::FieldReference> modelled_field(const Where& where, const ReferenceOptions& options,
                                                             const StatedSigmas& sigmas, double depth_m) {
  geomagnetic::Place place = where.place;
  place.height_m -= depth_m;
  const io::FileExpected<geomagnetic::EarthField> field = geomagnetic::field_at(where.model, place, *where.year);
  if (!field) return tl::unexpected<io::FileError>(option_error("--place, --date", field.error()));
  const bool trade = options.errors == ReferenceErrors::iscwsa;
  geomagnetic::FieldReference out =
      geomagnetic::reference_of(*field, trade ? geomagnetic::iscwsa_errors() : geomagnetic::wmm2025_errors());
  if (sigmas.field_tesla > 0.0) out.total_tesla_sigma = {sigmas.field_tesla, 0.0};
  if (sigmas.dip_rad > 0.0) out.dip_rad_sigma = {sigmas.dip_rad, 0.0};
  if (sigmas.declination_rad > 0.0) out.declination_rad_sigma = {sigmas.declination_rad, 0.0};
  return out;
}

}  // namespace

io::FileExpected<geomagnetic::Place> place_of(const ReferenceOptions& options) {
  geomagnetic::Place out;
  const char* at = options.place.data();
  const char* const end = at + options.place.size();
  const auto skip = [&](const char* what) {
    while (at != end && std::string_view(what).find(*at) != std::string_view::npos) ++at;
  };
  auto read = std::from_chars(at, end, out.latitude_deg);
  at = read.ptr;
  const bool first = read.ec == std::errc();
  skip(" ,");
  read = std::from_chars(at, end, out.longitude_deg);
  at = read.ptr;
  skip(" ");
  if (!first || read.ec != std::errc() || at != end)
    return refuse("--place", "is not latitude and longitude in degrees",
                  "write it as in \"60.40, 2.10\", north and east");
  if (!options.height.empty()) {
    const io::FileExpected<double> height = quantity_option(io::Quantity::length, "--height", options.height);
    if (!height) return tl::unexpected<io::FileError>(height.error());
    out.height_m = *height;
  }
  return out;
}

io::FileExpected<double> quantity_option(io::Quantity quantity, const char* option, const std::string& text) {
  io::FileExpected<double> out = io::parse_quantity(quantity, text);
  if (!out) return tl::unexpected<io::FileError>(option_error(option, out.error()));
  return out;
}

io::FileExpected<double> field_option(const char* option, const std::string& text) {
  io::FileExpected<double> out = geomagnetic::parse_field(text);
  if (!out) return tl::unexpected<io::FileError>(option_error(option, out.error()));
  return out;
}

io::FileExpected<std::vector<survey::ReferencedStation>> referenced(const std::vector<survey::Measurement>& stations,
                                                                    const ReferenceOptions& options) {
  const auto where = where_of(options);
  if (!where) return tl::unexpected<io::FileError>(where.error());
  const auto field = stated_field(options);
  if (!field) return tl::unexpected<io::FileError>(field.error());
  const auto gravity = stated_gravity(options);
  if (!gravity) return tl::unexpected<io::FileError>(gravity.error());
  const auto sigmas = stated_sigmas(options);
  if (!sigmas) return tl::unexpected<io::FileError>(sigmas.error());
  if (!*where && !options.normal_gravity && !*gravity)
    return refuse("--gravity", "is missing: nothing says how large gravity is", "state it, or give --place or --array");
  if (!*field && (!*where || !(*where)->year))
    return refuse(*where ? "--date" : "--field", "is missing: nothing says how large the magnetic field is",
                  "give --place and --date, or --array, or state --field and --dip");
  const std::vector<double> depth_m = survey::depths_m(stations);
  std::vector<survey::ReferencedStation> out;
  for (std::size_t k = 0; k < stations.size(); ++k) {
    const auto one_gravity = *gravity ? io::FileExpected<GravityReference>(**gravity)
                                      : gravity_at(where->value_or(Where{}), options, *sigmas, depth_m[k]);
    if (!one_gravity) return tl::unexpected<io::FileError>(one_gravity.error());
    const auto one_field = *field ? io::FileExpected<geomagnetic::FieldReference>(**field)
                                  : modelled_field(**where, options, *sigmas, depth_m[k]);
    if (!one_field) return tl::unexpected<io::FileError>(one_field.error());
    out.push_back({stations[k], {*one_gravity, *one_field}});
  }
  return out;
}

void add_reference_options(const Options& command, ReferenceOptions& options) {
  const auto text = [&](const char* name, std::string& value, const char* type, const char* about) {
    command.add_option(name, value, about).type_name(type);
  };
  text("--array", options.array, "TOOL.toml[#mag]",
       "gravity from its [gravity], the field from the [group.reference] of its magnetic group; options override");
  text("--place", options.place, "\"LAT, LON\"", "of the well, degrees north and east: gravity and field by models");
  text("--height", options.height, "\"25 m\"", "of measured depth 0 above the ellipsoid, 0 by default");
  text("--date", options.date, "YYYY-MM-DD", "of the survey: the field changes by years");
  text("--coefficients", options.coefficients, "WMM.COF", "another model of the field than WMM2025");
  command
      .add_option("--reference-errors", options.errors,
                  {{"iscwsa", ReferenceErrors::iscwsa}, {"wmm", ReferenceErrors::wmm}},
                  "how sure the model of the field is: ISCWSA's figures (default), or NOAA's of WMM2025")
      .type_name("iscwsa|wmm");
  text("--gravity", options.gravity, "\"9.81 m/s^2\"", "stated instead of the model");
  text("--gravity-sigma", options.gravity_sigma, "\"0.15 mg\"",
       "1 sigma of gravity, stated or by the model (default \"0.15 mg\")");
  text("--field", options.field, "\"50812 nT\"", "stated instead of the model, with --dip");
  text("--field-sigma", options.field_sigma, "\"130 nT\"",
       "1 sigma of the field (default \"130 nT\" of a stated one, else the model's)");
  text("--dip", options.dip, "\"72.4 deg\"", "of the stated field, down positive");
  text("--dip-sigma", options.dip_sigma, "\"0.2 deg\"",
       "1 sigma of the dip (default \"0.2 deg\" of a stated one, else the model's)");
  text("--declination", options.declination, "\"-0.6 deg\"",
       "of the stated field, east positive; without it azimuths are magnetic");
  text("--declination-sigma", options.declination_sigma, "\"0.4 deg\"",
       "1 sigma of it (default \"0.4 deg\" of a stated one, else the model's)");
}

}  // namespace cli
}  // namespace PLUMB_ABI
}  // namespace plumb
