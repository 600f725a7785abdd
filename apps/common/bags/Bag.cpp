#include "Bag.h"

#include <sqlite3.h>

#include <algorithm>
#include <map>
#include <memory>
#include <stdexcept>

namespace bags {

namespace fs = std::filesystem;

namespace {

bool isBag(const fs::path& file) {
  return file.extension() == ".mcap" || file.extension() == ".db3";
}

/** name_2 before name_10. */
bool comesFirst(const fs::path& a, const fs::path& b) {
  const std::string x = a.string(), y = b.string();
  return x.size() != y.size() ? x.size() < y.size() : x < y;
}

}  // namespace

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

void readBag(const fs::path& bag, const WantsTopic& wants, const TakeMessage& take) {
  bool goesOn = true;
  for (const fs::path& file : filesOfBag(bag)) try {
      if (!goesOn) return;
      const auto takeOne = [&](const BagTopic& topic, std::string_view message) {
        return goesOn = take(topic, message);
      };
      (file.extension() == ".mcap" ? readMcap : readSqliteBag)(file, wants, takeOne);
    } catch (const std::runtime_error& e) {
      throw std::runtime_error(file.string() + ": " + e.what());
    }
}

std::set<BagTopic> topicsOfBag(const fs::path& bag) {
  std::set<BagTopic> topics;
  const auto note = [&topics](const BagTopic& topic) {
    topics.insert(topic);
    return false;
  };
  readBag(bag, note, [](const BagTopic&, std::string_view) { return true; });
  return topics;
}

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
