#include "plumb/session/incident_recorder.hpp"

#include <fmt/format.h>

#include <filesystem>

#include "plumb/io/json_fields.hpp"
#include "plumb/io/records.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace session {
namespace {

namespace fs = std::filesystem;

constexpr const char* kIndex = "incidents.jsonl";

std::string name_of(int number) { return fmt::format("incident-{:04}.csv", number); }

Rotation rotation_of(const stepping::Turn& turn) { return {turn.turning, turn.rate_known, turn.rate_radps}; }

std::string line_of(const std::string& name, double begin_s, double end_s, std::size_t rows,
                    const std::vector<std::string>& changes) {
  io::Json out = io::object({{"file", name}, {"begin_s", begin_s}, {"end_s", end_s}, {"rows", rows}});
  out["changes"] = io::Json::array();
  for (const std::string& change : changes) out["changes"].push_back(io::Json::parse(change));
  return out.dump() + "\n";
}

}  // namespace

io::FileExpected<std::unique_ptr<IncidentRecorder>> IncidentRecorder::create(IncidentSettings settings,
                                                                             const io::ArrayFile& array) {
  std::error_code error;
  fs::create_directories(settings.directory, error);
  if (error) {
    return tl::unexpected<io::FileError>(io::FileError{settings.directory, 0, "--incidents",
                                                       "cannot create the directory: " + error.message(),
                                                       "name another directory", io::ExitCode::other});
  }
  const std::string index = (fs::path(settings.directory) / kIndex).string();
  if (fs::exists(index, error) || fs::exists(fs::path(settings.directory) / name_of(1), error)) {
    return tl::unexpected<io::FileError>(
        io::FileError{settings.directory, 0, "--incidents", "holds the incidents of another run",
                      "name another directory, or move these away", io::ExitCode::usage});
  }
  io::FileExpected<io::OutputFile> file = io::OutputFile::create(index, io::OutputFile::Mode::stream);
  if (!file) return tl::unexpected<io::FileError>(file.error());
  return std::unique_ptr<IncidentRecorder>(new IncidentRecorder(std::move(settings), array, *std::move(file)));
}

void IncidentRecorder::at_turn(const stepping::Turn& turn) { notes_.rotation = rotation_of(turn); }
void IncidentRecorder::at_second_turn(const stepping::Turn& turn) { notes_.second_rotation = rotation_of(turn); }

io::FileExpected<void> IncidentRecorder::take(double, const MotionVerdict&,
                                              const std::vector<io::MotionEvent>& events) {
  for (const io::MotionEvent& event : events) {
    changes_.emplace_back();
    io::append_motion_event_json(changes_.back(), event, array_.array);
  }
  return {};
}

std::string IncidentRecorder::path_of(const std::string& name) const {
  return (fs::path(settings_.directory) / name).string();
}

io::FileExpected<void> IncidentRecorder::begin() {
  const std::string name = name_of(recorded_ + 1);
  io::FileExpected<io::LogWriter> log = io::LogWriter::create(path_of(name), array_, io::LogWriter::Columns::all);
  if (!log) return tl::unexpected<io::FileError>(log.error());
  ++recorded_;
  now_.emplace(Incident{name, *std::move(log), 0.0, 0.0, 0, 0, {}});
  for (const Row& row : before_) {
    if (const io::FileExpected<void> done = record(row); !done) return done;
  }
  before_.clear();
  return {};
}

io::FileExpected<void> IncidentRecorder::record(const Row& row) {
  if (now_->rows++ == 0) now_->begin_s = row.sample.time_s;
  now_->end_s = row.sample.time_s;
  return now_->log.write(row.sample, row.notes);
}

io::FileExpected<void> IncidentRecorder::end() {
  io::FileExpected<void> done = now_->log.commit();
  if (done) done = index_.write(line_of(now_->name, now_->begin_s, now_->end_s, now_->rows, now_->changes));
  if (done) done = index_.flush();
  now_.reset();
  return done;
}

io::FileExpected<void> IncidentRecorder::take(const Sample& sample, const Verdict& verdict) {
  if (verdict.transition.sequence != 0) {
    changes_.emplace_back();
    io::append_event_json(changes_.back(), verdict.transition, array_.array);
  }
  const Row row{sample, notes_};
  notes_ = {};
  io::FileExpected<void> done;
  if (!changes_.empty() && !now_) {
    if (recorded_ == settings_.most)
      passed_over_ += static_cast<int>(changes_.size());
    else
      done = begin();
  }
  if (!now_) {
    changes_.clear();
    before_.push_back(row);
    if (before_.size() > static_cast<std::size_t>(settings_.rows)) before_.pop_front();
    return done;
  }
  if (!changes_.empty()) now_->left = settings_.rows + 1;  // the row at hand, and as many after it
  for (std::string& change : changes_) now_->changes.push_back(std::move(change));
  changes_.clear();
  if (done) done = record(row);
  if (done && --now_->left == 0) done = end();
  return done;
}

io::FileExpected<void> IncidentRecorder::commit() {
  io::FileExpected<void> done;
  if (now_) done = end();
  return done ? index_.commit() : done;
}

}  // namespace session
}  // namespace PLUMB_ABI
}  // namespace plumb
