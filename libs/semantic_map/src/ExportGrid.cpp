#include <mrpt/io/CMemoryStream.h>
#include <mrpt/serialization/CArchive.h>
#include <octomap/octomap_utils.h>
#include <semantic_map/MapFiles.h>
#include <strict_files/StrictYaml.h>
#include <strict_files/TextFile.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/imgcodecs.hpp>
#include <ostream>
#include <sstream>
#include <stdexcept>

#include "ExportColumns.h"
#include "ExportGround.h"

namespace semantic_map {

using mrpt::maps::COccupancyGridMap2D;
using semantic_octree::SemanticOcTree;
using semantic_types::ClassId;

namespace {

/** What is between `low` and `high` above the ground of each column. */
class Band {
 public:
  Band(const SemanticOcTree& tree, const ExportColumns& columns, const GridOptions& options)
      : m_options(options),
        m_resolution(columns.resolution()),
        m_ground(groundOf(tree, columns, options)),
        m_most(columns.size(), CV_32F, cv::Scalar(-std::numeric_limits<float>::infinity())),
        m_known(columns.size(), CV_32S, cv::Scalar(0)) {
    for (auto leaf = tree.begin_leafs(), end = tree.end_leafs(); leaf != end; ++leaf)
      if (options.ground.empty() || !isOccupiedBy(options.ground, tree, *leaf))
        add(leaf, columns.under(leaf));
  }

  /** p(occupied); 0.5 if unknown. */
  double occupancy(int row, int col) const {
    const float most = m_most.at<float>(row, col), ground = m_ground.seen.at<float>(row, col);
    if (most > 0) return octomap::probability(most);
    const bool seen = ground > 0 || 2 * m_known.at<int>(row, col) >= voxelsBetween();
    if (!seen) return 0.5;
    return octomap::probability(std::isinf(most) ? -ground : most);
  }

 private:
  int voxelsBetween() const {
    return std::max(1, int((m_options.high - m_options.low) / m_resolution));
  }

  void add(const SemanticOcTree::leaf_iterator& leaf, const cv::Rect& columns) {
    const double half = (leaf.getSize() - m_resolution) / 2;
    for (int row = columns.y; row < columns.br().y; ++row)
      for (int col = columns.x; col < columns.br().x; ++col)
        if (const int voxels = voxelsInside(leaf.getZ() - half, leaf.getZ() + half,
                                            m_ground.height.at<float>(row, col))) {
          m_known.at<int>(row, col) += voxels;
          float& most = m_most.at<float>(row, col);
          most = std::max(most, leaf->getLogOdds());
        }
  }

  /** How many voxels of a column, with centers from bottom to top, are in the band. */
  int voxelsInside(double bottom, double top, double ground) const {
    const double from = std::max(bottom, ground + m_options.low - kTiny);
    const double to = std::min(top, ground + m_options.high + kTiny);
    if (!(to >= from)) return 0;  // also where the ground is not known
    const int first = int(std::ceil((from - bottom) / m_resolution - kTiny));
    const int last = int(std::floor((to - bottom) / m_resolution + kTiny));
    return last - first + 1;
  }

  static constexpr double kTiny = 1e-5;  ///< heights are kept in single precision, m
  const GridOptions& m_options;
  double m_resolution;
  ExportGround m_ground;
  cv::Mat m_most;   ///< highest log-odds
  cv::Mat m_known;  ///< number of known voxels
};

}  // namespace

void GridOptions::describe(strict_files::OptionList& list) {
  list.add("low", low, "m", "what lies that far above the ground obstructs");
  list.add("high", high, "m", "what lies above this height does not, more than low");
  list.add("floor", floor, "m", strict_files::Range(), "height of a ground that is flat");
}

void GridOptions::validate() const {
  strict_files::checkOptions(*this, "GridOptions");
  strict_files::require(high > low, "GridOptions::high", high, "more than low");
}

COccupancyGridMap2D gridOf(const SemanticOcTree& tree, const GridOptions& options) {
  options.validate();
  for (const ClassId id : options.ground)
    strict_files::require(tree.classes().contains(id), "ground", id, "a class of the map");
  const ExportColumns columns(tree);
  const Band band(tree, columns, options);
  const double left = columns.upperLeft().x, top = columns.upperLeft().y;
  const int width = columns.size().width, height = columns.size().height;
  COccupancyGridMap2D grid;
  grid.setSize(float(left), float(left + width * columns.resolution()),
               float(top - height * columns.resolution()), float(top), float(columns.resolution()),
               0.5f);
  for (int row = 0; row < height; ++row)
    for (int col = 0; col < width; ++col)
      grid.setCell(col, height - 1 - row, float(1 - band.occupancy(row, col)));
  return grid;
}

void writeGridMap(std::ostream& out, const COccupancyGridMap2D& grid) {
  mrpt::io::CMemoryStream bytes;
  mrpt::serialization::archiveFrom(bytes) << grid;
  out.write(reinterpret_cast<const char*>(bytes.getRawBufferData()),
            std::streamsize(bytes.getTotalBytesCount()));
  if (!out) throw std::runtime_error("cannot write the grid");
}

MapServerFiles mapServerFiles(const COccupancyGridMap2D& grid, const std::string& pngName) {
  constexpr int kOccupied = 0, kFree = 254, kUnknown = 205;
  cv::Mat_<std::uint8_t> picture(int(grid.getSizeY()), int(grid.getSizeX()));
  for (int row = 0; row < picture.rows; ++row)
    for (int col = 0; col < picture.cols; ++col) {
      const float free = grid.getCell(col, picture.rows - 1 - row);
      picture(row, col) = std::uint8_t(free < 0.49f ? kOccupied : free > 0.51f ? kFree : kUnknown);
    }
  std::vector<std::uint8_t> png;
  if (!cv::imencode(".png", picture, png)) throw std::runtime_error("cannot encode the grid");
  std::ostringstream yaml;
  const strict_files::ClassicNumbers classic(yaml);
  yaml << "image: " << strict_files::yamlText(pngName) << "\nresolution: " << grid.getResolution()
       << "\norigin: [" << grid.getXMin() << ", " << grid.getYMin()
       << ", 0]\noccupied_thresh: 0.65\nfree_thresh: 0.196\nnegate: 0\n";
  return {std::string(png.begin(), png.end()), yaml.str()};
}

}  // namespace semantic_map
