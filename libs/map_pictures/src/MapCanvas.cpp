#include <map_pictures/MapCanvas.h>

#include <strict_files/OutputFiles.h>
#include <strict_files/TextFile.h>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <optional>
#include <sstream>
#include <stdexcept>

#include "MapCells.h"

namespace map_pictures {

using semantic_octree::SemanticOcTree;

namespace {

/** Edge of a column, m: that of the finest cells, or larger if there would be more columns than
 * memory is for. (One cell may be kilometers wide: a collapsed root.) */
double columnEdge(const Eigen::Vector2d& size, double finest) {
  constexpr double kMostColumns = 16e6;
  double edge = finest;
  while (size.x() / edge * (size.y() / edge) > kMostColumns) edge *= 2;
  return edge;
}

/** The columns that a region touches by more than a rounding error. */
cv::Rect columnsIn(const Eigen::AlignedBox2d& region, double edge) {
  constexpr double kTiny = 1e-3;  // columns
  const auto first = [&](double low) { return int(std::floor(low / edge + kTiny)); };
  const auto end = [&](double high) { return int(std::ceil(high / edge - kTiny)); };
  const cv::Point low(first(region.min().x()), first(region.min().y()));
  const cv::Point high(end(region.max().x()), end(region.max().y()));
  return {low, cv::Size(std::max(1, high.x - low.x), std::max(1, high.y - low.y))};
}

/** Sharp columns if they are larger than pixels, their mean if they are smaller. */
cv::Mat scaledBy(const cv::Mat& image, double scale) {
  const cv::Size target(std::max(1, int(std::lround(image.cols * scale))),
                        std::max(1, int(std::lround(image.rows * scale))));
  const int enlarge = std::max(1, int(std::ceil(scale - 1e-9)));
  cv::Mat large, out;
  cv::resize(image, large, {}, enlarge, enlarge, cv::INTER_NEAREST);
  cv::resize(large, out, target, 0, 0, cv::INTER_AREA);
  return out;
}

cv::Point nearestPixel(const cv::Point2d& p) {
  return {int(std::lround(p.x)), int(std::lround(p.y))};
}

/** Not 0 in the columns of which nothing is known; the first row is that of the largest y. It is
 * empty unless the map is in the plane: one layer of voxels, as a level laser scanner makes it. */
cv::Mat unknownColumns(const SemanticOcTree& tree, const cv::Rect& columns, double edge) {
  cv::Mat unknown(columns.size(), CV_8U, cv::Scalar(255));
  std::optional<int> layer;
  bool isInPlane = true;
  forEachNode(tree, [&](const SemanticOcTree::Node& node, const Cube& cube) {
    if (!isInPlane || !node.isLeaf()) return isInPlane;
    if (!layer) layer = cube.lowest.z();
    isInPlane = cube.edge() == 1 && cube.lowest.z() == *layer;
    const double size = tree.getResolution();
    const cv::Rect seen = columnsUnder(cube.center(size).head<2>(), size, edge) & columns;
    if (!seen.empty())
      unknown({seen.x - columns.x, columns.br().y - seen.br().y, seen.width, seen.height}) = 0;
    return false;
  });
  return isInPlane ? unknown : cv::Mat();
}

/** Copies what fits. \param corner of the image in the picture */
void copyInto(const cv::Mat& image, const cv::Point& corner, cv::Mat& picture) {
  const cv::Rect seen = cv::Rect(corner, image.size()) & cv::Rect({0, 0}, picture.size());
  if (!seen.empty()) image(seen - corner).copyTo(picture(seen));
}

}  // namespace

MapCanvas::MapCanvas(const Eigen::AlignedBox2d& region, const cv::Size& most, int border)
    : m_region(region) {
  const Eigen::Vector2d size = region.isEmpty() ? Eigen::Vector2d(0, 0) : region.sizes();
  m_pixelsPerMeter =
      std::min((most.width - 2 * border) / size.x(), (most.height - 2 * border) / size.y());
  if (!(size.minCoeff() > 0 && m_pixelsPerMeter > 0 && std::isfinite(m_pixelsPerMeter))) {
    std::ostringstream what;
    const strict_files::ClassicNumbers classic(what);
    what << "picture: " << size.x() << " m x " << size.y() << " m do not fit into " << most.width
         << " x " << most.height << " pixels with a border of " << border;
    throw std::invalid_argument(what.str());
  }
  m_origin = {border - region.min().x() * m_pixelsPerMeter,
              border + region.max().y() * m_pixelsPerMeter};
  const auto pixels = [&](double meters) {
    return std::max(1, int(std::lround(meters * m_pixelsPerMeter))) + 2 * border;
  };
  m_picture = cv::Mat(pixels(size.y()), pixels(size.x()), CV_8UC3, bgr(kPaper));
}

MapCanvas MapCanvas::ofMap(const SemanticOcTree& tree, const PictureStyle& style) {
  constexpr int kBorder = 24;
  style.validate();
  const cv::Size size(style.width, style.height);
  const MapCells map = collectCells(tree, style);
  if (map.cells.empty())
    return {Eigen::AlignedBox2d(Eigen::Vector2d(0, 0), Eigen::Vector2d(size.width, size.height)),
            size};
  const Extent extent = extentOf(map.cells);
  const Eigen::Vector2d low = extent.low.head<2>().cast<double>(),
                        high = extent.high.head<2>().cast<double>();
  const double edge = columnEdge(high - low, tree.getNodeSize(map.depth));
  const cv::Rect columns = columnsIn({low, high}, edge);
  MapCanvas canvas({Eigen::Vector2d(columns.x, columns.y) * edge,
                    Eigen::Vector2d(columns.br().x, columns.br().y) * edge},
                   size, kBorder);
  canvas.drawCells(map, tree);
  return canvas;
}

MapCanvas MapCanvas::blank() const {
  MapCanvas canvas;
  canvas.m_region = m_region;
  canvas.m_pixelsPerMeter = m_pixelsPerMeter;
  canvas.m_origin = m_origin;
  canvas.m_picture = cv::Mat(m_picture.size(), CV_8UC3, bgr(kPaper));
  return canvas;
}

void MapCanvas::drawMap(const SemanticOcTree& tree, const PictureStyle& style) {
  style.validate();
  drawCells(collectCells(tree, style), tree);
}

void MapCanvas::drawMapAround(const SemanticOcTree& tree, const PictureStyle& style) {
  constexpr double kBeside = 5;  // m: what is cut off depends on what is beside it
  style.validate();
  const Eigen::Vector2d beside(kBeside, kBeside);
  drawCells(collectCells(tree, style,
                         Eigen::AlignedBox2d(m_region.min() - beside, m_region.max() + beside)),
            tree);
}

void MapCanvas::drawCells(const MapCells& map, const SemanticOcTree& tree) {
  const double edge = columnEdge(m_region.sizes(), tree.getNodeSize(map.depth));
  const cv::Rect columns = columnsIn(m_region, edge);
  HighestCells highest(columns, edge);
  for (const MapCell& cell : map.cells) highest.add(cell.center.cast<double>(), cell.size, cell.id);
  cv::Mat picture = highest.inRelief(tree.classes());
  const cv::Mat unknown = unknownColumns(tree, columns, edge);
  if (!unknown.empty()) picture.setTo(bgr(kUnknown), unknown);
  copyInto(scaledBy(picture, m_pixelsPerMeter * edge),
           nearestPixel(at(columns.x * edge, columns.br().y * edge)), m_picture);
  const auto legend = classLegend(tree.classes(), map.countClasses(tree.numClasses()));
  m_legend.insert(m_legend.begin(), legend.begin(), legend.end());
  if (highest.showsCoarseCells()) explain(coarseCellEntry());
  if (!unknown.empty()) explain({"not known", kUnknown});
}

/** As far as they are in the picture. */
cv::Rect MapCanvas::pixelsOf(const Eigen::Vector2d& low, const Eigen::Vector2d& high) const {
  return cv::Rect(nearestPixel(at(low.x(), high.y())), nearestPixel(at(high.x(), low.y()))) &
         cv::Rect({0, 0}, m_picture.size());
}

void MapCanvas::paste(const MapCanvas& from, const Eigen::AlignedBox2d& part) {
  const cv::Point shift = nearestPixel(from.at(0, 0)) - nearestPixel(at(0, 0));
  const cv::Rect there = cv::Rect({0, 0}, from.m_picture.size()) - shift;
  const cv::Rect seen = pixelsOf(part.min(), part.max()) & there;
  if (!seen.empty()) from.m_picture(seen + shift).copyTo(m_picture(seen));
}

void MapCanvas::fillSquare(const Eigen::Vector2d& center, double edge, const Color& color,
                           double share) {
  cv::Mat part = m_picture(pixelsOf(center.array() - edge / 2, center.array() + edge / 2));
  const cv::Mat filled(part.size(), part.type(), bgr(color));
  cv::addWeighted(filled, share, part, 1 - share, 0, part);
}

void MapCanvas::drawLine(const std::vector<Eigen::Vector2d>& points, const Stroke& stroke) {
  std::vector<cv::Point2d> line;
  for (const Eigen::Vector2d& p : points) line.push_back(at(p.x(), p.y()));
  map_pictures::drawLine(m_picture, line, stroke);
}

void MapCanvas::drawPose(const mrpt::math::TPose2D& pose, const Arrow& arrow,
                         const std::string& name) {
  drawArrow(m_picture, at(pose.x, pose.y), pose.phi, arrow);
  if (!name.empty()) explain({name, arrow});
}

void MapCanvas::fillOutline(const std::vector<Eigen::Vector2d>& corners, const Color& color) {
  std::vector<cv::Point> outline;
  for (const Eigen::Vector2d& p : corners) outline.push_back(nearestPixel(at(p.x(), p.y())));
  cv::fillPoly(m_picture, outline, bgr(color), cv::LINE_AA);
  cv::polylines(m_picture, outline, true, bgr(kInk), 1, cv::LINE_AA);
}

void MapCanvas::drawThrough(double share, const std::function<void()>& draw) {
  const cv::Mat before = m_picture.clone();
  draw();
  cv::addWeighted(m_picture, share, before, 1 - share, 0, m_picture);
}

cv::Mat MapCanvas::withScale() const {
  cv::Mat picture = m_picture.clone(), empty;
  cv::inRange(picture, bgr(kPaper), bgr(kPaper), empty);
  if (cv::countNonZero(empty) == empty.size().area()) return picture;
  const cv::Rect axes =
      drawAxes(picture, {cv::Point2d(1, 0), cv::Point2d(0, -1), cv::Point2d(0, 0)});
  drawScaleBar(picture, m_pixelsPerMeter, axes);
  return picture;
}

using strict_files::above;
using strict_files::between;
using strict_files::checkOptions;
using strict_files::OptionList;

void PictureStyle::describe(OptionList& list) {
  constexpr int kMost = 16384;
  list.add("width", width, "pixels", between(200, kMost),
           "width of the picture without its legend");
  list.add("height", height, "pixels", between(200, kMost), "height of the picture");
  list.add("max_height", maxHeight, "m", strict_files::Range().orInfinite(),
           "higher cells are not drawn; none: all but the ceiling of an indoor map");
}

void PictureStyle::validate() const { checkOptions(*this, "PictureStyle"); }

void Viewpoint::describe(OptionList& list) {
  list.add("heading", heading, "degrees",
           "direction in which the perspective looks, from +x towards +y");
  list.add("tilt", tilt, "degrees", above(0).upTo(90), "how far it looks down");
}

void Viewpoint::validate() const { checkOptions(*this, "Viewpoint"); }

cv::Mat renderTopView(const semantic_octree::SemanticOcTree& tree, const PictureStyle& style) {
  const MapCanvas canvas = MapCanvas::ofMap(tree, style);
  return style.legend ? canvas.sheet(style.title) : canvas.withScale();
}

void savePicture(const cv::Mat& picture, const std::filesystem::path& file) {
  std::vector<std::uint8_t> png;
  if (!cv::imencode(".png", picture, png))
    throw std::runtime_error("cannot encode the picture for '" + file.string() + "'");
  strict_files::writeText(file, {png.begin(), png.end()});
}

namespace {

/** All columns of voxels with something in them. What lies within those that are known already is
 * not looked at. */
cv::Rect occupiedColumns(const SemanticOcTree& tree) {
  constexpr double kMostColumns = 2e8;
  cv::Rect columns;
  forEachNode(tree, [&](const SemanticOcTree::Node& node, const Cube& cube) {
    if (!(node.getLogOdds() > 0)) return false;
    const double voxel = tree.getResolution();
    const cv::Rect own = columnsUnder(cube.center(voxel).head<2>(), voxel * cube.edge(), voxel);
    if ((columns & own) == own) return false;
    if (node.isLeaf()) columns |= own;
    return true;
  });
  if (columns.empty()) throw std::runtime_error("nothing in the map is occupied");
  if (double(columns.width) * columns.height > kMostColumns)
    throw std::runtime_error("the map is too wide for a picture, " + std::to_string(columns.width) +
                             " x " + std::to_string(columns.height) +
                             " voxels: crop it, or make it coarser");
  return columns;
}

HighestCells highestLeaves(const SemanticOcTree& tree, const cv::Rect& columns, double maxHeight) {
  const double voxel = tree.getResolution();
  HighestCells highest(columns, voxel);
  forEachNode(tree, [&](const SemanticOcTree::Node& node, const Cube& cube) {
    if (!(node.getLogOdds() > 0)) return false;
    const Eigen::Vector3d center = cube.center(voxel);
    const double size = voxel * cube.edge();
    if ((columnsUnder(center.head<2>(), size, voxel) & columns).empty()) return false;
    if (!node.isLeaf()) return true;
    if (center.z() <= maxHeight) highest.add(center, size, tree.query(node).likeliestClass);
    return false;
  });
  return highest;
}

/** From top to bottom. They end where tiles do, which so are in one band only, unless there is room
 * for less than a row of tiles. */
std::vector<cv::Rect> bandsOf(const cv::Rect& columns, int columnsAtOnce) {
  int height = 1;
  while (height < columns.height && 2.0 * height * columns.width <= columnsAtOnce) height *= 2;
  std::vector<cv::Rect> bands;
  for (int top = columns.br().y; top > columns.y; top = bands.back().y) {
    const int low = height * int(std::floor(double(top - 1) / height));
    bands.emplace_back(cv::Point(columns.x, std::max(low, columns.y)),
                       cv::Point(columns.br().x, top));
  }
  return bands;
}

/** Pixels along a column's edge, so that a small map is no stamp. */
int enlargement(cv::Size columns) {
  constexpr int kGoodSize = 1000;
  return std::max(1, kGoodSize / std::max(columns.width, columns.height));
}

/** What stands to the right of a map of that height; higher than a low one, so that one column is
 * enough. */
cv::Mat legendBeside(int rows, const std::vector<LegendEntry>& entries) {
  const cv::Mat map(std::max(rows, legendHeight(entries.size())), 1, CV_8UC3, bgr(kPaper));
  const cv::Mat sheet = withLegend(map, "", entries);
  return sheet.colRange(1, sheet.cols).clone();
}

/** \param upperLeft outer corner of pixel (0, 0), m, map frame */
std::string worldFileOf(double metersPerPixel, const cv::Point2d& upperLeft) {
  const cv::Point2d center = upperLeft + cv::Point2d(metersPerPixel, -metersPerPixel) / 2;
  std::ostringstream text;
  const strict_files::ClassicNumbers classic(text);
  text << std::setprecision(12);
  for (const double value : {metersPerPixel, 0.0, 0.0, -metersPerPixel, center.x, center.y})
    text << value << '\n';
  return text.str();
}

}  // namespace

ClassMap drawClassMap(const SemanticOcTree& tree, const std::optional<double>& maxHeight,
                      int columnsAtOnce) {
  const cv::Rect columns = occupiedColumns(tree);
  const double top = maxHeight ? *maxHeight : collectCells(tree, {}).maxHeight;
  std::vector<std::size_t> counts(tree.numClasses() + 1, 0);
  cv::Mat map;
  for (const cv::Rect& band : bandsOf(columns, columnsAtOnce)) {
    const HighestCells highest = highestLeaves(tree, band, top);
    const auto inBand = highest.countClasses(tree.numClasses());
    std::transform(counts.begin(), counts.end(), inBand.begin(), counts.begin(), std::plus<>());
    const cv::Mat rows = highest.inColors(tree.classes());
    if (map.empty()) map.create(columns.size(), rows.type());
    rows.copyTo(map.rowRange(columns.br().y - band.br().y, columns.br().y - band.y));
  }
  const int scale = enlargement(columns.size());
  if (scale > 1) cv::resize(map, map, {}, scale, scale, cv::INTER_NEAREST);
  const cv::Mat legend = legendBeside(map.rows, classLegend(tree.classes(), counts));
  ClassMap drawn;
  cv::copyMakeBorder(map, drawn.picture, 0, legend.rows - map.rows, 0, legend.cols,
                     cv::BORDER_CONSTANT, bgr(kPaper));
  legend.copyTo(drawn.picture.colRange(map.cols, drawn.picture.cols));
  const double edge = tree.getResolution();
  drawn.worldFile = worldFileOf(edge / scale, {columns.x * edge, columns.br().y * edge});
  return drawn;
}

}  // namespace map_pictures
