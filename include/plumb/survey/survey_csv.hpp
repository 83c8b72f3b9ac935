/// A survey as a table.
#pragma once

#include <string>

#include "plumb/survey/survey_run.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace survey {

/// One row a station, the columns named by the first:
///   MD_m                                     to the centimetre
///   Inc_deg, AziMag_deg, AziTrue_deg, AziGrid_deg, GTF_deg, MTF_deg   two decimals; empty where undefined or withheld
///   Gt_mg, Bt_nT, Dip_deg                    as measured; dGt_mg, dBt_nT, dDip_deg: less reference
///   QC                                       accepted, inclination only, rejected
///   Flags                                    SurveyStation::flags
///   sInc_deg, sAzi_deg, PLInc_deg, PLAzi_deg 1 sigma and protection level; the azimuth is that of `north`
///   TVD_m, North_m, East_m, DLS_deg_per_30m  empty where the station is not on the path
///   sNorth_m, sEast_m, sTVD_m                1 sigma of the position (position_covariance.hpp)
///   AziNorth                                 which north sAzi, PLAzi and the positions are of
std::string survey_csv(const Survey& survey);

}  // namespace survey
}  // namespace PLUMB_ABI
}  // namespace plumb
