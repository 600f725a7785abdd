#include "DriveViews.h"

#include <labeled_cloud/LabelImage.h>
#include <mrpt/core/format.h>
#include <mrpt/obs/CObservation3DRangeScan.h>
#include <mrpt_compat/Drawing.h>
#include <semantic_octree/Keys.h>
#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

#include "label_overlay/LabelOverlay.h"

namespace semantic_map_drive {

using map_pictures::Arrow;
using map_pictures::MapCanvas;
using map_pictures::Stroke;
using mrpt::math::TPose2D;
using namespace semantic_driving;
using namespace semantic_planning;

namespace {

constexpr Stroke kPath{kPathColor, 2, 2}, kTrack{{20, 20, 20}, 2, 2};
constexpr Arrow kStart{{40, 150, 40}, 18, 2}, kGoal{kGoalColor, 18, 2};

void drawTrack(MapCanvas& canvas, const DriveRecord& record) {
  std::vector<Eigen::Vector2d> line;
  for (const DriveRow& row : record.rows) line.emplace_back(row.pose.x, row.pose.y);
  if (line.empty()) return;
  canvas.drawLine(line, kTrack);
  canvas.explain({"driven", kTrack});
}

void drawRoute(MapCanvas& canvas, const PathTracker& tracker) {
  std::vector<Eigen::Vector2d> line;
  for (const PathPoint& p : tracker.path().points())
    if (p.arcLength >= tracker.progress()) line.emplace_back(p.x, p.y);
  if (line.size() < 2) return;
  canvas.drawLine(line, kPath);
  canvas.explain({"path", kPath});
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

const map_pictures::LegendEntry kLeft{"may still tell something", kLeftColor};

/** In shades of what wholly unknown space promises. That is the same pink in all frames, while the
 * robot learns what to expect. */
void shadeWhatIsLeft(MapCanvas& canvas, const Eigen::AlignedBox2d& part, DriveLoop& loop) {
  constexpr double kFar = 1000, kOfUnknown = 0.35, kMost = 0.85, kLeast = 0.01;  // m, shares
  const double anywhere = loop.leftToSee(part.max().x() + kFar, part.max().y());
  if (anywhere <= 0) return;
  const double voxel = loop.mapper().map().getResolution(), edge = 2 * voxel;
  const Eigen::Vector2d low = (part.min().array() / edge).floor() * edge;
  for (double x = low.x() + voxel; x < part.max().x(); x += edge)
    for (double y = low.y() + voxel; y < part.max().y(); y += edge) {
      const double left = loop.leftToSee(x - voxel / 2, y - voxel / 2);
      const double share = std::min(kMost, kOfUnknown * left / anywhere);
      if (share >= kLeast) canvas.fillSquare({x, y}, edge, kLeftColor, share);
    }
  canvas.explain(kLeft);
}

void drawDrive(MapCanvas& canvas, const DriveLoop& loop) {
  drawTrack(canvas, loop.record());
  drawRoute(canvas, loop.controller().tracker());
  canvas.drawPose(loop.start(), kStart, "start");
  if (!loop.explores()) canvas.drawPose(loop.goal(), kGoal, "goal");
  drawRobot(canvas, loop);
}

Eigen::AlignedBox2d grown(const Eigen::AlignedBox2d& box, double meters) {
  return {box.min().array() - meters, box.max().array() + meters};
}

/** Made of whole voxels. */
Eigen::AlignedBox2d wholeVoxels(const Eigen::AlignedBox2d& box, double voxel) {
  return {((box.min().array() / voxel).floor() * voxel).matrix(),
          ((box.max().array() / voxel).ceil() * voxel).matrix()};
}

}  // namespace

std::string caption(const DriveLoop& loop) {
  const DriveRecord& record = loop.record();
  const double speed = record.rows.empty() ? 0 : record.rows.back().speed;
  return mrpt::format("%.0f s  %.0f m  %.1f m/s  to: %s", loop.time(), record.length, speed,
                      loop.explores() ? "a place to look from" : nameOf(loop.guide().target()));
}

Eigen::AlignedBox2d around(const TPose2D& pose, double meters) {
  const Eigen::Vector2d place(pose.x, pose.y);
  return {place.array() - meters, place.array() + meters};
}

void DrivePicture::include(const DriveRecord& record) {
  for (const DriveRow& row : record.rows) m_region.extend(around(row.pose, 3));
}

/** Each voxel is a whole number of pixels: sharp, and nothing flickers from frame to frame. */
MapCanvas DrivePicture::drawMap(const Eigen::AlignedBox2d& part, DriveLoop& loop) const {
  const semantic_octree::SemanticOcTree& map = loop.mapper().map();
  const double voxel = map.getResolution();
  const Eigen::AlignedBox2d whole = wholeVoxels(m_region, voxel),
                            drawn = wholeVoxels(part, voxel).intersection(whole);
  const double pixels = std::ceil(m_longerEdge * voxel / whole.sizes().maxCoeff());
  const Eigen::Array2d size = (drawn.sizes().array() / voxel).round() * pixels;
  MapCanvas canvas(drawn, cv::Size(int(size.x()), int(size.y())));
  map_pictures::PictureStyle style;
  style.maxAboveGround = kCutAbove;
  style.maxHeight = std::numeric_limits<double>::infinity();  // a part of it is no room
  canvas.drawMapAround(map, style);
  if (m_showsLeft) shadeWhatIsLeft(canvas, drawn, loop);
  return canvas;
}

MapCanvas DrivePicture::draw(DriveLoop& loop) const {
  MapCanvas canvas = drawMap(m_region, loop);
  drawDrive(canvas, loop);
  return canvas;
}

/** A voxel changes how the ground within 3 m and what stands on it is drawn, and the relief 2 m
 * around that. Known ground says something about unknown ground within 10 m. */
void DrivePicture::follow(DriveLoop& loop) {
  constexpr double kBeside = 3;  // m
  constexpr int kTile = 8;       // voxels
  const double kChanged = m_showsLeft ? 11 : 6, voxel = loop.mapper().map().getResolution();
  if (!m_changes) m_changes = loop.follow();
  const semantic_octree::TileChange change = m_changes->tiles();
  if (change.all) m_map = drawMap(m_region, loop);
  if (change.all || change.tiles.empty()) return;
  Eigen::AlignedBox2d tiles;
  for (const octomap::OcTreeKey& tile : change.tiles) {
    const Eigen::Array2d low = Eigen::Array2d(tile[0], tile[1]) - semantic_octree::kKeyOfOrigin;
    tiles.extend((low * voxel).matrix()).extend(((low + kTile) * voxel).matrix());
  }
  m_map->paste(drawMap(grown(tiles, kChanged + kBeside), loop), grown(tiles, kChanged));
}

cv::Mat DrivePicture::frame(DriveLoop& loop) {
  constexpr int kBelow = 64;  // pixels
  follow(loop);
  MapCanvas canvas = m_map->blank();
  canvas.paste(*m_map, m_region);
  drawDrive(canvas, loop);
  const auto& classes = loop.mapper().map().classes();
  std::vector<std::size_t> all(classes.size() + 1, 1);
  all[0] = 0;
  auto legend = map_pictures::classLegend(classes, all);
  if (m_showsLeft) legend.push_back(kLeft);
  legend.push_back({"driven", kTrack});
  legend.push_back({"path", kPath});
  legend.push_back({"start", kStart});
  if (!loop.explores()) legend.push_back({"goal", kGoal});
  legend.push_back({"robot", kRobotColor});
  cv::Mat picture;
  cv::copyMakeBorder(canvas.picture(), picture, 0, kBelow, 0, 0, cv::BORDER_CONSTANT,
                     map_pictures::bgr(map_pictures::kPaper));
  cv::Mat below = picture.rowRange(canvas.picture().rows, picture.rows);
  map_pictures::drawScaleBar(below, canvas.pixelsPerMeter());
  return map_pictures::withTitle(map_pictures::withLegend(picture, {}, legend), caption(loop));
}

using mrpt::math::TPoint3D;
using mrpt::math::TPoint3Df;
using namespace mrpt_compat::drawing;

namespace {

constexpr double kLift = 0.3;    // m: bands lie above the voxels of the ground
constexpr float kWidth = 0.16f;  // m
constexpr semantic_types::Color kTrackColor{250, 210, 40};

mrpt::img::TColor mrptColor(const semantic_types::Color& c) { return {c.r, c.g, c.b}; }

/** From the south, as wide as the way is long. */
map_window::Beginning beginningFor(const synthetic_world::World& world, const TPose2D& start,
                                   const TPose2D& goal) {
  map_window::Beginning beginning;
  const double z = world.groundHeight(goal.x, goal.y);
  map_view::OrbitCamera& camera = beginning.camera.emplace();
  camera.target = {(start.x + goal.x) / 2, (start.y + goal.y) / 2, z};
  camera.azimuth = -90, camera.elevation = 50;
  camera.distance = 1.5 * std::hypot(start.x - goal.x, start.y - goal.y) + 20;
  beginning.style.clip.max().z() = std::max(z, world.groundHeight(start.x, start.y)) + kCutAbove;
  return beginning;
}

TPoint3Df raised(double x, double y, double z) { return {float(x), float(y), float(z + kLift)}; }

/** Flat bands: many drivers draw lines one pixel wide whatever they are asked for. Each triangle
 * has its color: CSetOfTriangles::setColor_u8() calls itself without end in MRPT 2.7.0 to 2.15.19.
 */
CSetOfTriangles::Ptr bandAlong(const std::vector<TPoint3Df>& points,
                               const semantic_types::Color& color) {
  const auto band = CSetOfTriangles::Create();
  for (std::size_t i = 1; i < points.size(); ++i) {
    const TPoint3Df a = points[i - 1], b = points[i], along = b - a;
    if (along.norm() < 1e-6) continue;
    const TPoint3Df aside = TPoint3Df(-along.y, along.x, 0) * (kWidth / 2 / along.norm());
    for (TTriangle half :
         {TTriangle(a - aside, b - aside, b + aside), TTriangle(a - aside, b + aside, a + aside)}) {
      half.setColor(mrptColor(color));
      band->insertTriangle(half);
    }
  }
  band->enableLight(false);
  band->cullFaces(TCullFace::NONE);
  return band;
}

CSetOfTriangles::Ptr trackOf(const DriveLoop& loop) {
  std::vector<TPoint3Df> points;
  for (const DriveRow& row : loop.record().rows)
    points.push_back(raised(row.pose.x, row.pose.y, row.z));
  return bandAlong(points, kTrackColor);
}

/** What is left of it. */
CSetOfTriangles::Ptr pathOf(const DriveLoop& loop) {
  const semantic_driving::PathTracker& tracker = loop.controller().tracker();
  std::vector<TPoint3Df> points;
  for (const semantic_planning::PathPoint& p : tracker.path().points())
    if (p.arcLength >= tracker.progress()) points.push_back(raised(p.x, p.y, p.z));
  return bandAlong(points, kPathColor);
}

CPolyhedron::Ptr robotOf(const DriveLoop& loop) {
  const semantic_planning::VehicleOptions& vehicle = loop.config().planner.vehicle;
  std::vector<mrpt::math::TPoint2D> outline;
  for (const Eigen::Vector2d& p : vehicle.footprint) outline.emplace_back(p.x(), p.y());
  const auto robot = CPolyhedron::CreateCustomPrism(outline, vehicle.height);
  robot->setColor_u8(mrptColor(kRobotColor));
  robot->setPose(mrpt::poses::CPose3D(
      mrpt::math::CMatrixDouble44(Eigen::Matrix4d(loop.T_world_robot().matrix()))));
  return robot;
}

/** What the last step of each stage took. */
std::vector<std::string> stageTimes(const DriveRecord& record) {
  const auto text = [&](std::initializer_list<const char*> stages) {
    std::string line;
    for (const char* stage : stages) {
      const auto times = record.times.find(stage);
      if (times == record.times.end() || times->second.empty()) continue;
      line += (line.empty() ? "" : ", ") + mrpt::format("%s %.1f", stage, times->second.back());
    }
    return line.empty() ? line : line + " ms";
  };
  return {text({"localize", "insert", "update"}), text({"replan", "obstacles", "react"})};
}

/** What a camera saw, with its labels; none of a LiDAR. */
std::optional<mrpt::img::CImage> pictureOf(const Observation& seen,
                                           const semantic_types::ClassTable& classes) {
  const auto* scan = dynamic_cast<const mrpt::obs::CObservation3DRangeScan*>(seen.original.get());
  if (!scan) return {};
  const auto labels = labeled_cloud::EmbeddedLabels(classes).label(*scan);
  return label_overlay::labeledImage({scan->intensityImage, *labels, {}, {}}, classes);
}

CCylinder::Ptr postAt(const TPoint3D& place) {
  const auto post = CCylinder::Create(0.12f, 0.12f, 3.f);
  post->setLocation(place);
  post->setColor_u8(mrptColor(kGoalColor));
  return post;
}

}  // namespace

LiveWindow::LiveWindow(const DriveLoop& loop, const synthetic_world::World& world,
                       const TPose2D& start, const TPose2D& goal)
    : m_goal(goal.x, goal.y, world.groundHeight(goal.x, goal.y)),
      m_window(map_window::LiveMap::open("semantic-map-drive", loop.mapper().map(),
                                         beginningFor(world, start, goal))) {}

void LiveWindow::onSensed(const DriveLoop& loop, const std::vector<Observation>& seen) {
  const Eigen::Isometry3d T_map_robot = loop.T_world_robot();
  Eigen::AlignedBox3d box(T_map_robot.translation());
  for (const Observation& o : seen)
    for (const auto& p : o.cloud.points)
      box.extend(T_map_robot * o.T_robot_sensor * p.cast<double>());
  m_window->changed(box);
  for (const Observation& o : seen)
    if (const auto picture = pictureOf(o, loop.mapper().map().classes()))
      m_window->showPicture(*picture);
}

void LiveWindow::onDriven(const DriveLoop& loop) {
  if (!m_window->isOpen()) return;
  auto& marks = m_window->marks();
  marks.clear();
  marks.insert(postAt(m_goal));
  marks.insert(trackOf(loop));
  marks.insert(pathOf(loop));
  marks.insert(robotOf(loop));
  std::vector<std::string> lines = stageTimes(loop.record());
  lines.insert(lines.begin(), caption(loop));
  m_window->say(lines);
  using std::chrono::duration, std::chrono::steady_clock;
  m_due += std::chrono::duration_cast<steady_clock::duration>(
      duration<double>(loop.config().controlPeriod));
  m_due = std::max(m_due, steady_clock::now());
  m_window->show(duration<double>(m_due - steady_clock::now()).count());
}

}  // namespace semantic_map_drive
