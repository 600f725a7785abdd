#include "PackedScan.h"

#include <algorithm>

#include "Scan.h"

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

/** Of eight words, which are not 0. */
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
  for (PackedScan::Reader r(scan); !r.atEnd(); r.next()) codes.push_back(r.tile().code);
  return codes;
}

TileCodes differingTiles(const PackedScan& a, const PackedScan& b) {
  TileCodes codes;
  const bool alike = a.labels() == b.labels();
  PackedScan::Reader x(a), y(b);
  while (!x.atEnd() || !y.atEnd()) {
    const std::uint64_t atX = x.atEnd() ? UINT64_MAX : x.tile().code,
                        atY = y.atEnd() ? UINT64_MAX : y.tile().code;
    if (atX != atY || !alike || !x.tile().sameContent(y.tile()))
      codes.push_back(std::min(atX, atY));
    if (atX <= atY) x.next();
    if (atY <= atX) y.next();
  }
  return codes;
}

void HitVotes::pack(std::uint32_t voxel, Bytes& bytes) const {
  if (!m_softCounts.empty()) {
    const float* const soft = softLabelOf(voxel);
    bytes.push_back(soft != nullptr);
    for (int k = 0; soft && k < m_numClasses; ++k) appendTo(bytes, soft[k]);
    return;
  }
  const Result result = votesOf(voxel);
  appendTo(bytes, static_cast<std::uint8_t>(result.numVoted));
  for (std::size_t i = 0; i < result.numVoted; ++i) {
    appendTo(bytes, result.votes[i].id);
    appendCount(bytes, result.votes[i].count);
  }
}

void HitVotes::beginUnpacking(int numClasses) {
  m_numClasses = numClasses;
  m_labels.clear();
  m_endsOfLabels.clear();
  m_softSums.clear();
  m_softCounts.clear();
}

void HitVotes::unpack(const char*& bytes, bool soft) {
  const auto number = takeFrom<std::uint8_t>(bytes);
  if (soft) {
    m_softCounts.push_back(number);
    for (int k = 0; k < m_numClasses; ++k)
      m_softSums.push_back(number ? takeFrom<float>(bytes) : 0.f);
  } else {
    for (int i = 0; i < number; ++i) {
      const auto id = takeFrom<ClassId>(bytes);
      m_labels.insert(m_labels.end(), takeCount(bytes), id);
    }
  }
  m_endsOfLabels.push_back(static_cast<std::uint32_t>(m_labels.size()));
}

PackedScan Scan::pack() const {
  std::vector<std::pair<std::uint64_t, VoxelIndex>> tiles;
  if (hasVoxels())
    m_free[0].forEachTile([&](const VoxelIndex& tile, std::size_t number) {
      if (m_pyramid.tile(number).any()) {
        const VoxelIndex at = m_free[0].firstTile() + tile;
        tiles.emplace_back(tileCode(at), at);
      }
    });
  std::sort(tiles.begin(), tiles.end(),
            [](const auto& a, const auto& b) { return a.first < b.first; });
  PackedScan packed(m_votes.isSoft(), labels());
  for (const auto& [code, at] : tiles) {
    packTile(tile(at), packed.beginTile(code));
    packed.endTile();
  }
  return packed;
}

void Scan::packTile(const Tile& tile, Bytes& bytes) const {
  const std::uint8_t free = wordsWithBits(tile.free), hit = wordsWithBits(tile.hit.words);
  if (std::all_of(tile.free, tile.free + ScanGrid::kWords, [](VoxelBits b) { return !~b; })) return;
  bytes.push_back(static_cast<char>(free));
  bytes.push_back(static_cast<char>(hit));
  appendWords(bytes, tile.free, free);
  appendWords(bytes, tile.hit.words, hit);
  for (int w = 0; w < ScanGrid::kWords; ++w)
    for (int i = 0; i < countOf(tile.hit.words[w]); ++i)
      m_votes.pack(tile.hit.ranks[w] + static_cast<std::uint32_t>(i), bytes);
}

void Scan::unpack(const PackedScan& scan, const TileCodes& wanted, int numClasses,
                  const InsertionOptions& options) {
  m_report = InsertionReport();
  m_report.labels = scan.labels();
  TileBox box;
  forEachTileIn(scan, wanted, [&](const PackedTile& tile) { box.add(tileOf(tile.code)); });
  if (box.empty()) return;
  m_free.resize(1);
  // The box that ends one voxel inside of the outer tiles is the one that has no others.
  m_free[0].cover(box.lowest() * 8 - kKeyOfOrigin + 1, box.highest() * 8 - kKeyOfOrigin + 6,
                  maxTiles(options));
  m_hits.cover(m_free[0].numTilesInAll());
  m_votes.beginUnpacking(numClasses);
  forEachTileIn(scan, wanted, [&](const PackedTile& tile) { unpackTile(tile, scan.isSoft()); });
  m_report.hitVoxels = m_hits.rank();
  summarize();
}

void Scan::unpackTile(const PackedTile& tile, bool soft) {
  const VoxelIndex relative = tileOf(tile.code) - m_free[0].firstTile();
  VoxelBits* const free = m_free[0].words(relative);
  if (tile.size == 0) return void(std::fill_n(free, ScanGrid::kWords, ~VoxelBits(0)));
  const char* bytes = tile.content;
  const auto freeMask = takeFrom<std::uint8_t>(bytes), hitMask = takeFrom<std::uint8_t>(bytes);
  VoxelBits hit[ScanGrid::kWords] = {};
  takeWords(bytes, free, freeMask);
  takeWords(bytes, hit, hitMask);
  if (hitMask) m_hits.add(m_free[0].numberOf(relative), hit);
  for (int w = 0; w < ScanGrid::kWords; ++w)
    for (int i = countOf(hit[w]); i > 0; --i) m_votes.unpack(bytes, soft);
}

}  // namespace semantic_octree
