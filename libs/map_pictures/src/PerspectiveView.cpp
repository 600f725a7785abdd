#include <map_pictures/MapCanvas.h>
#include <mrpt_compat/Drawing.h>
#include <mrpt_compat/Images.h>

#include <cmath>
#include <opencv2/imgproc.hpp>
#include <stdexcept>

#include "CameraFit.h"
#include "MapCells.h"
#include "VoxelMesh.h"

namespace map_pictures {

using mrpt_compat::Scene;
using semantic_octree::SemanticOcTree;

namespace {

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
