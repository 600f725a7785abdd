#include <semantic_octree/TreeFile.h>

#include <semantic_octree/store/MapAccess.h>
#include <semantic_octree/store/TreeFormat.h>
#include <strict_files/OutputFiles.h>
#include <zlib.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <streambuf>

namespace semantic_octree {
namespace {

namespace fs = std::filesystem;
using strict_files::StagedFile;

void writeBeginning(std::ostream& out) {
  out.write(kMagic.data(), kMagic.size());
  out.write(reinterpret_cast<const char*>(&kVersion), sizeof(kVersion));
}

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

void readBeginning(std::istream& in) {
  std::array<char, kMagic.size()> magic{};
  readBytes(in, magic.data(), magic.size());
  if (magic != kMagic) throw std::runtime_error("not a semantic octree map");
  std::uint32_t version = 0;
  readBytes(in, reinterpret_cast<char*>(&version), sizeof(version));
  if (version != kVersion)
    throw std::runtime_error("version " + std::to_string(version) + " of the format, expected " +
                             std::to_string(kVersion));
}

/** Calls read(stream), which has to read all of the file. */
template <typename F>
auto readWhole(const fs::path& path, const F& read) {
  if (fs::is_directory(path)) throw std::runtime_error("it is a folder");
  if (fs::exists(path) && !fs::is_regular_file(path))
    throw std::runtime_error("it is no file, but a device or a pipe");
  errno = 0;
  std::ifstream in(path, std::ios::binary);
  if (!in) throw std::runtime_error(std::strerror(errno));
  if (in.peek() == std::ifstream::traits_type::eof()) throw std::runtime_error("the file is empty");
  auto content = read(in);
  if (in.peek() != std::ifstream::traits_type::eof())
    throw std::runtime_error("altered: bytes after the end of the map");
  return content;
}

/** Calls read(reader). */
template <typename F>
auto readContent(std::istream& in, const F& read) {
  readBeginning(in);
  TreeReader reader(in);
  try {
    return read(reader);
  } catch (const std::invalid_argument& e) {
    throw std::runtime_error(std::string("altered: ") + e.what());
  }
}

std::uint32_t write(std::ostream& out, const SemanticOcTree& tree) {
  writeBeginning(out);
  return TreeWriter(out, tree).write();
}

/** Calls write(stream), which tells the checksum. */
template <typename F>
std::uint32_t save(const std::string& path, StagedFile::Disk when, const F& write) {
  try {
    StagedFile file(path);
    errno = 0;
    std::ofstream out(file.path(), std::ios::binary | std::ios::trunc);
    const std::uint32_t checksum = write(out);
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

template <typename F>
auto load(const std::string& path, const F& read) {
  try {
    return readWhole(path, read);
  } catch (const std::runtime_error& e) {
    throw std::runtime_error("cannot load map '" + path + "': " + e.what());
  }
}

}  // namespace

void writeTree(std::ostream& out, const SemanticOcTree& tree) { write(out, tree); }

std::size_t fileSize(const SemanticOcTree& tree) {
  CountingBuffer buffer;
  std::ostream out(&buffer);
  writeTree(out, tree);
  return buffer.bytes();
}

SemanticOcTree readTree(std::istream& in) {
  return readContent(in, [](TreeReader& reader) { return reader.read(); });
}

void saveTree(const SemanticOcTree& tree, const std::string& path) {
  save(path, StagedFile::Disk::Now, [&](std::ostream& out) { return write(out, tree); });
}

std::uint32_t saveTreeFile(const SemanticOcTree& tree, const std::string& path) {
  return save(path, StagedFile::Disk::Later, [&](std::ostream& out) { return write(out, tree); });
}

SemanticOcTree loadTree(const std::string& path) { return loadTreeFile(path); }

SemanticOcTree loadTreeFile(const std::string& path, std::uint32_t* checksum) {
  return load(path, [&](std::istream& in) {
    return readContent(in, [&](TreeReader& reader) {
      SemanticOcTree tree = reader.read();
      if (checksum) *checksum = reader.checksum();
      return tree;
    });
  });
}

std::uint32_t saveTile(const SemanticOcTree& tree, const Slot& octant, const Cell& cell,
                       std::uint64_t nodes, const std::string& path) {
  return save(path, StagedFile::Disk::Later, [&](std::ostream& out) {
    writeBeginning(out);
    return TreeWriter(out, tree).writeTile(octant, cell, nodes);
  });
}

std::uint32_t loadTile(const SemanticOcTree& tree, NodeArena& arena, Octant& octant,
                       const Cell& cell, const std::string& path) {
  return load(path, [&](std::istream& in) {
    return readContent(in, [&](TreeReader& reader) {
      reader.readTile(tree, arena, octant, cell);
      return reader.checksum();
    });
  });
}

using semantic_types::Color;

TreeWriter::TreeWriter(std::ostream& out, const SemanticOcTree& tree)
    : m_out(out), m_tree(tree), m_store(MapAccess::store(tree)) {}

void TreeWriter::putHeader() {
  m_out.put(m_tree.getResolution());
  m_out.put(m_tree.pruning());
  putParameters(m_tree.filterParameters());
  putClasses(m_tree.classes());
  putTime();
}

std::uint32_t TreeWriter::writeTile(const Slot& octant, const Cell& cell, std::uint64_t nodes) {
  putHeader();
  m_out.put<std::uint64_t>(nodes + static_cast<std::uint64_t>(cell.depth) + 1);
  m_out.put(static_cast<std::uint8_t>(NodeKind::Inner));
  for (int depth = 1; depth <= cell.depth; ++depth)
    m_out.put(static_cast<std::uint16_t>(static_cast<unsigned>(NodeKind::Inner)
                                         << 2 * cell.childOnTheWay(depth)));
  putSlot(octant);
  return m_out.finish();
}

std::uint32_t TreeWriter::write() {
  putHeader();
  m_out.put<std::uint64_t>(m_tree.size());
  if (!m_tree.empty()) {
    m_out.put(static_cast<std::uint8_t>(kindOf(m_store.root())));
    putSlot(m_store.root());
  }
  return m_out.finish();
}

void TreeWriter::putParameters(const FilterParameters& p) {
  m_out.put(std::uint8_t{0});  // kept free
  for (const double x :
       {p.accuracy, p.hitProbability, p.falseAlarmProbability, p.minOccupancy, p.maxProbability,
        p.softLabelFloor, p.labelCorrelation, p.calibration.power, p.calibration.shared})
    m_out.put(x);
}

void TreeWriter::putClasses(const ClassTable& classes) {
  m_out.put(static_cast<std::uint8_t>(classes.size()));
  for (int id = 1; id <= classes.size(); ++id) {
    const Color& color = classes.color(static_cast<ClassId>(id));
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

void TreeWriter::putTime() {
  for (int id = 0; id <= m_tree.numClasses(); ++id) {
    const double halfLife = m_tree.classes().halfLife(static_cast<ClassId>(id));
    m_out.put(halfLife == semantic_types::kForever ? 0.0 : halfLife);
  }
  m_out.put(m_tree.classes().hasHalfLives() ? MapAccess::clock(m_tree) : 0);
}

NodeKind TreeWriter::kindOf(const Slot& slot) {
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

void TreeWriter::putLeaf(const Slot& leaf) {
  m_out.put(leaf.value);
  if (leaf.kind == Slot::Kind::LeafWithRecord) putRecord(m_store.record(leaf));
}

void TreeWriter::putRecord(const ClassRecord& record) {
  m_out.put(record.count);
  m_out.put(record.rest);
  for (int i = 0; i < record.count; ++i) {
    m_out.put(record.ids[i]);
    m_out.put(record.logOdds[i]);
  }
}

void TreeWriter::putSlot(const Slot& slot) {
  if (slot.isLeaf()) return putLeaf(slot);
  m_store.bring(slot);
  slot.kind == Slot::Kind::Block ? putBlock(m_store.block(slot))
                                 : putChildren(m_store.octant(slot));
}

void TreeWriter::putChildren(const Octant& octant) {
  std::uint16_t kinds = 0;
  for (int i = 0; i < 8; ++i)
    kinds |= static_cast<std::uint16_t>(static_cast<unsigned>(kindOf(octant.slots[i])) << 2 * i);
  m_out.put(kinds);
  for (const Slot& child : octant.slots)
    if (child.isLeaf()) putLeaf(child);
  for (const Slot& child : octant.slots)
    if (child.isInner()) putSlot(child);
}

void TreeWriter::putBlock(const Block& block) {
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

std::uint32_t extendCrc(std::uint32_t crc, const void* bytes, std::size_t size) {
  return static_cast<std::uint32_t>(crc32_z(crc, static_cast<const unsigned char*>(bytes), size));
}

void CheckedWriter::put(const std::string& text) {
  if (text.size() > UINT16_MAX)
    throw std::runtime_error("a name of " + std::to_string(text.size()) +
                             " characters is too long for a map file");
  put(static_cast<std::uint16_t>(text.size()));
  for (const char c : text) put(c);
}

void CheckedWriter::flush() {
  const std::uint32_t length = static_cast<std::uint32_t>(m_used);
  m_crc = extendCrc(extendCrc(m_crc, &length, sizeof(length)), m_block.data(), m_used);
  m_out.write(reinterpret_cast<const char*>(&length), sizeof(length));
  m_out.write(reinterpret_cast<const char*>(&m_crc), sizeof(m_crc));
  m_out.write(m_block.data(), static_cast<std::streamsize>(m_used));
  m_used = 0;
}

std::uint32_t CheckedWriter::finish() {
  if (m_used > 0) flush();
  flush();
  if (!m_out)
    throw std::runtime_error("the map could not be written completely: " +
                             std::string(std::strerror(errno)));
  return m_crc;
}

std::string CheckedReader::getText() {
  std::string text(get<std::uint16_t>(), '\0');
  for (char& c : text) c = get<char>();
  return text;
}

void CheckedReader::getAcrossBlocks(char* to, std::size_t bytes) {
  while (bytes > 0) {
    if (m_next == m_size) {
      nextBlock();
      if (m_size == 0) throw std::runtime_error("altered: its content ends too early");
    }
    const std::size_t part = std::min(bytes, m_size - m_next);
    std::memcpy(to, m_block.data() + m_next, part);
    m_next += part, to += part, bytes -= part;
  }
}

void CheckedReader::nextBlock() {
  std::uint32_t length = 0, crc = 0;
  readBytes(m_in, reinterpret_cast<char*>(&length), sizeof(length));
  readBytes(m_in, reinterpret_cast<char*>(&crc), sizeof(crc));
  if (length > kMaxBlockBytes)
    throw std::runtime_error("altered: a block of " + std::to_string(length) + " bytes");
  readBytes(m_in, m_block.data(), length);
  m_crc = extendCrc(extendCrc(m_crc, &length, sizeof(length)), m_block.data(), length);
  if (m_crc != crc) throw std::runtime_error("altered: a checksum does not match");
  m_next = 0;
  m_size = length;
}

void CheckedReader::finish() {
  if (m_next == m_size) nextBlock();
  if (m_size > 0) throw std::runtime_error("altered: more content than its counts tell");
}

void readBytes(std::istream& in, char* to, std::size_t bytes) {
  in.read(to, static_cast<std::streamsize>(bytes));
  if (static_cast<std::size_t>(in.gcount()) != bytes) throw std::runtime_error("truncated");
}

}  // namespace semantic_octree
