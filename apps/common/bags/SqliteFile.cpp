#include <sqlite3.h>

#include <map>
#include <memory>
#include <stdexcept>

#include "Bag.h"
#include "ChunkBytes.h"

namespace bags {
namespace {

/** A database that is only read, and whose bytes are not trusted. */
class Database {
 public:
  explicit Database(const std::filesystem::path& file) {
    sqlite3* opened = nullptr;
    const int result = sqlite3_open_v2(file.c_str(), &opened, SQLITE_OPEN_READONLY, nullptr);
    m_database.reset(opened);
    check(result);
    sqlite3_limit(opened, SQLITE_LIMIT_LENGTH, static_cast<int>(kMostChunkBytes - 1));
    sqlite3_db_config(opened, SQLITE_DBCONFIG_DEFENSIVE, 1, nullptr);
    sqlite3_db_config(opened, SQLITE_DBCONFIG_TRUSTED_SCHEMA, 0, nullptr);
    sqlite3_exec(opened, "PRAGMA cell_size_check = ON", nullptr, nullptr, nullptr);
  }
  void check(int result) const {
    if (result != SQLITE_OK && result != SQLITE_ROW && result != SQLITE_DONE)
      throw std::runtime_error(std::string("is no bag that can be read: ") +
                               sqlite3_errmsg(m_database.get()));
  }
  sqlite3* get() const { return m_database.get(); }

 private:
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

}  // namespace

void readSqliteBag(const std::filesystem::path& file, const WantsTopic& wants,
                   const TakeMessage& take) {
  const Database database(file);
  std::map<std::int64_t, BagTopic> wanted;
  Query topics(database, "SELECT id, name, type, serialization_format FROM topics");
  while (topics.next()) {
    const BagTopic topic{std::string(topics.bytes(1)), std::string(topics.bytes(2))};
    if (topics.bytes(3) == "cdr" && wants(topic)) wanted[topics.number(0)] = topic;
  }
  if (wanted.empty()) return;
  Query messages(database, "SELECT topic_id, data FROM messages ORDER BY timestamp");
  while (messages.next()) {
    const auto topic = wanted.find(messages.number(0));
    if (topic != wanted.end() && !take(topic->second, messages.bytes(1))) return;
  }
}

}  // namespace bags
