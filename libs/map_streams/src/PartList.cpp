#include "PartList.h"

#include <algorithm>
#include <cstring>
#include <tuple>

namespace semantic_octree {
namespace {

using Kind = StreamLeaf::Kind;

/** Bytes of a kind, and of what a leaf of it says. */
constexpr std::size_t kMostBytes = 1 + sizeof(Units) + sizeof(ClassRecord);

template <typename T>
char* put(char* to, const T& value) {
  std::memcpy(to, &value, sizeof(T));
  return to + sizeof(T);
}

template <typename T>
const char* get(const char* from, T& value) {
  std::memcpy(&value, from, sizeof(T));
  return from + sizeof(T);
}

char* putLeaf(char* to, const StreamLeaf& leaf) {
  to = put(to, leaf.kind);
  if (leaf.kind != Kind::None) to = put(to, leaf.value);
  if (leaf.kind == Kind::WithRecord) to = put(to, leaf.record);
  return to;
}

const char* getLeaf(const char* from, StreamLeaf& leaf) {
  from = get(from, leaf.kind);
  if (leaf.kind != Kind::None) from = get(from, leaf.value);
  if (leaf.kind == Kind::WithRecord) from = get(from, leaf.record);
  return from;
}

}  // namespace

void PartList::add(const TreePart& part, std::size_t step, bool begins) {
  if (m_used + 8 * kMostBytes > kChunk) {
    m_chunks.push_back(std::make_unique<char[]>(kChunk));
    m_used = 0;
  }
  m_entries.push_back(
      {part.cell.path, static_cast<std::uint32_t>(step),
       static_cast<std::uint32_t>(m_chunks.size() - 1), static_cast<std::uint32_t>(m_used),
       static_cast<std::uint8_t>(part.cell.depth), part.mask, part.isOctet, begins});
  char* const chunk = m_chunks.back().get();
  char* to = chunk + m_used;
  for (int i = 0; i < 8; ++i)
    if (part.mask >> i & 1) to = putLeaf(to, part.leaves[i]);
  m_used = static_cast<std::size_t>(to - chunk);
}

void PartList::sort() {
  const auto key = [](const Entry& e) { return std::tuple(e.step, e.chunk, e.at); };
  std::sort(m_entries.begin(), m_entries.end(),
            [&](const Entry& a, const Entry& b) { return key(a) < key(b); });
}

TreePart PartList::part(std::size_t i) const {
  const Entry& e = m_entries[i];
  TreePart part;
  part.cell = {e.path, e.depth};
  part.isOctet = e.isOctet;
  part.mask = e.mask;
  const char* from = m_chunks[e.chunk].get() + e.at;
  for (int leaf = 0; leaf < 8; ++leaf)
    if (e.mask >> leaf & 1) from = getLeaf(from, part.leaves[leaf]);
  return part;
}

}  // namespace semantic_octree
