#include "Bag.h"

#include <lz4frame.h>
#include <sqlite3.h>
#include <zlib.h>
#include <zstd.h>

#include <algorithm>
#include <fstream>
#include <map>
#include <memory>
#include <optional>
#include <stdexcept>
#include <vector>

#include "ByteReader.h"

namespace bags {

namespace fs = std::filesystem;

namespace {

/** Bytes of a chunk, or a message, that is larger are refused. */
constexpr std::uint64_t kMostChunkBytes = std::uint64_t{1} << 30;

bool isBag(const fs::path& file) {
  return file.extension() == ".mcap" || file.extension() == ".db3";
}

/** name_2 before name_10. */
bool comesFirst(const fs::path& a, const fs::path& b) {
  const std::string x = a.string(), y = b.string();
  return x.size() != y.size() ? x.size() < y.size() : x < y;
}

/** The bag itself, or the files of a folder. */
std::vector<fs::path> filesOfBag(const fs::path& bag) {
  if (!fs::exists(bag)) throw std::runtime_error(bag.string() + ": there is no such bag");
  if (!fs::is_directory(bag)) {
    if (isBag(bag)) return {bag};
    throw std::runtime_error(bag.string() +
                             ": expected a bag of ROS 2, .mcap or .db3 (of .zst files: "
                             "unzstd first)");
  }
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(bag))
    if (isBag(entry.path())) files.push_back(entry.path());
  if (files.empty())
    throw std::runtime_error(bag.string() + ": no .mcap or .db3 file is in this folder");
  std::sort(files.begin(), files.end(), comesFirst);
  return files;
}

/** A recorder that was killed leaves what came last beside the database. */
std::uint64_t bytesOf(const fs::path& database) {
  std::error_code none;
  const std::uint64_t beside = fs::file_size(database.string() + "-wal", none);
  return fs::file_size(database) + (none ? 0 : beside);
}

/** A database that is only read, and whose bytes are not trusted. */
class Database {
 public:
  explicit Database(const fs::path& file) {
    sqlite3* opened = nullptr;
    const int result = sqlite3_open_v2(file.c_str(), &opened, SQLITE_OPEN_READONLY, nullptr);
    m_database.reset(opened);
    check(result);
    sqlite3_limit(opened, SQLITE_LIMIT_LENGTH, static_cast<int>(kMostChunkBytes - 1));
    sqlite3_db_config(opened, SQLITE_DBCONFIG_DEFENSIVE, 1, nullptr);
    sqlite3_db_config(opened, SQLITE_DBCONFIG_TRUSTED_SCHEMA, 0, nullptr);
    sqlite3_db_config(opened, SQLITE_DBCONFIG_ENABLE_VIEW, 0, nullptr);  // which may have no end
    sqlite3_exec(opened, "PRAGMA cell_size_check = ON", nullptr, nullptr, nullptr);
    constexpr int kSteps = 10'000, kStepsOfByte = 10;  // a row takes some 20, and as many bytes
    m_left = 1 + static_cast<std::int64_t>(bytesOf(file)) * kStepsOfByte / kSteps;
    sqlite3_progress_handler(
        opened, kSteps, [](void* left) -> int { return --*static_cast<std::int64_t*>(left) < 0; },
        &m_left);
  }
  void check(int result) const {
    if (result != SQLITE_OK && result != SQLITE_ROW && result != SQLITE_DONE)
      throw std::runtime_error(std::string("is no bag that can be read: ") +
                               (result == SQLITE_INTERRUPT ? "its pages lead to no end"
                                                           : sqlite3_errmsg(m_database.get())));
  }
  sqlite3* get() const { return m_database.get(); }

 private:
  std::int64_t m_left = 0;  ///< 10,000 steps each; pages that hold each other lead to no end
  std::unique_ptr<sqlite3, int (*)(sqlite3*)> m_database{nullptr, &sqlite3_close};
};

class Query {
 public:
  Query(const Database& database, const char* text) : m_database(database) {
    sqlite3_stmt* made = nullptr;
    database.check(sqlite3_prepare_v2(database.get(), text, -1, &made, nullptr));
    m_statement.reset(made);
  }
  bool next() {
    const int result = sqlite3_step(m_statement.get());
    m_database.check(result);
    return result == SQLITE_ROW;
  }
  /** Its one row for another number, if there is one. */
  bool nextFor(std::int64_t number) {
    sqlite3_reset(m_statement.get());
    sqlite3_bind_int64(m_statement.get(), 1, number);
    return next();
  }
  std::int64_t number(int column) { return sqlite3_column_int64(m_statement.get(), column); }
  /** Until the next row. */
  std::string_view bytes(int column) {
    const auto* data = static_cast<const char*>(sqlite3_column_blob(m_statement.get(), column));
    const int size = sqlite3_column_bytes(m_statement.get(), column);
    return data ? std::string_view(data, static_cast<std::size_t>(size)) : std::string_view();
  }

 private:
  const Database& m_database;
  std::unique_ptr<sqlite3_stmt, int (*)(sqlite3_stmt*)> m_statement{nullptr, &sqlite3_finalize};
};

void readSqlite(const fs::path& file, const WantsTopic& wants, const TakeMessage& take) {
  const Database database(file);
  for (const char* columns : {"pragma_table_xinfo('topics')", "pragma_table_xinfo('messages')"})
    if (Query(database, (std::string("SELECT 1 FROM ") + columns + " WHERE hidden").c_str()).next())
      throw std::runtime_error("is no bag that can be read: its tables compute columns");
  std::map<std::int64_t, BagTopic> wanted;
  Query topics(database, "SELECT id, name, type, serialization_format FROM topics");
  while (topics.next()) {
    const BagTopic topic{std::string(topics.bytes(1)), std::string(topics.bytes(2))};
    if (topics.bytes(3) == "cdr" && wants(topic)) wanted[topics.number(0)] = topic;
  }
  if (wanted.empty()) return;
  Query order(database, "SELECT rowid, topic_id FROM messages ORDER BY timestamp");
  Query messages(database, "SELECT data FROM messages WHERE rowid = ?");
  std::uint64_t left = bytesOf(file);
  while (order.next()) {
    const auto topic = wanted.find(order.number(1));
    if (topic == wanted.end() || !messages.nextFor(order.number(0))) continue;
    const std::string_view message = messages.bytes(0);
    if (message.size() > left) throw std::runtime_error("has more messages than bytes");
    left -= message.size();
    if (!take(topic->second, message)) return;
  }
}

[[noreturn]] void failAs(std::string_view compression, const char* what) {
  throw std::runtime_error("a chunk compressed by " + std::string(compression) +
                           " is damaged: " + what);
}

struct Zstd {
  static constexpr std::string_view kName = "zstd";
  std::unique_ptr<ZSTD_DStream, std::size_t (*)(ZSTD_DStream*)> stream{ZSTD_createDStream(),
                                                                       &ZSTD_freeDStream};
  void step(std::string_view& in, char* out, std::size_t& space) const {
    ZSTD_inBuffer input{in.data(), in.size(), 0};
    ZSTD_outBuffer output{out, space, 0};
    const std::size_t result = ZSTD_decompressStream(stream.get(), &output, &input);
    if (ZSTD_isError(result)) failAs(kName, ZSTD_getErrorName(result));
    in.remove_prefix(input.pos);
    space = output.pos;
  }
};

struct Lz4 {
  static constexpr std::string_view kName = "lz4";
  LZ4F_dctx* context = nullptr;

  Lz4() {
    if (LZ4F_isError(LZ4F_createDecompressionContext(&context, LZ4F_VERSION)))
      throw std::bad_alloc();
  }
  ~Lz4() { LZ4F_freeDecompressionContext(context); }
  Lz4(const Lz4&) = delete;
  Lz4& operator=(const Lz4&) = delete;
  void step(std::string_view& in, char* out, std::size_t& space) const {
    std::size_t taken = in.size();
    const std::size_t result = LZ4F_decompress(context, out, &space, in.data(), &taken, nullptr);
    if (LZ4F_isError(result)) failAs(kName, LZ4F_getErrorName(result));
    in.remove_prefix(taken);
  }
};

template <class Method>
std::string decompressed(std::string_view in, std::uint64_t size) {
  constexpr std::size_t kStep = 1 << 20;
  const Method method;
  std::string out;
  while (true) {
    const std::size_t begin = out.size(), left = in.size();
    std::size_t space = std::min<std::uint64_t>(kStep, size - begin + 1);  // one more is an error
    out.resize(begin + space);
    method.step(in, out.data() + begin, space);
    out.resize(begin + space);
    if (out.size() > size) failAs(Method::kName, "it is larger than announced");
    if (space == 0 && (in.empty() || in.size() == left)) break;
  }
  if (out.size() != size || !in.empty()) failAs(Method::kName, "it is not of the announced size");
  return out;
}

/** What was compressed; memory grows with what comes out, not with what is announced.
 * \param compression "" (it was not), "zstd" or "lz4" \param size as announced
 * \throw std::runtime_error it is another compression, damaged, or of another size. */
std::string uncompressed(std::string_view bytes, std::string_view compression, std::uint64_t size) {
  if (size > kMostChunkBytes)
    throw std::runtime_error("a chunk of " + std::to_string(size) + " bytes, expected at most " +
                             std::to_string(kMostChunkBytes));
  if (compression == Zstd::kName) return decompressed<Zstd>(bytes, size);
  if (compression == Lz4::kName) return decompressed<Lz4>(bytes, size);
  if (!compression.empty())
    throw std::runtime_error("a chunk is compressed by '" + std::string(compression) +
                             "', expected zstd or lz4");
  if (bytes.size() != size) throw std::runtime_error("a chunk is not of the announced size");
  return std::string(bytes);
}

constexpr std::string_view kMagic("\x89MCAP0\r\n", 8);

enum Opcode : std::uint8_t {
  kFooter = 0x02,
  kSchema = 0x03,
  kChannel = 0x04,
  kMessage = 0x05,
  kChunk = 0x06,
  kDataEnd = 0x0f
};

/** The records of a file from its begin to the end of its data. What stands behind, the summary, is
 * not looked at. */
class McapReader {
 public:
  McapReader(const fs::path& file, const WantsTopic& wants, const TakeMessage& take)
      : m_in(file, std::ios::binary), m_wants(wants), m_take(take) {
    if (!m_in) throw std::runtime_error("cannot be read");
    m_left = fs::file_size(file);
  }

  void read() {
    if (next(kMagic.size()) != kMagic) throw std::runtime_error("is no MCAP file");
    while (m_goesOn) {
      const std::string head = next(9);
      ByteReader reader(head);
      const auto opcode = reader.number<std::uint8_t>();
      const auto size = reader.number<std::uint64_t>();
      if (opcode == kDataEnd || opcode == kFooter) return;
      if (isOfUse(opcode))
        add(opcode, next(size), true);
      else
        skip(size);
    }
  }

 private:
  static bool isOfUse(std::uint8_t opcode) { return opcode >= kSchema && opcode <= kChunk; }

  std::string next(std::uint64_t size) {
    check(size);
    if (size > kMostChunkBytes)
      throw std::runtime_error("a record of " + std::to_string(size) + " bytes, expected at most " +
                               std::to_string(kMostChunkBytes));
    std::string bytes(static_cast<std::size_t>(size), '\0');
    m_in.read(bytes.data(), static_cast<std::streamsize>(size));
    if (!m_in) throw std::runtime_error("cannot be read");
    return bytes;
  }
  void skip(std::uint64_t size) {
    check(size);
    m_in.seekg(static_cast<std::streamoff>(size), std::ios::cur);
  }
  void check(std::uint64_t size) {
    if (size > m_left)
      throw std::runtime_error("is cut off: " + std::to_string(size) + " bytes expected, " +
                               std::to_string(m_left) + " are left");
    m_left -= size;
  }

  void add(std::uint8_t opcode, std::string_view content, bool mayBeChunk) {
    ByteReader reader(content);
    if (opcode == kSchema)
      addSchema(reader);
    else if (opcode == kChannel)
      addChannel(reader);
    else if (opcode == kMessage)
      addMessage(reader);
    else if (opcode == kChunk && mayBeChunk)
      addChunk(reader);
  }
  void addSchema(ByteReader& reader) {
    const auto id = reader.number<std::uint16_t>();
    m_schemas[id] = std::string(reader.text());
  }
  void addChannel(ByteReader& reader) {
    const auto id = reader.number<std::uint16_t>(), schema = reader.number<std::uint16_t>();
    BagTopic topic;
    topic.name = std::string(reader.text());
    const std::string_view encoding = reader.text();
    const auto type = m_schemas.find(schema);
    if (type != m_schemas.end()) topic.type = type->second;
    const bool isKnown = m_channels.count(id) > 0;
    if (isKnown) return;
    const bool isWanted = encoding == "cdr" && m_wants(topic);
    m_channels[id] = isWanted ? std::optional<BagTopic>(topic) : std::nullopt;
  }
  void addMessage(ByteReader& reader) {
    const auto channel = m_channels.find(reader.number<std::uint16_t>());
    if (channel == m_channels.end()) throw std::runtime_error("a message has no channel");
    constexpr std::uint64_t kRest = 4 + 8 + 8;  // its number and two times
    reader.bytes(kRest);
    if (channel->second && m_goesOn)
      m_goesOn = m_take(*channel->second, reader.bytes(reader.left()));
  }
  void addChunk(ByteReader& reader) {
    reader.bytes(16);  // two times
    const auto size = reader.number<std::uint64_t>();
    const auto checksum = reader.number<std::uint32_t>();
    const std::string_view compression = reader.text();
    const std::string records =
        uncompressed(reader.bytes(reader.number<std::uint64_t>()), compression, size);
    if (checksum != 0 &&
        checksum != crc32_z(0, reinterpret_cast<const Bytef*>(records.data()), records.size()))
      throw std::runtime_error("a chunk is damaged: its checksum is another");
    ByteReader inside(records);
    while (!inside.atEnd() && m_goesOn) {
      const auto opcode = inside.number<std::uint8_t>();
      add(opcode, inside.bytes(inside.number<std::uint64_t>()), false);
    }
  }

  std::ifstream m_in;
  std::uint64_t m_left = 0;
  const WantsTopic& m_wants;
  const TakeMessage& m_take;
  bool m_goesOn = true;
  std::map<std::uint16_t, std::string> m_schemas;
  std::map<std::uint16_t, std::optional<BagTopic>> m_channels;  ///< none: not wanted
};

void readMcap(const fs::path& file, const WantsTopic& wants, const TakeMessage& take) {
  McapReader(file, wants, take).read();
}

}  // namespace

void readBag(const fs::path& bag, const WantsTopic& wants, const TakeMessage& take) {
  bool goesOn = true;
  for (const fs::path& file : filesOfBag(bag)) try {
      if (!goesOn) return;
      if (fs::exists(file) && !fs::is_regular_file(file))
        throw std::runtime_error("it is no file, but a device or a pipe");
      const auto takeOne = [&](const BagTopic& topic, std::string_view message) {
        return goesOn = take(topic, message);
      };
      (file.extension() == ".mcap" ? readMcap : readSqlite)(file, wants, takeOne);
    } catch (const std::runtime_error& e) {
      throw std::runtime_error(file.string() + ": " + e.what());
    }
}

}  // namespace bags
