#include "MapCells.h"

#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <array>

namespace map_pictures {

using semantic_octree::SemanticOcTree;

namespace {

/** More than that are smaller than a pixel. */
constexpr std::size_t kMostCells = 600'000;

bool isInPart(const Cube& cube, const Eigen::AlignedBox2d& part, double voxelSize) {
  const Eigen::Vector2d center = cube.center(voxelSize).head<2>();
  const Eigen::Vector2d nearest = center.cwiseMax(part.min()).cwiseMin(part.max());
  return (nearest - center).cwiseAbs().maxCoeff() < voxelSize * cube.edge() / 2;
}

/** The largest depth at which there are not too many cells, and how many there are at most. Of a
 * map in tiles, each tile comes in once at most. \param takes whether a node is worth a look */
template <class Takes>
std::pair<int, std::size_t> depthToDraw(const SemanticOcTree& tree, const Takes& takes) {
  std::array<std::size_t, semantic_octree::kTreeDepth + 1> cells{};  // at each depth
  int deepest = semantic_octree::kTreeDepth;
  forEachNode(tree, [&](const SemanticOcTree::Node& node, const Cube& cube) {
    if (!takes(node, cube)) return false;
    const int last = node.isLeaf() ? deepest : cube.depth;
    for (int depth = cube.depth; depth <= last; ++depth) ++cells[depth];
    while (deepest > 1 && cells[deepest] > kMostCells) --deepest;
    return cube.depth < deepest;
  });
  return {deepest, cells[deepest]};
}

MapCell cellOf(const Cube& cube, double voxelSize) {
  const Eigen::Array3i middle = cube.lowest + cube.edge() / 2;
  return {semantic_octree::octomapKey(middle.x(), middle.y(), middle.z()),
          static_cast<unsigned>(cube.depth), cube.center(voxelSize).cast<float>(),
          float(voxelSize * cube.edge()), semantic_types::kNoClass};
}

/** Room below a ceiling, m. */
constexpr float kRoom = 1.2f;
/** Ceilings are that flat: most of it within these, m. */
constexpr float kFlat = 0.4f;

/** The two uppermost surfaces of one column, m: centers of their highest cells. */
struct Column {
  float top = -std::numeric_limits<float>::infinity(), next = top;

  void add(float z) {
    if (z > top) std::swap(z, top);
    if (top - z > kRoom) next = std::max(next, z);
  }
};

/** Heights of what hangs over something with room between. */
std::vector<float> hangingSurfaces(const std::vector<MapCell>& cells, std::size_t& columns) {
  std::unordered_map<std::uint32_t, Column> byPlace;
  for (const MapCell& cell : cells)
    byPlace[std::uint32_t(cell.key[0]) << 16 | cell.key[1]].add(cell.center.z());
  columns = byPlace.size();
  std::vector<float> heights;
  for (const auto& [place, column] : byPlace)
    if (column.next > -std::numeric_limits<float>::infinity()) heights.push_back(column.top);
  return heights;
}

/** The lowest height at which a flat surface of a room's size begins; heights are sorted. */
float lowestFlatSurface(const std::vector<float>& heights, std::size_t size) {
  for (std::size_t i = 0; i + size <= heights.size(); ++i)
    if (heights[i + size - 1] - heights[i] < kFlat / 2) return heights[i];
  return heights.front();
}

/** The height under the lowest ceiling, if the map is of an indoor place. It is if most columns end
 * in a surface at nearly one height with room to stand below. Infinite otherwise. */
double heightUnderCeiling(const std::vector<MapCell>& cells) {
  constexpr double kNone = std::numeric_limits<double>::infinity();
  std::size_t columns = 0;
  std::vector<float> heights = hangingSurfaces(cells, columns);
  if (columns == 0 || heights.size() * 2 < columns) return kNone;
  std::sort(heights.begin(), heights.end());
  const float lower = heights[heights.size() / 5], upper = heights[heights.size() * 4 / 5];
  if (upper - lower > kFlat) return kNone;
  return lowestFlatSurface(heights, std::max<std::size_t>(1, columns / 20)) - kFlat / 2;
}

void cutOff(MapCells& map, const PictureStyle& style) {
  map.maxHeight = style.maxHeight ? *style.maxHeight : heightUnderCeiling(map.cells);
  if (style.maxAboveGround) {
    map.maxAboveGround = *style.maxAboveGround;
    for (const MapCell& cell : map.cells) map.ground.add(cell.center, cell.size);
  }
  const auto above = [&map](const MapCell& cell) { return map.isCutOff(cell.center); };
  map.cells.erase(std::remove_if(map.cells.begin(), map.cells.end(), above), map.cells.end());
}

}  // namespace

std::vector<std::size_t> MapCells::countClasses(int numClasses) const {
  std::vector<std::size_t> count(numClasses + 1, 0);
  for (const MapCell& cell : cells) ++count[cell.id];
  return count;
}

MapCells collectCells(const SemanticOcTree& tree, const PictureStyle& style,
                      const std::optional<Eigen::AlignedBox2d>& part) {
  MapCells map;
  const auto takes = [&](const SemanticOcTree::Node& node, const Cube& cube) {
    return tree.isNodeOccupied(node) && (!part || isInPart(cube, *part, tree.getResolution()));
  };
  const auto [depth, most] = depthToDraw(tree, takes);
  map.depth = static_cast<unsigned>(depth);
  map.cells.reserve(most);
  forEachNode(tree, [&](const SemanticOcTree::Node& node, const Cube& cube) {
    if (!takes(node, cube)) return false;
    if (!node.isLeaf() && cube.depth < static_cast<int>(map.depth)) return true;
    MapCell cell = cellOf(cube, tree.getResolution());
    cell.id = tree.query(node).likeliestClass;
    map.cells.push_back(cell);
    return false;
  });
  cutOff(map, style);
  return map;
}

Extent extentOf(const std::vector<MapCell>& cells) {
  constexpr double kFar = 0.002;
  Extent extent;
  std::vector<float> values(cells.size());
  for (int axis = 0; axis < 3; ++axis) {
    const auto edges = [&](float sign) {
      for (std::size_t i = 0; i < cells.size(); ++i)
        values[i] = cells[i].center[axis] + sign * cells[i].size / 2;
    };
    edges(-1), extent.low[axis] = quantile(values, kFar);
    edges(+1), extent.high[axis] = quantile(values, 1 - kFar);
  }
  return extent;
}

namespace {

/** Means around each pixel. */
cv::Mat averaged(const cv::Mat& values, int radius) {
  cv::Mat mean;
  cv::boxFilter(values, mean, CV_32F, cv::Size(2 * radius + 1, 2 * radius + 1));
  return mean;
}

/** The heights, and 0 where nothing is known. */
cv::Mat knownHeights(const cv::Mat& height, const cv::Mat& known) {
  cv::Mat values = height.clone();
  values.setTo(0, ~known);
  return values;
}

/** 1 where something is known, else 0. */
cv::Mat weightOf(const cv::Mat& known) {
  cv::Mat weight;
  known.convertTo(weight, CV_32F, 1.0 / 255);
  return weight;
}

/** Mean of the known heights around each pixel. Maps may be large: as little as can be is in memory
 * at a time. */
cv::Mat meanAround(const cv::Mat& height, int radius) {
  const cv::Mat known = height == height;
  cv::Mat mean = averaged(knownHeights(height, known), radius);
  cv::Mat weight = averaged(weightOf(known), radius);
  cv::max(weight, 1e-6, weight);
  cv::divide(mean, weight, mean);
  return mean;
}

float heightAt(const cv::Mat& height, int row, int col, float otherwise) {
  row = std::clamp(row, 0, height.rows - 1), col = std::clamp(col, 0, height.cols - 1);
  const float h = height.at<float>(row, col);
  return std::isnan(h) ? otherwise : h;
}

/** Rise towards the lower right, of which the light from the upper left shows more. */
double slopeFromLight(const cv::Mat& height, int row, int col, double cell) {
  const float h = height.at<float>(row, col);
  return (heightAt(height, row + 1, col + 1, h) - heightAt(height, row - 1, col - 1, h)) /
         (2 * M_SQRT2 * cell);
}

cv::Vec3b shaded(const cv::Vec3b& color, double brightness) {
  cv::Vec3b out;
  for (int i = 0; i < 3; ++i) {
    const double c = brightness <= 1 ? color[i] * brightness
                                     : 255 - (255 - color[i]) * std::max(0.0, 2 - brightness);
    out[i] = cv::saturate_cast<std::uint8_t>(c);
  }
  return out;
}

/** Shades an image of columns by their heights, as maps do: lit from the upper left, and what
 * stands out of its surroundings brighter than what lies low. \param color BGR \param height 32 bit
 * float, m, NaN where there is nothing \param cell m */
void shadeByRelief(cv::Mat& color, const cv::Mat& height, double cell) {
  constexpr double kLight = 0.25, kProminence = 0.2;
  constexpr double kSurroundings = 2.0, kStep = 1.5;  // m
  const cv::Mat mean = meanAround(height, std::max(1, int(kSurroundings / cell)));
  for (int row = 0; row < height.rows; ++row)
    for (int col = 0; col < height.cols; ++col) {
      const float h = height.at<float>(row, col);
      if (std::isnan(h)) continue;
      const double light = kLight * std::tanh(slopeFromLight(height, row, col, cell));
      const double prominence = kProminence * std::tanh((h - mean.at<float>(row, col)) / kStep);
      auto& c = color.at<cv::Vec3b>(row, col);
      c = shaded(c, 1 + light + prominence);
    }
}

/** Cells of that many columns are coarse; and a hatch has a stripe every so many columns. */
constexpr int kCoarse = 4, kStripes = 4;

}  // namespace

cv::Rect columnsUnder(const Eigen::Vector2d& center, double size, double edge) {
  const int width = std::max(1, int(std::lround(size / edge)));
  return {int(std::lround((center.x() - size / 2) / edge)),
          int(std::lround((center.y() - size / 2) / edge)), width, width};
}

HighestCells::HighestCells(const cv::Rect& columns, double edge)
    : m_columns(columns),
      m_edge(edge),
      m_height(columns.size(), CV_32F, cv::Scalar(NAN)),
      m_classId(columns.size(), CV_8U, cv::Scalar(0)),
      m_coarse(columns.size(), CV_8U, cv::Scalar(0)) {}

void HighestCells::add(const Eigen::Vector3d& center, double size, semantic_types::ClassId id) {
  const cv::Rect covered = columnsUnder(center.head<2>(), size, m_edge);
  const cv::Rect seen = covered & m_columns;
  const float top = float(center.z() + size / 2);
  for (int y = seen.y; y < seen.br().y; ++y)
    for (int x = seen.x; x < seen.br().x; ++x) {
      const cv::Point pixel(x - m_columns.x, m_columns.br().y - 1 - y);
      float& height = m_height.at<float>(pixel);
      if (height >= top) continue;
      height = top;
      m_classId.at<std::uint8_t>(pixel) = id;
      m_coarse.at<std::uint8_t>(pixel) = covered.width >= kCoarse;
    }
}

std::vector<std::size_t> HighestCells::countClasses(int numClasses) const {
  std::vector<std::size_t> counts(numClasses + 1, 0);
  const cv::Mat known = m_height == m_height;
  for (int id = 0; id <= numClasses; ++id)
    counts[id] = std::size_t(cv::countNonZero((m_classId == id) & known));
  return counts;
}

cv::Mat HighestCells::inColors(const semantic_types::ClassTable& classes) const {
  cv::Mat_<cv::Vec3b> picture(m_height.size());
  for (int row = 0; row < picture.rows; ++row)
    for (int col = 0; col < picture.cols; ++col) {
      const auto color = std::isnan(m_height.at<float>(row, col))
                             ? kPaper
                             : colorOf(m_classId.at<std::uint8_t>(row, col), classes);
      picture(row, col) = {color.b, color.g, color.r};
    }
  return picture;
}

cv::Mat HighestCells::inRelief(const semantic_types::ClassTable& classes) const {
  cv::Mat_<cv::Vec3b> picture = inColors(classes);
  for (int row = 0; row < picture.rows; ++row)
    for (int col = 0; col < picture.cols; ++col)
      if (m_coarse.at<std::uint8_t>(row, col))
        picture(row, col) = hatched(picture(row, col), col, row, kStripes);
  shadeByRelief(picture, m_height, m_edge);
  return picture;
}

}  // namespace map_pictures
