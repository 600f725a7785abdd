#include <map_pictures/MapCanvas.h>
#include <mrpt_compat/Drawing.h>
#include <mrpt_compat/Images.h>
#include <semantic_types/ClassTable.h>
#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "MapCells.h"

namespace map_pictures {

using mrpt_compat::Scene;
using mrpt_compat::drawing::CSetOfTriangles;
using mrpt_compat::drawing::TTriangle;
using semantic_octree::SemanticOcTree;

namespace {

/** A pinhole camera in the map. */
struct PictureCamera {
  /** Axes of the camera (right, down, forward) as columns, and where it is, m. */
  Eigen::Matrix3d R_map_camera;
  Eigen::Vector3d position;
  /** Pixels; the principal point is the picture's middle. */
  double focalLength;
  int width, height;
  /** Depths between which nearly all cells are, m. */
  double near, far;
};

constexpr double kRadians = M_PI / 180;
/** Horizontal angle of view: little perspective, so that distances compare. */
constexpr double kAngleOfView = 40 * kRadians;
/** Share of the picture that stays free at each side. */
constexpr double kBorder = 0.03;
/** Cells beyond it on each side of the picture may be cut off. */
constexpr double kFar = 0.001;

Eigen::Matrix3d orientation(const Viewpoint& viewpoint) {
  const double h = viewpoint.heading * kRadians, t = viewpoint.tilt * kRadians;
  const Eigen::Vector3d forward(std::cos(t) * std::cos(h), std::cos(t) * std::sin(h), -std::sin(t));
  const Eigen::Vector3d right(std::sin(h), -std::cos(h), 0);
  Eigen::Matrix3d R;
  R << right, forward.cross(right), forward;
  return R;
}

/** Along one axis of the picture, the offset and the least distance D at which all points are seen.
 * A point is s sideways and d deep: |s - offset| <= slope (d + D). */
struct AxisFit {
  double distance, offset;
};
AxisFit fitAxis(const std::vector<Eigen::Vector3d>& points, int axis, double slope) {
  std::vector<double> values(points.size());
  const auto extreme = [&](double sign) {
    std::transform(points.begin(), points.end(), values.begin(),
                   [&](const Eigen::Vector3d& p) { return sign * p[axis] - slope * p.z(); });
    return quantile(values, 1 - kFar);
  };
  const double right = extreme(+1), left = -extreme(-1);
  return {(right - left) / (2 * slope), (right + left) / 2};
}

/** The nearest camera with the viewpoint's direction that sees nearly all of the cells. */
PictureCamera fitCamera(const std::vector<MapCell>& cells, const Viewpoint& viewpoint, int width,
                        int height) {
  PictureCamera camera;
  camera.R_map_camera = orientation(viewpoint);
  camera.width = width, camera.height = height;
  camera.focalLength = width / 2.0 / std::tan(kAngleOfView / 2);

  std::vector<Eigen::Vector3d> points;
  for (const MapCell& cell : cells)
    points.push_back(camera.R_map_camera.transpose() * cell.center.cast<double>());
  const double slope = (1 - 2 * kBorder) / camera.focalLength;
  const AxisFit horizontal = fitAxis(points, 0, slope * width / 2);
  const AxisFit vertical = fitAxis(points, 1, slope * height / 2);

  std::vector<double> depths(points.size());
  std::transform(points.begin(), points.end(), depths.begin(), [](const auto& p) { return p.z(); });
  const double nearest = quantile(depths, kFar), farthest = quantile(depths, 1 - kFar);
  const double size = cells.front().size;
  const double distance = std::max({horizontal.distance, vertical.distance, 2 * size - nearest});
  camera.position =
      camera.R_map_camera * Eigen::Vector3d(horizontal.offset, vertical.offset, -distance);
  camera.near = std::max(0.1 * size, 0.2 * (nearest + distance));
  camera.far = 3 * (farthest + distance) + size;
  return camera;
}

struct Face {
  Eigen::Vector3i normal, u, v;  ///< u x v = normal
  float brightness;
};

const std::array<Face, 6> kFaces = {{{{0, 0, 1}, {1, 0, 0}, {0, 1, 0}, 1.0f},
                                     {{0, 0, -1}, {0, 1, 0}, {1, 0, 0}, 0.5f},
                                     {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, 0.8f},
                                     {{-1, 0, 0}, {0, 0, 1}, {0, 1, 0}, 0.8f},
                                     {{0, 1, 0}, {0, 0, 1}, {1, 0, 0}, 0.66f},
                                     {{0, -1, 0}, {1, 0, 0}, {0, 0, 1}, 0.66f}}};

/** Whether the place beside a cell, of its size, is filled. */
bool isFilled(const SemanticOcTree& tree, const MapCells& map, const MapCell& cell,
              const Eigen::Vector3i& step) {
  if (map.isCutOff(cell.center + step.cast<float>() * cell.size)) return false;
  octomap::OcTreeKey key;
  const int keys = 1 << (tree.getTreeDepth() - cell.depth);
  for (int axis = 0; axis < 3; ++axis) {
    const int k = cell.key[axis] + step[axis] * keys;
    if (k < 0 || k > 0xffff) return false;
    key[axis] = static_cast<octomap::key_type>(k);
  }
  const auto node = tree.search(key, cell.depth);
  return node && tree.isNodeOccupied(node) && (node->isLeaf() || cell.depth == map.depth);
}

/** Two triangles, in a class's color with light from above. */
void addFace(const MapCell& cell, const Face& face, const Color& color, CSetOfTriangles& mesh) {
  const auto shade = [&face](std::uint8_t x) {
    return static_cast<std::uint8_t>(float(x) * face.brightness + 0.5f);
  };
  // Corners in the order that turns to the left seen from outside.
  constexpr std::array<std::array<int, 2>, 4> kCorners = {{{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}};
  std::array<TTriangle::Vertex, 4> corners;
  for (int i = 0; i < 4; ++i) {
    const auto [su, sv] = kCorners[i];
    const Eigen::Vector3f p =
        cell.center + cell.size / 2 * (face.normal + su * face.u + sv * face.v).cast<float>();
    corners[i].xyzrgba.pt = {p.x(), p.y(), p.z()};
    corners[i].normal = {float(face.normal.x()), float(face.normal.y()), float(face.normal.z())};
    corners[i].setColor({shade(color.r), shade(color.g), shade(color.b), 255});
  }
  for (const int second : {1, 2}) {
    TTriangle triangle;
    triangle.vertices = {corners[0], corners[second], corners[second + 1]};
    mesh.insertTriangle(triangle);
  }
}

/** The faces of a map's cells that are not hidden by a neighbor (map frame, m), in the classes'
 * colors (gray: none). */
CSetOfTriangles::Ptr meshOf(const SemanticOcTree& tree, const MapCells& map) {
  const auto mesh = CSetOfTriangles::Create();
  for (const MapCell& cell : map.cells)
    for (const Face& face : kFaces)
      if (!isFilled(tree, map, cell, face.normal))
        addFace(cell, face, colorOf(cell.id, tree.classes()), *mesh);
  mesh->enableLight(false);  // the colors are lit already
  mesh->cullFaces(mrpt_compat::drawing::TCullFace::NONE);
  return mesh;
}

/** What the renderer gives back. */
struct Rendered {
  cv::Mat color;  ///< BGR
  cv::Mat depth;  ///< 32 bit float, m; 0 where nothing is seen
};

Scene sceneOf(const mrpt_compat::drawing::CSetOfTriangles::Ptr& mesh, const PictureCamera& camera) {
  Scene scene;
  scene.insert(mesh);
  mrpt_compat::keepColors(scene);
  const auto viewport = scene.getViewport();
  viewport->setCustomBackgroundColor(
      mrpt::img::TColorf(mrpt::img::TColor(kPaper.r, kPaper.g, kPaper.b)));
  viewport->setViewportClipDistances(float(camera.near), float(camera.far));
  return scene;
}

mrpt_compat::drawing::CCamera mrptCamera(const PictureCamera& camera) {
  mrpt::img::TCamera pinhole;
  pinhole.ncols = camera.width, pinhole.nrows = camera.height;
  pinhole.setIntrinsicParamsFromValues(camera.focalLength, camera.focalLength, camera.width / 2.0,
                                       camera.height / 2.0);
  mrpt::math::CMatrixDouble33 R;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) R(i, j) = camera.R_map_camera(i, j);
  const auto& p = camera.position;

  mrpt_compat::drawing::CCamera c;
  c.setProjectiveFromPinhole(pinhole);
  c.set6DOFMode(true);
  c.setPose(mrpt::poses::CPose3D(R, mrpt::math::CVectorFixedDouble<3>({p.x(), p.y(), p.z()})));
  return c;
}

Rendered render(const Scene& scene, const PictureCamera& camera) {
  mrpt::opengl::CFBORender renderer(camera.width, camera.height);
  mrpt_compat::setCamera(renderer, scene, mrptCamera(camera));
  mrpt::img::CImage image;
  mrpt::math::CMatrixFloat depth;
  renderer.render_RGBD(scene, image, depth);
  Rendered out;
  out.color = mrpt_compat::toOpenCv(image);
  out.depth = cv::Mat(depth.rows(), depth.cols(), CV_32F, depth.data()).clone();
  return out;
}

/** Eye-dome lighting: pixels that lie behind their neighbors are darker, which draws outlines. */
void outlineByDepth(Rendered& picture, int radius) {
  constexpr double kStrength = 4;
  cv::Mat logDepth;
  cv::log(cv::max(picture.depth, 1e-3), logDepth);
  const cv::Point steps[] = {{radius, 0}, {-radius, 0}, {0, radius}, {0, -radius}};
  const cv::Rect all({0, 0}, picture.depth.size());
  for (int row = 0; row < all.height; ++row)
    for (int col = 0; col < all.width; ++col) {
      if (picture.depth.at<float>(row, col) <= 0) continue;
      double behind = 0;
      for (const cv::Point& step : steps) {
        const cv::Point other = cv::Point(col, row) + step;
        if (!all.contains(other) || picture.depth.at<float>(other) <= 0) continue;
        behind += std::max(0.f, logDepth.at<float>(row, col) - logDepth.at<float>(other));
      }
      picture.color.at<cv::Vec3b>(row, col) *= 0.4 + 0.6 * std::exp(-kStrength * behind);
    }
}

/** The part with something in it, with a border. */
cv::Rect contents(const Rendered& picture, int border) {
  const cv::Mat seen = picture.depth > 0;
  cv::Rect area = cv::boundingRect(seen);
  area -= cv::Point(border, border);
  area += cv::Size(2 * border, 2 * border);
  return area & cv::Rect({0, 0}, picture.depth.size());
}

/** The map's axes as the camera sees them (right, down). */
std::array<cv::Point2d, 3> axesSeenBy(const PictureCamera& camera) {
  std::array<cv::Point2d, 3> axes;
  for (int axis = 0; axis < 3; ++axis)
    axes[axis] = {camera.R_map_camera(axis, 0), camera.R_map_camera(axis, 1)};
  return axes;
}

}  // namespace

cv::Mat renderPerspective(const SemanticOcTree& tree, const PictureStyle& style,
                          const Viewpoint& viewpoint) {
  style.validate();
  viewpoint.validate();
  const MapCells map = collectCells(tree, style);
  if (map.cells.empty()) return cv::Mat(style.height, style.width, CV_8UC3, bgr(kPaper));

  const int finer = std::max(style.width, style.height) <= 4096 ? 2 : 1;
  const PictureCamera camera =
      fitCamera(map.cells, viewpoint, finer * style.width, finer * style.height);
  Rendered rendered = render(sceneOf(meshOf(tree, map), camera), camera);
  outlineByDepth(rendered, finer);
  cv::Mat picture;
  cv::resize(rendered.color(contents(rendered, finer * 24)), picture, {}, 1.0 / finer, 1.0 / finer,
             cv::INTER_AREA);
  drawAxes(picture, axesSeenBy(camera));
  if (!style.legend) return picture;
  return withLegend(picture, style.title,
                    classLegend(tree.classes(), map.countClasses(tree.numClasses())));
}

}  // namespace map_pictures
