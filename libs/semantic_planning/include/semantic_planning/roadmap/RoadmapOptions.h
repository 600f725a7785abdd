#pragma once
#include <strict_files/OptionList.h>

#include <cstddef>

namespace semantic_planning {

/** Where a roadmap's vertices come from. */
enum class GraphKind {
  Compressed,     ///< ground in the leaves of the map's compressed tree
                  ///< (setAbstraction()); large ones have several points
  Leaves,         ///< the same, one point a leaf and one heading that looks random, as published
  Halton,         ///< a Halton sequence; samples off the ground or in the way are dropped
  HaltonDrivable  ///< the same, and goes on until there are as many drivable vertices as asked for
};

/** "compressed", "leaves", "halton", "halton_drivable". */
const strict_files::Choices<GraphKind>& choicesOf(GraphKind);
const char* nameOf(GraphKind kind);
/** Whether a kind's points lie in leaves of the compressed tree, which the map then has to keep. */
bool isOfTree(GraphKind kind);

/** How a roadmap is made. */
struct RoadmapOptions {
  GraphKind kind = GraphKind::Compressed;
  /** Vertices, start and goal not counted; of Halton, samples. 0: all that Compressed and
   * Leaves have, 1000 for the others. */
  std::size_t vertices = 1000;
  /** Vertices lie within this distance from the line between start and goal, meters. */
  double buffer = 30;

  // For studies and tests, without a name in files.
  /** Each vertex is connected with that many nearest ones in Reeds-Shepp distance, and with six
   * more for each doubling of `vertices` beyond 1000. */
  int neighbors = 10;
  /** Most edges, start's and goal's not counted, also after updates; 0: as many as the nearest
   * neighbors give. Every vertex's nearest go first. */
  std::size_t maxEdges = 0;
  /** Another value gives other vertices of the same kind. */
  unsigned seed = 0;

  static constexpr double kLongestEdge = 15;  ///< meters

  void describe(strict_files::OptionList& list);
  /** \throw std::invalid_argument naming the option and its value. */
  void validate() const;
};

}  // namespace semantic_planning
