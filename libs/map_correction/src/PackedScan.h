#pragma once
#include <semantic_octree/store/Scan.h>
#include <semantic_types/LabeledCloud.h>
#include <strict_files/OutputFiles.h>

#include <cstring>

namespace semantic_octree {

using Bytes = std::vector<char>;

template <typename T>
void appendTo(Bytes& bytes, const T& value) {
  const auto* begin = reinterpret_cast<const char*>(&value);
  bytes.insert(bytes.end(), begin, begin + sizeof value);
}
template <typename T>
T takeFrom(const char*& bytes) {
  T value;
  std::memcpy(&value, bytes, sizeof value);
  bytes += sizeof value;
  return value;
}

/** What a scan saw in a tile. */
struct PackedTile {
  std::uint64_t code;
  const char* content;
  std::size_t size;  ///< 0: all voxels are free

  bool sameContent(const PackedTile& o) const {
    return size == o.size && std::memcmp(content, o.content, size) == 0;
  }
};

/** A scan's voxels, tile by tile, ascending: enough to merge the scan or a part of it without
 * following its beams again. It is the same whenever the scan is traced from the same pose. For
 * this process only. */
class PackedScan {
 public:
  PackedScan(bool soft, const LabelReliability& labels) {
    m_bytes.push_back(soft);
    appendTo(m_bytes, labels);
  }
  explicit PackedScan(Bytes bytes) : m_bytes(std::move(bytes)) {}

  /** Whether votes are soft labels. */
  bool isSoft() const { return m_bytes[0]; }
  LabelReliability labels() const {
    const char* at = &m_bytes[1];
    return takeFrom<LabelReliability>(at);
  }
  const Bytes& bytes() const { return m_bytes; }

  void add(std::uint64_t code, const Bytes& content) {
    appendTo(m_bytes, code << kSizeBits | content.size());
    m_bytes.insert(m_bytes.end(), content.begin(), content.end());
  }
  /** What they point to is the scan's. */
  std::vector<PackedTile> tiles() const {
    std::vector<PackedTile> tiles;
    const char *next = m_bytes.data() + kHeaderBytes, *const end = m_bytes.data() + m_bytes.size();
    while (next != end) {
      const auto header = takeFrom<std::uint64_t>(next);
      tiles.push_back({header >> kSizeBits, next, header & ((std::uint64_t(1) << kSizeBits) - 1)});
      next += tiles.back().size;
    }
    return tiles;
  }

 private:
  static constexpr std::size_t kHeaderBytes = 1 + sizeof(LabelReliability);
  static constexpr int kSizeBits = 24;  // 512 soft labels of 255 classes fit

  Bytes m_bytes;
};

/** What is to be kept of a scan to merge it again. */
PackedScan packed(const Scan& scan);
/** Some tiles of a scan that was packed. \param options its memory's limit
 * \param scan whose content is replaced \throw std::length_error the limit is too small. */
void unpack(const PackedScan& packed, const TileCodes& wanted, int numClasses,
            const InsertionOptions& options, Scan& scan);

TileCodes tilesOf(const PackedScan& scan);
/** The tiles in which not the same was seen; all, if labels are not trusted alike. */
TileCodes differingTiles(const PackedScan& a, const PackedScan& b);
/** Keeps bytes in a file. */
class ScanStorage {
 public:
  struct Piece {
    std::uint64_t place = 0;
    std::size_t size = 0;
  };

  explicit ScanStorage(const std::filesystem::path& folder) : m_file(folder) {}

  Piece keep(const Bytes& bytes) {
    return {m_file.append(bytes.data(), bytes.size()), bytes.size()};
  }
  Bytes load(const Piece& piece) const {
    Bytes bytes(piece.size);
    m_file.read(piece.place, bytes.data(), bytes.size());
    return bytes;
  }
  /** The piece is not needed any more. */
  void drop(const Piece& piece) noexcept { m_file.discard(piece.place, piece.size); }

 private:
  strict_files::ScratchFile m_file;
};

/** All of a cloud, bit for bit. */
Bytes packCloud(const semantic_types::LabeledCloud& cloud);
semantic_types::LabeledCloud unpackCloud(const Bytes& bytes);

}  // namespace semantic_octree
