// plumb_trace_export ROOT OUT.cpp: a program of the build. Reads the requirements, the hazards, the tags of the tests
// and the table of docs/assurance.md with the readers that plumb_trace_tests judges them by, and writes all of it as
// the source of one text, so that the tool knows it without a source tree.
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <regex>
#include <set>
#include <string>

#include "trace/audit.hpp"

namespace {

using Json = nlohmann::ordered_json;
namespace fs = std::filesystem;

const char* kind_name(trace::Kind kind) {
  switch (kind) {
    case trace::Kind::test: return "test";
    case trace::Kind::law: return "law";
    case trace::Kind::compile: return "compile";
    case trace::Kind::proof: return "proof";
  }
  return "?";
}

/// First groups of all matches, in order, each once.
std::vector<std::string> found_in(const std::string& text, const std::string& pattern) {
  const std::regex expression(pattern);
  std::vector<std::string> out;
  for (std::sregex_iterator it(text.begin(), text.end(), expression), end; it != end; ++it) {
    const std::string name = (*it)[1].str();
    if (std::find(out.begin(), out.end(), name) == out.end()) out.push_back(name);
  }
  return out;
}

/// The sources that share their name with a test file: tests/<room>/x_test.cpp stands for x.hpp and x.cpp of the room;
/// where there are none, the room.
std::vector<std::string> sources_of(const fs::path& root, const std::string& test_file) {
  std::vector<std::string> out;
  const fs::path test(test_file);
  std::string stem = test.stem().string();
  const std::string room = test.parent_path().filename().string(), end = "_test";
  if (stem.size() <= end.size() || stem.compare(stem.size() - end.size(), end.size(), end) != 0) return out;
  stem.resize(stem.size() - end.size());
  for (const std::string& path : {"include/plumb/" + room + "/" + stem + ".hpp", "src/" + room + "/" + stem + ".cpp"}) {
    if (fs::exists(root / path)) out.push_back(path);
  }
  if (out.empty() && fs::exists(root / "src" / room)) out.push_back("src/" + room);
  return out;
}

Json node_json(const trace::Node& node) {
  Json out = {{"id", node.get("UID")}, {"title", node.get("TITLE")}};
  if (!node.get("STATUS").empty()) out["status"] = node.get("STATUS");
  if (!node.get("METHOD").empty()) out["methods"] = trace::listed(node.get("METHOD"));
  out["statement"] = node.get("STATEMENT");
  if (!node.get("RATIONALE").empty()) out["rationale"] = node.get("RATIONALE");
  if (!node.parents.empty()) out["hazards"] = node.parents;
  out["file"] = node.file;
  out["line"] = node.line;
  return out;
}

Json tests_json(const fs::path& root, const trace::Evidence& evidence) {
  Json out = Json::array();
  for (const trace::TaggedTest& test : evidence.tests) {
    if (test.verifies.empty() && test.negative.empty()) continue;
    out.push_back({{"name", test.name},
                   {"kind", kind_name(test.kind)},
                   {"file", test.file},
                   {"line", test.line},
                   {"verifies", test.verifies},
                   {"negative", test.negative},
                   {"sources", sources_of(root, test.file)}});
  }
  return out;
}

/// A row of docs/assurance.md: what it is about, its requirements, and which items of which tool stand behind them.
Json row_json(const std::string& line) {
  const std::string about = line.substr(2, line.find(" |", 2) - 2);
  Json items = Json::array();
  const std::regex item(R"(`([A-Za-z0-9_]+)` \((Coq|spin)\))");
  for (std::sregex_iterator it(line.begin(), line.end(), item), end; it != end; ++it)
    items.push_back({{"name", (*it)[1].str()}, {"tool", (*it)[2].str()}});
  for (const char* word : {"lockstep", "liveness"}) {
    const std::string cell = std::string(" ") + word;
    if (line.find(cell) == std::string::npos || line.find(cell + "_") != std::string::npos) continue;
    for (const char* size : {"_4", "_5", "_6"}) items.push_back({{"name", word + std::string(size)}, {"tool", "spin"}});
  }
  return {{"about", std::regex_search(about, std::regex("REQ-")) ? Json() : Json(about)},
          {"requirements", found_in(line, "(REQ-[0-9]{3})")},
          {"items", items},
          {"tests", found_in(line, R"(`([A-Z]\w+\.\w+)`)")}};
}

Json assurance_json(const std::string& page) {
  Json out = Json::array();
  for (const std::string& line : trace::lines_of(page)) {
    if (line.rfind("| ", 0) == 0 && line.find("REQ-") != std::string::npos) out.push_back(row_json(line));
  }
  return out;
}

/// A raw literal holds 64 KiB on every compiler; so many short ones follow one another.
std::string source_of(const std::string& text) {
  constexpr std::size_t kPiece = 8000;
  std::string out =
      "// Written by the build: see src/trace/export.cpp.\n#include \"plumb/render/traceability.hpp\"\n\n"
      "namespace plumb {\ninline namespace PLUMB_ABI {\nnamespace render {\n\n"
      "const char* built_in_traceability() noexcept {\n  return\n";
  for (std::size_t at = 0; at < text.size();) {
    std::size_t end = std::min(at + kPiece, text.size());
    // A character of several bytes is not cut.
    while (end < text.size() && (static_cast<unsigned char>(text[end]) & 0xC0U) == 0x80U) --end;
    out += "R\"trace(" + text.substr(at, end - at) + ")trace\"\n";
    at = end;
  }
  return out + "  ;\n}\n\n}  // namespace render\n}  // namespace PLUMB_ABI\n}  // namespace plumb\n";
}

int run(const std::string& root, const std::string& target) {
  trace::Findings findings;
  const trace::Evidence evidence = trace::read_repository(root, findings);
  const std::string assurance = trace::content_of(root + "/docs/assurance.md", findings);
  if (evidence.requirements.empty()) {
    std::fprintf(stderr, "plumb_trace_export: no requirements below %s/docs/requirements\n", root.c_str());
    return 1;
  }
  Json out = {{"schema", "plumb-traceability"}, {"version", 1}};
  out["hazards"] = Json::array();
  out["requirements"] = Json::array();
  for (const trace::Node& node : evidence.hazards) out["hazards"].push_back(node_json(node));
  for (const trace::Node& node : evidence.requirements) out["requirements"].push_back(node_json(node));
  out["tests"] = tests_json(root, evidence);
  out["assurance"] = assurance_json(assurance);
  out["findings"] =
      findings;  // what the readers did not understand; plumb_trace_tests fails on it, the report shows it
  const std::string text = source_of(out.dump());
  {
    std::ifstream old(target, std::ios::binary);
    const std::string before((std::istreambuf_iterator<char>(old)), std::istreambuf_iterator<char>());
    if (before == text) return 0;  // what includes it need not be built again
  }
  std::ofstream file(target, std::ios::binary);
  file << text;
  return file.flush() ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) {
    std::fprintf(stderr, "usage: plumb_trace_export ROOT OUT.cpp\n");
    return 2;
  }
  return run(argv[1], argv[2]);
}
