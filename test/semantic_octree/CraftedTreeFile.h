#pragma once
#include <semantic_octree/TreeFile.h>
#include <zlib.h>

#include <cstdint>
#include <cstring>
#include <sstream>
#include <string>
#include <vector>

/** \file Bytes of map files, put together by hand. */

template <typename T>
void append(std::string& bytes, T value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof(T));
}

/** Values one behind the other, each as its type is stored. */
template <typename... Values>
std::string bytesOf(Values... values) {
  std::string bytes;
  (append(bytes, values), ...);
  return bytes;
}

/** A file with right checksums around any content. */
inline std::string fileAround(const std::string& content) {
  constexpr std::size_t kBlock = 60000;
  std::string file = "SEMOCTRE" + bytesOf(std::uint32_t{5});
  std::uint32_t crc = 0;
  const auto add = [&](const std::string& block) {
    const std::string size = bytesOf(static_cast<std::uint32_t>(block.size())), part = size + block;
    crc = static_cast<std::uint32_t>(crc32(crc, reinterpret_cast<const unsigned char*>(part.data()),
                                           static_cast<uInt>(part.size())));
    file += size + bytesOf(crc) + block;
  };
  for (std::size_t i = 0; i < content.size(); i += kBlock) add(content.substr(i, kBlock));
  add("");
  return file;
}

/** What fileAround() was given. */
inline std::string contentIn(const std::string& file) {
  std::string content;
  for (std::size_t i = 12; i < file.size();) {
    std::uint32_t size = 0;
    std::memcpy(&size, &file[i], sizeof(size));
    content += file.substr(i + 8, size);
    i += 8 + size;
  }
  return content;
}

/** What precedes a map's nodes. */
struct Header {
  double resolution = 0.5;
  std::uint8_t pruning = 1, hasFactors = 0, policy = 0;
  double accuracy = 0.9, hitProbability = 0.6, falseAlarmProbability = 0.1, minOccupancy = 0.12,
         maxProbability = 0.97, softLabelFloor = 0.001, labelCorrelation = 0.2, power = 0.7,
         shared = 0.2, halfLife = 0;
  std::vector<std::string> names = {"a", "b"};
  std::uint32_t numFolds = 0;
  std::int64_t clock = 0;
  std::vector<double> factors;
  std::uint64_t numNodes = 0;

  std::string bytes() const {
    std::string bytes =
        bytesOf(resolution, pruning, hasFactors, accuracy, hitProbability, falseAlarmProbability,
                minOccupancy, maxProbability, softLabelFloor, labelCorrelation, power, shared);
    append(bytes, static_cast<std::uint8_t>(names.size()));
    for (const std::string& name : names)
      bytes += bytesOf(static_cast<std::uint16_t>(name.size())) + name + "rgb";
    bytes += bytesOf(policy, numFolds);
    for (std::size_t id = 0; id <= names.size(); ++id) append(bytes, halfLife);
    append(bytes, clock);
    for (const double factor : factors) append(bytes, factor);
    return bytes + bytesOf(numNodes);
  }
};

inline semantic_octree::SemanticOcTree treeOf(const std::string& file) {
  std::istringstream in(file);
  return semantic_octree::readTree(in);
}
