// A bag of ROS 2 in SQLite: one file of it. The messages are read in ros_topics.
#include <sys/stat.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <string>
#include <string_view>
#include <utility>

#include "log_magic.hpp"
#include "plumb/io/mapped_file.hpp"
#include "plumb/logs/flight_log.hpp"
#include "ros_notes.hpp"
#include "ros_topics.hpp"
#include "sqlite_file.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace logs {
namespace {

constexpr const char* kGiveBag = "give a .db3 file of a bag of ROS 2";
constexpr std::size_t kSqliteHead = 100;
/// A message of an IMU has some 330 bytes.
constexpr std::size_t kLongestMessage = 1U << 20U;
/// Where the tree of messages is damaged, it is entered again behind the damage so many times.
constexpr int kMostEntries = 200;

class BagReader {
 public:
  BagReader(std::string path, LogSink& sink) : path_(std::move(path)), notes_(sink), topics_(sink, notes_) {}

  io::FileExpected<LogExtent> read();

 private:
  tl::unexpected<io::FileError> error(std::string what, std::string remedy) const {
    return tl::unexpected<io::FileError>(io::FileError{path_, 0, "", std::move(what), std::move(remedy)});
  }
  io::FileExpected<void> open();
  /// Of the database, by its own head; 0 where that is of no use.
  std::uint64_t stated_size(std::string_view head) const noexcept;
  void say_journal();
  bool read_topics();
  bool read_messages();
  /// Until the end of the table (true), or until it cannot go on.
  bool read_rows(SqliteRows& rows, std::int64_t& last);
  void take(const SqliteRows& rows);

  std::string path_;
  RosNotes notes_;
  RosTopics topics_;
  SqliteFile database_;
  std::uint64_t size_ = 0;
  std::map<std::int64_t, std::size_t> numbers_;  ///< of the topics that are read, by their id
};

std::uint64_t BagReader::stated_size(std::string_view head) const noexcept {
  const auto big_endian = [head](std::size_t at, std::size_t count) {
    std::uint64_t out = 0;
    for (std::size_t k = 0; k < count; ++k) out = out << 8U | static_cast<unsigned char>(head[at + k]);
    return out;
  };
  const std::uint64_t page = big_endian(16, 2) == 1 ? 65536 : big_endian(16, 2);
  const bool is_current = big_endian(24, 4) == big_endian(92, 4);  // else the number of pages is an old one
  return is_current ? page * big_endian(28, 4) : 0;
}

/// What a recorder that was broken off has not yet moved into the bag.
void BagReader::say_journal() {
  struct stat status {};
  if (::stat((path_ + "-wal").c_str(), &status) != 0 || status.st_size == 0) return;
  notes_.say(size_, "what stands in the file beside it that ends with -wal (" + std::to_string(status.st_size) +
                        " bytes) is not read: `sqlite3 BAG.db3 'PRAGMA wal_checkpoint'` moves it into the bag");
}

io::FileExpected<void> BagReader::open() {
  io::MappedFile file;
  if (auto opened = open_log(path_, kGiveBag, file); !opened) return opened;
  size_ = file.size();
  const std::string_view head = first_bytes(file, kMagicBytes);
  const KnownFile* known = known_file(head);
  if (known == nullptr || known->kind != FileKind::sqlite) {
    if (known != nullptr) return error(std::string(known->what) + ", no SQLite database", known->remedy);
    return error("is no SQLite database: it does not begin with \"SQLite format 3\" at byte 0", kGiveBag);
  }
  if (head.size() < kSqliteHead)
    return error("ends at byte " + std::to_string(size_) + ", inside the 100 bytes that a database begins with",
                 "copy the bag again");
  const std::uint64_t stated = stated_size(head);
  const bool is_cut = stated > size_;
  if (is_cut) notes_.say(size_, "the bag ends here, of " + std::to_string(stated) + " bytes that it says it has");
  if (!database_.open(path_, size_, is_cut))
    return error("cannot be opened: " + database_.what(), "copy the bag again");
  if (database_.has_table("topics") && database_.has_table("messages")) return {};
  const std::string what = database_.what();
  if (what != "not an error" && what != "no more rows available")
    return error("is a damaged SQLite database: " + what, "copy the bag again, or try `sqlite3 BAG.db3 .recover`");
  return error("is an SQLite database without the tables `topics` and `messages` of a bag of ROS 2", kGiveBag);
}

bool BagReader::read_topics() {
  const auto select = [](const char* format) {
    return std::string("SELECT rowid, id, name, type, ") + format + " FROM topics WHERE rowid > ? ORDER BY rowid";
  };
  SqliteRows rows = database_.prepare(select("serialization_format"));
  if (!rows) rows = database_.prepare(select("'cdr'"));  // of a bag by another program
  if (!rows) return false;
  std::int64_t last = std::numeric_limits<std::int64_t>::min();
  rows.start_behind(last);
  SqliteRows::Step step = SqliteRows::Step::end;
  while ((step = rows.next()) == SqliteRows::Step::row && rows.whole(0) > last) {
    last = rows.whole(0);
    const std::size_t number = topics_.define(rows.text(2), rows.text(3), rows.text(4), 0);
    if (number != RosTopics::kNotRead) numbers_.emplace(rows.whole(1), number);
  }
  if (step != SqliteRows::Step::end)
    notes_.say(std::min(database_.last_read(), size_),
               "the table of topics is damaged (" + database_.what() + "), those before the damage are read");
  return true;
}

void BagReader::take(const SqliteRows& rows) {
  const auto topic = numbers_.find(rows.whole(1));
  if (topic == numbers_.end()) return;
  const std::int64_t size = rows.whole(3);
  const std::uint64_t place = std::min(database_.last_read(), size_);
  if (size > static_cast<std::int64_t>(kLongestMessage)) {
    if (notes_.wanted(RosTrouble::record, place))
      notes_.say(place, "message " + std::to_string(rows.whole(0)) + " has " + std::to_string(size) +
                            " bytes, more than 1 MiB, it is left out");
    return;
  }
  const std::string_view data = rows.bytes(4);
  const auto* bytes = reinterpret_cast<const unsigned char*>(data.data());  // NOLINT(*-reinterpret-cast)
  topics_.take(topic->second, rows.whole(2), bytes, data.size(), place);
}

bool BagReader::read_rows(SqliteRows& rows, std::int64_t& last) {
  rows.start_behind(last);
  while (true) {
    const SqliteRows::Step step = rows.next();
    if (step != SqliteRows::Step::row) return step == SqliteRows::Step::end;
    if (rows.whole(0) <= last) return false;  // a tree that leads back into itself
    last = rows.whole(0);
    take(rows);
  }
}

bool BagReader::read_messages() {
  std::string ids;
  for (const auto& [id, number] : numbers_) ids += (ids.empty() ? "" : ",") + std::to_string(id);
  // Of other topics not a byte is read; nor of what is too long to be a message.
  SqliteRows rows = database_.prepare("SELECT rowid, topic_id, timestamp, length(data), CASE WHEN topic_id IN (" + ids +
                                      ") AND length(data) <= " + std::to_string(kLongestMessage) +
                                      " THEN data END FROM messages WHERE rowid > ? ORDER BY rowid");
  if (!rows) return false;
  std::int64_t last = -1;  // they count from 1
  std::int64_t step = 1;
  for (int entries = 0; entries < kMostEntries; ++entries) {
    const std::int64_t before = last;
    if (read_rows(rows, last)) return true;
    const std::uint64_t place = std::min(database_.last_read(), size_);
    step = last > before ? 1 : 2 * step;
    if ((last > before || entries == 0) && notes_.wanted(RosTrouble::record, place))
      notes_.say(place, "the table of messages is damaged behind message " +
                            std::to_string(std::max(last, std::int64_t{0})) + " (" + database_.what() +
                            "), what is behind the damage is looked for");
    if (last > std::numeric_limits<std::int64_t>::max() - step || step > (std::int64_t{1} << 40)) break;
    last += step;
  }
  return false;
}

io::FileExpected<LogExtent> BagReader::read() {
  if (const auto opened = open(); !opened) return tl::make_unexpected(opened.error());
  LogExtent out;
  out.bytes = size_;
  if (!read_topics())
    return error("is no bag of ROS 2: " + database_.what(), "give a bag whose tables have the columns of rosbag2");
  say_journal();
  const bool is_whole = numbers_.empty() || read_messages();
  out.read_bytes = is_whole ? size_ : std::min(database_.last_read(), size_);
  if (!is_whole) notes_.say(out.read_bytes, "the messages could not be read to their end: " + database_.what());
  topics_.finish();
  notes_.sum_up();
  out.records = topics_.records();
  return out;
}

}  // namespace

io::FileExpected<LogExtent> read_rosbag2(const std::string& path, LogSink& sink) {
  return BagReader(path, sink).read();
}

}  // namespace logs
}  // namespace PLUMB_ABI
}  // namespace plumb
