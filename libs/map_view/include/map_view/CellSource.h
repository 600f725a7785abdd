#pragma once
#include <map_view/LiveCompression.h>
#include <semantic_octree/SemanticOcTree.h>
#include <strict_files/OptionList.h>
#include <view_information/BeamInformation.h>

#include <Eigen/Geometry>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

namespace map_view {

using semantic_octree::SemanticOcTree;
using semantic_types::ClassId;
using semantic_types::Color;

/** What the color of an occupied cell says. */
enum class ViewColoring { Class, Probability, Entropy, Occupancy, Height, Gain, Retained };
const strict_files::Choices<ViewColoring>& choicesOf(ViewColoring);

/** The colors of a coloring from one end of its scale to the other. */
struct ColorScale {
  std::string what;                                         ///< "height, m"
  std::string low, high;                                    ///< what the ends mean
  Color (*colorAt)(double) = semantic_types::trafficLight;  ///< of 0 (low) to 1 (high)
};

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
   * violet (lowest) over green to yellow (highest). Gain: what another look tells of the class,
   * from green (nothing) to red (as much as the first look at unknown space). Retained of what is
   * worth telling in the cell's block: from red (nothing) to green (all). */
  Color colorOf(const ViewCell& cell) const;
  /** What these colors mean; none: the classes. */
  std::optional<ColorScale> scale() const;
  /** Likeliest class of an occupied cell. */
  ClassId classOf(const ViewCell& cell) const { return stateOf(cell).likeliestClass; }

 private:
  struct State {
    ClassId likeliestClass;
    float probability;
  };
  State stateOf(const ViewCell& cell) const;
  State newState(const ViewCell& cell) const;
  /** Lowest and highest of what is known and not cut off, m. */
  std::pair<double, double> heights() const;
  /** What a look at it tells, of what a first look does. */
  double gainOf(const semantic_octree::SemanticOcTreeNode& node) const;

  const SemanticOcTree& m_map;
  const view_information::Question m_question;  ///< which class is it
  const view_information::BeamModel m_model;
  const semantic_octree::ClassFilter m_filter;
  const LiveCompression* m_compression = nullptr;
  ViewStyle m_style;
  Eigen::AlignedBox3d m_known;  ///< m
  mutable std::unordered_map<std::uint64_t, State> m_inner;
};

/** The leaves of a map, or of its compressed tree, as a view wants them. */
class CellSource {
 public:
  using Visit = std::function<void(const ViewCell&)>;

  /** Both must outlive it. \param compression null: the leaves of the map */
  explicit CellSource(const SemanticOcTree& map, const LiveCompression* compression = nullptr)
      : m_map(&map), m_compression(compression) {}

  const SemanticOcTree& map() const { return *m_map; }

  /** Calls visit(cell) for all cells in a box that are shown. Finer ones than a depth are drawn
   * together: a cube of this depth stands for them, occupied if one of them is. Unknown are cubes
   * of which nothing is known. */
  void forEachShown(const KeyBox& box, int maxDepth, const CellLook& look,
                    const Visit& visit) const;
  /** The cell that holds a voxel; where that is unknown, the largest unknown cube. */
  ViewCell at(const Eigen::Array3i& key) const;

 private:
  const SemanticOcTree* m_map;
  const LiveCompression* m_compression;
};

/** Calls f(cell) for the occupied leaves of a map. */
void forEachOccupiedLeaf(const SemanticOcTree& map, const CellSource::Visit& f);

/** What the map knows about a cell, in words and numbers for people. */
struct CellAnswer {
  octomap::OcTreeKey key;  ///< of its lowest voxel
  Eigen::Vector3d center;  ///< m, map frame
  double size = 0;         ///< edge, m
  std::string state;       ///< "occupied, road"
  double occupancy = 0;    ///< p(occupied); of a larger cell its most occupied voxel's
  /** A class, or free space, and its share of the cell's distribution. */
  struct Share {
    std::string name;
    ClassId id;  ///< 0: free space
    double probability;
  };
  std::vector<Share> shares;  ///< of 0.0005 and more, the largest first
};

CellAnswer answerOf(const ViewCell& cell, const SemanticOcTree& map);

}  // namespace map_view
