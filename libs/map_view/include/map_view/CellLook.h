#pragma once
#include <map_view/ViewCell.h>
#include <semantic_octree/SemanticOcTree.h>
#include <strict_files/OptionList.h>

#include <Eigen/Geometry>
#include <cstdint>
#include <limits>
#include <unordered_map>
#include <vector>

namespace map_view {

using semantic_octree::SemanticOcTree;
using semantic_types::ClassId;
using semantic_types::Color;

/** What the color of an occupied cell says. */
enum class ViewColoring { Class, Probability, Entropy, Occupancy, Height, Retained };
const strict_files::Choices<ViewColoring>& choicesOf(ViewColoring);

class LiveCompression;

/** What a view shows of a map, and how. */
struct ViewStyle {
  ViewColoring coloring = ViewColoring::Class;
  /** K + 1 switches, [0] for cells without a class; empty: all classes are shown. */
  std::vector<bool> hiddenClasses;
  /** Free cells, in pale blue, translucent. */
  bool freeSpace = false;
  /** What is unknown within the bounding box of what is known, in gray, translucent. */
  bool unknownSpace = false;
  /** Cells with their center outside are not shown; m, map frame. */
  Eigen::AlignedBox3d clip = everywhere();

  static Eigen::AlignedBox3d everywhere() {
    const auto far = Eigen::Vector3d::Constant(std::numeric_limits<double>::infinity());
    return {-far, far};
  }

  bool hidesClasses() const;
};

/** Which cells of a map a view shows, and in which colors. Remembers what was found out about inner
 * nodes, until the map changes. */
class CellLook {
 public:
  explicit CellLook(const SemanticOcTree& map);
  /** The map has changed. */
  void forget();

  const ViewStyle& style() const { return m_style; }
  void setStyle(const ViewStyle& style) { m_style = style; }
  /** Whose leaves are shown; null: the map's. It must outlive this, or be taken away before. */
  void setCompression(const LiveCompression* compression) { m_compression = compression; }

  bool isShown(const ViewCell& cell) const;
  /** Voxels with their center within the bounding box of what is known, and not cut off; nothing
   * outside is unknown space. */
  KeyBox bounds() const;
  /** Class: the classes' colors (gray: none). Probability of the likeliest class, entropy of the
   * distribution and occupancy: from red (unsure) over yellow to green (sure). Height: from dark
   * violet (lowest) over green to yellow (highest). Retained of what is worth telling in the cell's
   * block: from red (nothing) to green (all). */
  Color colorOf(const ViewCell& cell) const;
  /** Likeliest class of an occupied cell. */
  ClassId classOf(const ViewCell& cell) const { return stateOf(cell).likeliestClass; }

 private:
  struct State {
    ClassId likeliestClass;
    float probability;
  };
  State stateOf(const ViewCell& cell) const;
  State newState(const ViewCell& cell) const;
  Color heightColor(const ViewCell& cell) const;

  const SemanticOcTree& m_map;
  const LiveCompression* m_compression = nullptr;
  ViewStyle m_style;
  Eigen::AlignedBox3d m_known;  ///< m
  mutable std::unordered_map<std::uint64_t, State> m_inner;
};

}  // namespace map_view
