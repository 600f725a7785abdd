#pragma once
#include <semantic_types/LabeledCloud.h>
#include <strict_files/OutputFiles.h>

#include <optional>

#include "PackedScan.h"

namespace semantic_octree {

/** Keeps bytes in memory or in a file. */
class ScanStorage {
 public:
  /** What was kept; moved, not copied. */
  struct Piece {
    Bytes bytes;  ///< in memory
    std::uint64_t place = 0;
    std::size_t size = 0;
  };

  /** \param folder of the file; none: in memory */
  explicit ScanStorage(const std::optional<std::filesystem::path>& folder) {
    if (folder) m_file.emplace(*folder);
  }

  Piece keep(Bytes bytes) {
    Piece piece{{}, 0, bytes.size()};
    if (m_file) {
      piece.place = m_file->append(bytes.data(), bytes.size());
    } else {
      bytes.shrink_to_fit();
      piece.bytes = std::move(bytes);
    }
    return piece;
  }
  Bytes load(const Piece& piece) const {
    if (!m_file) return piece.bytes;
    Bytes bytes(piece.size);
    m_file->read(piece.place, bytes.data(), bytes.size());
    return bytes;
  }
  /** The piece is not needed any more. */
  void drop(Piece& piece) noexcept {
    if (m_file) m_file->discard(piece.place, piece.size);
    piece = {};
  }
  bool isInMemory() const { return !m_file; }

 private:
  std::optional<strict_files::ScratchFile> m_file;
};

/** All of a cloud, bit for bit. */
Bytes packCloud(const semantic_types::LabeledCloud& cloud);
semantic_types::LabeledCloud unpackCloud(const Bytes& bytes);

}  // namespace semantic_octree
