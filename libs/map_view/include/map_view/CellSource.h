#pragma once
#include <map_view/CellLook.h>
#include <map_view/LiveCompression.h>

#include <functional>

namespace map_view {

/** The cells of a map, or of its compressed tree, as a view wants them. */
class CellSource {
 public:
  using Visit = std::function<void(const ViewCell&)>;

  explicit CellSource(const SemanticOcTree& map) : m_map(map) {}
  virtual ~CellSource() = default;
  CellSource(const CellSource&) = delete;
  CellSource& operator=(const CellSource&) = delete;

  const SemanticOcTree& map() const { return m_map; }

  /** Calls visit(cell) for all cells in a box that are shown. Finer ones than a depth are drawn
   * together: a cube of this depth stands for them, occupied if one of them is. Unknown are cubes
   * of which nothing is known. */
  virtual void forEachShown(const KeyBox& box, int maxDepth, const CellLook& look,
                            const Visit& visit) const = 0;
  /** The cell that holds a voxel; where that is unknown, the largest unknown cube. */
  virtual ViewCell at(const Eigen::Array3i& key) const = 0;

 protected:
  const SemanticOcTree& m_map;
};

/** The leaves of the map. */
class FullCells : public CellSource {
 public:
  using CellSource::CellSource;
  void forEachShown(const KeyBox& box, int maxDepth, const CellLook& look,
                    const Visit& visit) const override;
  ViewCell at(const Eigen::Array3i& key) const override;
};

/** The leaves of the compressed tree. */
class CompressedCells : public CellSource {
 public:
  /** Both must outlive it. */
  CompressedCells(const SemanticOcTree& map, const LiveCompression& compression)
      : CellSource(map), m_compression(compression) {}
  void forEachShown(const KeyBox& box, int maxDepth, const CellLook& look,
                    const Visit& visit) const override;
  ViewCell at(const Eigen::Array3i& key) const override;

 private:
  const LiveCompression& m_compression;
};

/** Calls f(cell) for the occupied leaves of a map. */
void forEachOccupiedLeaf(const SemanticOcTree& map, const CellSource::Visit& f);

}  // namespace map_view
