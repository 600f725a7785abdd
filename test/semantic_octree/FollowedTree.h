#pragma once
#include <gtest/gtest.h>
#include <semantic_octree/Abstraction.h>

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

/** The leaves of a compressed tree, known by its changes alone. */
class FollowedTree {
 public:
  /** Takes the change; then these leaves have to be the tree's. */
  void follow(semantic_octree::Abstraction abstraction) {
    const semantic_octree::TreeChange change = abstraction.takeChange();
    for (const LeafId& id : idsOf(change.removed)) EXPECT_EQ(m_leaves.erase(id), 1u);
    for (const LeafId& id : idsOf(change.added)) EXPECT_TRUE(m_leaves.insert(id).second);
    EXPECT_EQ(idsOf(change.removed).size(), change.removed.size());
    EXPECT_EQ(idsOf(change.added).size(), change.added.size());
    EXPECT_TRUE(m_leaves == idsOf(abstraction.leaves()));
  }
  std::size_t size() const { return m_leaves.size(); }

 private:
  std::set<LeafId> m_leaves;
};
