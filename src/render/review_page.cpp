#include <fmt/format.h>

#include <cmath>

#include "html_view.hpp"
#include "plumb/core/vec3.hpp"
#include "plumb/io/printable.hpp"
#include "plumb/render/review_report.hpp"
#include "plumb/scenario/count_text.hpp"
#include "review_words.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace render {
namespace {

using review::LogReview;

std::string tone_of(review::Grade grade) {
  if (grade == review::Grade::red) return "bad";
  return grade == review::Grade::orange ? "open" : "good";
}
std::string tone_of(const LogReview& log) {
  return log.judged || log.grade != review::Grade::green ? tone_of(log.grade) : std::string("open");
}

std::string figure(double value, const char* format) {
  return std::isfinite(value) ? fmt::format(fmt::runtime(format), value) : "-";
}

Section fleet_view(const std::vector<LogReview>& logs, const std::vector<UnreadLog>& unread) {
  Section out("fleet", "Logs", "One row for each log, then what several logs tell of the same accelerometer.");
  ViewRows rows;
  for (std::size_t k = 0; k < logs.size(); ++k) {
    const LogReview& log = logs[k];
    rows.push_back({io::printable_line(log.name), ViewCell(grade_word(log), tone_of(log)),
                    std::to_string(log.chips.size()), figure(log.to_s - log.from_s, "{:.0f}"),
                    fmt::format("{:.0f}", log.at_rest_s), answer_of(log)});
  }
  for (const UnreadLog& log : unread)
    rows.push_back(
        {io::printable_line(log.name), ViewCell("NOT READ", "open"), "-", "-", "-", io::printable_line(log.why)});
  out.table("Every log", {"log", "grade", "accelerometers", "s", "at rest, s", "answer"}, rows);
  const std::vector<DeviceTrend> trends = trends_of(logs);
  if (trends.empty()) return out;
  ViewRows devices;
  for (const DeviceTrend& trend : trends) {
    for (std::size_t k = 0; k < trend.logs.size(); ++k) {
      devices.push_back({std::to_string(trend.device_id), io::printable_line(logs[trend.logs[k]].name),
                         figure(trend.off_gravity_mps2[k], "{:+.3f}"), figure(trend.warmest_degc[k], "{:.0f}")});
    }
  }
  out.table("The same accelerometer in several logs", {"device", "log", "at rest, m/s^2 off gravity", "warmest, degC"},
            devices,
            "A change from log to log beyond the uncertainty of gravity is drift, a shock or a new calibration.");
  return out;
}

void add_findings(const LogReview& log, Section& out) {
  if (log.findings.empty()) return;
  ViewRows rows;
  for (const review::Finding& finding : log.findings) {
    const ReviewSentence sentence = sentence_of(finding, log);
    rows.push_back({ViewCell(grade_word(finding.grade), tone_of(finding.grade)), sentence.what,
                    sentence.where.empty() ? "whole log" : sentence.where, sentence.remedy});
  }
  out.table("Findings", {"grade", "what", "where", "what to do"}, rows);
}

void add_chips(const LogReview& log, Section& out) {
  ViewRows rows;
  for (std::size_t i = 0; i < log.chips.size(); ++i) {
    const review::ChipSummary& chip = log.chips[i];
    const review::Axes& s = chip.scatter_mps2;
    rows.push_back({chip_name(log, i), device_words(chip), figure(chip.rate_hz, "{:.4g}"), temperature_words(chip),
                    figure(off_gravity_mps2(log, i), "{:+.3f}"),
                    std::isfinite(s[0]) ? fmt::format("{:.3f}, {:.3f}, {:.3f}", s[0], s[1], s[2]) : "-",
                    figure(chip.vibration_mps2, "{:.1f}"), std::to_string(chip.clipped), calibration_words(chip)});
  }
  out.table("Accelerometers",
            {"name in the log", "device", "rate, Hz", "degC", "at rest, m/s^2 off gravity",
             "scatter at rest x, y, z, m/s^2", "worst vibration, m/s^2", "clipped", "installed calibration"},
            rows);
}

void add_stretches(const LogReview& log, Section& out) {
  if (log.stretches.empty()) return;
  std::vector<std::string> head = {"from, s", "to, s"};
  for (std::size_t i = 0; i < log.chips.size(); ++i) head.push_back(chip_name(log, i) + " x, y, z; length, m/s^2");
  ViewRows rows;
  for (const review::Stretch& stretch : log.stretches) {
    std::vector<ViewCell> row = {fmt::format("{:.1f}", stretch.from_s), fmt::format("{:.1f}", stretch.to_s)};
    for (const review::Axes& m : stretch.mean_mps2) {
      row.emplace_back(std::isfinite(m[0]) ? fmt::format("{:.3f}, {:.3f}, {:.3f}; {:.3f}", m[0], m[1], m[2], norm(m))
                                           : "-");
    }
    rows.push_back(row);
  }
  out.table("Stretches at rest", head, rows, "", Fold::when_long);
}

Section log_view(const LogReview& log, std::size_t number) {
  Section out(fmt::format("log{}", number), io::printable_line(log.name), grade_word(log));
  out.notice(std::string(grade_word(log)) + ": " + answer_of(log), tone_of(log));
  if (log.chips.empty()) return out;
  out.figures(
      {{"Accelerometers", std::to_string(log.chips.size()), "in this log"},
       {"At rest", fmt::format("{:.0f} s", log.at_rest_s), count_text(log.stretches.size(), "stretch", "stretches")},
       {"Agreement in motion", figure(log.motion_agreement_mps2, "{:.2f} m/s^2"),
        fmt::format("median of {}", count_text(log.motion_cells, "cell"))}});
  add_findings(log, out);
  add_chips(log, out);
  add_stretches(log, out);
  std::vector<std::string> open;
  for (const review::OpenQuestion question : log.open) open.push_back(sentence_of(question));
  if (!open.empty()) out.list("What this log cannot tell", open);
  std::vector<std::string> notes;
  for (const review::Note& note : log.notes)
    notes.push_back(fmt::format("byte {}: {}", note.offset, io::printable_line(note.what)));
  if (!notes.empty()) out.list("Notes of the reader", notes);
  return out;
}

}  // namespace

std::string review_html(const std::vector<LogReview>& logs, const std::vector<UnreadLog>& unread) {
  std::vector<Section> sections;
  if (logs.size() + unread.size() > 1) sections.push_back(fleet_view(logs, unread));
  for (std::size_t k = 0; k < logs.size(); ++k) sections.push_back(log_view(logs[k], k + 1));
  PageFrame frame;
  frame.title = "Review of accelerometers";
  frame.lead = "What the logs say of their accelerometers, without an array file and without a calibration of plumb.";
  frame.footer =
      "Made by plumb review. docs/review.md lists every limit with its source. GREEN: nothing found in what "
      "was judged; what was not is listed.";
  return sections_html(frame, std::move(sections));
}

}  // namespace render
}  // namespace PLUMB_ABI
}  // namespace plumb
