#pragma once
#include <semantic_octree/MapFollower.h>
#include <semantic_octree/SemanticOcTreeNode.h>
#include <semantic_octree/store/TileCodes.h>

#include <algorithm>
#include <cstdint>
#include <deque>
#include <memory>
#include <vector>

namespace semantic_octree {

/** What changed (a map's: the cubes, each a tile of 8 x 8 x 8 voxels or larger, packed), oldest
 * first and numbered, for readers that each have a place of their own. What all of them have read
 * is dropped. When the log is long, its older half is dropped. A reader that has not read it is
 * lost, and has to look at everything. */
class ChangeLog {
  using Number = std::uint64_t;

 public:
  using Entry = std::uint64_t;
  static constexpr std::size_t kMost = std::size_t(1) << 20;

  /** Where a reader is. */
  class Place {
   public:
    /** Lost at first. */
    explicit Place(std::shared_ptr<ChangeLog> log) : m_log(std::move(log)) {
      m_log->m_places.push_back(this);
    }
    ~Place() {
      auto& places = m_log->m_places;
      places.erase(std::find(places.begin(), places.end(), this));
      m_log->dropRead();
    }
    Place(const Place&) = delete;
    Place& operator=(const Place&) = delete;

    bool isIn(const ChangeLog& log) const { return m_log.get() == &log; }
    bool isLost() const { return m_next == kLost; }
    /** What was pushed since, unless it is lost. */
    auto begin() const {
      return m_log->m_entries.begin() + static_cast<std::ptrdiff_t>(m_next - m_log->m_first);
    }
    auto end() const { return m_log->m_entries.end(); }
    void moveToEnd() {
      m_next = m_log->end();
      m_log->dropRead();
    }

   private:
    friend class ChangeLog;
    std::shared_ptr<ChangeLog> m_log;
    Number m_next = kLost;
  };

  explicit ChangeLog(std::size_t most = kMost) : m_most(most) {}
  /** Whether anybody is there who would read what is pushed. */
  bool isRead() const {
    return std::any_of(m_places.begin(), m_places.end(),
                       [](const Place* p) { return !p->isLost(); });
  }
  void push(Entry entry) {
    if (m_entries.size() >= m_most) {
      dropBefore(end() - m_most / 2);
      dropRead();
    }
    m_entries.push_back(entry);
  }
  std::size_t size() const { return m_entries.size(); }

 private:
  static constexpr Number kLost = 0;

  Number end() const { return m_first + m_entries.size(); }
  void dropBefore(Number first) {
    for (Place* const place : m_places)
      if (place->m_next < first) place->m_next = kLost;
    m_entries.erase(m_entries.begin(),
                    m_entries.begin() + static_cast<std::ptrdiff_t>(first - m_first));
    m_first = first;
  }
  void dropRead() {
    Number first = end();
    for (const Place* const place : m_places)
      if (!place->isLost()) first = std::min(first, place->m_next);
    dropBefore(first);
  }

  std::size_t m_most;
  Number m_first = 1;
  std::deque<Entry> m_entries;
  std::vector<Place*> m_places;
};

/** The log of who made it, as long as somebody reads it. */
template <typename Log>
std::shared_ptr<Log> readLog(std::weak_ptr<Log>& kept) {
  std::shared_ptr<Log> log = kept.lock();
  if (!log) kept = log = std::make_shared<Log>();
  return log;
}

/** The reader's place, lost if it was in another log. */
inline ChangeLog::Place& placeIn(std::unique_ptr<ChangeLog::Place>& place,
                                 const std::shared_ptr<ChangeLog>& log) {
  if (!place || !place->isIn(*log)) place = std::make_unique<ChangeLog::Place>(log);
  return *place;
}

}  // namespace semantic_octree
