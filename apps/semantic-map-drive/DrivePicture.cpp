#include "DrivePicture.h"

#include <cmath>
#include <opencv2/imgproc.hpp>

namespace semantic_map_drive {

using mrpt::math::TPose2D;
using namespace semantic_driving;
using namespace semantic_planning;

namespace {

constexpr double kAround = 12;     // m around start and goal
constexpr double kBeside = 3;      // m beside a track
constexpr double kCutAbove = 2.5;  // m above the robot: crowns of trees would hide the way
const cv::Scalar kPaper(245, 245, 245), kPath(40, 40, 220), kTrack(20, 20, 20),
    kHalo(255, 255, 255), kStart(40, 150, 40), kGoal(30, 30, 200), kRobot(230, 120, 20);

cv::Scalar colorOf(semantic_types::ClassId id, const semantic_types::ClassTable& classes) {
  if (!classes.contains(id)) return {190, 190, 190};
  const semantic_types::Color c = classes.color(id);
  return cv::Scalar(c.b, c.g, c.r);
}

void drawLine(cv::Mat& picture, const std::vector<cv::Point>& line, const cv::Scalar& color) {
  cv::polylines(picture, line, false, kHalo, 5, cv::LINE_AA);
  cv::polylines(picture, line, false, color, 2, cv::LINE_AA);
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

DrivePicture::DrivePicture(const TPose2D& start, const TPose2D& goal, int size)
    : m_longerEdge(size), m_left(start.x), m_right(start.x), m_bottom(start.y), m_top(start.y) {
  include(start, kAround);
  include(goal, kAround);
  fit();
}

void DrivePicture::include(const DriveRecord& record) {
  for (const DriveRow& row : record.rows) include(row.pose, kBeside);
  fit();
}

void DrivePicture::include(const TPose2D& pose, double margin) {
  m_left = std::min(m_left, pose.x - margin);
  m_right = std::max(m_right, pose.x + margin);
  m_bottom = std::min(m_bottom, pose.y - margin);
  m_top = std::max(m_top, pose.y + margin);
}

void DrivePicture::fit() {
  const double width = m_right - m_left, height = m_top - m_bottom;
  m_scale = m_longerEdge / std::max(width, height);
  m_size = {static_cast<int>(width * m_scale), static_cast<int>(height * m_scale)};
}

cv::Point DrivePicture::pixel(double x, double y) const {
  return {static_cast<int>(std::lround((x - m_left) * m_scale)),
          static_cast<int>(std::lround((m_top - y) * m_scale))};
}

cv::Mat DrivePicture::draw(const DriveLoop& loop) const {
  cv::Mat picture(m_size, CV_8UC3, kPaper);
  drawMap(picture, loop.mapper().map(), loop.T_world_robot().translation().z() + kCutAbove);
  addTrack(picture, loop.record(), kTrack);
  drawRoute(picture, loop);
  drawPose(picture, loop.start(), kStart);
  drawPose(picture, loop.goal(), kGoal);
  drawRobot(picture, loop);
  cv::putText(picture, caption(loop), {8, 18}, cv::FONT_HERSHEY_SIMPLEX, 0.5, kHalo, 4,
              cv::LINE_AA);
  cv::putText(picture, caption(loop), {8, 18}, cv::FONT_HERSHEY_SIMPLEX, 0.5, kTrack, 1,
              cv::LINE_AA);
  return picture;
}

void DrivePicture::drawMap(cv::Mat& picture, const semantic_octree::SemanticOcTree& map,
                           double top) const {
  cv::Mat heights(m_size, CV_32F, cv::Scalar(-1e9));
  const octomap::point3d low(float(m_left), float(m_top - m_size.height / m_scale), -50.f);
  const octomap::point3d high(float(m_left + m_size.width / m_scale), float(m_top), float(top));
  for (auto it = map.begin_leafs_bbx(low, high), end = map.end_leafs_bbx(); it != end; ++it) {
    if (it->getLogOdds() <= 0 || it.getZ() > top) continue;
    const double half = it.getSize() / 2;
    const cv::Rect area(pixel(it.getX() - half, it.getY() + half),
                        pixel(it.getX() + half, it.getY() - half));
    const cv::Rect seen = area & cv::Rect({0, 0}, m_size);
    if (seen.empty() || heights.at<float>(seen.tl()) > float(it.getZ())) continue;
    heights(seen) = float(it.getZ());
    picture(seen) = colorOf(map.query(*it).likeliestClass, map.classes());
  }
}

void DrivePicture::addTrack(cv::Mat& picture, const DriveRecord& record,
                            const cv::Scalar& color) const {
  std::vector<cv::Point> line;
  for (const DriveRow& row : record.rows) line.push_back(pixel(row.pose.x, row.pose.y));
  if (!line.empty()) drawLine(picture, line, color);
}

void DrivePicture::drawRoute(cv::Mat& picture, const DriveLoop& loop) const {
  const PathTracker& tracker = loop.controller().tracker();
  std::vector<cv::Point> line;
  for (const PathPoint& p : tracker.path().points())
    if (p.arcLength >= tracker.progress()) line.push_back(pixel(p.x, p.y));
  if (!line.empty()) drawLine(picture, line, kPath);
}

void DrivePicture::drawPose(cv::Mat& picture, const TPose2D& pose, const cv::Scalar& color) const {
  const double length = 16 / m_scale;
  const cv::Point from = pixel(pose.x, pose.y), to = pixel(pose.x + length * std::cos(pose.phi),
                                                           pose.y + length * std::sin(pose.phi));
  cv::circle(picture, from, 6, kHalo, cv::FILLED, cv::LINE_AA);
  cv::circle(picture, from, 4, color, cv::FILLED, cv::LINE_AA);
  cv::arrowedLine(picture, from, to, color, 2, cv::LINE_AA, 0, 0.4);
}

void DrivePicture::drawRobot(cv::Mat& picture, const DriveLoop& loop) const {
  std::vector<cv::Point> outline;
  for (const Eigen::Vector2d& p : loop.config().planner.vehicle.footprint) {
    const mrpt::math::TPoint2D corner = loop.state().pose.composePoint({p.x(), p.y()});
    outline.push_back(pixel(corner.x, corner.y));
  }
  cv::fillConvexPoly(picture, outline, kRobot, cv::LINE_AA);
  cv::polylines(picture, outline, true, kTrack, 1, cv::LINE_AA);
}

}  // namespace semantic_map_drive
