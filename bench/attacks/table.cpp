#include "table.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "plumb/io/json_fields.hpp"
#include "plumb/io/output_file.hpp"
#include "plumb/study/proportion.hpp"

namespace plumb_bench {
namespace {

using plumb::io::FileError;
using plumb::io::FileExpected;
using plumb::io::Json;
using plumb::study::Proportion;

constexpr int kEveryN = 0;

std::size_t at(int k) { return static_cast<std::size_t>(k); }

struct Row {
  int family = 0;
  int n = kEveryN;
  Tally tally;
  const Family& what() const { return families()[at(family)]; }
  std::string size() const {
    if (n != kEveryN) return std::to_string(n);
    const Family& f = what();
    return f.least_n == f.most_n ? std::to_string(f.least_n) : fmt::format("{}-{}", f.least_n, f.most_n);
  }
};

std::vector<Row> rows_of(const Progress& progress, bool every_n) {
  std::vector<Row> out;
  for (int family = 0; family < static_cast<int>(families().size()); ++family) {
    const Family& f = families()[at(family)];
    const bool split = f.by_n || every_n;
    for (int n = f.least_n; split && n <= f.most_n; ++n) {
      out.push_back({family, n, progress.tally[at(family)][at(n - kLeastSensors)]});
    }
    if (!split) out.push_back({family, kEveryN, progress.total(family)});
  }
  out.erase(std::remove_if(out.begin(), out.end(), [](const Row& row) { return row.tally[Count::episodes] == 0; }),
            out.end());
  return out;
}

double share(std::uint64_t k, std::uint64_t n) {
  return n == 0 ? 0.0 : static_cast<double>(k) / static_cast<double>(n);
}

std::string bounded(std::uint64_t k, std::uint64_t n) {
  const Proportion p = plumb::study::proportion(k, n);
  if (k == 0) return fmt::format("0 (< {})", plumb::study::rounded_up(p.high, 2));
  return fmt::format("{} ({})", k, plumb::study::interval_text(p, 2));
}

/// Percent, with bounds.
std::string bounded_share(std::uint64_t k, std::uint64_t n) {
  const Proportion p = plumb::study::proportion(k, n);
  return plumb::study::rounded_share(p, 3, 100.0) + " % " + plumb::study::interval_text(p, 3, 100.0);
}

std::string blocks(std::size_t median) {
  return median + 1 < kNominalBins ? std::to_string(median) : std::string("never");
}

const char* standing(const Family& family) { return to_string(family.safety); }

std::string columns() {
  return " wrong exclusions | provisional | beyond level | hazardous | stale | broken | failed, none faulty | "
         "beyond what is promised | valid blocks | false doubts | blocks to nominal | failed |\n";
}

std::string line_of(const std::string& lead, const Tally& t) {
  std::string out = lead;
  const std::uint64_t n = t[Count::episodes];
  for (const Count c : kSafety) out += " " + bounded(t[c], n) + " |";
  out += " " + bounded(t[Count::unpromised], n) + " |";
  out += fmt::format(" {:.1f} % |", 100.0 * share(t[Count::valid_blocks], t[Count::blocks]));
  out += " " + bounded_share(t[Count::false_doubt], n) + " |";
  out += " " + blocks(t.median_to_nominal()) + " |";
  return out + " " + bounded_share(t[Count::failed], n) + " |\n";
}

/// Sum over the families that are promised, and over all.
Tally sum_of(const Progress& progress, bool promised_alone, bool adaptive_alone) {
  Tally sum;
  for (int family = 0; family < static_cast<int>(families().size()); ++family) {
    const Family& f = families()[at(family)];
    if (promised_alone && f.safety != Standing::promised) continue;
    if (adaptive_alone && !f.adaptive) continue;
    sum.add(progress.total(family));
  }
  return sum;
}

Json bounded_json(std::uint64_t k, std::uint64_t n) {
  const Proportion p = plumb::study::proportion(k, n);
  return plumb::io::object({{"count", k}, {"low", p.low}, {"high", p.high}});
}

Json row_json(const Row& row) {
  const Tally& t = row.tally;
  const std::uint64_t n = t[Count::episodes];
  Json out = plumb::io::object({{"family", row.what().name},
                                {"n", row.size()},
                                {"standing", standing(row.what())},
                                {"adaptive", row.what().adaptive},
                                {"episodes", n}});
  for (const Count c : kSafety) out[to_string(c)] = bounded_json(t[c], n);
  for (const Count c : {Count::unpromised, Count::false_doubt, Count::failed}) {
    out[to_string(c)] = bounded_json(t[c], n);
  }
  out["blocks"] = t[Count::blocks];
  out["valid_blocks"] = t[Count::valid_blocks];
  const std::size_t median = t.median_to_nominal();
  out["blocks_to_nominal"] = median + 1 < kNominalBins ? Json(median) : Json(nullptr);
  return out;
}

/// The same row of another result; null where it has none.
Json same_row(const Json& before, const Row& row) {
  for (const Json& other : before.value("rows", Json::array())) {
    if (other.value("family", "") == row.what().name && other.value("n", "") == row.size()) return other;
  }
  return Json();
}

/// "k of n" in short: the count, and its share where there are any.
std::string told(std::uint64_t k, std::uint64_t n) {
  return k == 0 ? std::string("0") : fmt::format("{} ({:.3g} %)", k, 100.0 * share(k, n));
}

/// Both, or one where they are the same.
std::string arrow(const std::string& was, const std::string& is) { return was == is ? is : was + " -> " + is; }

std::string compared_row(const Json& was, const Row& row) {
  const Tally& t = row.tally;
  const std::uint64_t n = t[Count::episodes];
  const std::uint64_t n_was = was.value("episodes", std::uint64_t{0});
  const auto count_was = [&was](Count c) {
    return was.value(to_string(c), Json::object()).value("count", std::uint64_t{0});
  };
  const auto percent = [](std::uint64_t k, std::uint64_t of) { return fmt::format("{:.1f} %", 100.0 * share(k, of)); };
  std::string out = fmt::format("| {} | {} | {} | {} |", row.what().name, row.size(), standing(row.what()),
                                arrow(std::to_string(n_was), std::to_string(n)));
  const auto cell = [&out](const std::string& before, const std::string& now) {
    out += " " + arrow(before, now) + " |";
  };
  for (const Count c : kSafety) cell(told(count_was(c), n_was), told(t[c], n));
  cell(told(count_was(Count::unpromised), n_was), told(t[Count::unpromised], n));
  cell(percent(was.value("valid_blocks", std::uint64_t{0}), was.value("blocks", std::uint64_t{0})),
       percent(t[Count::valid_blocks], t[Count::blocks]));
  cell(percent(count_was(Count::false_doubt), n_was), percent(t[Count::false_doubt], n));
  const Json median = was.value("blocks_to_nominal", Json());
  cell(median.is_number_unsigned() ? std::to_string(median.get<std::size_t>()) : "never",
       blocks(t.median_to_nominal()));
  cell(percent(count_was(Count::failed), n_was), percent(t[Count::failed], n));
  return out + "\n";
}

}  // namespace

std::string broken_promises(const Progress& progress) {
  std::string out;
  for (int family = 0; family < static_cast<int>(families().size()); ++family) {
    const Family& f = families()[at(family)];
    const Tally t = progress.total(family);
    for (const Count c : kSafety) {
      if (f.safety != Standing::promised || t[c] == 0) continue;
      out += fmt::format("{}: {} in {} of {} episodes\n", f.name, to_string(c), t[c], t[Count::episodes]);
    }
    if (f.failing == Standing::promised && t[Count::failed] != 0) {
      out += fmt::format("{}: failed in {} of {} episodes\n", f.name, t[Count::failed], t[Count::episodes]);
    }
  }
  return out;
}

std::string table_text(const Progress& progress, bool every_n) {
  std::string out = "| family | n | standing | episodes |" + columns();
  out += "|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|\n";
  for (const Row& row : rows_of(progress, every_n)) {
    const std::string lead = fmt::format("| {} | {} | {} | {} |", row.what().name, row.size(), standing(row.what()),
                                         row.tally[Count::episodes]);
    out += line_of(lead, row.tally);
  }
  const auto sum = [&out](const char* name, const char* which, const Tally& t) {
    if (t[Count::episodes] > 0) out += line_of(fmt::format("| {} | | {} | {} |", name, which, t[Count::episodes]), t);
  };
  sum("**promised, together**", "promised", sum_of(progress, true, false));
  sum("**of these adaptive**", "promised", sum_of(progress, true, true));
  return out;
}

std::string table_json(const Progress& progress) {
  std::string out = fmt::format("{{\n  \"harness\": {},\n  \"seed\": {},\n  \"confidence\": 0.95,\n  \"rows\": [",
                                kHarnessVersion, progress.seed);
  bool first = true;
  for (const Row& row : rows_of(progress, false)) {
    out += (first ? "\n    " : ",\n    ") + row_json(row).dump();
    first = false;
  }
  out += "\n  ],\n  \"cells\": [";
  first = true;
  for (const Row& row : rows_of(progress, true)) {
    out += (first ? "\n    " : ",\n    ") + row_json(row).dump();
    first = false;
  }
  return out + "\n  ]\n}\n";
}

FileExpected<std::string> comparison_text(const std::string& before, const Progress& progress) {
  const FileExpected<std::string> text = plumb::io::read_file(before);
  if (!text) return tl::unexpected<FileError>(text.error());
  const Json json = plumb::io::parsed(*text);
  if (json.is_discarded() || !json.is_object() || !json.contains("rows")) {
    return tl::unexpected<FileError>(
        FileError{before, 0, "", "is no table of plumb_monitor_attacks", "write it with --json there"});
  }
  std::string out = "| family | n | standing | episodes |" + columns();
  out += "|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|\n";
  for (const Row& row : rows_of(progress, false)) {
    const Json was = same_row(json, row);
    if (!was.is_null()) out += compared_row(was, row);
  }
  return out;
}

}  // namespace plumb_bench
