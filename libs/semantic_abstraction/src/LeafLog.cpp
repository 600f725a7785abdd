#include <semantic_octree/store/ChangeLog.h>

#include <algorithm>

#include "CompressedTree.h"

namespace semantic_octree {

/** The leaves of a compressed tree that came and went, and the tree as it was last seen. A node of
 * that is an index: none, a leaf, or an inner node's eight children. */
class LeafLog : public ChangeLog {
 public:
  /** Compares with the map as it is now, remembers that, and writes down the difference if anybody
   * reads it. Visits only nodes that changed or have changed nodes below them. If it fails, the log
   * is of no use any more. */
  void update(const NodeStore& store, const GTree& gTree, const Node& root);
  std::size_t numLeaves() const { return m_numLeaves; }
  /** All leaves. */
  TreeChange everything() const;
  /** What is different. */
  static TreeChange since(const Place& place);

 private:
  using Index = std::uint32_t;
  static constexpr Index kNone = 0, kLeaf = 1, kFirstInner = 2;

  void update(const CompressedTree& tree, Index& told, const Node& node, const Cube& cell);
  void updateChildren(const CompressedTree& tree, Index& told, const Node& node, const Cube& cell);
  void becomeLeaf(Index& told, const Cube& cell);
  /** Forgets a subtree. */
  void remove(Index told, const Cube& cell);
  void note(const Cube& leaf, bool isAdded);
  Index newInner();
  void addLeaves(Index told, const Cube& cell, std::vector<LeafCell>& leaves) const;

  Index m_root = kNone;
  std::size_t m_numLeaves = 0;
  std::vector<std::array<Index, 8>> m_inner;
  std::vector<Index> m_free;
  bool m_notes = false;  ///< somebody reads it
};

namespace {

/** A leaf came; otherwise it went. */
constexpr std::uint64_t kAdded = std::uint64_t(1) << 63;

std::uint64_t leafOf(std::uint64_t entry) { return entry & ~kAdded; }

}  // namespace

void LeafLog::update(const NodeStore& store, const GTree& gTree, const Node& root) {
  m_notes = isRead();
  if (root) return update(CompressedTree(store, gTree), m_root, root, Cube());
  remove(m_root, Cube());
  m_root = kNone;
}

TreeChange LeafLog::everything() const {
  TreeChange change;
  change.all = true;
  change.added.reserve(m_numLeaves);
  addLeaves(m_root, Cube(), change.added);
  return change;
}

/** A leaf that came and went, or went and came back, is as if nothing had happened. */
TreeChange LeafLog::since(const Place& place) {
  std::vector<std::uint64_t> entries(place.begin(), place.end());
  std::stable_sort(entries.begin(), entries.end(),
                   [](std::uint64_t a, std::uint64_t b) { return leafOf(a) < leafOf(b); });
  TreeChange change;
  for (auto it = entries.begin(); it != entries.end();) {
    const auto ofNext = std::find_if(
        it, entries.end(), [&](std::uint64_t entry) { return leafOf(entry) != leafOf(*it); });
    if ((ofNext - it) % 2 == 1)
      (*it & kAdded ? change.added : change.removed).push_back({unpacked(leafOf(*it)), {}});
    it = ofNext;
  }
  return change;
}

void LeafLog::update(const CompressedTree& tree, Index& told, const Node& node, const Cube& cell) {
  if (!tree.isExpanded(node) && !tree.isSplitAbove(node, cell)) return becomeLeaf(told, cell);
  const bool wasInner = told >= kFirstInner;
  const bool hasState = !node.isLeaf() && NodeStore::octantOf(node) < 0;
  BlockState* state = hasState ? tree.state(NodeStore::slotOf(node)) : nullptr;
  if (wasInner && state && !state->changedBelow) return;
  if (!wasInner) {
    remove(told, cell);
    told = newInner();
  }
  updateChildren(tree, told, node, cell);
  if (state) state->changedBelow = 0;
}

void LeafLog::updateChildren(const CompressedTree& tree, Index& told, const Node& node,
                             const Cube& cell) {
  for (int i = 0; i < 8; ++i) {
    Index below = m_inner[told - kFirstInner][i];
    if (node.isLeaf()) {  // a leaf of the map above the blocks stands for each of its parts
      update(tree, below, node, cell.child(i));
    } else if (const Node child = node.child(i)) {
      update(tree, below, child, cell.child(i));
    } else {
      remove(below, cell.child(i));
      below = kNone;
    }
    m_inner[told - kFirstInner][i] = below;
  }
}

void LeafLog::becomeLeaf(Index& told, const Cube& cell) {
  if (told == kLeaf) return;
  remove(told, cell);
  told = kLeaf;
  ++m_numLeaves;
  note(cell, true);
}

void LeafLog::remove(Index told, const Cube& cell) {
  if (told == kNone) return;
  if (told == kLeaf) {
    --m_numLeaves;
    return note(cell, false);
  }
  for (int i = 0; i < 8; ++i) remove(m_inner[told - kFirstInner][i], cell.child(i));
  m_free.push_back(told);
}

void LeafLog::note(const Cube& leaf, bool isAdded) {
  if (m_notes) push(packed(leaf) | (isAdded ? kAdded : 0));
}

LeafLog::Index LeafLog::newInner() {
  if (m_free.empty()) {
    m_inner.push_back({});
    return static_cast<Index>(m_inner.size()) - 1 + kFirstInner;
  }
  const Index index = m_free.back();
  m_free.pop_back();
  m_inner[index - kFirstInner].fill(kNone);
  return index;
}

void LeafLog::addLeaves(Index told, const Cube& cell, std::vector<LeafCell>& leaves) const {
  if (told == kLeaf) leaves.push_back({cell, {}});
  if (told < kFirstInner) return;
  for (int i = 0; i < 8; ++i) addLeaves(m_inner[told - kFirstInner][i], cell.child(i), leaves);
}

std::shared_ptr<LeafLog> Abstraction::leafLog() const {
  const auto log = readLog(m_gTree.leafLog);
  try {
    log->update(MapAccess::store(m_map), m_gTree, m_map.root());
  } catch (...) {
    m_gTree.leafLog.reset();
    throw;
  }
  return log;
}

struct LeafFollower::Content {
  FollowedMap map;
  std::unique_ptr<LeafLog::Place> place = nullptr;
};

LeafFollower::LeafFollower(SemanticOcTree& map)
    : m(std::make_unique<Content>(Content{FollowedMap(map)})) {}
LeafFollower::~LeafFollower() = default;
LeafFollower::LeafFollower(LeafFollower&&) noexcept = default;
LeafFollower& LeafFollower::operator=(LeafFollower&&) noexcept = default;

TreeChange LeafFollower::leaves() {
  const auto log = Abstraction(m->map.get()).leafLog();
  LeafLog::Place& place = placeIn(m->place, log);
  TreeChange change = place.isLost() ? log->everything() : LeafLog::since(place);
  place.moveToEnd();
  return change;
}

std::size_t LeafFollower::skipLeaves() {
  const auto log = Abstraction(m->map.get()).leafLog();
  placeIn(m->place, log).moveToEnd();
  return log->numLeaves();
}

}  // namespace semantic_octree
