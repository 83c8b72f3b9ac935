#include "plumb/render/verification_exports.hpp"
#include "plumb/io/json_fields.hpp"

#include <fmt/format.h>

#include "markup.hpp"
#include "plumb/render/verdict_section.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace render {
namespace {

struct Suite {
  std::string name, cases;
  int tests = 0, failures = 0, skipped = 0;

  void add(const std::string& test, const std::string& result, const std::string& why,
           const std::string& requirement = "") {
    ++tests;
    cases += "    <testcase classname=\"" + in_markup(name) + "\" name=\"" + in_markup(test) + "\">";
    if (!requirement.empty())
      cases += "<properties><property name=\"requirement\" value=\"" + in_markup(requirement) + "\"/></properties>";
    if (result == "not met" || result == "failed") {
      ++failures;
      cases += "<failure message=\"" + in_markup(why) + "\"/>";
    } else if (result != "met" && result != "verified") {
      ++skipped;
      cases += "<skipped message=\"" + in_markup(why) + "\"/>";
    }
    cases += "</testcase>\n";
  }

  std::string text() const {
    return fmt::format("  <testsuite name=\"{}\" tests=\"{}\" failures=\"{}\" skipped=\"{}\">\n{}  </testsuite>\n",
                       in_markup(name), tests, failures, skipped, cases);
  }
};

std::string need_id(const std::string& id) {
  std::string out = id;
  for (char& c : out) {
    if (c == '-' || c == '.') c = '_';
  }
  return out;
}

}  // namespace

std::string junit_xml(const Json& report) {
  Suite limits{"limits", "", 0, 0, 0}, requirements{"requirements", "", 0, 0, 0};
  for (const verification::Criterion& c : criteria_of(report))
    limits.add(entry_of(c.id).title, to_string(c.result), c.reason);
  for (const Json& orphan : report["verdict"]["orphans"]) requirements.add(orphan, "failed", "an orphan");
  for (const Json& r : report["traceability"]["requirements"]) {
    const std::string id = r["id"], result = r["result"];
    const std::string why = result == "failed"   ? "a test or a formal item behind it failed"
                            : result == "traced" ? "its tests exist; their results were not given"
                                                 : "not every test of it ran";
    requirements.add(id + " " + r["title"].get<std::string>(), result, why, id);
  }
  return fmt::format(
             "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites name=\"plumb verify {}\" tests=\"{}\" "
             "failures=\"{}\">\n",
             in_markup(report["subject"]["name"]), limits.tests + requirements.tests,
             limits.failures + requirements.failures) +
         limits.text() + requirements.text() + "</testsuites>\n";
}

std::string needs_json(const Json& report) {
  const std::string version = report["identity"]["build"]["version"];
  Json needs = Json::object();
  const auto add = [&needs](const std::string& id, const char* type, const std::string& title, const std::string& text,
                            Json links, const std::string& status) {
    Json ids = Json::array();
    for (const Json& link : links) ids.push_back(need_id(link));
    needs[need_id(id)] = io::object({{"id", need_id(id)},
                                     {"type", type},
                                     {"title", title},
                                     {"description", text},
                                     {"status", status},
                                     {"links", ids},
                                     {"tags", Json::array()}});
  };
  const Json& trace = report["traceability"];
  for (const Json& h : trace["hazards"]) add(h["id"], "hazard", h["title"], h["statement"], Json::array(), "");
  for (const Json& r : trace["requirements"])
    add(r["id"], "req", r["title"], r["statement"], r["hazards"], r["result"]);
  for (const Json& t : trace["tests"]) {
    Json links = t["verifies"];
    for (const Json& id : t["negative"]) links.push_back(id);
    add("TEST_" + t["name"].get<std::string>(), "test", t["name"], t["file"], links,
        t["result"].is_string() ? t["result"].get<std::string>() : "not given");
  }
  const std::size_t amount = needs.size();
  Json out =
      io::object({{"project", "plumb: " + report["subject"]["name"].get<std::string>()}, {"current_version", version}});
  out["versions"][version] = io::object(
      {{"needs_amount", amount}, {"needs", std::move(needs)}, {"filters", Json::object()}, {"filters_amount", 0}});
  return out.dump(1) + "\n";
}

std::string requirements_sdoc(const Json& report) {
  std::string out = "[DOCUMENT]\nTITLE: plumb, verified for " + report["subject"]["name"].get<std::string>() +
                    "\n\n[GRAMMAR]\nELEMENTS:\n";
  const auto grammar = [&out](const char* tag, std::initializer_list<const char*> fields) {
    out += std::string("- TAG: ") + tag + "\n  FIELDS:\n";
    for (const char* field : fields)
      out += std::string("  - TITLE: ") + field + "\n    TYPE: String\n    REQUIRED: True\n";
    out += "  RELATIONS:\n  - TYPE: Parent\n";
  };
  grammar("HAZARD", {"UID", "TITLE", "STATEMENT"});
  grammar("REQUIREMENT", {"UID", "STATUS", "RESULT", "TITLE", "STATEMENT"});
  const auto block = [](const Json& text) { return ">>>\n" + text.get<std::string>() + "\n<<<\n"; };
  const Json& trace = report["traceability"];
  for (const Json& h : trace["hazards"])
    out += "\n[HAZARD]\nUID: " + h["id"].get<std::string>() + "\nTITLE: " + h["title"].get<std::string>() +
           "\nSTATEMENT: " + block(h["statement"]);
  for (const Json& r : trace["requirements"]) {
    out += "\n[REQUIREMENT]\nUID: " + r["id"].get<std::string>() + "\nSTATUS: " + r["status"].get<std::string>() +
           "\nRESULT: " + r["result"].get<std::string>() + "\nTITLE: " + r["title"].get<std::string>() +
           "\nSTATEMENT: " + block(r["statement"]);
    if (!r["hazards"].empty()) out += "RELATIONS:\n";
    for (const Json& hazard : r["hazards"]) out += "- TYPE: Parent\n  VALUE: " + hazard.get<std::string>() + "\n";
  }
  return out;
}

std::string spdx_json(const Json& report) {
  const Json& build = report["identity"]["build"];
  Json packages = Json::array(), relations = Json::array();
  const auto add = [&packages](const std::string& id, const std::string& name, const std::string& version,
                               const std::string& licence) {
    packages.push_back(io::object({{"SPDXID", id},
                                   {"name", name},
                                   {"versionInfo", version},
                                   {"downloadLocation", "NOASSERTION"},
                                   {"filesAnalyzed", false},
                                   {"licenseConcluded", "NOASSERTION"},
                                   {"licenseDeclared", licence},
                                   {"copyrightText", "NOASSERTION"}}));
  };
  add("SPDXRef-plumb", "plumb", build["version"].get<std::string>() + " (" + build["commit"].get<std::string>() + ")",
      "NOASSERTION");
  relations.push_back(io::object({{"spdxElementId", "SPDXRef-DOCUMENT"},
                                  {"relationshipType", "DESCRIBES"},
                                  {"relatedSpdxElement", "SPDXRef-plumb"}}));
  for (const Json& library : build["libraries"]) {
    std::string id = "SPDXRef-";
    for (const char c : library["name"].get<std::string>()) id += c == '+' ? std::string("x") : std::string(1, c);
    add(id, library["name"], library["version"], library["licence"]);
    relations.push_back(io::object(
        {{"spdxElementId", "SPDXRef-plumb"}, {"relationshipType", "DEPENDS_ON"}, {"relatedSpdxElement", id}}));
  }
  const std::string name = "plumb-" + build["version"].get<std::string>() + "-" + build["commit"].get<std::string>();
  const Json out =
      io::object({{"spdxVersion", "SPDX-2.3"},
                  {"dataLicense", "CC0-1.0"},
                  {"SPDXID", "SPDXRef-DOCUMENT"},
                  {"name", name},
                  {"documentNamespace", "https://spdx.org/spdxdocs/" + name},
                  // The time of the build is not known to the tool, and the same build has to give the same bytes.
                  {"creationInfo",
                   io::object({{"created", "1970-01-01T00:00:00Z"},
                               {"creators", Json::array({"Tool: plumb-" + build["version"].get<std::string>()})}})},
                  {"packages", packages},
                  {"relationships", relations}});
  return out.dump(1) + "\n";
}

}  // namespace render
}  // namespace PLUMB_ABI
}  // namespace plumb
