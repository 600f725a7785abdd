#pragma once
#include <semantic_octree/SemanticOcTree.h>
#include <semantic_octree/store/NodeEditor.h>

namespace semantic_octree {

class Scan;

/** What the libraries of the map may do with it beside what everybody may: the one friend of
 * SemanticOcTree. */
class MapAccess {
 public:
  /** \throw std::logic_error the map is broken. */
  static NodeStore& store(const SemanticOcTree& map) { return map.store(); }
  /** Other nodes; null: the map is broken. */
  static void setStore(SemanticOcTree& map, std::unique_ptr<NodeStore> store) {
    map.m_store = std::move(store);
    tellAll(map);
  }
  static const ClassFilter& filter(const SemanticOcTree& map) { return map.m_filter; }

  /** What observations make of voxels; null: the class filter. Copies of the map, and maps that are
   * like it, have it, too; files do not: whoever goes on with one sets it anew.
   * \throw std::logic_error the map is not empty. */
  static void setRule(SemanticOcTree& map, std::shared_ptr<const FusionRule> rule);

  /** Null: nobody keeps anything of inner nodes. */
  static NodeObserver* observer(const SemanticOcTree& map) { return map.m_observer.get(); }
  /** Has it compute all that it keeps. Of a map in tiles they are read, one by one: if that fails,
   * the map has none. */
  static void setObserver(SemanticOcTree& map, std::unique_ptr<NodeObserver> observer);
  /** Recomputes for nodes that came into the map, of which some are away. */
  static void recomputeTileByTile(SemanticOcTree& map);

  /** For readers, who may outlive the map. */
  static std::weak_ptr<SemanticOcTree*> self(SemanticOcTree& map);
  static std::shared_ptr<ChangeLog> tileLog(SemanticOcTree& map) { return readLog(map.m_tileLog); }
  /** At their next look, readers are told everything. */
  static void tellAll(SemanticOcTree& map);

  /** \throw std::logic_error the map is in a folder of tiles that was opened to be read. */
  static void checkMayChange(const SemanticOcTree& map);
  /** Whoever changes nodes does it in f(MergeTarget): if it fails, the map is broken.
   * \throw std::logic_error also where somebody holds a ReadLock: nothing has changed then. */
  template <typename F>
  static void change(SemanticOcTree& map, const F& f) {
    checkMayChange(map);
    const auto log = map.m_tileLog.lock();
    ChangeLog* const touched = log && log->isRead() ? log.get() : nullptr;
    const MergeTarget target{map.store(),          map.m_filter, map.m_rule.get(),
                             map.m_observer.get(), touched,      map.m_pruning};
    target.store.beginChanging();
    try {
      f(target);
    } catch (...) {
      map.m_store = nullptr;  // what is half changed cannot be told from what was there
      throw;
    }
    target.store.endChanging();
  }
  static void merge(SemanticOcTree& map, const Scan& scan, int threads);

  /** An empty map of the same kind and time. \param resolution its voxels' edge, m */
  static SemanticOcTree emptyWith(const SemanticOcTree& map, double resolution);

  /** The clock's highest time, ns: 200 years. */
  static constexpr std::int64_t kOldest = 200LL * 365 * 86400 * 1000000000;
  /** The map's clock, ns. */
  static std::int64_t clock(const SemanticOcTree& map) { return map.m_clock; }
  static void setClock(SemanticOcTree& map, std::int64_t time) { map.m_clock = time; }
  /** What it will say after some seconds. \throw see SemanticOcTree::age(). */
  static std::int64_t timeIn(const SemanticOcTree& map, double seconds);
  /** \param time not before now */
  static void ageUntil(SemanticOcTree& map, std::int64_t time);
};

/** A map that may be gone. */
class FollowedMap {
 public:
  explicit FollowedMap(SemanticOcTree& map) : m_map(MapAccess::self(map)) {}
  /** \throw std::logic_error the map is gone, or broken. */
  SemanticOcTree& get() const;

 private:
  std::weak_ptr<SemanticOcTree*> m_map;
};

}  // namespace semantic_octree
