#pragma once
#include <semantic_octree/MapFollower.h>
#include <semantic_octree/SemanticOcTree.h>
#include <synthetic_world/World.h>

#include <map>
#include <set>
#include <vector>

#include "ExploreTrial.h"

namespace drive_study {

/** How much of what is looked for a map has right: columns of ground that nothing stands on, and
 * things. A thing is known if a quarter of its outer columns is, which is one side of it. */
class KnownShare {
 public:
  KnownShare(semantic_octree::SemanticOcTree& map, const synthetic_world::World& world,
             const ExploreTask& task);
  /** How much of the ground or of the things is known; the mean, if weights ask for both. */
  double share();
  /** How many columns of ground or things are right. Ground is as in the last share(). */
  long columns() const;

 private:
  using Column = semantic_octree::Column;
  using ClassId = semantic_types::ClassId;
  struct Thing {
    ClassId id;
    std::vector<Column> outer;
  };

  bool isWithin(double x, double y) const;
  bool isGround(double x, double y) const;
  ClassId thingAt(Column c, const std::set<ClassId>& things) const;
  void findThings(const std::set<ClassId>& things);
  Thing take(Column first, std::map<Column, ClassId>& columns) const;
  void lookAtTile(Column first);
  bool hasRightGround(Column c) const;
  bool hasRight(Column c, ClassId thing) const;
  long rightOf(const Thing& thing) const;
  bool isKnown(const Thing& thing) const;
  double centerOf(int key) const { return semantic_octree::centerOf(key, m_map.getResolution()); }

  semantic_octree::SemanticOcTree& m_map;
  const synthetic_world::World& m_world;
  const std::set<ClassId> m_classes;
  const double m_far;
  semantic_octree::MapFollower m_follower;
  std::set<Column> m_known;  ///< columns of ground
  int m_all = 0;             ///< columns of ground in the world
  std::vector<Thing> m_things;
};

}  // namespace drive_study
