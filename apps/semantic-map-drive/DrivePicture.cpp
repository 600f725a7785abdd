#include "DrivePicture.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <opencv2/imgproc.hpp>

namespace semantic_map_drive {

using map_pictures::Arrow;
using map_pictures::MapCanvas;
using map_pictures::Stroke;
using mrpt::math::TPose2D;
using namespace semantic_driving;
using namespace semantic_planning;

namespace {

constexpr Stroke kPath{kPathColor, 2, 2}, kTrack{{20, 20, 20}, 2, 2},
    kOtherTrack{{20, 60, 220}, 2, 2};
constexpr Arrow kStart{{40, 150, 40}, 18, 2}, kGoal{kGoalColor, 18, 2};

Eigen::AlignedBox2d around(const TPose2D& pose, double meters) {
  const Eigen::Vector2d place(pose.x, pose.y);
  return {place.array() - meters, place.array() + meters};
}

void drawTrack(MapCanvas& canvas, const DriveRecord& record, const std::string& name,
               const Stroke& stroke) {
  std::vector<Eigen::Vector2d> line;
  for (const DriveRow& row : record.rows) line.emplace_back(row.pose.x, row.pose.y);
  if (line.empty()) return;
  canvas.drawLine(line, stroke);
  canvas.explain({name, stroke});
}

void drawRoute(MapCanvas& canvas, const PathTracker& tracker) {
  std::vector<Eigen::Vector2d> line;
  for (const PathPoint& p : tracker.path().points())
    if (p.arcLength >= tracker.progress()) line.emplace_back(p.x, p.y);
  if (line.size() < 2) return;
  canvas.drawLine(line, kPath);
  canvas.explain({"path", kPath});
}

void drawEnd(MapCanvas& canvas, const std::string& name, const TPose2D& pose, const Arrow& arrow) {
  canvas.drawPose(pose, arrow);
  canvas.explain({name, arrow});
}

void drawRobot(MapCanvas& canvas, const DriveLoop& loop) {
  std::vector<Eigen::Vector2d> outline;
  for (const Eigen::Vector2d& p : loop.config().planner.vehicle.footprint) {
    const mrpt::math::TPoint2D corner = loop.state().pose.composePoint({p.x(), p.y()});
    outline.emplace_back(corner.x, corner.y);
  }
  canvas.fillOutline(outline, kRobotColor);
  canvas.explain({"robot", kRobotColor});
}

}  // namespace

std::string caption(const DriveLoop& loop) {
  const DriveRecord& record = loop.record();
  char text[120];
  const double speed = record.rows.empty() ? 0 : record.rows.back().speed;
  std::snprintf(text, sizeof text, "%.0f s  %.0f m  %.1f m/s  to: %s", loop.time(), record.length,
                speed, nameOf(loop.guide().target()));
  return text;
}

DrivePicture::DrivePicture(const TPose2D& start, const TPose2D& goal, int longerEdge,
                           bool compressed)
    : m_region(around(start, 12)), m_longerEdge(longerEdge), m_compressed(compressed) {
  m_region.extend(around(goal, 12));
}

void DrivePicture::include(const DriveRecord& record) {
  for (const DriveRow& row : record.rows) m_region.extend(around(row.pose, 3));
}

/** Each voxel is a whole number of pixels: sharp, and nothing flickers from frame to frame. */
MapCanvas DrivePicture::paperFor(double voxel) const {
  const Eigen::Array2d low = (m_region.min().array() / voxel).floor(),
                       high = (m_region.max().array() / voxel).ceil();
  const Eigen::Array2d voxels = high - low;
  const double pixels = std::ceil(m_longerEdge / voxels.maxCoeff());
  return {{(low * voxel).matrix(), (high * voxel).matrix()},
          cv::Size(int(voxels.x() * pixels), int(voxels.y() * pixels))};
}

MapCanvas DrivePicture::draw(const DriveLoop& loop) const {
  MapCanvas canvas = paperFor(loop.mapper().map().getResolution());
  map_pictures::PictureStyle style;
  style.maxAboveGround = kCutAbove;
  if (m_compressed)
    canvas.drawMapAround(loop.compressedMap(), style);
  else
    canvas.drawMapAround(loop.mapper().map(), style);
  drawTrack(canvas, loop.record(), "driven", kTrack);
  drawRoute(canvas, loop.controller().tracker());
  drawEnd(canvas, "start", loop.start(), kStart);
  drawEnd(canvas, "goal", loop.goal(), kGoal);
  drawRobot(canvas, loop);
  return canvas;
}

cv::Mat DrivePicture::frame(const DriveLoop& loop) const {
  constexpr int kBelow = 64;  // pixels
  const MapCanvas canvas = draw(loop);
  const auto& classes = loop.mapper().map().classes();
  std::vector<std::size_t> all(classes.size() + 1, 1);
  all[0] = 0;
  auto legend = map_pictures::classLegend(classes, all);
  for (const map_pictures::LegendEntry& entry :
       std::initializer_list<map_pictures::LegendEntry>{{"driven", kTrack},
                                                        {"path", kPath},
                                                        {"start", kStart},
                                                        {"goal", kGoal},
                                                        {"robot", kRobotColor}})
    legend.push_back(entry);
  if (m_compressed) legend.push_back(map_pictures::coarseCellEntry());
  cv::Mat picture;
  cv::copyMakeBorder(canvas.picture(), picture, 0, kBelow, 0, 0, cv::BORDER_CONSTANT,
                     map_pictures::bgr(map_pictures::kPaper));
  cv::Mat below = picture.rowRange(canvas.picture().rows, picture.rows);
  map_pictures::drawScaleBar(below, canvas.pixelsPerMeter());
  return map_pictures::withTitle(map_pictures::withLegend(picture, {}, legend), caption(loop));
}

cv::Mat DrivePicture::whatIsLeft(DriveLoop& loop) const {
  constexpr double kEdge = 0.4, kMost = 0.2, kLeast = 0.01;  // m, nats in a column
  MapCanvas canvas = paperFor(loop.mapper().map().getResolution());
  map_pictures::PictureStyle style;
  style.maxAboveGround = kCutAbove;
  canvas.drawMapAround(loop.mapper().map(), style);
  for (double x = m_region.min().x(); x < m_region.max().x(); x += kEdge)
    for (double y = m_region.min().y(); y < m_region.max().y(); y += kEdge) {
      const double left = loop.leftToSee(x, y);
      if (left < kLeast) continue;
      canvas.drawThrough(0.85 * std::min(1.0, left / kMost), [&] {
        canvas.fillSquare({x, y}, kEdge, kLeftColor);
      });
    }
  canvas.explain({"may still tell something", kLeftColor});
  drawTrack(canvas, loop.record(), "driven", kTrack);
  drawRobot(canvas, loop);
  return map_pictures::withTitle(canvas.sheet(), caption(loop));
}

void addOtherTrack(MapCanvas& canvas, const DriveRecord& record) {
  drawTrack(canvas, record, "driven before", kOtherTrack);
}

}  // namespace semantic_map_drive
