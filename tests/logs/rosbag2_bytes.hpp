/// Bags of ROS 2 in SQLite, for tests: the bytes of a database that is made in memory.
#pragma once

#include <gtest/gtest.h>
#include <sqlite3.h>

#include <cstdint>
#include <memory>
#include <string>

#include "ros_bytes.hpp"

namespace rosbag2_bytes {

inline const std::string kTables =
    "CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT NOT NULL, type TEXT NOT NULL, "
    "serialization_format TEXT NOT NULL, offered_qos_profiles TEXT NOT NULL);"
    "CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER NOT NULL, timestamp INTEGER NOT NULL, "
    "data BLOB NOT NULL);"
    "CREATE INDEX timestamp_idx ON messages (timestamp ASC);";
inline std::string topic(int id, const std::string& name, const std::string& type = "sensor_msgs/msg/Imu",
                         const std::string& format = "cdr") {
  return "INSERT INTO topics VALUES(" + std::to_string(id) + ",'" + name + "','" + type + "','" + format + "','');";
}
inline std::string hex(const std::string& bytes) {
  constexpr const char* kDigits = "0123456789abcdef";
  std::string out;
  for (const char c : bytes) {
    out += kDigits[static_cast<unsigned char>(c) >> 4U];
    out += kDigits[static_cast<unsigned char>(c) & 0xFU];
  }
  return out;
}
constexpr std::int64_t kBagTime_ns = 1700000000500000000;
inline std::string row(int topic_id, const std::string& data, std::int64_t time_ns = kBagTime_ns) {
  return "INSERT INTO messages(topic_id, timestamp, data) VALUES(" + std::to_string(topic_id) + "," +
         std::to_string(time_ns) + ",x'" + hex(data) + "');";
}

/// The file that these statements make.
inline std::string database(const std::string& sql, int page_size = 512) {
  sqlite3* made = nullptr;
  EXPECT_EQ(sqlite3_open(":memory:", &made), SQLITE_OK);
  const std::unique_ptr<sqlite3, int (*)(sqlite3*)> open(made, &sqlite3_close);
  const std::string all = "PRAGMA page_size=" + std::to_string(page_size) + ";BEGIN;" + sql + "COMMIT;";
  char* message = nullptr;
  EXPECT_EQ(sqlite3_exec(made, all.c_str(), nullptr, nullptr, &message), SQLITE_OK) << message;
  sqlite3_int64 size = 0;
  unsigned char* bytes = sqlite3_serialize(made, "main", &size, 0);
  std::string out(reinterpret_cast<const char*>(bytes), static_cast<std::size_t>(size));
  sqlite3_free(bytes);
  return out;
}

/// Two IMUs and a camera.
inline std::string small_bag(int count = 8) {
  std::string sql =
      kTables + topic(1, "/imu/data") + topic(2, "/camera", "sensor_msgs/msg/Image") + topic(7, "/imu/spare");
  for (int k = 0; k < count; ++k) {
    sql += row(1, ros_bytes::imu(ros_bytes::imu_at(k))) + row(2, std::string(600, 'i')) +
           row(7, ros_bytes::imu(ros_bytes::imu_at(k, 9.5)));
  }
  return database(sql);
}

}  // namespace rosbag2_bytes
