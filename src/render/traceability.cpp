#include "plumb/render/traceability.hpp"
#include "plumb/io/json_fields.hpp"

#include <boost/property_tree/ptree.hpp>
#include <boost/property_tree/xml_parser.hpp>
#include <sstream>

#include "plumb/io/output_file.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace render {
namespace {

tl::unexpected<io::FileError> refuse_trace(const std::string& path, const std::string& what,
                                           const std::string& remedy) {
  return tl::unexpected<io::FileError>(io::FileError{path, 0, "", what, remedy});
}

bool is_text_list(const Json& value) {
  if (!value.is_array()) return false;
  for (const Json& item : value) {
    if (!item.is_string()) return false;
  }
  return true;
}

/// The first thing that is not as it must be; empty where all is well.
std::string shortcoming(const Json& json) {
  if (!json.is_object() || json.value("schema", "") != "plumb-traceability" || json.value("version", 0) != 1)
    return "is not of the schema plumb-traceability, version 1";
  for (const char* part : {"hazards", "requirements", "tests", "assurance"}) {
    if (!json.contains(part) || !json[part].is_array()) return std::string("has no list \"") + part + "\"";
    for (const Json& row : json[part]) {
      if (!row.is_object()) return std::string("has something in \"") + part + "\" that is not an object";
    }
  }
  const auto texts = [&json](const char* part, std::initializer_list<const char*> keys) -> std::string {
    for (const Json& row : json[part]) {
      for (const char* key : keys) {
        if (!row.contains(key) || !row[key].is_string()) return std::string(part) + ": an entry lacks \"" + key + "\"";
      }
    }
    return "";
  };
  const auto lists = [&json](const char* part, std::initializer_list<const char*> keys) -> std::string {
    for (const Json& row : json[part]) {
      for (const char* key : keys) {
        if (!row.contains(key) || !is_text_list(row[key]))
          return std::string(part) + ": an entry lacks the list \"" + key + "\"";
      }
    }
    return "";
  };
  for (const std::string& wrong :
       {texts("hazards", {"id", "title"}), texts("requirements", {"id", "title", "status", "statement"}),
        lists("requirements", {"methods"}), texts("tests", {"name", "kind", "file"}),
        lists("tests", {"verifies", "negative", "sources"}), lists("assurance", {"requirements"})}) {
    if (!wrong.empty()) return wrong;
  }
  return "";
}

/// "Many/Suite.Name/3" -> "Suite.Name".
std::string plain_name(std::string name) {
  const std::size_t last = name.rfind('/');
  if (last != std::string::npos && name.find_first_not_of("0123456789", last + 1) == std::string::npos)
    name.resize(last);
  const std::size_t slash = name.find('/');
  return slash == std::string::npos ? name : name.substr(slash + 1);
}

TestResult result_of(const boost::property_tree::ptree& test) {
  if (test.find("failure") != test.not_found() || test.find("error") != test.not_found()) return TestResult::failed;
  if (test.find("skipped") != test.not_found()) return TestResult::not_run;
  const std::string status = test.get("<xmlattr>.status", std::string("run"));
  if (status == "fail") return TestResult::failed;
  return status == "run" ? TestResult::passed : TestResult::not_run;
}

/// The worse of two: a failure counts, and so does one that did not run.
TestResult worse(TestResult a, TestResult b) {
  if (a == TestResult::failed || b == TestResult::failed) return TestResult::failed;
  return a == TestResult::not_run ? a : b;
}

void collect(const boost::property_tree::ptree& tree, TestResults& out) {
  for (const auto& [tag, child] : tree) {
    if (tag == "testcase") {
      std::string name = child.get("<xmlattr>.name", std::string());
      // GoogleTest itself puts the suite apart; ctest repeats the whole name.
      const std::string suite = child.get("<xmlattr>.classname", std::string());
      const bool plain = name.find_first_of(". ") == std::string::npos;
      if (plain && !suite.empty() && suite != name) name = suite + "." + name;
      const std::string test = plain_name(name);
      const TestResult result = result_of(child);
      const auto [at, fresh] = out.emplace(test, result);
      if (!fresh) at->second = worse(at->second, result);
    } else if (tag != "<xmlattr>") {
      collect(child, out);
    }
  }
}

}  // namespace

io::FileExpected<Json> parse_traceability(const std::string& text, const std::string& path) {
  Json json = Json::parse(text, nullptr, false);
  const std::string remedy = "take traceability.json of a report of plumb verify as the pattern";
  if (json.is_discarded()) return refuse_trace(path, "is not JSON", remedy);
  const std::string wrong = shortcoming(json);
  if (!wrong.empty()) return refuse_trace(path, wrong, remedy);
  return json;
}

io::FileExpected<Json> read_traceability(const std::string& path) {
  const io::FileExpected<std::string> text = io::read_file(path);
  if (!text) return tl::unexpected<io::FileError>(text.error());
  return parse_traceability(*text, path);
}

namespace {

constexpr const char* kTestsRemedy = "write it by scripts/test, or by: ctest --output-junit results.xml";

io::FileExpected<boost::property_tree::ptree> read_junit(const std::string& path) {
  const io::FileExpected<std::string> text = io::read_file(path);
  if (!text) return tl::unexpected<io::FileError>(text.error());
  boost::property_tree::ptree tree;
  try {
    std::istringstream in(*text);
    boost::property_tree::read_xml(in, tree);
  } catch (const boost::property_tree::xml_parser_error& error) {
    io::FileError refusal{path, static_cast<int>(error.line()), "", "is not XML: " + error.message(), kTestsRemedy};
    return tl::unexpected<io::FileError>(refusal);
  }
  return tree;
}

/// Wherever in the file they stand; the first of each counts.
void find_build(const boost::property_tree::ptree& node,
                BuildKey& out) {  // NOLINT(misc-no-recursion) as deep as the file
  for (const auto& [tag, child] : node) {
    if (tag != "property") {
      if (tag != "<xmlattr>" && tag != "testcase") find_build(child, out);
      continue;
    }
    const std::string name = child.get("<xmlattr>.name", ""), value = child.get("<xmlattr>.value", "");
    for (const auto& [key, to] : {std::pair<const char*, std::string*>{"plumb.commit", &out.commit},
                                  {"plumb.compiler", &out.compiler},
                                  {"plumb.flags", &out.flags}}) {
      if (name == key && to->empty()) *to = value;
    }
  }
}

}  // namespace

io::FileExpected<TestResults> read_test_results(const std::string& path) {
  const io::FileExpected<boost::property_tree::ptree> tree = read_junit(path);
  if (!tree) return tl::unexpected<io::FileError>(tree.error());
  TestResults out;
  collect(*tree, out);
  if (out.empty()) return refuse_trace(path, "holds no test", kTestsRemedy);
  return out;
}

io::FileExpected<BuildKey> read_test_build(const std::string& path) {
  const io::FileExpected<boost::property_tree::ptree> tree = read_junit(path);
  if (!tree) return tl::unexpected<io::FileError>(tree.error());
  BuildKey out;
  find_build(*tree, out);
  return out;
}

io::FileExpected<AssuranceResults> read_assurance(const std::string& path) {
  const io::FileExpected<std::string> text = io::read_file(path);
  if (!text) return tl::unexpected<io::FileError>(text.error());
  const std::string remedy = "write it by scripts/assure: build/assure/results.json";
  const Json json = Json::parse(*text, nullptr, false);
  if (json.is_discarded() || !json.is_object()) return refuse_trace(path, "is not a JSON object", remedy);
  if (json.value("schema", Json()) != Json(2))
    return refuse_trace(path, "is not of schema 2 of scripts/assure", remedy);
  if (!json.contains("items") || !json["items"].is_array()) return refuse_trace(path, "holds no items", remedy);
  AssuranceResults out;
  try {
    out.version = json.value("version", "");
    out.complete = json.value("complete", false);
    for (const Json& row : json["items"]) {
      AssuranceResults::Item item{row.value("kind", ""),
                                  row.value("tool", ""),
                                  row.value("version", ""),
                                  row.value("figure", ""),
                                  row.value("title", ""),
                                  row.value("seconds", 0.0),
                                  row.value("result", "") == "holds",
                                  true};
      out.item[row.at("item").get<std::string>()] = item;
      for (const Json& detail : row.value("details", Json::array())) {
        AssuranceResults::Item one = item;
        one.figure = detail.value("figure", "");
        one.seconds = detail.value("seconds", 0.0);
        one.holds = detail.value("result", "") == "holds";
        one.listed = false;
        out.item.emplace(detail.at("item").get<std::string>(), one);
      }
    }
  } catch (const Json::exception& error) {
    return refuse_trace(path, std::string("has an item that does not follow docs/assurance.md: ") + error.what(),
                        remedy);
  }
  if (out.item.empty()) return refuse_trace(path, "holds no item", remedy);
  return out;
}

}  // namespace render
}  // namespace PLUMB_ABI
}  // namespace plumb
