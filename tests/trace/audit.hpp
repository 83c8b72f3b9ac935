/// Whether requirements, hazards and tests name each other. Pure function of what was read, so that a test can hand it
/// a broken copy.
#pragma once

#include <algorithm>
#include <filesystem>
#include <map>
#include <regex>
#include <set>
#include <string>
#include <vector>

#include "trace/sdoc.hpp"
#include "trace/tagged_tests.hpp"

namespace trace {

/// What docs/requirements/rooms.txt says of a room of tests/.
struct Room {
  bool required = false;  ///< every test of the room names a requirement
  std::string why;
};

struct Evidence {
  std::vector<Node> requirements, hazards;
  std::vector<TaggedTest> tests;
  std::map<std::string, Room> rooms;
};

inline void audit_nodes(const std::vector<Node>& nodes, const std::regex& id, std::set<std::string>& known,
                        Findings& out) {
  for (const Node& node : nodes) {
    const std::string uid = node.get("UID");
    const std::string where = node.file + ":" + std::to_string(node.line) + ": ";
    if (!std::regex_match(uid, id)) out.push_back(where + "\"" + uid + "\" is no id");
    if (!known.insert(uid).second) out.push_back(where + uid + " is given twice");
    for (const auto& [name, text] : node.field) {
      if (text.find("[LINK:") != std::string::npos) out.push_back(where + uid + ": " + name + " holds a link");
    }
  }
}

/// EARS: a trigger or none, then "shall".
inline bool is_ears(const std::string& statement) {
  static const std::regex form(R"(^(The|Every|With|When|While|If|Where|Until|Within|At|A|Under) .*\bshall\b.*\.$)");
  return std::regex_match(statement, form);
}

/// Names of the tests that carry `uid`, and whether the methods are backed by a test of their kind.
struct Links {
  std::set<std::string> verifying, negative;
  bool test = false, law = false, proof = false;
};

inline std::map<std::string, Links> links_of(const std::vector<TaggedTest>& tests, const std::set<std::string>& known,
                                             Findings& out) {
  std::map<std::string, Links> links;
  for (const TaggedTest& test : tests) {
    const auto note = [&](const std::vector<std::string>& ids, std::set<std::string> Links::*list) {
      for (const std::string& id : ids) {
        if (known.count(id) == 0) out.push_back(test.file + ": " + test.name + " names " + id + ", which is unknown");
        Links& link = links[id];
        if (list != nullptr) (link.*list).insert(test.name);
        link.test = link.test || test.kind == Kind::test || test.kind == Kind::compile;
        link.law = link.law || test.kind == Kind::law;
        link.proof = link.proof || test.kind == Kind::proof;
      }
    };
    note(test.verifies, &Links::verifying);
    note(test.negative, &Links::negative);
    for (const std::string& id : test.serves) {
      if (known.count(id) == 0) out.push_back(test.file + ": serves " + id + ", which is unknown");
    }
  }
  return links;
}

inline void audit_requirement(const Node& node, const Links& links, const std::set<std::string>& hazards,
                              Findings& out) {
  const std::string uid = node.get("UID");
  const auto complain = [&](const std::string& what) { out.push_back(uid + " " + what); };
  for (const char* name : {"METHOD", "STATEMENT", "RATIONALE", "TITLE", "STATUS"}) {
    if (node.get(name).empty()) complain(std::string("has no ") + name);
  }
  if (!is_ears(node.get("STATEMENT"))) complain("is no EARS sentence");
  if (node.parents.empty()) complain("answers no hazard");
  for (const std::string& hazard : node.parents) {
    if (hazards.count(hazard) == 0) complain("answers " + hazard + ", which is unknown");
  }
  if (node.get("STATUS") != "active") return;  // what is not built yet has no test yet
  if (links.verifying.empty()) complain("has no test that verifies it");
  if (links.negative.empty()) complain("has no negative test");
  std::set<std::string> both = links.verifying;
  both.insert(links.negative.begin(), links.negative.end());
  if (both.size() < 2) complain("has one test for both; the negative test is another one");
  for (const std::string& method : listed(node.get("METHOD"))) {
    const bool backed = method == "law" ? links.law : method == "proof" ? links.proof : method != "test" || links.test;
    if (!backed) complain("claims the method " + method + ", and no such test names it");
  }
}

inline Findings audit(const Evidence& evidence) {
  Findings out;
  std::set<std::string> known, hazards, answered;
  audit_nodes(evidence.requirements, std::regex("REQ-[0-9]{3}"), known, out);
  audit_nodes(evidence.hazards, std::regex("HAZ-[0-9]{2}"), hazards, out);
  const std::map<std::string, Links> links = links_of(evidence.tests, known, out);
  for (const Node& node : evidence.requirements) {
    const auto found = links.find(node.get("UID"));
    audit_requirement(node, found == links.end() ? Links{} : found->second, hazards, out);
    answered.insert(node.parents.begin(), node.parents.end());
  }
  for (const std::string& hazard : hazards) {
    if (answered.count(hazard) == 0) out.push_back(hazard + " is answered by no requirement");
  }
  std::set<std::string> seen;
  for (const TaggedTest& test : evidence.tests) {
    if (test.room.empty()) continue;  // not below tests/
    seen.insert(test.room);
    const auto room = evidence.rooms.find(test.room);
    if (room == evidence.rooms.end() || !room->second.required) continue;
    if (test.verifies.empty() && test.negative.empty() && test.serves.empty())
      out.push_back(test.file + ":" + std::to_string(test.line) + ": " + test.name + " names no requirement");
  }
  for (const std::string& room : seen) {
    if (evidence.rooms.count(room) == 0) out.push_back("tests/" + room + " is not in docs/requirements/rooms.txt");
  }
  for (const auto& [name, room] : evidence.rooms) {
    if (seen.count(name) == 0) out.push_back("rooms.txt names " + name + ", where no test is");
    if (room.why.empty()) out.push_back("rooms.txt gives no reason for " + name);
  }
  return out;
}

// ---- Reading the repository ------------------------------------------------------------------------------

inline std::map<std::string, Room> read_rooms(const std::string& text, Findings& out) {
  std::map<std::string, Room> rooms;
  static const std::regex form(R"(^(\w+) +\| (required|exempt) +\| (.+)$)");
  for (const std::string& line : lines_of(text)) {
    if (line.empty() || line[0] == '#') continue;
    std::smatch m;
    if (std::regex_match(line, m, form)) {
      rooms[m[1].str()] = Room{m[2].str() == "required", m[3].str()};
    } else {
      out.push_back("rooms.txt: \"" + line + "\" is not: room | required or exempt | why");
    }
  }
  return rooms;
}

/// Files below `folder` with the given end of name, in a fixed order.
inline std::vector<std::filesystem::path> files_below(const std::filesystem::path& folder, const std::string& end) {
  std::vector<std::filesystem::path> out;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    const std::string name = entry.path().string();
    if (name.size() >= end.size() && name.compare(name.size() - end.size(), end.size(), end) == 0)
      out.push_back(entry.path());
  }
  std::sort(out.begin(), out.end());
  return out;
}

inline Evidence read_repository(const std::string& root, Findings& out) {
  namespace fs = std::filesystem;
  Evidence evidence;
  const auto shown = [&root](const fs::path& path) { return fs::path(path).lexically_relative(root).string(); };
  for (const fs::path& path : files_below(fs::path(root) / "docs/requirements", ".sdoc")) {
    for (Node& node : SdocReader(shown(path), content_of(path.string(), out), out).nodes())
      (node.tag == "HAZARD" ? evidence.hazards : evidence.requirements).push_back(std::move(node));
  }
  evidence.rooms = read_rooms(content_of(root + "/docs/requirements/rooms.txt", out), out);
  const auto keep = [&evidence](std::vector<TaggedTest> tests) {
    evidence.tests.insert(evidence.tests.end(), tests.begin(), tests.end());
  };
  for (const fs::path& path : files_below(fs::path(root) / "tests", "_test.cpp")) {
    const std::string room = path.parent_path().filename().string();
    keep(TagScanner(shown(path), room, out).cpp(content_of(path.string(), out)));
  }
  for (const fs::path& path : files_below(fs::path(root) / "cmake", ".cmake"))
    keep(TagScanner(shown(path), "", out).cmake(content_of(path.string(), out)));
  for (const fs::path& path : files_below(fs::path(root) / "proofs", ".smt2"))
    keep(TagScanner(shown(path), "", out).proof(content_of(path.string(), out), path.stem().string()));
  return evidence;
}

}  // namespace trace
