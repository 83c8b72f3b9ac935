#include <nlohmann/json.hpp>

#include "plumb/io/json_fields.hpp"
#include "plumb/io/printable.hpp"
#include "plumb/render/review_report.hpp"
#include "review_words.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace render {
namespace {

using io::finite_or_null;
using io::object;
using review::LogReview;

Json axes_json(const review::Axes& axes) {
  Json out = Json::array();
  for (const double x : axes) out.push_back(finite_or_null(x));
  return out;
}

Json chip_json(const LogReview& in, std::size_t i) {
  const review::ChipSummary& chip = in.chips[i];
  Json calibration;
  if (chip.calibration.present) {
    calibration = object({{"offset_mps2", axes_json(chip.calibration.offset_mps2)},
                          {"scale", axes_json(chip.calibration.scale)},
                          {"applied_here", chip.calibration.applied_here}});
  }
  return object(
      {{"name", chip.name},
       {"device_id", chip.device_id},
       {"rate_hz", finite_or_null(chip.rate_hz)},
       {"from_s", finite_or_null(chip.from_s)},
       {"to_s", finite_or_null(chip.to_s)},
       {"temperature_degc", Json::array({finite_or_null(chip.coldest_degc), finite_or_null(chip.warmest_degc)})},
       {"off_gravity_at_rest_mps2", finite_or_null(off_gravity_mps2(in, i))},
       {"scatter_at_rest_mps2", axes_json(chip.scatter_mps2)},
       {"vibration_mps2", finite_or_null(chip.vibration_mps2)},
       {"vibration_at_s", finite_or_null(chip.vibration_at_s)},
       {"clipped", chip.clipped},
       {"disabled", chip.disabled},
       {"lag_s", finite_or_null(chip.lag_s)},
       {"lag_uncertainty_s", finite_or_null(chip.lag_uncertainty_s)},
       {"installed_calibration", calibration}});
}

Json name_or_null(const LogReview& in, std::size_t chip) {
  return chip == review::kNoChip ? Json() : Json(in.chips[chip].name);
}

Json finding_json(const LogReview& in, const review::Finding& finding) {
  const ReviewSentence sentence = sentence_of(finding, in);
  const bool undecided = finding.other != review::kNoChip;
  return object(
      {{"code", code_word(finding.code)},
       {"grade", grade_word(finding.grade)},
       {"chip", undecided ? Json() : name_or_null(in, finding.chip)},
       {"one_of", undecided ? Json::array({in.chips[finding.chip].name, in.chips[finding.other].name}) : Json()},
       {"likely", name_or_null(in, finding.likely)},
       {"axis", finding.axis < 0 ? Json() : Json(std::string(1, static_cast<char>('x' + finding.axis)))},
       {"figure", finite_or_null(finding.figure)},
       {"limit", finite_or_null(finding.limit)},
       {"uncertainty", finite_or_null(finding.uncertainty)},
       {"from_s", finite_or_null(finding.from_s)},
       {"to_s", finite_or_null(finding.to_s)},
       {"times", finding.times},
       {"text", sentence.what},
       {"to_do", sentence.remedy}});
}

Json stretch_json(const review::Stretch& stretch) {
  Json means = Json::array();
  Json uncertainties = Json::array();
  for (const review::Axes& mean : stretch.mean_mps2) means.push_back(axes_json(mean));
  for (const double u : stretch.uncertainty_mps2) uncertainties.push_back(finite_or_null(u));
  return object(
      {{"from_s", stretch.from_s}, {"to_s", stretch.to_s}, {"mean_mps2", means}, {"uncertainty_mps2", uncertainties}});
}

Json log_json(const LogReview& in) {
  Json chips = Json::array();
  for (std::size_t i = 0; i < in.chips.size(); ++i) chips.push_back(chip_json(in, i));
  Json findings = Json::array();
  for (const review::Finding& finding : in.findings) findings.push_back(finding_json(in, finding));
  Json stretches = Json::array();
  for (const review::Stretch& stretch : in.stretches) stretches.push_back(stretch_json(stretch));
  Json open = Json::array();
  for (const review::OpenQuestion question : in.open)
    open.push_back(object({{"code", code_word(question)}, {"text", sentence_of(question)}}));
  Json notes = Json::array();
  for (const review::Note& note : in.notes)
    notes.push_back(object({{"offset", note.offset}, {"text", io::printable_line(note.what)}}));
  return object({{"name", in.name},
                 {"read_as", io::printable_line(in.understood)},
                 {"grade", grade_word(in)},
                 {"answer", answer_of(in)},
                 {"judged", in.judged},
                 {"from_s", finite_or_null(in.from_s)},
                 {"to_s", finite_or_null(in.to_s)},
                 {"bytes", in.extent.bytes},
                 {"bytes_read", in.extent.read_bytes},
                 {"lost_by_logger_s", in.extent.dropped_s},
                 {"gravity_mps2", in.gravity_mps2},
                 {"gravity_half_range_mps2", in.gravity_half_mps2},
                 {"at_rest_s", in.at_rest_s},
                 {"motion_cells", in.motion_cells},
                 {"motion_difference_mps2", finite_or_null(in.motion_agreement_mps2)},
                 {"chips", chips},
                 {"findings", findings},
                 {"open", open},
                 {"stretches", stretches},
                 {"notes", notes}});
}

}  // namespace

Json review_json(const std::vector<LogReview>& logs, const std::vector<UnreadLog>& unread) {
  Json list = Json::array();
  for (const LogReview& log : logs) list.push_back(log_json(log));
  Json others = Json::array();
  for (const UnreadLog& log : unread)
    others.push_back(object({{"name", log.name}, {"why", io::printable_line(log.why)}}));
  Json devices = Json::array();
  for (const DeviceTrend& trend : trends_of(logs)) {
    Json seen = Json::array();
    for (std::size_t k = 0; k < trend.logs.size(); ++k) {
      seen.push_back(object({{"log", logs[trend.logs[k]].name},
                             {"off_gravity_at_rest_mps2", finite_or_null(trend.off_gravity_mps2[k])},
                             {"warmest_degc", finite_or_null(trend.warmest_degc[k])}}));
    }
    devices.push_back(object({{"device_id", trend.device_id}, {"logs", seen}}));
  }
  return object({{"schema", kReviewSchema},
                 {"version", kReviewVersion},
                 {"logs", list},
                 {"not_read", others},
                 {"devices_in_several_logs", devices}});
}

}  // namespace render
}  // namespace PLUMB_ABI
}  // namespace plumb
