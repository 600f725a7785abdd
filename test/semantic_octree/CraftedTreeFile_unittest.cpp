// Files whose checksums are right and whose content is not.
#include <gtest/gtest.h>
#include <semantic_octree/TreeFile.h>
#include <zlib.h>

#include <cmath>

#include "TemporaryFolder.h"

using namespace semantic_octree;

namespace {

/** What loading a file with this content says. */
std::string loadError(const TemporaryFolder& folder, const std::string& content) {
  const std::string path = folder.write("bad.semantic", content).string();
  const std::string error = errorOf([&] { loadTree(path); });
  EXPECT_TRUE(error.empty() || contains(error, path)) << error;
  return error;
}

template <typename T>
void append(std::string& bytes, T value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof(T));
}

/** A file with a right checksum around any content. */
std::string fileAround(const std::string& content) {
  std::string file = "SEMOCTRE";
  append(file, std::uint32_t(1));
  std::uint32_t crc = 0;
  for (const std::string& block : {content, std::string()}) {
    std::string part;
    append(part, static_cast<std::uint32_t>(block.size()));
    part += block;
    crc = static_cast<std::uint32_t>(crc32(crc, reinterpret_cast<const unsigned char*>(part.data()),
                                           static_cast<uInt>(part.size())));
    append(file, static_cast<std::uint32_t>(block.size()));
    append(file, crc);
    file += block;
  }
  return file;
}

struct Header {
  double resolution = 0.5;
  std::uint8_t pruning = 1, increments = 0, policy = 0;
  double accuracy = 0.9;
  std::vector<std::string> names = {"a", "b"};
  std::uint32_t numFolds = 0;
  std::uint64_t numNodes = 0;
};

std::string contentOf(const Header& h, const std::string& nodes = {}) {
  std::string bytes;
  append(bytes, h.resolution);
  append(bytes, h.pruning);
  append(bytes, h.increments);
  for (const double x : {h.accuracy, 0.6, 0.1, 0.12, 0.97, 0.001}) append(bytes, x);
  append(bytes, static_cast<std::uint8_t>(h.names.size()));
  for (const std::string& name : h.names) {
    append(bytes, static_cast<std::uint16_t>(name.size()));
    bytes += name + "rgb";
  }
  append(bytes, h.policy);
  append(bytes, h.numFolds);
  append(bytes, h.numNodes);
  return bytes + nodes;
}

}  // namespace

TEST(CraftedTreeFile, ofSenselessHeadersIsRefused) {
  const TemporaryFolder folder;
  const auto error = [&](const Header& h, const std::string& nodes = {}) {
    return loadError(folder, fileAround(contentOf(h, nodes)));
  };
  const auto with = [](auto change) {
    Header h;
    change(h);
    return h;
  };
  EXPECT_EQ(error({}), "");
  EXPECT_TRUE(contains(error(with([](Header& h) { h.resolution = -1; })), "resolution"));
  EXPECT_TRUE(contains(error(with([](Header& h) { h.resolution = NAN; })), "resolution"));
  EXPECT_TRUE(contains(error(with([](Header& h) { h.pruning = 2; })), "pruning"));
  EXPECT_TRUE(contains(error(with([](Header& h) { h.increments = 7; })), "increments"));
  EXPECT_TRUE(contains(error(with([](Header& h) { h.accuracy = 3; })), "accuracy"));
  EXPECT_TRUE(contains(error(with([](Header& h) { h.names = {}; })), "number of classes"));
  EXPECT_TRUE(contains(error(with([](Header& h) { h.names = {"a", "a"}; })), "two classes"));
  EXPECT_TRUE(contains(error(with([](Header& h) { h.policy = 2; })), "unknown raw id"));
  EXPECT_TRUE(contains(error(with([](Header& h) { h.numFolds = 4000000000u; })), "altered"));
  EXPECT_TRUE(contains(error({}, "more"), "more content"));
}

TEST(CraftedTreeFile, ofBrokenNodesIsRefused) {
  const TemporaryFolder folder;
  const auto error = [&](std::uint64_t numNodes, const std::string& nodes) {
    Header h;
    h.numNodes = numNodes;
    return loadError(folder, fileAround(contentOf(h, nodes)));
  };
  const auto bytes = [](auto... values) {
    std::string b;
    (append(b, values), ...);
    return b;
  };
  using u8 = std::uint8_t;
  using u16 = std::uint16_t;
  EXPECT_EQ(error(1, bytes(u8(1), 0.5f)), "");
  EXPECT_EQ(error(2, bytes(u8(3), u16(1), 0.5f)), "");
  EXPECT_EQ(error(1, bytes(u8(2), 0.5f, u8(1), -1.f, u8(2), 1.f)), "");
  EXPECT_TRUE(contains(error(1, ""), "ends too early"));
  EXPECT_TRUE(contains(error(1, bytes(u8(0))), "no root"));
  EXPECT_TRUE(contains(error(1, bytes(u8(4))), "node kind"));
  EXPECT_TRUE(contains(error(1, bytes(u8(1), NAN)), "not finite"));
  EXPECT_TRUE(contains(error(1, bytes(u8(3), u16(0))), "without children"));
  EXPECT_TRUE(contains(error(3, bytes(u8(3), u16(1), 0.5f)), "2 nodes, expected 3"));
  EXPECT_TRUE(contains(error(~0ull, bytes(u8(3), u16(1), 0.5f)), "nodes, expected"));
  EXPECT_TRUE(contains(error(1, bytes(u8(2), 0.5f, u8(3), -1.f, u8(2), 1.f)), "named classes"));
  EXPECT_TRUE(contains(error(1, bytes(u8(2), 0.5f, u8(1), -1.f, u8(3), 1.f)), "class = 3"));
  std::string chain = bytes(u8(3));
  for (int i = 0; i < 17; ++i) chain += bytes(u16(3));
  EXPECT_TRUE(contains(error(18, chain), "16 levels"));
}
