#include <semantic_octree/TreeFile.h>
#include <semantic_octree/store/MapAccess.h>
#include <strict_files/OutputFiles.h>

#include <fstream>
#include <streambuf>

#include "TreeContent.h"

namespace semantic_octree {
namespace {

class TreeWriter {
 public:
  TreeWriter(std::ostream& out, const SemanticOcTree& tree)
      : m_out(out), m_tree(tree), m_store(MapAccess::store(tree)) {
    out.write(kMagic.data(), kMagic.size());
    out.write(reinterpret_cast<const char*>(&kVersion), sizeof(kVersion));
  }

  /** \return the checksum, as all that write */
  std::uint32_t write() {
    putHeader();
    m_out.put<std::uint64_t>(m_tree.size());
    if (!m_tree.empty()) {
      m_out.put(static_cast<std::uint8_t>(kindOf(m_store.root())));
      putSlot(m_store.root());
    }
    return m_out.finish();
  }

  std::uint32_t writeTile(const Slot& octant, const Cube& cell, std::uint64_t nodes) {
    putHeader();
    m_out.put<std::uint64_t>(nodes + static_cast<std::uint64_t>(cell.depth) + 1);
    m_out.put(static_cast<std::uint8_t>(NodeKind::Inner));
    for (int depth = 1; depth <= cell.depth; ++depth)
      m_out.put(static_cast<std::uint16_t>(static_cast<unsigned>(NodeKind::Inner)
                                           << 2 * childOnTheWay(cell, depth)));
    putSlot(octant);
    return m_out.finish();
  }

 private:
  void putHeader() {
    m_out.put(m_tree.getResolution());
    m_out.put(m_tree.pruning());
    const std::vector<double>& factors = m_tree.filterParameters().calibration.factors;
    m_out.put(static_cast<std::uint8_t>(!factors.empty()));
    for (const double* x : numbersOf(m_tree.filterParameters())) m_out.put(*x);
    putClasses(m_tree.classes());
    putTime();
    for (const double x : factors) m_out.put(x);
  }

  void putClasses(const ClassTable& classes) {
    m_out.put(static_cast<std::uint8_t>(classes.size()));
    for (int id = 1; id <= classes.size(); ++id) {
      const semantic_types::Color& color = classes.color(static_cast<ClassId>(id));
      m_out.put(classes.name(static_cast<ClassId>(id)));
      for (const std::uint8_t channel : {color.r, color.g, color.b}) m_out.put(channel);
    }
    m_out.put(static_cast<std::uint8_t>(classes.unknownRawId()));
    m_out.put(static_cast<std::uint32_t>(classes.folds().size()));
    for (const auto& [rawId, id] : classes.folds()) {
      m_out.put(rawId);
      m_out.put(id);
    }
  }

  void putTime() {
    for (int id = 0; id <= m_tree.numClasses(); ++id) {
      const double halfLife = m_tree.classes().halfLife(static_cast<ClassId>(id));
      m_out.put(halfLife == semantic_types::kForever ? 0.0 : halfLife);
    }
    m_out.put(m_tree.classes().hasHalfLives() ? MapAccess::clock(m_tree) : 0);
  }

  static NodeKind kindOf(const Slot& slot) {
    switch (slot.kind) {
      case Slot::Kind::None:
        return NodeKind::None;
      case Slot::Kind::Leaf:
        return NodeKind::Leaf;
      case Slot::Kind::LeafWithRecord:
        return NodeKind::LeafWithRecord;
      default:
        return NodeKind::Inner;
    }
  }

  void putLeaf(const Slot& leaf) {
    m_out.put(leaf.value);
    if (leaf.kind == Slot::Kind::LeafWithRecord) putRecord(m_store.record(leaf));
  }

  void putRecord(const ClassRecord& record) {
    m_out.put(record.count);
    m_out.put(record.rest);
    for (int i = 0; i < record.count; ++i) {
      m_out.put(record.ids[i]);
      m_out.put(record.logOdds[i]);
    }
  }

  void putSlot(const Slot& slot) {
    if (slot.isLeaf()) return putLeaf(slot);
    m_store.bring(slot);
    slot.kind == Slot::Kind::Block ? putBlock(m_store.block(slot))
                                   : putChildren(m_store.octant(slot));
  }

  void putChildren(const Octant& octant) {
    std::uint16_t kinds = 0;
    for (int i = 0; i < 8; ++i)
      kinds |= static_cast<std::uint16_t>(static_cast<unsigned>(kindOf(octant.slots[i])) << 2 * i);
    m_out.put(kinds);
    for (const Slot& child : octant.slots)
      if (child.isLeaf()) putLeaf(child);
    for (const Slot& child : octant.slots)
      if (child.isInner()) putSlot(child);
  }

  void putBlock(const Block& block) {
    std::uint8_t known = 0, recorded = 0;
    for (int o = 0; o < 8; ++o) {
      known |= static_cast<std::uint8_t>((block.knownIn(o) != 0) << o);
      recorded |= static_cast<std::uint8_t>((block.isLeafOctant(o) && block.hasRecord(8 * o)) << o);
    }
    m_out.put(known);
    m_out.put(block.leafOctants);
    m_out.put(recorded);
    for (int o = 0; o < 8; ++o) {
      if (!block.knownIn(o) || block.isLeafOctant(o)) continue;
      m_out.put(block.knownIn(o));
      m_out.put(static_cast<std::uint8_t>(block.recorded >> 8 * o));
    }
    Units values[64];
    int numValues = 0;
    for (int o = 0; o < 8; ++o)
      for (VoxelBits bits = block.isLeafOctant(o) ? 1 : block.knownIn(o); bits; bits &= bits - 1)
        values[numValues++] = block.values[8 * o + __builtin_ctzll(bits)];
    m_out.put(values, numValues);
    const ClassRecord* records = block.recorded ? m_store.recordsOf(block) : nullptr;
    for (int i = 0; i < block.numRecords(); ++i) putRecord(records[i]);
  }

  CheckedWriter m_out;
  const SemanticOcTree& m_tree;
  const NodeStore& m_store;
};

/** Counts what is written to it. */
class CountingBuffer : public std::streambuf {
 public:
  std::size_t bytes() const { return m_bytes; }

 private:
  int_type overflow(int_type c) override {
    ++m_bytes;
    return traits_type::not_eof(c);
  }
  std::streamsize xsputn(const char*, std::streamsize n) override {
    m_bytes += static_cast<std::size_t>(n);
    return n;
  }
  std::size_t m_bytes = 0;
};

/** What an error of a file says, without the path that it begins with. */
std::string reasonOf(const std::exception& error, const std::string& path) {
  const std::string message = error.what(), named = path + ": ";
  return message.rfind(named, 0) == 0 ? message.substr(named.size()) : message;
}

/** Calls write(writer), which tells the checksum. */
template <typename F>
std::uint32_t save(const SemanticOcTree& tree, const std::string& path,
                   strict_files::StagedFile::Disk when, const F& write) {
  try {
    strict_files::StagedFile file(path);
    errno = 0;
    std::ofstream out(file.path(), std::ios::binary | std::ios::trunc);
    const std::uint32_t checksum = write(TreeWriter(out, tree));
    out.close();
    if (!out)
      throw std::runtime_error("the file could not be written completely: " +
                               std::string(std::strerror(errno)));
    file.commit(when);
    return checksum;
  } catch (const std::exception& e) {
    throw std::runtime_error("cannot save map '" + path + "': " + reasonOf(e, path));
  }
}

std::uint32_t writeAll(TreeWriter writer) { return writer.write(); }

using strict_files::StagedFile;

}  // namespace

void writeTree(std::ostream& out, const SemanticOcTree& tree) { TreeWriter(out, tree).write(); }

std::size_t fileSize(const SemanticOcTree& tree) {
  CountingBuffer buffer;
  std::ostream out(&buffer);
  writeTree(out, tree);
  return buffer.bytes();
}

void saveTree(const SemanticOcTree& tree, const std::string& path) {
  save(tree, path, StagedFile::Disk::Now, writeAll);
}

std::uint32_t saveTreeFile(const SemanticOcTree& tree, const std::string& path) {
  return save(tree, path, StagedFile::Disk::Later, writeAll);
}

std::uint32_t saveTile(const SemanticOcTree& tree, const Slot& octant, const Cube& cell,
                       std::uint64_t nodes, const std::string& path) {
  return save(tree, path, StagedFile::Disk::Later,
              [&](TreeWriter writer) { return writer.writeTile(octant, cell, nodes); });
}

}  // namespace semantic_octree
