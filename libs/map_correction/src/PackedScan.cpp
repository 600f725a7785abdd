#include "PackedScan.h"

#include <algorithm>

namespace semantic_octree {
namespace {

/** Numbers are small: seven bits a byte, the eighth says that more follow. */
void appendCount(Bytes& bytes, std::uint32_t count) {
  for (; count >= 0x80; count >>= 7) bytes.push_back(static_cast<char>(count | 0x80));
  bytes.push_back(static_cast<char>(count));
}

std::uint32_t takeCount(const char*& bytes) {
  std::uint32_t count = 0;
  for (int shift = 0;; shift += 7) {
    const auto byte = takeFrom<std::uint8_t>(bytes);
    count |= static_cast<std::uint32_t>(byte & 0x7f) << shift;
    if (byte < 0x80) return count;
  }
}

/** A bit for each of eight words that is not 0. */
std::uint8_t wordsWithBits(const VoxelBits* words) {
  unsigned mask = 0;
  for (int w = 0; w < ScanGrid::kWords; ++w) mask |= unsigned(words[w] != 0) << w;
  return static_cast<std::uint8_t>(mask);
}

void appendWords(Bytes& bytes, const VoxelBits* words, std::uint8_t mask) {
  for (int w = 0; w < ScanGrid::kWords; ++w)
    if (mask >> w & 1) appendTo(bytes, words[w]);
}

void takeWords(const char*& bytes, VoxelBits* words, std::uint8_t mask) {
  for (int w = 0; w < ScanGrid::kWords; ++w)
    if (mask >> w & 1) words[w] = takeFrom<VoxelBits>(bytes);
}

}  // namespace

TileCodes tilesOf(const PackedScan& scan) {
  TileCodes codes;
  for (const PackedTile& tile : scan.tiles()) codes.push_back(tile.code);
  return codes;
}

TileCodes differingTiles(const PackedScan& a, const PackedScan& b) {
  TileCodes codes;
  const bool alike = a.labels() == b.labels();
  const auto tilesOfA = a.tiles(), tilesOfB = b.tiles();
  auto x = tilesOfA.begin(), y = tilesOfB.begin();
  while (x != tilesOfA.end() || y != tilesOfB.end()) {
    const std::uint64_t atX = x == tilesOfA.end() ? UINT64_MAX : x->code,
                        atY = y == tilesOfB.end() ? UINT64_MAX : y->code;
    if (atX != atY || !alike || !x->sameContent(*y)) codes.push_back(std::min(atX, atY));
    if (atX <= atY) ++x;
    if (atY <= atX) ++y;
  }
  return codes;
}

namespace {

void packVotes(const HitVotes& votes, std::uint32_t voxel, Bytes& bytes) {
  if (votes.isSoft()) {
    const float* const soft = votes.softLabelOf(voxel);
    bytes.push_back(soft != nullptr);
    for (int k = 0; soft && k < votes.numClasses(); ++k) appendTo(bytes, soft[k]);
    return;
  }
  const HitVotes::Result result = votes.votesOf(voxel);
  appendTo(bytes, static_cast<std::uint8_t>(result.numVoted));
  for (std::size_t i = 0; i < result.numVoted; ++i) {
    appendTo(bytes, result.votes[i].id);
    appendCount(bytes, result.votes[i].count);
  }
}

void unpackVotes(const char*& bytes, bool soft, HitVotes& votes) {
  const auto number = takeFrom<std::uint8_t>(bytes);
  if (soft) {
    std::vector<float> label(votes.numClasses());
    for (std::size_t k = 0; number && k < label.size(); ++k) label[k] = takeFrom<float>(bytes);
    return votes.add(number ? label.data() : nullptr);
  }
  HitVotes::Result result;
  for (; result.numVoted < number; ++result.numVoted) {
    ClassVotes& of = result.votes[result.numVoted];
    of.id = takeFrom<ClassId>(bytes);
    of.count = takeCount(bytes);
  }
  votes.add(result.votes.data(), result.numVoted);
}

void packTile(const Scan::Tile& tile, const HitVotes& votes, Bytes& bytes) {
  const std::uint8_t free = wordsWithBits(tile.free), hit = wordsWithBits(tile.hit.words);
  if (std::all_of(tile.free, tile.free + ScanGrid::kWords, [](VoxelBits b) { return !~b; })) return;
  bytes.push_back(static_cast<char>(free));
  bytes.push_back(static_cast<char>(hit));
  appendWords(bytes, tile.free, free);
  appendWords(bytes, tile.hit.words, hit);
  for (int w = 0; w < ScanGrid::kWords; ++w)
    for (int i = 0; i < countOf(tile.hit.words[w]); ++i)
      packVotes(votes, tile.hit.ranks[w] + static_cast<std::uint32_t>(i), bytes);
}

void unpackTile(const PackedTile& tile, bool soft, Scan& scan) {
  VoxelBits free[ScanGrid::kWords] = {}, hit[ScanGrid::kWords] = {};
  const char* bytes = tile.content;
  if (tile.size == 0) {
    std::fill_n(free, ScanGrid::kWords, ~VoxelBits(0));
  } else {
    const auto freeMask = takeFrom<std::uint8_t>(bytes), hitMask = takeFrom<std::uint8_t>(bytes);
    takeWords(bytes, free, freeMask);
    takeWords(bytes, hit, hitMask);
  }
  scan.addTile(tileOf(tile.code), free, hit);
  for (int w = 0; w < ScanGrid::kWords; ++w)
    for (int i = countOf(hit[w]); i > 0; --i) unpackVotes(bytes, soft, scan.votes());
}

}  // namespace

PackedScan packed(const Scan& scan) {
  std::vector<std::pair<std::uint64_t, VoxelIndex>> tiles;
  for (const VoxelIndex& tile : scan.tiles()) tiles.emplace_back(tileCode(tile), tile);
  std::sort(tiles.begin(), tiles.end(),
            [](const auto& a, const auto& b) { return a.first < b.first; });
  PackedScan result(scan.votes().isSoft(), scan.labels());
  Bytes content;
  for (const auto& [code, at] : tiles) {
    content.clear();
    packTile(scan.tile(at), scan.votes(), content);
    result.add(code, content);
  }
  return result;
}

void unpack(const PackedScan& packed, const TileCodes& wanted, int numClasses,
            const InsertionOptions& options, Scan& scan) {
  std::vector<PackedTile> tiles = packed.tiles();
  const auto isUnwanted = [&wanted](const PackedTile& tile) {
    return !std::binary_search(wanted.begin(), wanted.end(), tile.code);
  };
  tiles.erase(std::remove_if(tiles.begin(), tiles.end(), isUnwanted), tiles.end());
  if (tiles.empty()) return scan.reset();
  TileBox box;
  for (const PackedTile& tile : tiles) box.add(tileOf(tile.code));
  scan.begin(box, packed.labels(), numClasses, options);
  for (const PackedTile& tile : tiles) unpackTile(tile, packed.isSoft(), scan);
  scan.finish();
}

namespace {

template <typename T>
void appendAll(Bytes& bytes, const std::vector<T>& values) {
  appendTo(bytes, values.size());
  const auto* begin = reinterpret_cast<const char*>(values.data());
  bytes.insert(bytes.end(), begin, begin + values.size() * sizeof(T));
}

template <typename T>
void takeAll(const char*& bytes, std::vector<T>& values) {
  values.resize(takeFrom<std::size_t>(bytes));
  if (values.empty()) return;
  std::memcpy(static_cast<void*>(values.data()), bytes, values.size() * sizeof(T));
  bytes += values.size() * sizeof(T);
}

}  // namespace

Bytes packCloud(const semantic_types::LabeledCloud& cloud) {
  Bytes bytes;
  bytes.reserve(24 + cloud.points.size() * sizeof(Eigen::Vector3f) + cloud.classes.size() +
                cloud.probabilities.size() * sizeof(float));
  appendAll(bytes, cloud.points);
  appendAll(bytes, cloud.classes);
  appendAll(bytes, cloud.probabilities);
  return bytes;
}

semantic_types::LabeledCloud unpackCloud(const Bytes& bytes) {
  semantic_types::LabeledCloud cloud;
  const char* at = bytes.data();
  takeAll(at, cloud.points);
  takeAll(at, cloud.classes);
  takeAll(at, cloud.probabilities);
  return cloud;
}

}  // namespace semantic_octree
