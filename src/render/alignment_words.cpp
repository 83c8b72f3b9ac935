#include "plumb/render/alignment_words.hpp"

#include <fmt/format.h>

namespace plumb {
inline namespace PLUMB_ABI {
namespace render {
namespace {

using findings::Alignment;
using findings::AlignmentSource;

const char* source_words(AlignmentSource source) {
  switch (source) {
    case AlignmentSource::stated: return "as the array file states";
    case AlignmentSource::datasheet: return "by the axes of the datasheet";
    case AlignmentSource::roll_groups:
      return "by the roll groups, and about the roll axis by the axes of the datasheet";
    case AlignmentSource::known_attitudes: return "by the stations of known attitude";
    case AlignmentSource::dip: return "by the dip of the field and the frame of the accelerometers";
  }
  return "";
}

std::string degrees(double rad) { return fmt::format("{:.3g} deg", deg_from_rad(rad)); }

}  // namespace

std::string alignment_words(const Alignment& alignment) {
  if (!(alignment.bound_rad < kPi)) return "how the calibrated axes as a whole sit in the housing is not known";
  const bool wiring_known = alignment.source == AlignmentSource::known_attitudes;  // else it may be a mirror image
  return fmt::format("the calibrated axes as a whole are within {} of the housing, {}{}", degrees(alignment.bound_rad),
                     source_words(alignment.source), wiring_known ? "" : ", if the channels are wired as stated");
}

bool alignment_exceeds_alert(const io::ArrayFile& array, const Alignment& alignment) {
  return array.monitor.alert_frame == AlertFrame::housing && alignment.bound_rad >= array.monitor.alert_limit_rad;
}

std::string alignment_remedy() {
  return "calibrate with stations of known attitude (known_attitudes in [input], or --known-attitude), or state "
         "alignment_bound in [monitor]; alert_frame = \"calibrated-axes\" asks for bounds without the housing, which "
         "is "
         "enough where only changes of direction count";
}

std::string alignment_note(const io::ArrayFile& array, const Alignment& alignment) {
  if (!alignment_exceeds_alert(array, alignment)) return "";
  return fmt::format(
      "{}: {}, the alert limit for the direction in the housing is {}: no output will be valid. "
      "Remedy: {}.\n",
      array.path, alignment_words(alignment), degrees(array.monitor.alert_limit_rad), alignment_remedy());
}

io::Json alignment_json(const io::ArrayFile& array, const Alignment& alignment) {
  const bool known = alignment.bound_rad < kPi;
  return io::object({{"bound_deg", known ? io::Json(deg_from_rad(alignment.bound_rad)) : io::Json()},
                     {"source", to_string(alignment.source)},
                     {"alert_frame", array.monitor.alert_frame == AlertFrame::housing ? "housing" : "calibrated_axes"},
                     {"text", alignment_words(alignment)}});
}

}  // namespace render
}  // namespace PLUMB_ABI
}  // namespace plumb
