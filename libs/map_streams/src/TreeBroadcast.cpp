#include <map_streams/MapStream.h>
#include <semantic_abstraction/Abstraction.h>
#include <semantic_octree/MapFollower.h>
#include <semantic_octree/store/TileCodes.h>

#include <algorithm>
#include <map>
#include <optional>
#include <stdexcept>

#include "StreamPackets.h"

namespace semantic_octree {

struct TreeBroadcast::State {
  SemanticOcTree& map;
  std::uint32_t stream, number = 0;
  MapFollower tiles;
  LeafFollower leaves;
  std::unique_ptr<SemanticOcTree> kind;  ///< an empty map
  std::unique_ptr<PartCoder> coder;
  std::size_t learned = 0;  ///< from so many parts
  StreamTree told;
  Calibration calibration, stated;  ///< of the map, and of the tree when it was fitted to that
  bool isFirst = true;

  std::optional<ChangedCells> changes();
  bool isAnother(const Abstraction& abstraction) const;
  bool calibrate(const Abstraction& abstraction);
  std::string description() const;
  std::vector<std::string> encoded(const TreeParts& parts) const;
};

TreeBroadcast::TreeBroadcast(SemanticOcTree& map, std::uint32_t stream)
    : m_state(new State{
          map, stream, 0, map.follow(), LeafFollower(map), {}, {}, 0, {}, {}, {}, true}) {}
TreeBroadcast::~TreeBroadcast() = default;
TreeBroadcast::TreeBroadcast(TreeBroadcast&&) noexcept = default;

/** None: anywhere. The tree's shape changes also where no voxel does, as a price changes. */
std::optional<ChangedCells> TreeBroadcast::State::changes() {
  const TileChange values = tiles.tiles();
  const TreeChange shape = leaves.leaves();
  if (values.all || shape.all) return std::nullopt;
  std::vector<CellPath> cells;
  for (const auto& key : values.tiles)
    cells.push_back(CellPath::of(Cube::around({key[0], key[1], key[2]}, kTileDepth)));
  for (const auto& cubes : {shape.removed, shape.added})
    for (const LeafCell& cube : cubes) cells.push_back(CellPath::of(cube));
  return ChangedCells(std::move(cells));
}

bool TreeBroadcast::State::isAnother(const Abstraction& abstraction) const {
  return isFirst || coder->rootDepth() != abstraction.rootDepth() ||
         abstraction.emptyCompressedMap() != *kind;
}

/** Looks at all of the map, but only when its calibration is another. \return whether it is */
bool TreeBroadcast::State::calibrate(const Abstraction& abstraction) {
  const Calibration& now = map.filterParameters().calibration;
  if (now == calibration) return false;
  stated = abstraction.compressedMap().filterParameters().calibration;
  calibration = now;
  return true;
}

std::string TreeBroadcast::State::description() const {
  StreamDescription d;
  d.rootDepth = static_cast<std::uint8_t>(coder->rootDepth());
  d.coding = coder->toText();
  d.kind = fileOf(*kind);
  return d.compressed();
}

std::vector<std::string> TreeBroadcast::State::encoded(const TreeParts& all) const {
  constexpr std::size_t kGroup = 8192;  // unpacked, these are 2 MB
  std::vector<std::string> groups;
  for (std::size_t at = 0; at < all.parts.size(); at += kGroup) {
    std::vector<TreePart> parts;
    std::vector<const TreePart*> pointers;
    for (std::size_t i = at; i < std::min(at + kGroup, all.parts.size()); ++i)
      parts.push_back(all.parts.part(i));
    for (const TreePart& part : parts) pointers.push_back(&part);
    groups.push_back(coder->encode(pointers));
  }
  return groups;
}

std::string TreeBroadcast::change() {
  State& s = *m_state;
  const Abstraction abstraction(s.map);
  TreeMessage message;
  message.isAll = s.isAnother(abstraction);
  s.isFirst = true;  // until it is done
  const auto changes = s.changes();
  if (message.isAll) {
    s.told = StreamTree();
    s.kind = std::make_unique<SemanticOcTree>(abstraction.emptyCompressedMap());
    s.learned = 0;
  }
  const bool anywhere = message.isAll || !changes;
  const TreeParts parts = unorderedPartsOfChange(s.map, s.told, anywhere ? nullptr : &*changes);
  if (const std::size_t count = parts.parts.size(); message.isAll || count > 2 * s.learned) {
    s.coder =
        std::make_unique<PartCoder>(coderFor(parts, s.map.numClasses(), abstraction.rootDepth()));
    s.learned = count;
    message.description = s.description();
  }
  message.stream = s.stream;
  message.number = s.number + 1;
  const bool isStatedNew = s.calibrate(abstraction);
  message.stated = s.stated;
  message.parts = s.encoded(parts);
  for (std::size_t i = 0; i < parts.parts.size(); ++i)
    s.told.apply(parts.parts.part(i), message.number);
  s.isFirst = false;
  if (!message.isAll && message.parts.empty() && !isStatedNew) return {};
  s.number = message.number;
  return message.bytes();
}

std::string TreeBroadcast::all() const {
  const State& s = *m_state;
  if (!s.coder) return {};
  return TreeMessage{s.stream,        s.number, true,
                     s.description(), s.stated, s.encoded(partsOf(s.told, s.coder->rootDepth()))}
      .bytes();
}

struct TreeCopy::State {
  std::uint32_t stream = 0, number = 0, heard = 0;  ///< changes that it holds; that it heard of
  StreamKind kind;
  StreamTree tree;
  std::map<std::uint32_t, TreeMessage> waiting;

  void take(const TreeMessage& m);
  void wait(TreeMessage m);
};

TreeCopy::TreeCopy() : m_state(std::make_unique<State>()) {}
TreeCopy::~TreeCopy() = default;
TreeCopy::TreeCopy(TreeCopy&&) noexcept = default;

bool TreeCopy::accept(const std::string& message) {
  State& s = *m_state;
  TreeMessage m = TreeMessage::of(message);
  if (m.stream != s.stream) {
    s.stream = m.stream;
    s.number = s.heard = 0;
    s.waiting.clear();
  }
  if (m.number <= s.number) return isCurrent();
  s.heard = std::max(s.heard, m.number);
  if (!m.isAll && m.number != s.number + 1) {
    s.wait(std::move(m));
    return false;
  }
  s.take(m);
  for (auto next = s.waiting.begin(); next != s.waiting.end(); next = s.waiting.erase(next)) {
    if (next->first <= s.number) continue;
    if (next->first != s.number + 1) break;
    s.take(next->second);
  }
  return isCurrent();
}

/** If it fails, what is there counts no longer. */
void TreeCopy::State::take(const TreeMessage& m) {
  number = 0;
  if (!m.description.empty()) kind = StreamDescription::of(m.description).read();
  if (!kind.coder || (m.isAll && m.description.empty()))
    throw std::runtime_error("altered: nothing says of which kind the tree is");
  kind.calibrate(m.stated);
  if (m.isAll) tree = StreamTree();
  for (const std::string& group : m.parts)
    for (const TreePart& part : kind.coder->decode(group))
      if (!tree.apply(part, m.number))
        throw std::runtime_error("altered: children of what is not there");
  number = m.number;
}

/** Where more wait than kMost, all of the tree will be asked for anyway. */
void TreeCopy::State::wait(TreeMessage m) {
  constexpr std::size_t kMost = 100;
  waiting[m.number] = std::move(m);
  if (waiting.size() > kMost) waiting.erase(waiting.begin());
}

bool TreeCopy::isCurrent() const {
  return m_state->number > 0 && m_state->number == m_state->heard;
}

SemanticOcTree TreeCopy::map() const {
  if (!m_state->kind.empty) throw std::logic_error("no tree was received yet");
  return m_state->tree.map(*m_state->kind.empty);
}

std::size_t TreeCopy::numLeaves() const { return m_state->tree.numLeaves(); }

}  // namespace semantic_octree
