#include <map_operations/MapOperations.h>
#include <octomap/ColorOcTree.h>
#include <octomap/OcTree.h>
#include <semantic_map/CSemanticOctoMap.h>
#include <semantic_map/MapFiles.h>
#include <semantic_types/ClassTable.h>
#include <strict_files/TextFile.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>
#include <iterator>
#include <sstream>
#include <stdexcept>
#include <string>

namespace semantic_map {
namespace {

struct Header {
  bool binary = false;
  std::string type;
  std::size_t size = 0;
  double resolution = 0;
  semantic_types::ClassTable classes;

  bool isColored() const { return type == "ColorOcTree"; }
};

/** What follows `#` in a header. */
void readComment(std::istream& words, semantic_types::ClassTable& classes) {
  std::string key, name;
  int r = 0, g = 0, b = 0;
  if (!(words >> key >> r >> g >> b && std::getline(words >> std::ws, name)) || key != "class")
    return;
  const auto byte = [](int x) { return static_cast<std::uint8_t>(std::clamp(x, 0, 255)); };
  classes.add(name, {byte(r), byte(g), byte(b)});
}

Header readHeader(std::istream& in) {
  Header header;
  std::string line;
  std::getline(in, line);
  header.binary = line.rfind("# Octomap OcTree binary file", 0) == 0;
  if (!header.binary && line.rfind("# Octomap OcTree file", 0) != 0)
    throw std::runtime_error("is no map of OctoMap's");
  while (std::getline(in, line) && line != "data") {
    std::istringstream words(line);
    const strict_files::ClassicNumbers classic(words);
    std::string key;
    words >> key;
    if (key == "#") readComment(words, header.classes);
    if (key == "id") words >> header.type;
    if (key == "size") words >> header.size;
    if (key == "res") words >> header.resolution;
  }
  if (!in || !std::isfinite(header.resolution) || header.resolution <= 0)
    throw std::runtime_error("has a damaged header");
  return header;
}

/** Follows the nodes of a file from the root down, for OctoMap believes whatever it reads. */
class Nodes {
 public:
  /** \param payload bytes of a node before its children's; 0: a binary file */
  Nodes(const std::string& bytes, std::size_t payload) : m_bytes(bytes), m_payload(payload) {
    visit(0);
    if (m_next != bytes.size()) throw std::runtime_error("has bytes that belong to no node");
  }
  std::size_t count() const { return m_count; }

 private:
  void visit(int depth) {
    ++m_count;
    if (depth > 16) throw std::runtime_error("has nodes below the lowest level");
    const int inner = m_payload ? childrenOfFull() : childrenOfBinary();
    for (int i = 0; i < inner; ++i) visit(depth + 1);
  }
  /** One bit for each child. \return number of children that follow */
  int childrenOfFull() {
    float logOdds = 0;
    skip(m_payload);
    std::memcpy(&logOdds, m_bytes.data() + m_next - m_payload, sizeof logOdds);
    if (!std::isfinite(logOdds)) throw std::runtime_error("has a log-odds that is not finite");
    return __builtin_popcount(byte());
  }
  /** Two bits for each child: none, free, occupied, or a node that follows. */
  int childrenOfBinary() {
    const unsigned bits = byte() | byte() << 8;
    const unsigned one = bits & 0x5555, other = bits >> 1 & 0x5555;
    m_count += __builtin_popcount(one ^ other);
    return __builtin_popcount(one & other);
  }
  unsigned byte() {
    skip(1);
    return static_cast<unsigned char>(m_bytes[m_next - 1]);
  }
  void skip(std::size_t n) {
    m_next += n;
    if (m_next > m_bytes.size()) throw std::runtime_error("is cut off");
  }

  const std::string& m_bytes;
  std::size_t m_payload, m_next = 0, m_count = 0;
};

/** A file whose nodes were followed. */
struct Checked {
  Header header;
  std::string nodes;

  template <class Tree>
  std::unique_ptr<Tree> tree() const {
    auto tree = std::make_unique<Tree>(header.resolution);
    std::istringstream in(nodes);
    if (header.size > 0) header.binary ? tree->readBinaryData(in) : tree->readData(in);
    return tree;
  }
};

Checked checked(std::istream& in) {
  Checked file{readHeader(in), {std::istreambuf_iterator<char>(in), {}}};
  const Header& header = file.header;
  if (header.size == 0) return file;
  if (!header.isColored() && header.type != "OcTree")
    throw std::runtime_error("holds a map of type '" + header.type +
                             "', expected OcTree or ColorOcTree");
  const std::size_t payload = header.binary ? 0 : header.isColored() ? 7 : 4;
  const std::size_t count = Nodes(file.nodes, payload).count();
  if (count != header.size)
    throw std::runtime_error("has " + std::to_string(count) + " nodes, its header says " +
                             std::to_string(header.size));
  return file;
}

semantic_octree::SemanticOcTree mapOf(const Checked& content,
                                      const semantic_octree::SemanticOcTree* like) {
  const Header& header = content.header;
  const auto filter = like ? like->filterParameters() : semantic_octree::FilterParameters();
  const auto& classes = like                     ? like->classes()
                        : header.classes.empty() ? CSemanticOctoMap::occupancyOnly()
                                                 : header.classes;
  if (header.isColored() && !header.binary)
    return fromOcTree(*content.tree<octomap::ColorOcTree>(), classes, filter);
  return fromOcTree(*content.tree<octomap::OcTree>(), classes, filter);
}

}  // namespace

semantic_octree::SemanticOcTree importOctomapFile(const std::filesystem::path& file,
                                                  const semantic_octree::SemanticOcTree* like) {
  if (std::filesystem::is_fifo(file) || std::filesystem::is_character_file(file))
    throw std::runtime_error(file.string() + ": it is no file, but a device or a pipe");
  std::ifstream in(file, std::ios::binary);
  if (!in || std::filesystem::is_directory(file))
    throw std::runtime_error(file.string() + ": cannot be read");
  try {
    return mapOf(checked(in), like);
  } catch (const std::exception& e) {
    throw std::runtime_error(file.string() + ": " + e.what());
  }
}

}  // namespace semantic_map
