#include <mrpt/io/CMemoryStream.h>
#include <mrpt/serialization/CArchive.h>
#include <octomap/octomap_utils.h>
#include <semantic_map/MapFiles.h>
#include <semantic_octree/Column.h>
#include <semantic_octree/ColumnScan.h>
#include <semantic_octree/Keys.h>
#include <semantic_octree/SemanticOcTree.h>
#include <strict_files/StrictYaml.h>
#include <strict_files/TextFile.h>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <ostream>
#include <sstream>
#include <stdexcept>
#include <string>

namespace semantic_map {

using mrpt::maps::COccupancyGridMap2D;
using semantic_octree::SemanticOcTree;
using semantic_types::ClassId;

namespace {

constexpr double kMostColumns = 2e8;

/** x and y keys of the voxels in a leaf. */
cv::Rect keysOf(const SemanticOcTree::leaf_iterator& leaf) {
  const octomap::OcTreeKey lowest = leaf.getIndexKey();
  const int edge = semantic_octree::edgeAtDepth(static_cast<int>(leaf.getDepth()));
  return {lowest[0], lowest[1], edge, edge};
}

/** The vertical columns of voxels over (or under) the leaves of a map: the pixels of what is made
 * of it from above. Pixel (0, 0) is at the least x and the largest y. */
class ExportColumns {
 public:
  /** Columns of all leaves.
   * \throw std::runtime_error there are none, or more than a grid can hold. */
  explicit ExportColumns(const SemanticOcTree& tree) : m_resolution(tree.getResolution()) {
    for (auto leaf = tree.begin_leafs(), end = tree.end_leafs(); leaf != end; ++leaf)
      m_keys |= keysOf(leaf);
    if (m_keys.empty()) throw std::runtime_error("the map is empty");
    if (double(m_keys.width) * m_keys.height > kMostColumns)
      throw std::runtime_error("the map is too wide for a grid, " + std::to_string(m_keys.width) +
                               " x " + std::to_string(m_keys.height) +
                               " voxels: crop it, or make it coarser");
  }

  cv::Size size() const { return m_keys.size(); }
  /** Edge of a column, m. */
  double resolution() const { return m_resolution; }
  /** Outer corner of pixel (0, 0), m. */
  cv::Point2d upperLeft() const {
    return {semantic_octree::lowerBorderOf(m_keys.x, m_resolution),
            semantic_octree::lowerBorderOf(m_keys.br().y, m_resolution)};
  }
  /** Keys of a pixel's column. */
  semantic_octree::Column columnAt(int row, int col) const {
    return {m_keys.x + col, m_keys.br().y - 1 - row};
  }
  /** The columns that a leaf covers, at least in part in the picture. */
  cv::Rect under(const SemanticOcTree::leaf_iterator& leaf) const {
    const cv::Rect keys = keysOf(leaf);
    const cv::Rect pixels(keys.x - m_keys.x, m_keys.br().y - keys.br().y, keys.width, keys.height);
    return pixels & cv::Rect({0, 0}, size());
  }

 private:
  double m_resolution;
  cv::Rect m_keys;  ///< x and y keys of the columns
};

/** Whether a leaf is occupied and of one of these classes (any, if there are none). */
bool isOccupiedBy(const std::vector<ClassId>& classes, const SemanticOcTree& tree,
                  const SemanticOcTree::Node& leaf) {
  if (leaf.getLogOdds() <= 0) return false;
  if (classes.empty()) return true;
  return std::count(classes.begin(), classes.end(), tree.query(leaf).likeliestClass) > 0;
}

/** The ground under each column. */
struct ExportGround {
  /** Height of its voxel's center, m, 32 bit float; NaN where it is not known. */
  cv::Mat height;
  /** Log-odds of the ground's voxel where it was seen in this very column, else 0. */
  cv::Mat seen;
};

constexpr float kNowhere = std::numeric_limits<float>::max();

/** Height below which a column has nothing but ghosts (see ColumnTile), m. */
cv::Mat floorsOf(const SemanticOcTree& tree, const ExportColumns& columns, double low) {
  using semantic_octree::Column;
  const semantic_octree::ColumnScanner scanner(tree);
  const int margin = int(low / columns.resolution());
  cv::Mat floors(columns.size(), CV_32F);
  const Column first = semantic_octree::tileOf(columns.columnAt(floors.rows - 1, 0));
  const Column last = semantic_octree::tileOf(columns.columnAt(0, floors.cols - 1));
  const Column upperLeft = columns.columnAt(0, 0);
  for (int y = first.y; y <= last.y; ++y)
    for (int x = first.x; x <= last.x; ++x) {
      const auto tile = scanner.scan({x, y});
      const Column corner = semantic_octree::firstColumnOf({x, y});
      for (int i = 0; i < semantic_octree::kTileColumns; ++i) {
        const cv::Point pixel(corner.x + i % semantic_octree::kTileEdge - upperLeft.x,
                              upperLeft.y - corner.y - i / semantic_octree::kTileEdge);
        if (pixel.inside({{0, 0}, floors.size()}))
          floors.at<float>(pixel) =
              float(semantic_octree::lowerBorderOf(tile.floorOf(i, margin), columns.resolution()));
      }
    }
  return floors;
}

/** The lowest leaf of each column that may be ground. */
struct LowestLeaves {
  cv::Mat floor, height, logOdds;

  /** \param floors what is below them does not count */
  explicit LowestLeaves(const cv::Mat& floors)
      : floor(floors),
        height(floors.size(), CV_32F, cv::Scalar(kNowhere)),
        logOdds(floors.size(), CV_32F, cv::Scalar(0)) {}

  void add(const cv::Rect& columns, float z, float leafLogOdds) {
    const cv::Mat higher = (height(columns) > z) & (floor(columns) < z);
    height(columns).setTo(z, higher);
    logOdds(columns).setTo(leafLogOdds, higher);
  }
};

LowestLeaves lowestLeaves(const SemanticOcTree& tree, const ExportColumns& columns,
                          const GridOptions& options) {
  LowestLeaves lowest(floorsOf(tree, columns, options.low));
  for (auto leaf = tree.begin_leafs(), end = tree.end_leafs(); leaf != end; ++leaf)
    if (isOccupiedBy(options.ground, tree, *leaf))
      lowest.add(columns.under(leaf),
                 float(leaf.getZ() + (leaf.getSize() - columns.resolution()) / 2),
                 leaf->getLogOdds());
  return lowest;
}

/** Opening: what is narrower than the window and stands out of its surroundings is gone; holes that
 * are narrower are filled. */
cv::Mat opened(const cv::Mat& height, int window) {
  const cv::Mat square = cv::Mat::ones(window, window, CV_8U);
  cv::Mat low, surface;
  cv::erode(height, low, square, {-1, -1}, 1, cv::BORDER_CONSTANT, cv::Scalar(kNowhere));
  low.setTo(-kNowhere, low == kNowhere);
  cv::dilate(low, surface, square, {-1, -1}, 1, cv::BORDER_CONSTANT, cv::Scalar(-kNowhere));
  surface.setTo(std::nanf(""), surface == -kNowhere);
  return surface;
}

ExportGround groundOf(const SemanticOcTree& tree, const ExportColumns& columns,
                      const GridOptions& options) {
  if (options.floor)
    return {cv::Mat(columns.size(), CV_32F, cv::Scalar(*options.floor)),
            cv::Mat(columns.size(), CV_32F, cv::Scalar(0))};
  LowestLeaves lowest = lowestLeaves(tree, columns, options);
  // What stands out of its surroundings is no ground: the surface is opened (morphologically) by a
  // square that is wider than cars and narrower than hills.
  constexpr double kWindow = 4;  // m
  const int window = 2 * int(std::lround(kWindow / columns.resolution() / 2)) + 1;
  const cv::Mat height = opened(lowest.height, window);
  lowest.logOdds.setTo(0, lowest.height > height + options.low);
  return {height, lowest.logOdds};
}

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
  list.add("low", low, "m", "lowest obstacle above the ground");
  list.add("high", high, "m", "highest obstacle above the ground, more than low");
  list.add("floor", floor, "m", strict_files::Range(), "height of the ground, if it is flat");
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
