#include "GridFiles.h"

#include <semantic_octree/Column.h>
#include <semantic_octree/ColumnScan.h>
#include <semantic_octree/Keys.h>
#include <strict_files/StrictYaml.h>
#include <strict_files/TextFile.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <sstream>
#include <stdexcept>
#include <utility>

namespace semantic_map_export {

using semantic_octree::SemanticOcTree;

namespace {

/** x and y keys of the voxels in a leaf. */
cv::Rect keysOf(const SemanticOcTree::leaf_iterator& leaf) {
  const octomap::OcTreeKey lowest = leaf.getIndexKey();
  const int edge = semantic_octree::edgeAtDepth(static_cast<int>(leaf.getDepth()));
  return {lowest[0], lowest[1], edge, edge};
}

/** All columns of a map. */
cv::Rect keysOf(const SemanticOcTree& map) {
  constexpr double kMostCells = 2e8;
  cv::Rect keys;
  for (auto leaf = map.begin_leafs(), end = map.end_leafs(); leaf != end; ++leaf)
    keys |= keysOf(leaf);
  if (keys.empty()) throw std::runtime_error("the map is empty");
  if (double(keys.width) * keys.height > kMostCells)
    throw std::runtime_error("the map is too wide for a grid: crop it, or make it coarser");
  return keys;
}

constexpr float kNowhere = std::numeric_limits<float>::max();

/** Sets the height below which a column has nothing but ghosts (see ColumnTile). */
void findGhosts(const SemanticOcTree& map, const cv::Rect& keys, double low, cv::Mat& heights) {
  using namespace semantic_octree;
  const ColumnScanner scanner(map);
  const int margin = int(low / map.getResolution());
  const Column first = tileOf({keys.x, keys.y}), last = tileOf({keys.br().x - 1, keys.br().y - 1});
  for (int y = first.y; y <= last.y; ++y)
    for (int x = first.x; x <= last.x; ++x) {
      const auto tile = scanner.scan({x, y});
      const Column corner = firstColumnOf({x, y});
      for (int i = 0; i < kTileColumns; ++i) {
        const cv::Point cell(corner.x + i % kTileEdge - keys.x, corner.y + i / kTileEdge - keys.y);
        if (cell.inside({{0, 0}, heights.size()}))
          heights.at<float>(cell) =
              float(lowerBorderOf(tile.floorOf(i, margin), map.getResolution()));
      }
    }
}

/** The lowest occupied voxel of each column: its center. */
cv::Mat lowestOf(const SemanticOcTree& map, const cv::Rect& keys, double low) {
  cv::Mat ghosts(keys.size(), CV_32F), lowest(keys.size(), CV_32F, cv::Scalar(kNowhere));
  findGhosts(map, keys, low, ghosts);
  for (auto leaf = map.begin_leafs(), end = map.end_leafs(); leaf != end; ++leaf) {
    if (!map.isNodeOccupied(*leaf)) continue;
    const cv::Rect under = keysOf(leaf) - keys.tl();
    const auto z = float(leaf.getZ() + (leaf.getSize() - map.getResolution()) / 2);
    lowest(under).setTo(z, (lowest(under) > z) & (ghosts(under) < z));
  }
  return lowest;
}

/** Opening: what is narrower than cars and stands out of its surroundings is gone; holes that are
 * narrower are filled. */
cv::Mat opened(const cv::Mat& lowest, double voxel) {
  constexpr double kWindow = 4;  // m, wider than cars and narrower than hills
  const int window = 2 * int(std::lround(kWindow / voxel / 2)) + 1;
  const cv::Mat square = cv::Mat::ones(window, window, CV_8U);
  cv::Mat low, surface;
  cv::erode(lowest, low, square, {-1, -1}, 1, cv::BORDER_CONSTANT, cv::Scalar(kNowhere));
  low.setTo(-kNowhere, low == kNowhere);
  cv::dilate(low, surface, square, {-1, -1}, 1, cv::BORDER_CONSTANT, cv::Scalar(-kNowhere));
  return surface;
}

/** \param heights above the centers of the ground's voxels, m */
void markObstacles(const SemanticOcTree& map, const cv::Rect& keys,
                   std::pair<double, double> heights, const cv::Mat& ground, cv::Mat& cells) {
  for (auto leaf = map.begin_leafs(), end = map.end_leafs(); leaf != end; ++leaf) {
    const double half = (leaf.getSize() - map.getResolution()) / 2;  // to its voxels' centers
    const cv::Rect under = keysOf(leaf) - keys.tl();
    const bool isOccupied = map.isNodeOccupied(*leaf);
    for (int row = under.y; row < under.br().y; ++row)
      for (int column = under.x; column < under.br().x; ++column) {
        const double above = leaf.getZ() - double(ground.at<float>(row, column));
        if (above + half < heights.first || above - half > heights.second) continue;
        std::uint8_t& cell = cells.at<std::uint8_t>(row, column);
        if (isOccupied || cell != Grid::kLethal) cell = isOccupied ? Grid::kLethal : 0;
      }
  }
}

std::uint8_t grayOf(int cost, CostMode mode) {
  constexpr std::uint8_t kFree = 254, kOccupied = 0, kNeither = 205, kNoCost = 255;
  if (mode == CostMode::Raw)
    return cost == Grid::kUnknown ? kNoCost : static_cast<std::uint8_t>(cost);
  if (mode == CostMode::Scale)
    return static_cast<std::uint8_t>(255 - std::lround(2.55 * std::max(cost, 0)));
  if (cost == Grid::kUnknown) return kNeither;
  return cost == Grid::kLethal ? kOccupied : kFree;
}

}  // namespace

Grid gridOf(const ground_costs::GroundCosts& costs) {
  const auto& box = *costs.box();
  return {costs.voxelSize(),
          costs.borderOf(box.low.x),
          costs.borderOf(box.low.y),
          box.width(),
          box.height(),
          costs.cells()};
}

Grid gridOf(const SemanticOcTree& map, const semantic_planning::VehicleOptions& vehicle,
            std::optional<double> floor) {
  const double voxel = map.getResolution();
  const cv::Rect keys = keysOf(map);
  // Above the center of the ground's voxel; a step of one voxel cannot be told from a slope.
  const double low = std::max(vehicle.stepHeight, voxel) + voxel / 2;
  cv::Mat cells(keys.size(), CV_8U, cv::Scalar(std::uint8_t(Grid::kUnknown)));
  cv::Mat ground(keys.size(), CV_32F, cv::Scalar(floor.value_or(0) - voxel / 2));
  if (!floor) {
    const cv::Mat lowest = lowestOf(map, keys, low);
    ground = opened(lowest, voxel);
    cells.setTo(0, lowest < ground + low);
  }
  markObstacles(map, keys, {low, vehicle.height + voxel / 2}, ground, cells);
  return {voxel,
          semantic_octree::lowerBorderOf(keys.x, voxel),
          semantic_octree::lowerBorderOf(keys.y, voxel),
          keys.width,
          keys.height,
          {cells.datastart, cells.dataend}};
}

mrpt::maps::COccupancyGridMap2D occupancyOf(const Grid& grid) {
  mrpt::maps::COccupancyGridMap2D result;
  result.setSize(float(grid.xMin), float(grid.xMin + grid.width * grid.resolution),
                 float(grid.yMin), float(grid.yMin + grid.height * grid.resolution),
                 float(grid.resolution), 0.5f);
  for (int row = 0; row < grid.height; ++row)
    for (int column = 0; column < grid.width; ++column)
      if (const int cost = grid.at(column, row); cost != Grid::kUnknown)
        result.setCell(column, row, cost == Grid::kLethal ? 0.f : 1.f);
  return result;
}

std::string pictureOf(const Grid& grid, CostMode mode, const std::string& ending) {
  const bool isTransparent = mode == CostMode::Scale;
  cv::Mat picture(grid.height, grid.width, isTransparent ? CV_8UC4 : CV_8UC1);
  for (int row = 0; row < grid.height; ++row)
    for (int column = 0; column < grid.width; ++column) {
      const int cost = grid.at(column, grid.height - 1 - row);
      const std::uint8_t gray = grayOf(cost, mode);
      if (isTransparent)
        picture.at<cv::Vec4b>(row, column) = {gray, gray, gray,
                                              std::uint8_t(cost == Grid::kUnknown ? 0 : 255)};
      else
        picture.at<std::uint8_t>(row, column) = gray;
    }
  std::vector<std::uint8_t> bytes;
  if (!cv::imencode(ending, picture, bytes)) throw std::runtime_error("cannot encode the grid");
  return {bytes.begin(), bytes.end()};
}

std::string yamlOf(const Grid& grid, CostMode mode, const std::string& pictureName) {
  std::ostringstream yaml;
  const strict_files::ClassicNumbers classic(yaml);
  const bool isScaled = mode == CostMode::Scale;
  yaml << "image: " << strict_files::yamlText(pictureName) << "\nmode: "
       << (isScaled                ? "scale"
           : mode == CostMode::Raw ? "raw"
                                   : "trinary")
       << "\nresolution: " << grid.resolution << "\norigin: [" << grid.xMin << ", " << grid.yMin
       << ", 0]\noccupied_thresh: " << (isScaled ? 0.995 : 0.65)
       << "\nfree_thresh: " << (isScaled ? 0.005 : 0.196) << "\nnegate: 0\n";
  return yaml.str();
}

}  // namespace semantic_map_export
