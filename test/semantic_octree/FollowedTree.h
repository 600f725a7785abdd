#pragma once
#include <gtest/gtest.h>
#include <semantic_abstraction/Abstraction.h>

#include <set>
#include <tuple>
#include <vector>

/** Key and depth. */
using LeafId = std::tuple<int, int, int, unsigned>;

inline std::set<LeafId> idsOf(const std::vector<semantic_octree::LeafCell>& leaves) {
  std::set<LeafId> ids;
  for (const auto& leaf : leaves)
    ids.insert({leaf.key()[0], leaf.key()[1], leaf.key()[2], leaf.depth});
  return ids;
}

/** The leaves of a map's compressed tree, known by its changes alone. */
class FollowedTree {
 public:
  explicit FollowedTree(semantic_octree::SemanticOcTree& map) : m_map(map), m_follower(map) {}

  /** Looks what changed; then these leaves have to be the tree's. */
  void follow() {
    const semantic_octree::TreeChange change = m_follower.leaves();
    if (change.all) m_leaves.clear();
    for (const LeafId& id : idsOf(change.removed)) EXPECT_EQ(m_leaves.erase(id), 1u);
    for (const LeafId& id : idsOf(change.added)) EXPECT_TRUE(m_leaves.insert(id).second);
    EXPECT_EQ(idsOf(change.removed).size(), change.removed.size());
    EXPECT_EQ(idsOf(change.added).size(), change.added.size());
    EXPECT_TRUE(m_leaves == idsOf(semantic_octree::Abstraction(m_map).leaves()));
    EXPECT_EQ(m_follower.skipLeaves(), m_leaves.size());
  }
  std::size_t size() const { return m_leaves.size(); }

 private:
  semantic_octree::SemanticOcTree& m_map;
  semantic_octree::LeafFollower m_follower;
  std::set<LeafId> m_leaves;
};
