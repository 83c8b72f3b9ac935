#include "plumb/render/verdict_section.hpp"

#include <stdexcept>

#include "plumb/io/json_fields.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace render {
Json counts_json(const verification::RequirementCounts& counts) {
  Json out;
  for (const verification::RequirementCount& count : verification::kRequirementCounts)
    out[count.key] = counts.*count.value;
  return out;
}

Json verdict_section(const verification::Report& judged) {
  Json answers = Json::array(), criteria = Json::array(), notes = Json::array();
  for (const verification::Answer& a : judged.answers)
    answers.push_back(io::object({{"question", a.question}, {"value", a.value}, {"label", a.label}}));
  for (const verification::Criterion& c : judged.criteria) {
    Json one;
    describe(c, [&one](const char* key, const std::string& text) { one[key] = text; });
    criteria.push_back(std::move(one));
  }
  for (const verification::Note& n : judged.known_limits)
    notes.push_back(io::object({{"name", n.name}, {"text", n.text}}));
  return io::object({{"verdict", verification::fitness(judged)},
                     {"sentence", judged.sentence},
                     {"limits_file", judged.limits_file.empty() ? Json() : Json(judged.limits_file)},
                     {"answers", std::move(answers)},
                     {"criteria", std::move(criteria)},
                     {"requirements", counts_json(judged.requirements)},
                     {"orphans", judged.orphans},
                     {"assumptions", judged.assumptions},
                     {"known_limits", std::move(notes)}});
}

std::vector<verification::Criterion> criteria_of(const Json& report) {
  std::vector<verification::Criterion> out;
  for (const Json& one : report["verdict"]["criteria"]) {
    const std::string key = one["id"], word = one["result"];
    const std::optional<verification::CriterionId> id = verification::criterion_of(key);
    const std::optional<verification::Result> result = verification::result_of(word);
    if (!id || !result) throw std::invalid_argument("unknown criterion in the report: " + key + ", " + word);
    out.push_back({*id, *result, one["limit"], one["limit_from"], one["found"], one["reason"]});
  }
  return out;
}

}  // namespace render
}  // namespace PLUMB_ABI
}  // namespace plumb
