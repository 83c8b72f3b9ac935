/// What a survey compares its magnetometers with: length, dip and declination of the field, each with its uncertainty.
#pragma once

#include <string>
#include <string_view>

#include "plumb/geomagnetic/field_model.hpp"
#include "plumb/io/field.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace geomagnetic {

/// 1-sigma of the reference. Declination: sqrt(declination_deg^2 + (declination_deg_nt / H)^2), never above 180
/// degrees.
struct ErrorTerms {
  double total_nt = 0.0;
  double dip_deg = 0.0;
  double declination_deg = 0.0;
  double declination_deg_nt = 0.0;  ///< falls with the horizontal field
};

/// What is the same at every station of a well, and what is drawn anew at each.
struct ErrorModel {
  std::string name;
  ErrorTerms common;
  ErrorTerms random;
};

/// NOAA's error model of WMM2025: F 138 nT, dip 0.20 deg, declination sqrt(0.26^2 + (5417 / H)^2) deg, global averages
/// of 1 sigma, crust and disturbance field included (technical report, section 3.4). All of it counts as common. The
/// figures were compared with two programs that quote the report, not with the report itself.
const ErrorModel& wmm2025_errors();

/// ISCWSA MWD error model, revision 5, standard resolution ("MWD+SRGM"): DEC 0.36 deg, DBH 5000 deg nT, MDI 0.20 deg,
/// MFI 130 nT (the roots of the squares of their parts U, OS, OH and OI), and at random DECR 0.10 deg, DBHR 3000 deg
/// nT, MDIR 0.08 deg, MFIR 60 nT. From OWSG's set A, revision 5.1, 8 October 2020; the base is SPE 67616. They are
/// stated for a model that is renewed every year (BGGM, MVSD); WMM, renewed every five, is somewhat worse.
const ErrorModel& iscwsa_errors();

struct Sigma {
  double common = 0.0;
  double random = 0.0;
};

struct FieldReference {
  std::string source;  ///< model and error model, or "stated"
  double year = 0.0;   ///< 0: stated without one
  double total_tesla = 0.0;
  double dip_rad = 0.0;
  Sigma total_tesla_sigma, dip_rad_sigma;
  bool declination_known = false;  ///< without it only magnetic azimuths are to be had
  double declination_rad = 0.0;
  Sigma declination_rad_sigma;
  std::string declination_note;  ///< why there is none, or why not to trust it: a pole, a weak horizontal field
};

FieldReference reference_of(const EarthField& field, const ErrorModel& errors);

/// Values that the user states. Sigmas are common ones.
struct StatedField {
  double total_nt = 0.0, total_sigma_nt = 0.0;
  double dip_deg = 0.0, dip_sigma_deg = 0.0;
  bool declination_known = false;
  double declination_deg = 0.0, declination_sigma_deg = 0.0;
};

/// Refuses what is no field of the Earth: 15 000 to 80 000 nT (its extremes are 22 200 and 67 000 nT), dip within 90
/// degrees, declination within 180, sigmas above 0 and below a tenth of the field, 10 and 180 degrees.
io::FileExpected<FieldReference> stated_reference(const StatedField& stated);

/// WMM2025 with `iscwsa_errors`, for the magnetic groups of an array file (`io::read_array_file`). What is alike at all
/// places and what is drawn anew count together. Errors: those of `decimal_year` and `field_at`, with `field` a key of
/// the file.
io::FileExpected<io::MagneticReference> lookup(const io::MagneticPlace& place);

/// "50123 nT" in tesla: nT, uT, mG, G or T, the blank before the unit may be left out. A number without unit is
/// refused.
io::FileExpected<double> parse_field(std::string_view text);

}  // namespace geomagnetic
}  // namespace PLUMB_ABI
}  // namespace plumb
