#pragma once
#include <lz4frame.h>
#include <sqlite3.h>
#include <zlib.h>
#include <zstd.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

/** \file Bags of ROS 2, as its own recorder writes them. */

/** A message in CDR. */
class Cdr {
 public:
  explicit Cdr(bool bigEndian = false)
      : bytes(bigEndian ? std::string(4, '\0') : std::string("\0\1\0\0", 4)), m_swaps(bigEndian) {}

  template <class T>
  Cdr& number(T value) {
    while ((bytes.size() - 4) % sizeof(T) != 0) bytes += '\0';
    std::string raw(reinterpret_cast<const char*>(&value), sizeof(T));
    if (m_swaps) std::reverse(raw.begin(), raw.end());
    bytes += raw;
    return *this;
  }
  Cdr& text(const std::string& t) {
    number(std::uint32_t(t.size() + 1));
    bytes += t + '\0';
    return *this;
  }
  Cdr& header(double seconds, const std::string& frame) {
    number(std::int32_t(seconds)).number(std::uint32_t((seconds - std::int32_t(seconds)) * 1e9));
    return text(frame);
  }
  Cdr& pose(const Eigen::Isometry3d& T) {
    const Eigen::Quaterniond q(T.linear());
    for (const double v : {T.translation().x(), T.translation().y(), T.translation().z(), q.x(),
                           q.y(), q.z(), q.w()})
      number(v);
    return *this;
  }

  std::string bytes;

 private:
  bool m_swaps;
};

struct BagMessage {
  std::string topic, type;
  double seconds;
  std::string bytes;
};

/** Points with a label, or another field, of 16 bits each; the first field stands behind two bytes
 * of something else. */
inline BagMessage cloudMessage(const std::string& topic, double seconds, const std::string& frame,
                               const std::vector<Eigen::Vector4f>& points, bool bigEndian = false,
                               const char* fourth = "label") {
  Cdr cdr(bigEndian);
  cdr.header(seconds, frame).number(std::uint32_t(1)).number(std::uint32_t(points.size()));
  cdr.number(std::uint32_t(4));
  const char* names[] = {"x", "y", "z", fourth};
  for (int i = 0; i < 4; ++i)
    cdr.text(names[i])
        .number(std::uint32_t(2 + 4 * i))
        .number(std::uint8_t(i < 3 ? 7 : 4))
        .number(std::uint32_t(1));
  constexpr std::uint32_t kStep = 16;
  cdr.number(std::uint8_t(0)).number(kStep).number(std::uint32_t(kStep * points.size()));
  std::string data;
  for (const Eigen::Vector4f& p : points) {
    const auto label = static_cast<std::uint16_t>(p.w());
    data += std::string(2, 'x') + std::string(reinterpret_cast<const char*>(p.data()), 12) +
            std::string(reinterpret_cast<const char*>(&label), 2);
  }
  cdr.number(std::uint32_t(data.size()));
  cdr.bytes += data + '\1';
  return {topic, "sensor_msgs/msg/PointCloud2", seconds, cdr.bytes};
}

/** Pixels row by row, with two bytes of something else behind each row. */
template <class Pixel>
BagMessage imageMessage(const std::string& topic, double seconds, const std::string& frame,
                        const std::string& encoding, std::uint32_t width,
                        const std::vector<Pixel>& pixels) {
  const auto height = static_cast<std::uint32_t>(pixels.size()) / width;
  const auto row = static_cast<std::uint32_t>(width * sizeof(Pixel));
  Cdr cdr;
  cdr.header(seconds, frame).number(height).number(width).text(encoding);
  cdr.number(std::uint8_t(0)).number(row + 2).number((row + 2) * height);
  for (std::uint32_t y = 0; y < height; ++y)
    cdr.bytes += std::string(reinterpret_cast<const char*>(&pixels[y * width]), row) + "xx";
  return {topic, "sensor_msgs/msg/Image", seconds, cdr.bytes};
}

/** Without distortion, looking through the middle of the image. */
inline BagMessage cameraMessage(const std::string& topic, double seconds, std::uint32_t width,
                                std::uint32_t height, double focalLength) {
  Cdr cdr;
  cdr.header(seconds, "").number(height).number(width).text("plumb_bob").number(std::uint32_t(0));
  for (const double k :
       {focalLength, 0., (width - 1) / 2., 0., focalLength, (height - 1) / 2., 0., 0., 1.})
    cdr.number(k);
  for (int i = 0; i < 9 + 12; ++i) cdr.number(0.0);
  for (int i = 0; i < 2 + 4; ++i) cdr.number(std::uint32_t(0));
  cdr.number(std::uint8_t(0));
  return {topic, "sensor_msgs/msg/CameraInfo", seconds, cdr.bytes};
}

/** Ranges from 0.1 to 20 m count. */
inline BagMessage laserMessage(const std::string& topic, double seconds, const std::string& frame,
                               float first, float step, const std::vector<float>& ranges,
                               float timeStep = 0) {
  Cdr cdr;
  cdr.header(seconds, frame);
  for (const float value : {first, 0.f, step, timeStep, 0.f, 0.1f, 20.f}) cdr.number(value);
  cdr.number(std::uint32_t(ranges.size()));
  for (const float range : ranges) cdr.number(range);
  cdr.number(std::uint32_t(0));
  return {topic, "sensor_msgs/msg/LaserScan", seconds, cdr.bytes};
}

inline BagMessage transformMessage(const std::string& topic, double seconds,
                                   const std::string& parent, const std::string& child,
                                   const Eigen::Isometry3d& T) {
  Cdr cdr;
  cdr.number(std::uint32_t(1)).header(seconds, parent).text(child).pose(T);
  return {topic, "tf2_msgs/msg/TFMessage", seconds, cdr.bytes};
}

inline BagMessage odometryMessage(double seconds, const Eigen::Isometry3d& T) {
  Cdr cdr;
  cdr.header(seconds, "odom").text("base_link").pose(T);
  for (int i = 0; i < 36 + 6 + 36; ++i) cdr.number(0.0);
  return {"/odom", "nav_msgs/msg/Odometry", seconds, cdr.bytes};
}

template <class T>
std::string raw(T value) {
  return {reinterpret_cast<const char*>(&value), sizeof(T)};
}
inline std::string withLength(const std::string& t) { return raw(std::uint32_t(t.size())) + t; }
inline std::string record(std::uint8_t opcode, const std::string& content) {
  return raw(opcode) + raw(std::uint64_t(content.size())) + content;
}

inline std::string compressedBy(const std::string& method, const std::string& bytes) {
  if (method.empty()) return bytes;
  const bool isZstd = method == "zstd";
  std::string out(
      isZstd ? ZSTD_compressBound(bytes.size()) : LZ4F_compressFrameBound(bytes.size(), nullptr),
      '\0');
  out.resize(isZstd
                 ? ZSTD_compress(out.data(), out.size(), bytes.data(), bytes.size(), 3)
                 : LZ4F_compressFrame(out.data(), out.size(), bytes.data(), bytes.size(), nullptr));
  return out;
}

/** \param chunks "none": messages without, "", "zstd", "lz4" \return bytes of an MCAP file, whose
 * summary tells nothing but lies */
inline std::string mcapOf(const std::vector<BagMessage>& messages, const std::string& chunks) {
  std::string file("\x89MCAP0\r\n", 8), records;
  const std::string magic = file;
  file += record(1, withLength("ros2") + withLength("test"));
  std::vector<std::string> topics;
  for (const BagMessage& m : messages) {
    auto topic = std::find(topics.begin(), topics.end(), m.topic);
    const auto id = static_cast<std::uint16_t>(topic - topics.begin() + 1);
    if (topic == topics.end()) {
      topics.push_back(m.topic);
      records +=
          record(3, raw(id) + withLength(m.type) + withLength("ros2msg") + withLength("# text"));
      records += record(
          4, raw(id) + raw(id) + withLength(m.topic) + withLength("cdr") + raw(std::uint32_t(0)));
    }
    const auto time = static_cast<std::uint64_t>(m.seconds * 1e9);
    records += record(5, raw(id) + raw(std::uint32_t(0)) + raw(time) + raw(time) + m.bytes);
  }
  if (chunks == "none") {
    file += records;
  } else {
    const auto crc = static_cast<std::uint32_t>(crc32(
        0, reinterpret_cast<const Bytef*>(records.data()), static_cast<uInt>(records.size())));
    const std::string packed = compressedBy(chunks, records);
    file += record(6, raw(std::uint64_t(0)) + raw(std::uint64_t(0)) +
                          raw(std::uint64_t(records.size())) + raw(crc) + withLength(chunks) +
                          raw(std::uint64_t(packed.size())) + packed);
    file += record(7, std::string(10, '\0'));  // an index of messages
  }
  file += record(15, raw(std::uint32_t(0)));
  file += record(4, "lies") + record(2, std::string(20, '\7')) + magic;
  return file;
}

inline void writeSqliteBag(const std::filesystem::path& file,
                           const std::vector<BagMessage>& messages) {
  sqlite3* db = nullptr;
  sqlite3_open(file.c_str(), &db);
  sqlite3_exec(db,
               "CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT, type TEXT, "
               "serialization_format TEXT, "
               "offered_qos_profiles TEXT);"
               "CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER, timestamp INTEGER, "
               "data BLOB);",
               nullptr, nullptr, nullptr);
  std::vector<std::string> topics;
  for (const BagMessage& m : messages) {
    auto topic = std::find(topics.begin(), topics.end(), m.topic);
    const std::string id = std::to_string(topic - topics.begin() + 1);
    if (topic == topics.end()) {
      topics.push_back(m.topic);
      sqlite3_exec(
          db,
          ("INSERT INTO topics VALUES(" + id + ",'" + m.topic + "','" + m.type + "','cdr','')")
              .c_str(),
          nullptr, nullptr, nullptr);
    }
    sqlite3_stmt* insert = nullptr;
    sqlite3_prepare_v2(
        db, ("INSERT INTO messages(topic_id, timestamp, data) VALUES(" + id + ",?,?)").c_str(), -1,
        &insert, nullptr);
    sqlite3_bind_int64(insert, 1, static_cast<std::int64_t>(m.seconds * 1e9));
    sqlite3_bind_blob(insert, 2, m.bytes.data(), static_cast<int>(m.bytes.size()),
                      SQLITE_TRANSIENT);
    sqlite3_step(insert);
    sqlite3_finalize(insert);
  }
  sqlite3_close(db);
}
