#include <map_folders/MapFolder.h>
#include <semantic_abstraction/Abstraction.h>
#include <semantic_octree/TreeFile.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <sstream>

#include "CraftedTreeFile.h"
#include "FuzzedFile.h"
#include "Readers.h"
#include "StreamPackets.h"
#include "radio/Radio.h"

namespace {

namespace fs = std::filesystem;
using semantic_octree::Datagram;
using semantic_octree::SemanticOcTree;

constexpr std::uint32_t kStream = 1;

SemanticOcTree emptyMap() { return SemanticOcTree(0.4, fuzzedClasses()); }

/** A small map with two tiles, G-values and its weights. */
SemanticOcTree someMap() {
  semantic_types::LabeledCloud cloud;
  cloud.points = {{1, 2, 3}, {1, 2, 2}, {-3, 1, 0.5}};
  cloud.classes = {1, 2, 4};
  SemanticOcTree map = emptyMap();
  map.insert(cloud, Eigen::Isometry3d::Identity());
  semantic_octree::AbstractionOptions options;
  options.weights.terms = {tree_abstraction::relevant("road", 1.0, {1})};
  options.blockSize = 3.2;
  setAbstraction(map, options);
  return map;
}

/** What was read has the nodes that it says, can be written, and read again. */
void expectSound(const SemanticOcTree& map) {
  std::size_t nodes = 0;
  for (auto node = map.begin_tree(); node != map.end_tree(); ++node) ++nodes;
  if (nodes != map.size()) std::abort();
  std::istringstream in(semantic_octree::fileOf(map));
  if (!(semantic_octree::readTree(in) == map)) std::abort();
}

void readMap(const std::string& bytes) {
  std::istringstream in(bytes);
  expectSound(semantic_octree::readTree(in));
}

/** With right checksums. */
void readMapContent(const std::string& bytes) { readMap(fileAround(bytes)); }

std::uint32_t crcOf(const std::string& bytes) {
  return static_cast<std::uint32_t>(
      crc32(0, reinterpret_cast<const Bytef*>(bytes.data()), static_cast<uInt>(bytes.size())));
}

std::string textIn(const fs::path& file) {
  std::ostringstream text;
  text << std::ifstream(file, std::ios::binary).rdbuf();
  return text.str();
}

/** The last checksum in a map's file: that of all its blocks, before the length of the empty one.
 */
std::uint32_t checksumOf(const fs::path& map) {
  const std::string bytes = textIn(map);
  std::uint32_t checksum = 0;
  std::memcpy(&checksum, &bytes[bytes.size() - sizeof(checksum)], sizeof(checksum));
  return checksum;
}

/** The file of leaves that an index of generation 1 names is there, and one tile with right
 * checksums around what the folder has. The index gets its checksum, and theirs for `leaves` and
 * `tile` behind "checksum: ". */
void readTiles(const fs::path& folder) {
  const fs::path tile = folder / "tile_0_0_0.1.semantic", leaves = folder / "leaves.1.semantic";
  semantic_octree::FilterParameters parameters;
  parameters.accuracy = 0.9;  // of the seeds
  parameters.labelCorrelation = 0.5;
  semantic_octree::saveTree(SemanticOcTree(0.4, fuzzedClasses(), parameters), leaves.string());
  const std::string content = textIn(tile);
  std::ofstream(tile, std::ios::binary) << fileAround(content);
  std::string index = textIn(folder / "index.yaml");
  for (const auto& [name, file] : {std::pair("tile", tile), std::pair("leaves", leaves)}) {
    const std::string mark = std::string("checksum: ") + name;
    if (const std::size_t at = index.find(mark); at != std::string::npos)
      index.replace(at, mark.size(), "checksum: " + std::to_string(checksumOf(file)));
  }
  std::ofstream(folder / "index.yaml", std::ios::binary)
      << index + "checksum: " + std::to_string(crcOf(index)) + '\n';
  expectSound(semantic_octree::loadMap(folder.string()));
}

/** Each behind its length (2 bytes). */
std::vector<std::string> recordsOf(const std::string& bytes) {
  std::vector<std::string> records;
  for (std::size_t next = 0; bytes.size() - next >= 2;) {
    std::uint16_t size = 0;
    std::memcpy(&size, &bytes[next], sizeof(size));
    records.push_back(bytes.substr(next + 2, size));
    next += 2 + records.back().size();
  }
  return records;
}

/** Packets of a map, and of its changes behind each empty record. The first record is the depth of
 * the trees' roots (1 byte), and what is frequent. All checksums but the map's own are right. A
 * copy takes them, too, as messages. */
void receivePackets(const std::string& bytes) {
  std::vector<std::string> records = recordsOf(bytes);
  if (records.empty() || records[0].empty()) return;
  semantic_octree::StreamDescription description;
  description.rootDepth = static_cast<unsigned char>(records[0][0]) % 17;
  description.coding = records[0].substr(1);
  description.kind = semantic_octree::fileOf(emptyMap());
  semantic_octree::MapReceiver receiver(kStream);
  semantic_octree::TreeCopy copy;
  semantic_octree::PacketHeader header;
  for (auto at = records.begin(); at != records.end();) {
    auto end = std::find(at + 1, records.end(), "");
    std::vector<std::string> contents(at + 1, end);
    const std::string text = description.compressed();
    const bool isFirst = at == records.begin();
    try {
      semantic_octree::TreeMessage message;
      message.stream = kStream;
      message.number = header.revision + 1u;
      message.isAll = isFirst;
      if (isFirst) message.description = text;
      message.parts = contents;
      copy.accept(message.bytes());
      expectSound(copy.map());
    } catch (const std::exception&) {
    }
    constexpr std::size_t kPart = semantic_octree::kMaxContent;
    header.numDescription = static_cast<std::uint8_t>((text.size() + kPart - 1) / kPart);
    for (std::size_t i = header.numDescription; i > 0; --i)
      contents.insert(contents.begin(), text.substr((i - 1) * kPart, kPart));
    ++header.revision;
    header.count = static_cast<std::uint32_t>(contents.size());
    for (header.number = 0; header.number < header.count; ++header.number) try {
        receiver.accept({Datagram::Type::Data, kStream, header.bytes() + contents[header.number]});
      } catch (const std::exception&) {
      }
    if (receiver.hasMap()) expectSound(receiver.map());
    receiver.receipt();
    at = end;
  }
}

/** Datagrams for a sender and a receiver, as they are and with right headers: the first byte of
 * each is its type. */
void acceptDatagrams(const std::string& bytes) {
  static SemanticOcTree map = someMap();
  semantic_octree::MapSender sender(kStream);
  sender.setMap(map);
  semantic_octree::MapReceiver receiver(kStream);
  const auto take = [&](const Datagram& datagram) {
    if (datagram.type == Datagram::Type::Data) receiver.accept(datagram);
    if (datagram.type == Datagram::Type::Receipt) sender.accept(datagram);
    if (datagram.type != Datagram::Type::Request) return;
    radio::Wish::of(datagram.payload).forClasses(map.classes(), "weights");
  };
  for (const std::string& record : recordsOf(bytes)) try {
      sender.next();
      if (record.empty()) continue;
      const auto type = static_cast<Datagram::Type>(record[0]);
      take(Datagram::of(Datagram{type, kStream, record.substr(1)}.bytes()));
      take(Datagram::of(record));
    } catch (const std::exception&) {
    }
  if (receiver.hasMap()) expectSound(receiver.map());
}

}  // namespace

std::vector<Reader> mapReaders() {
  return {{"map", readMap, {}},
          {"map-content", readMapContent, {}},
          {"tiles", fromFolder({"index.yaml", "tile_0_0_0.1.semantic"}, readTiles), {}},
          {"packets", receivePackets, {}},
          {"datagrams", acceptDatagrams, {}}};
}
