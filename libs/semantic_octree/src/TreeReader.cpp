#include <semantic_octree/TreeFile.h>
#include <semantic_octree/store/LeafContent.h>
#include <semantic_octree/store/MapAccess.h>
#include <zlib.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "TreeContent.h"

namespace semantic_octree {
namespace {

/** Checks what the checksums let pass, too, so that no input leads to a broken tree.
 * \throw std::runtime_error (all functions), std::invalid_argument bad parameters or classes */
class TreeReader {
 public:
  explicit TreeReader(std::istream& in) : m_in(in) {
    std::array<char, kMagic.size()> magic{};
    readBytes(in, magic.data(), magic.size());
    if (magic != kMagic) throw std::runtime_error("not a semantic octree map");
    std::uint32_t version = 0;
    readBytes(in, reinterpret_cast<char*>(&version), sizeof(version));
    if (version != kVersion)
      throw std::runtime_error("version " + std::to_string(version) + " of the format, expected " +
                               std::to_string(kVersion));
  }

  SemanticOcTree read() {
    SemanticOcTree tree = getHeader();
    if (const auto numNodes = m_in.get<std::uint64_t>(); numNodes > 0) {
      begin(tree, MapAccess::store(tree).arena(0));
      getNode(m_store->root(), static_cast<NodeKind>(getUpTo(3, "node kind")), 0);
      checkNodes(m_store->numNodes(), numNodes);
    }
    m_in.finish();
    return tree;
  }

  void readTile(const SemanticOcTree& tree, NodeArena& arena, Octant& octant, const Cube& cell) {
    SemanticOcTree written = getHeader();
    written.setHalfLives(tree.classes());  // the map's now: it may have aged since
    MapAccess::setClock(written, MapAccess::clock(tree));
    if (written != emptyLike(tree))
      throw std::runtime_error(
          "it is of a map with another resolution, other classes or parameters");
    begin(tree, arena);
    const std::uint64_t others = m_store->numNodes() - static_cast<std::uint64_t>(cell.depth) - 1;
    const auto expected = m_in.get<std::uint64_t>();
    bool isTile = getUpTo(3, "node kind") == static_cast<std::uint8_t>(NodeKind::Inner);
    for (int depth = 1; isTile && depth <= cell.depth; ++depth)
      isTile = getKinds() == static_cast<unsigned>(NodeKind::Inner)
                                 << 2 * childOnTheWay(cell, depth);
    if (!isTile) throw std::runtime_error("it is no tile, or another one");
    fill(octant, cell.depth);
    checkNodes(m_store->numNodes() - others, expected);
    m_in.finish();
  }

  /** The checksum of what was read. */
  std::uint32_t checksum() const { return m_in.checksum(); }

 private:
  SemanticOcTree getHeader() {
    const auto resolution = m_in.get<double>();
    const bool pruning = getUpTo(1, "pruning");
    const bool hasFactors = getUpTo(1, "factors of classes");
    FilterParameters parameters;
    for (double* x : numbersOf(parameters)) *x = m_in.get<double>();
    ClassTable classes = getClasses();
    const std::int64_t clock = getTime(classes);
    if (hasFactors) parameters.calibration.factors.resize(static_cast<std::size_t>(classes.size()));
    for (double& x : parameters.calibration.factors) x = m_in.get<double>();
    SemanticOcTree tree(resolution, std::move(classes), parameters);
    tree.setPruning(pruning);
    MapAccess::setClock(tree, clock);
    return tree;
  }

  void begin(const SemanticOcTree& tree, NodeArena& arena) {
    m_store = &MapAccess::store(tree);
    m_arena = &arena;
    m_numClasses = tree.numClasses();
  }

  static void checkNodes(std::uint64_t found, std::uint64_t expected) {
    if (found != expected)
      throw std::runtime_error("altered: " + std::to_string(found) + " nodes, expected " +
                               std::to_string(expected));
  }

  /** One byte, 0 to `last`. */
  std::uint8_t getUpTo(int last, const char* what) {
    const auto value = m_in.get<std::uint8_t>();
    if (value > last)
      throw std::runtime_error(std::string("altered: ") + what + " = " + std::to_string(value) +
                               ", expected 0 to " + std::to_string(last));
    return value;
  }

  ClassTable getClasses() {
    ClassTable classes;
    for (int left = getUpTo(semantic_types::kMaxClasses, "number of classes"); left > 0; --left) {
      const std::string name = m_in.getText();
      semantic_types::Color color;
      for (std::uint8_t* channel : {&color.r, &color.g, &color.b})
        *channel = m_in.get<std::uint8_t>();
      classes.add(name, color);
    }
    classes.setUnknownRawId(static_cast<ClassTable::UnknownRawId>(getUpTo(1, "unknown raw id")));
    for (auto left = m_in.get<std::uint32_t>(); left > 0; --left) {
      const auto rawId = m_in.get<std::uint32_t>();
      classes.fold(rawId, m_in.get<ClassId>());
    }
    return classes;
  }

  /** Half-lives. \return the clock */
  std::int64_t getTime(ClassTable& classes) {
    for (int id = 0; id <= classes.size(); ++id)
      if (const auto halfLife = m_in.get<double>(); halfLife != 0)
        classes.setHalfLife(static_cast<ClassId>(id), halfLife);
    const auto clock = m_in.get<std::int64_t>();
    if (clock < 0 || clock > (classes.hasHalfLives() ? MapAccess::kOldest : 0))
      throw std::runtime_error("altered: a clock that cannot be");
    return clock;
  }

  void getNode(Slot& slot, NodeKind kind, int depth) {
    if (kind == NodeKind::None) throw std::runtime_error("altered: a map with nodes but no root");
    if (kind != NodeKind::Inner)
      return getLeaf(kind == NodeKind::LeafWithRecord).write(*m_arena, slot);
    depth == Block::kDepth ? void(m_arena->createBlock(slot, getBlockContent()))
                           : getChildren(slot, depth);
  }

  LeafContent getLeaf(bool hasRecord) {
    LeafContent leaf;
    leaf.value = getLogOdds();
    if (hasRecord) leaf.record = getRecord();
    return leaf;
  }

  ClassRecord getRecord() {
    Belief belief;
    belief.count = getUpTo(std::min(3, m_numClasses), "named classes");
    belief.rest = fromUnits(getLogOdds());
    for (int i = 0; i < belief.count; ++i) {
      const ClassId id = getUpTo(m_numClasses, "class");
      const bool isTwice =
          std::find(belief.ids.begin(), belief.ids.begin() + i, id) != belief.ids.begin() + i;
      if (id == kNoClass || isTwice)
        throw std::runtime_error("altered: class " + std::to_string(id) +
                                 (isTwice ? " twice in a class record" : " in a class record"));
      belief.ids[i] = id;
      belief.logOdds[i] = fromUnits(getLogOdds());
    }
    belief.sort();
    return ClassRecord::of(belief);
  }

  /** Two bits of NodeKind per child. */
  std::uint16_t getKinds() {
    const auto kinds = m_in.get<std::uint16_t>();
    if (kinds == 0) throw std::runtime_error("altered: an inner node without children");
    return kinds;
  }

  void getChildren(Slot& inner, int depth) {
    fill(m_arena->createOctant(inner), depth);
    inner.value = m_store->highestValueBelow(inner);
  }

  void fill(Octant& octant, int depth) {
    const std::uint16_t kinds = getKinds();
    const auto kindOf = [kinds](int i) { return static_cast<NodeKind>(kinds >> 2 * i & 3); };
    for (int i = 0; i < 8; ++i)
      if (kindOf(i) == NodeKind::Leaf || kindOf(i) == NodeKind::LeafWithRecord)
        getNode(octant.slots[i], kindOf(i), depth + 1);
    for (int i = 0; i < 8; ++i)
      if (kindOf(i) == NodeKind::Inner) getNode(octant.slots[i], NodeKind::Inner, depth + 1);
  }

  BlockContent getBlockContent() {
    const auto altered = [] { throw std::runtime_error("altered: a block that cannot be"); };
    BlockContent block;
    const auto known = m_in.get<std::uint8_t>(), leaves = m_in.get<std::uint8_t>(),
               recorded = m_in.get<std::uint8_t>();
    if (known == 0 || (leaves & ~known) || (recorded & ~leaves)) altered();
    std::uint8_t knownIn[8] = {}, recordedIn[8] = {};
    for (int o = 0; o < 8; ++o) {
      if (!((known & ~leaves) >> o & 1)) continue;
      knownIn[o] = m_in.get<std::uint8_t>();
      recordedIn[o] = m_in.get<std::uint8_t>();
      if (knownIn[o] == 0 || (recordedIn[o] & ~knownIn[o])) altered();
    }
    for (int o = 0; o < 8; ++o) {
      if (leaves >> o & 1) {
        block.leafOctants |= static_cast<std::uint8_t>(1u << o);
        knownIn[o] = 0xff;
        recordedIn[o] = recorded >> o & 1;
      }
      block.known |= VoxelBits(knownIn[o]) << 8 * o;
      block.recorded |= VoxelBits(recordedIn[o]) << 8 * o;
    }
    getValues(block);
    for (VoxelBits bits = block.recorded; bits; bits &= bits - 1)
      block.records[__builtin_ctzll(bits)] = getRecord();
    return block;
  }

  void getValues(BlockContent& block) {
    const auto stored = [&block](int o) -> unsigned {
      return block.leafOctants >> o & 1 ? 1 : octantOf(block.known, o);
    };
    int numValues = 0;
    for (int o = 0; o < 8; ++o) numValues += countOf(stored(o));
    Units values[64];
    m_in.get(values, static_cast<std::size_t>(numValues));
    if (std::find(values, values + numValues, kUnknown) != values + numValues)
      throw std::runtime_error("altered: a log-odds that is out of range");
    const Units* next = values;
    for (int o = 0; o < 8; ++o) {
      for (unsigned bits = stored(o); bits; bits &= bits - 1)
        block.values[8 * o + __builtin_ctz(bits)] = *next++;
      if (block.leafOctants >> o & 1) std::fill_n(block.values + 8 * o + 1, 7, block.values[8 * o]);
    }
  }

  Units getLogOdds() {
    const auto value = m_in.get<std::int16_t>();
    if (value == kUnknown) throw std::runtime_error("altered: a log-odds that is out of range");
    return value;
  }

  CheckedReader m_in;
  NodeStore* m_store = nullptr;
  NodeArena* m_arena = nullptr;
  int m_numClasses = 0;
};

/** Calls read(reader). */
template <typename F>
auto readFrom(std::istream& in, const F& read) {
  TreeReader reader(in);
  try {
    return read(reader);
  } catch (const std::invalid_argument& e) {
    throw std::runtime_error(std::string("altered: ") + e.what());
  }
}

/** Calls read(reader), which has to read all of the file. */
template <typename F>
auto load(const std::string& path, const F& read) {
  namespace fs = std::filesystem;
  try {
    if (fs::is_directory(path)) throw std::runtime_error("it is a folder");
    if (fs::exists(path) && !fs::is_regular_file(path))
      throw std::runtime_error("it is no file, but a device or a pipe");
    errno = 0;
    std::ifstream in(path, std::ios::binary);
    if (!in) throw std::runtime_error(std::strerror(errno));
    if (in.peek() == std::ifstream::traits_type::eof())
      throw std::runtime_error("the file is empty");
    auto content = readFrom(in, read);
    if (in.peek() != std::ifstream::traits_type::eof())
      throw std::runtime_error("altered: bytes after the end of the map");
    return content;
  } catch (const std::runtime_error& e) {
    throw std::runtime_error("cannot load map '" + path + "': " + e.what());
  }
}

}  // namespace

SemanticOcTree readTree(std::istream& in) {
  return readFrom(in, [](TreeReader& reader) { return reader.read(); });
}

SemanticOcTree loadTree(const std::string& path) { return loadTreeFile(path); }

SemanticOcTree loadTreeFile(const std::string& path, std::uint32_t* checksum) {
  return load(path, [&](TreeReader& reader) {
    SemanticOcTree tree = reader.read();
    if (checksum) *checksum = reader.checksum();
    return tree;
  });
}

std::uint32_t loadTile(const SemanticOcTree& tree, NodeArena& arena, Octant& octant,
                       const Cube& cell, const std::string& path) {
  return load(path, [&](TreeReader& reader) {
    reader.readTile(tree, arena, octant, cell);
    return reader.checksum();
  });
}

std::uint32_t extendCrc(std::uint32_t crc, const void* bytes, std::size_t size) {
  return static_cast<std::uint32_t>(crc32_z(crc, static_cast<const unsigned char*>(bytes), size));
}

}  // namespace semantic_octree
