#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "plumb/core/units.hpp"
#include "plumb/io/printable.hpp"
#include "plumb/render/review_report.hpp"
#include "plumb/scenario/count_text.hpp"
#include "review_words.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace render {
namespace {

using review::LogReview;

using Rows = std::vector<std::vector<std::string>>;

/// Columns as wide as their longest cell; the first row is the head.
std::string columns(const Rows& rows) {
  std::vector<std::size_t> widths;
  for (const auto& row : rows) {
    widths.resize(std::max(widths.size(), row.size()));
    for (std::size_t k = 0; k < row.size(); ++k) widths[k] = std::max(widths[k], row[k].size());
  }
  std::string out;
  for (const auto& row : rows) {
    std::string line = " ";
    for (std::size_t k = 0; k < row.size(); ++k) line += fmt::format(" {:<{}} ", row[k], widths[k]);
    out += line.substr(0, line.find_last_not_of(' ') + 1) + "\n";
  }
  return out;
}

std::string signed_figure(double value) { return std::isfinite(value) ? fmt::format("{:+.3f}", value) : "-"; }

std::string scatter_words(const review::ChipSummary& chip) {
  const review::Axes& s = chip.scatter_mps2;
  return std::isfinite(s[0]) ? fmt::format("{:.3f} {:.3f} {:.3f}", s[0], s[1], s[2]) : "-";
}

std::string chip_table(const LogReview& in) {
  Rows rows = {{"accelerometer", "device", "rate", "degC", "rest, m/s^2 off gravity", "scatter x y z", "clipped",
                "installed calibration"}};
  for (std::size_t i = 0; i < in.chips.size(); ++i) {
    const review::ChipSummary& chip = in.chips[i];
    rows.push_back({chip_name(in, i), device_words(chip),
                    std::isfinite(chip.rate_hz) ? fmt::format("{:.4g} Hz", chip.rate_hz) : "-", temperature_words(chip),
                    signed_figure(off_gravity_mps2(in, i)), scatter_words(chip), std::to_string(chip.clipped),
                    calibration_words(chip)});
  }
  return columns(rows);
}

std::string findings_text(const LogReview& in) {
  std::string out;
  for (const review::Finding& finding : in.findings) {
    const ReviewSentence sentence = sentence_of(finding, in);
    out += fmt::format("  {:<7} {}{}.\n          To do: {}.\n", grade_word(finding.grade), sentence.what,
                       sentence.where.empty() ? "" : " (" + sentence.where + ")", sentence.remedy);
  }
  return out;
}

/// Every figure where they fit on a line; else the first, the last and the one that is furthest off.
std::string trend_words(const DeviceTrend& trend, const std::vector<LogReview>& logs) {
  constexpr std::size_t kMostFigures = 10;
  const std::vector<double>& off = trend.off_gravity_mps2;
  std::string out;
  if (off.size() <= kMostFigures) {
    for (const double one : off) out += signed_figure(one) + " ";
    return out;
  }
  std::vector<std::size_t> known;
  for (std::size_t k = 0; k < off.size(); ++k) {
    if (std::isfinite(off[k])) known.push_back(k);
  }
  if (known.empty()) return "-";
  const std::size_t worst = *std::max_element(
      known.begin(), known.end(), [&](std::size_t a, std::size_t b) { return std::abs(off[a]) < std::abs(off[b]); });
  return fmt::format("first {}, last {}, furthest {} in {}{}", signed_figure(off[known.front()]),
                     signed_figure(off[known.back()]), signed_figure(off[worst]),
                     io::printable_line(logs[trend.logs[worst]].name),
                     known.size() == off.size() ? "" : fmt::format("; {} never at rest", off.size() - known.size()));
}

std::string rest_words(const LogReview& in) {
  if (in.stretches.empty()) return "At rest: never for 3 s or more.";
  return fmt::format("At rest: {:.1f} s in {}. Gravity is taken as {:.3f} m/s^2, +-{:.3f}.", in.at_rest_s,
                     count_text(in.stretches.size(), "stretch", "stretches"), in.gravity_mps2, in.gravity_half_mps2);
}

std::string notes_text(const LogReview& in, bool all) {
  if (in.notes.empty()) return "";
  if (!all) return fmt::format("The reader left {} (--notes shows them).\n", count_text(in.notes.size(), "note"));
  std::string out = "Notes of the reader:\n";
  for (const review::Note& note : in.notes)
    out += fmt::format("  byte {}: {}.\n", note.offset, io::printable_line(note.what));
  return out;
}

}  // namespace

const char* grade_word(const LogReview& one) noexcept {
  return one.judged || one.grade != review::Grade::green ? grade_word(one.grade) : "NOT JUDGED";
}

std::string review_text(const LogReview& one, bool notes) {
  std::string out = fmt::format("{}: {}\n{}\n", io::printable_line(one.name), grade_word(one), answer_of(one));
  if (!one.understood.empty()) out += "Read as " + io::printable_line(one.understood) + ".\n";
  if (one.chips.empty()) return out + notes_text(one, notes);
  out +=
      fmt::format("\nLog: {:.1f} s, {}, {} bytes of {} read{}. {}\n", one.to_s - one.from_s,
                  count_text(one.chips.size(), "accelerometer"), one.extent.read_bytes, one.extent.bytes,
                  one.extent.dropped_s > 0.0 ? fmt::format(", {:.2f} s lost by the logger", one.extent.dropped_s) : "",
                  rest_words(one));
  if (one.motion_cells > 0) {
    out += fmt::format("In motion: compared in {}, difference {:.2f} m/s^2 (median).\n",
                       count_text(one.motion_cells, "cell"), one.motion_agreement_mps2);
  }
  out += "\n" + chip_table(one);
  if (!one.findings.empty()) out += "\nFindings\n" + findings_text(one);
  if (!one.open.empty()) out += "\nOpen\n";
  for (const review::OpenQuestion question : one.open) out += "  " + sentence_of(question) + ".\n";
  const std::string told = notes_text(one, notes);
  return out + (told.empty() ? "" : "\n" + told);
}

std::string fleet_text(const std::vector<LogReview>& logs, const std::vector<UnreadLog>& unread) {
  Rows rows = {{"log", "grade", "s", "chips", "at rest, s", "answer"}};
  for (const LogReview& log : logs) {
    rows.push_back({io::printable_line(log.name), grade_word(log),
                    log.chips.empty() ? "-" : fmt::format("{:.0f}", log.to_s - log.from_s),
                    std::to_string(log.chips.size()), fmt::format("{:.0f}", log.at_rest_s), answer_of(log)});
  }
  for (const UnreadLog& log : unread)
    rows.push_back({io::printable_line(log.name), "NOT READ", "-", "-", "-", io::printable_line(log.why)});
  std::string out = columns(rows);
  const std::vector<DeviceTrend> trends = trends_of(logs);
  if (trends.empty()) return out;
  Rows table = {{"device", "logs", "rest, m/s^2 off gravity, in the order of the logs"}};
  for (const DeviceTrend& trend : trends)
    table.push_back({std::to_string(trend.device_id), std::to_string(trend.logs.size()), trend_words(trend, logs)});
  return out + "\nThe same accelerometer in several logs\n" + columns(table);
}

}  // namespace render
}  // namespace PLUMB_ABI
}  // namespace plumb
