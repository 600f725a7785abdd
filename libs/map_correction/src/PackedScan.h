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

  /** To be filled at the end of bytes, then endTile(). */
  Bytes& beginTile(std::uint64_t code) {
    m_begin = m_bytes.size();
    appendTo(m_bytes, code << kSizeBits);
    return m_bytes;
  }
  void endTile() {
    const std::uint64_t size = m_bytes.size() - m_begin - sizeof(std::uint64_t);
    const char* at = &m_bytes[m_begin];
    const auto header = takeFrom<std::uint64_t>(at) | size;
    std::memcpy(&m_bytes[m_begin], &header, sizeof header);
  }

  /** Goes from tile to tile. */
  class Reader {
   public:
    explicit Reader(const PackedScan& scan)
        : m_next(scan.m_bytes.data() + kHeaderBytes),
          m_end(scan.m_bytes.data() + scan.m_bytes.size()) {
      next();
    }
    bool atEnd() const { return m_tile.content == nullptr; }
    const PackedTile& tile() const { return m_tile; }
    void next() {
      m_tile = {};
      if (m_next == m_end) return;
      const auto header = takeFrom<std::uint64_t>(m_next);
      m_tile = {header >> kSizeBits, m_next, header & ((std::uint64_t(1) << kSizeBits) - 1)};
      m_next += m_tile.size;
    }

   private:
    const char *m_next, *m_end;
    PackedTile m_tile{};
  };

 private:
  static constexpr std::size_t kHeaderBytes = 1 + sizeof(LabelReliability);
  static constexpr int kSizeBits = 24;  // 512 soft labels of 255 classes fit

  Bytes m_bytes;
  std::size_t m_begin = 0;
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
/** The tiles of a scan that are among others. \param f is called with each PackedTile */
template <typename F>
void forEachTileIn(const PackedScan& scan, const TileCodes& wanted, const F& f) {
  PackedScan::Reader reader(scan);
  for (auto code = wanted.begin(); code != wanted.end() && !reader.atEnd();) {
    if (reader.tile().code == *code) f(reader.tile());
    if (reader.tile().code < *code)
      reader.next();
    else
      ++code;
  }
}

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
