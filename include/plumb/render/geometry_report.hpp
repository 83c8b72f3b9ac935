/// What is said of a geometry, for people and for machines.
#pragma once

#include <string>

#include "plumb/findings/geometry_study.hpp"
#include "plumb/io/json_fields.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace render {

/// What a warning or a known limit of the study means, without a full stop.
std::string geometry_words(const findings::Finding& f, const findings::GeometrySubject& subject,
                           const findings::GeometryStudy& study);
/// "a1 and a2 exchanged"
std::string wiring_words(const findings::HiddenWiring& wiring, const SensorArray& array);

std::string geometry_text(const findings::GeometrySubject& subject, const findings::GeometryStudy& study);
/// SI units in the names, null where the geometry has no such figure; of a magnetic group nT.
std::string geometry_json(const findings::GeometrySubject& subject, const findings::GeometryStudy& study);
/// The same as of gravity, whatever the field.
io::Json geometry_document(const findings::GeometrySubject& subject, const findings::GeometryStudy& study);

}  // namespace render
}  // namespace PLUMB_ABI
}  // namespace plumb
