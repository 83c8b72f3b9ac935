#include <set>

#include "plumb/io/json_fields.hpp"
#include "plumb/io/output_file.hpp"
#include "plumb/render/change.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace render {
namespace {

constexpr std::size_t kMostListed = 300;
constexpr std::size_t kLongest = 160;

/// What names an entry of a list; empty where nothing does.
std::string key_of(const Json& entry) {
  if (entry.is_string()) return entry.get<std::string>();
  if (!entry.is_object()) return "";
  if (entry.contains("id") && entry["id"].is_string()) return entry["id"].get<std::string>();  // whatever it is called
  std::string out;
  for (const char* key :
       {"name", "fault", "faulty", "mode", "event", "from", "to", "role", "what", "question", "from_mdb"}) {
    if (entry.contains(key) && (entry[key].is_string() || entry[key].is_number()))
      out += (out.empty() ? "" : " ") + (entry[key].is_string() ? entry[key].get<std::string>() : entry[key].dump());
  }
  return out;
}

/// The keys of a list whose entries all have one of their own.
bool keyed(const Json& list) {
  std::set<std::string> seen;
  for (const Json& entry : list) {
    const std::string key = key_of(entry);
    if (key.empty() || !seen.insert(key).second) return false;
  }
  return true;
}

std::string brief(const Json& value) {
  std::string text =
      value.is_string() ? value.get<std::string>() : value.dump(-1, ' ', false, Json::error_handler_t::replace);
  if (text.size() > kLongest) text = text.substr(0, kLongest) + " ...";
  return text;
}

class Differences {
 public:
  void compare(const Json& before, const Json& now, const std::string& path) {
    if (before == now) return;
    if (before.is_object() && now.is_object()) return objects(before, now, path);
    if (before.is_array() && now.is_array() && keyed(before) && keyed(now)) return lists(before, now, path);
    if (before.is_array() && now.is_array() && before.size() == now.size()) {
      for (std::size_t k = 0; k < now.size(); ++k) compare(before[k], now[k], path + "[" + std::to_string(k + 1) + "]");
      return;
    }
    note(path, brief(before), brief(now));
  }

  Json take(std::size_t& left_out) {
    left_out = left_out_;
    return std::move(out_);
  }

 private:
  void objects(const Json& before, const Json& now, const std::string& path) {
    for (const auto& [key, value] : before.items()) {
      if (path.empty() && (key == "run" || key == "change")) continue;
      const std::string place = path.empty() ? key : path + "." + key;
      if (now.contains(key)) {
        compare(value, now[key], place);
      } else {
        note(place, brief(value), Json());
      }
    }
    for (const auto& [key, value] : now.items()) {
      if (path.empty() && (key == "run" || key == "change")) continue;
      if (!before.contains(key)) note(path.empty() ? key : path + "." + key, Json(), brief(value));
    }
  }

  void lists(const Json& before, const Json& now, const std::string& path) {
    const auto find = [](const Json& list, const std::string& key) -> const Json* {
      for (const Json& entry : list) {
        if (key_of(entry) == key) return &entry;
      }
      return nullptr;
    };
    for (const Json& entry : before) {
      const std::string key = key_of(entry);
      const Json* other = find(now, key);
      if (other != nullptr) {
        compare(entry, *other, path + "[" + key + "]");
      } else {
        note(path + "[" + key + "]", brief(entry), Json());
      }
    }
    for (const Json& entry : now) {
      const std::string key = key_of(entry);
      if (find(before, key) == nullptr) note(path + "[" + key + "]", Json(), brief(entry));
    }
  }

  void note(const std::string& path, Json before, Json now) {
    if (out_.size() == kMostListed) {
      ++left_out_;
    } else {
      out_.push_back(io::object({{"where", path}, {"before", std::move(before)}, {"now", std::move(now)}}));
    }
  }

  Json out_ = Json::array();
  std::size_t left_out_ = 0;
};

}  // namespace

io::FileExpected<Json> read_report(const std::string& path) {
  const io::FileExpected<std::string> text = io::read_file(path);
  if (!text) return tl::unexpected<io::FileError>(text.error());
  Json json = io::parsed(*text);
  const auto refuse = [&path](const std::string& what) {
    return tl::unexpected<io::FileError>(
        io::FileError{path, 0, "", what, "name the report.json of an earlier plumb verify"});
  };
  if (json.is_discarded() || !json.is_object()) return refuse("is not a report of plumb verify: not a JSON object");
  if (json.value("schema", Json()) != Json(kReportSchema))
    return refuse("is not a report of plumb verify: its schema is not plumb-verification");
  if (json.value("version", Json()) != Json(kReportVersion)) return refuse("has another version of the schema");
  return json;
}

Json change_section(const Json& before, const Json& now) {
  Differences differences;
  differences.compare(before, now, "");
  std::size_t left_out = 0;
  Json list = differences.take(left_out);
  const auto at = [](const Json& report, const char* section, const char* key) {
    const Json part = report.value(section, Json::object());
    return part.is_object() ? part.value(key, Json()) : Json();
  };
  const std::size_t count = list.size() + left_out;
  return io::object({{"given", true},
                     {"verdict_before", at(before, "verdict", "verdict")},
                     {"verdict_now", at(now, "verdict", "verdict")},
                     {"count", count},
                     {"left_out", left_out},
                     {"differences", std::move(list)}});
}

}  // namespace render
}  // namespace PLUMB_ABI
}  // namespace plumb
