#include "plumb/render/evidence.hpp"
#include "plumb/io/json_fields.hpp"

#include <fmt/format.h>

#include <cctype>
#include <charconv>
#include <map>
#include <optional>
#include <set>
#include <sstream>
#include <string_view>

#include "plumb/io/output_file.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace render {
namespace {

tl::unexpected<io::FileError> refuse(const std::string& path, const std::string& what, const std::string& remedy) {
  return tl::unexpected<io::FileError>(io::FileError{path, 0, "", what, remedy});
}

struct Line {
  std::string file, level, text, check;
  int line = 0, column = 0;
};

/// The number that ends at `end`, behind a colon; `end` then stands at that colon.
std::optional<int> number_before(const std::string& text, std::size_t& end) {
  const std::size_t colon = end == 0 ? std::string::npos : text.rfind(':', end - 1);
  if (colon == std::string::npos) return std::nullopt;
  int value = 0;
  const char* const last = text.data() + end;
  const auto [stopped, error] = std::from_chars(text.data() + colon + 1, last, value);
  if (error != std::errc() || stopped != last || value < 1) return std::nullopt;
  end = colon;
  return value;
}

/// "path:line:column: level: text [check]", else nothing.
std::optional<Line> line_of(const std::string& text) {
  for (const char* level : {"warning", "error", "note"}) {
    const std::string mark = std::string(": ") + level + ": ";
    std::size_t at = text.find(mark);
    if (at == std::string::npos) continue;
    Line out;
    out.level = level;
    out.text = text.substr(at + mark.size());
    const std::optional<int> column = number_before(text, at);
    const std::optional<int> line = column ? number_before(text, at) : std::nullopt;
    if (!line || at == 0) continue;
    out.file = text.substr(0, at);
    out.line = *line;
    out.column = *column;
    const std::size_t open = out.text.rfind(" [");
    if (out.level != "note" && open != std::string::npos && out.text.back() == ']') {
      out.check = out.text.substr(open + 2, out.text.size() - open - 3);
      out.check = out.check.substr(0, out.check.find(','));  // "check,-warnings-as-errors"
      out.text.resize(open);
    }
    return out;
  }
  return std::nullopt;
}

/// What clang-tidy says beside its findings.
bool is_talk(const std::string& line) {
  for (const char* part : {"warnings generated.", "warning generated.", "Suppressed ", "Use -header-filter",
                           "warnings treated as errors", "warning treated as error", "Error while processing",
                           "errors generated.", "error generated.", "Found compiler error"}) {
    if (line.find(part) != std::string::npos) return true;
  }
  return false;
}

Json place_of(const Line& line) {
  return io::object({{"file", line.file}, {"line", line.line}, {"column", line.column}, {"text", line.text}});
}

/// A path as a URI reference (RFC 3986): what is not unreserved is spelled by its bytes; an absolute one names its
/// host.
std::string uri_of(const std::string& path) {
  std::string out = path.rfind('/', 0) == 0 ? "file://" : "";
  for (const char c : path) {
    const auto byte = static_cast<unsigned char>(c);
    const bool plain =
        (byte < 0x80 && std::isalnum(byte) != 0) || std::string_view("-._~/").find(c) != std::string::npos;
    out += plain ? std::string(1, c) : fmt::format("%{:02X}", byte);
  }
  return out;
}

Json location_of(const Json& place) {
  return io::object(
      {{"physicalLocation",
        io::object({{"artifactLocation", io::object({{"uri", uri_of(place["file"].get<std::string>())}})},
                    {"region", io::object({{"startLine", place["line"]}, {"startColumn", place["column"]}})}})}});
}

}  // namespace

io::FileExpected<Analysis> parse_analysis(const std::string& text, const std::string& path) {
  Json results = Json::array();
  std::map<std::string, int> by_check;
  std::set<std::string> seen;
  std::istringstream in(text);
  std::string line;
  bool known = false, empty = true, kept = false;
  while (std::getline(in, line)) {
    if (!line.empty() && line.back() == '\r') line.pop_back();
    empty = empty && line.empty();
    const std::optional<Line> found = line_of(line);
    known = known || found || is_talk(line);
    if (!found) continue;
    if (found->level == "note") {
      if (kept) results.back()["notes"].push_back(place_of(*found));
      continue;
    }
    kept = seen.insert(line).second;
    if (!kept) continue;
    Json one = place_of(*found);
    one["level"] = found->level;
    one["check"] = found->check.empty() ? "clang-diagnostic" : found->check;
    one["notes"] = Json::array();
    ++by_check[one["check"].get<std::string>()];
    results.push_back(std::move(one));
  }
  if (!empty && !known)
    return refuse(path, "is not the output of clang-tidy",
                  "give the output of: clang-tidy --quiet -p build/release FILE... > clang-tidy.log");
  Json checks = Json::array();
  for (const auto& [check, count] : by_check) checks.push_back(io::object({{"check", check}, {"count", count}}));
  Analysis out;
  out.findings = results.size();
  out.section = io::object({{"given", true},
                            {"tool", "clang-tidy"},
                            {"findings", out.findings},
                            {"by_check", std::move(checks)},
                            {"results", std::move(results)}});
  return out;
}

io::FileExpected<Analysis> read_analysis(const std::string& path) {
  const io::FileExpected<std::string> text = io::read_file(path);
  if (!text) return tl::unexpected<io::FileError>(text.error());
  return parse_analysis(*text, path);
}

Json no_analysis() {
  return io::object({{"given", false}, {"how", "--analysis clang-tidy.log, what clang-tidy printed"}});
}

std::string sarif_json(const Json& analysis, const std::string& version) {
  Json rules = Json::array(), results = Json::array();
  std::map<std::string, std::size_t> index;
  for (const Json& row : analysis["by_check"]) {
    const std::string check = row["check"];
    index.emplace(check, rules.size());
    rules.push_back(io::object({{"id", check}}));
  }
  for (const Json& found : analysis["results"]) {
    Json one = io::object({{"ruleId", found["check"]},
                           {"ruleIndex", index.at(found["check"].get<std::string>())},
                           {"level", found["level"]},
                           {"message", io::object({{"text", found["text"]}})},
                           {"locations", Json::array({location_of(found)})}});
    Json related = Json::array();
    for (const Json& note : found["notes"]) {
      Json place = location_of(note);
      place["id"] = related.size();
      place["message"] = io::object({{"text", note["text"]}});
      related.push_back(std::move(place));
    }
    if (!related.empty()) one["relatedLocations"] = std::move(related);
    results.push_back(std::move(one));
  }
  Json run = io::object(
      {{"tool",
        io::object({{"driver", io::object({{"name", "clang-tidy"},
                                           {"informationUri", "https://clang.llvm.org/extra/clang-tidy/"},
                                           {"rules", std::move(rules)},
                                           {"properties", io::object({{"convertedBy", "plumb " + version}})}})}})},
       {"columnKind", "utf16CodeUnits"},
       {"results", std::move(results)}});
  const Json out = io::object(
      {{"$schema", "https://docs.oasis-open.org/sarif/sarif/v2.1.0/errata01/os/schemas/sarif-schema-2.1.0.json"},
       {"version", "2.1.0"},
       {"runs", Json::array({std::move(run)})}});
  return out.dump(1) + "\n";
}

io::FileExpected<TargetResources> parse_resources(const std::string& text, const std::string& path) {
  const std::string remedy = "write it by scripts/baremetal: build/metal/results.json";
  const Json json = io::parsed(text);
  if (json.is_discarded() || !json.is_object()) return refuse(path, "is not a JSON object", remedy);
  if (json.value("schema", Json()) != Json("plumb-resources") || json.value("version", Json()) != Json(1))
    return refuse(path, "is not of the schema plumb-resources, version 1", remedy);
  const auto is_text = [](const Json& of, const char* key) { return of.contains(key) && of[key].is_string(); };
  if (!is_text(json, "commit") || !json.contains("items") || !json["items"].is_array() || json["items"].empty())
    return refuse(path, "lacks its commit or its items", remedy);
  TargetResources out;
  Json items = Json::array();
  for (const Json& item : json["items"]) {
    if (!item.is_object() || !is_text(item, "name") || !is_text(item, "unit") || !is_text(item, "target") ||
        !item.contains("value") || !item["value"].is_number())
      return refuse(path, "has an item without name, unit, target or value", remedy);
    const Json limit = item.value("limit", Json());
    if (!limit.is_null() && !limit.is_number()) return refuse(path, "has a limit that is not a number", remedy);
    out.items.push_back(
        {item["name"], item["value"], limit.is_null() ? std::nullopt : std::optional<double>(limit.get<double>())});
    items.push_back(io::object({{"target", item["target"]},
                                {"name", item["name"]},
                                {"value", item["value"]},
                                {"limit", limit},
                                {"unit", item["unit"]}}));
  }
  out.section = io::object({{"given", true}, {"commit", json["commit"]}, {"items", std::move(items)}});
  return out;
}

Json no_resources() {
  return io::object({{"given", false}, {"how", "--resources build/metal/results.json, from scripts/baremetal"}});
}

io::FileExpected<TargetResources> read_resources(const std::string& path) {
  const io::FileExpected<std::string> text = io::read_file(path);
  if (!text) return tl::unexpected<io::FileError>(text.error());
  return parse_resources(*text, path);
}

}  // namespace render
}  // namespace PLUMB_ABI
}  // namespace plumb
