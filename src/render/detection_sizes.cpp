#include "plumb/render/detection_sizes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "plumb/render/field_words.hpp"
#include "plumb/scenario/count_text.hpp"
#include "size_fields.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace render {
namespace {

using findings::SizeCondition;
using findings::SizeTable;
using findings::VisitedKnown;

constexpr struct {
  SizeCondition condition;
  const char* key;
  const char* words;
} kConditions[findings::kSizeConditions] = {
    {SizeCondition::stability_0, "stability_0", "stability 0"},
    {SizeCondition::stability_0_2_mg0, "stability_0_2_mg0", "stability 0.2 mg0"},
    {SizeCondition::as_stated, "as_stated", "as stated"},
};

const findings::DetectionSizes& sizes_at(const SizeTable& table, SizeCondition condition) {
  return table.at[static_cast<std::size_t>(condition)];
}

/// Of some row.
bool any_beyond(const SizeTable& table, std::size_t k) {
  return std::any_of(table.at.begin(), table.at.end(), [k](const auto& sizes) { return is_beyond(sizes, k); });
}

std::string visited_words(const SizeTable& table) {
  switch (table.known) {
    case VisitedKnown::yes: return "visited: the " + count_text(table.visited, "attitude") + " of the calibration";
    case VisitedKnown::no_calibration:
      return "visited: no figure without a calibration, and every other size is of an exact tool";
    case VisitedKnown::not_in_the_file: break;
  }
  return "visited: no figure, because the calibration file does not keep the attitudes of its stations; run plumb "
         "calibrate again";
}

/// What the sizes mean, sentence by sentence, from what the JSON holds.
std::array<std::string, 2> meaning_of(double missed, double false_alarms, double rejection, double attitudes) {
  return {fmt::format("minimum detectable bias: P_MD {:.3g}, P_FA {:.3g} per block", missed, false_alarms),
          fmt::format("guaranteed: unless the noise of a block is beyond its quantile at {:.3g}; E = {:.0f}", rejection,
                      attitudes)};
}

}  // namespace

std::string sizes_text(const SizeTable& table, int sensors, io::FieldKind field) {
  const TestSettings& s = table.settings;
  const double fine = io::units_of(field).fine_per_inside;
  std::string out =
      fmt::format("\ndetection sizes, one block of {:.0f} samples at rest, the worst sensor\n", s.samples);
  const std::vector<int> widths =
      widths_with_words(kSizeFields, [&table](std::size_t k) { return any_beyond(table, k); });
  out += fmt::format("  {:<18}", "") + text_head(kSizeFields, &SizeField::above, "", widths);
  out += fmt::format("  {:<18}", "tool") + text_head(kSizeFields, &SizeField::below, "", widths);
  for (const auto& row : kConditions) {
    const findings::DetectionSizes& sizes = sizes_at(table, row.condition);
    const auto instead = [&sizes](std::size_t k) { return is_beyond(sizes, k) ? kBeyondFullScale : nullptr; };
    out += fmt::format("  {:<18}", row.words) + text_row_or(kSizeFields, widths, instead, fine, sizes);
  }
  for (const std::string& one :
       meaning_of(s.missed_detection, s.false_alarm_rate, s.rejection_rate, s.isolation_attitudes))
    out += "  " + one + "\n";
  out +=
      fmt::format("  as stated: drift of {:.3g} mg0 and acceleration of {:.3g} mg0 allowed for; else acceleration 0\n",
                  fine * table.tolerance_mps2(SizeCondition::as_stated, sensors),
                  fine * table.acceleration_mps2(SizeCondition::as_stated));
  return in_field_words(out + "  " + visited_words(table) + "\n", field);
}

Json sizes_json(const SizeTable& table, int sensors) {
  const TestSettings& s = table.settings;
  Json out = io::object({{"samples", s.samples},
                         {"missed_detection", s.missed_detection},
                         {"false_alarm_rate", s.false_alarm_rate},
                         {"rejection_rate", s.rejection_rate},
                         {"integrity_risk", s.integrity_risk},
                         {"isolation_attitudes", s.isolation_attitudes},
                         {"visited_attitudes", table.known == VisitedKnown::yes ? Json(table.visited) : Json()},
                         {"visited_text", visited_words(table)}});
  for (const auto& row : kConditions) {
    Json& one = out[row.key];
    one = io::object({{"drift_tolerance_mps2", table.tolerance_mps2(row.condition, sensors)},
                      {"acceleration_mps2", table.acceleration_mps2(row.condition)}});
    const findings::DetectionSizes& sizes = sizes_at(table, row.condition);
    put_fields(one, kSizeFields, sizes);
    one[kBeyondKey] = put_beyond(one, kSizeFields, [&sizes](std::size_t k) { return is_beyond(sizes, k); });
  }
  return out;
}

void put_sizes(const Json& sizes, Section& out) {
  if (sizes.is_null()) return out.text("Detection sizes: none without a calibration file.");
  const std::array<std::string, 2> meaning = meaning_of(sizes["missed_detection"], sizes["false_alarm_rate"],
                                                        sizes["rejection_rate"], sizes["isolation_attitudes"]);
  ViewRows rows;
  for (const auto& row : kConditions)
    rows.push_back(page_row(row.words, kSizeFields, sizes[row.key], sizes[row.key][kBeyondKey]));
  out.table(fmt::format("Detection sizes, one block of {} samples at rest, the worst sensor", shown(sizes["samples"])),
            page_head("tool", kSizeFields), rows,
            "As in docs/sizes.md. " + meaning[0] + "; " + meaning[1] +
                ". As stated: with the stability and the acceleration of the array file; else acceleration 0. " +
                sizes["visited_text"].get<std::string>() + ".");
}

}  // namespace render
}  // namespace PLUMB_ABI
}  // namespace plumb
