#include "LiveWindow.h"

#include <map_pictures/MapMesh.h>
#include <mrpt/opengl/CCylinder.h>
#include <mrpt/opengl/COpenGLScene.h>
#include <mrpt/opengl/CPolyhedron.h>
#include <mrpt/opengl/CSetOfTriangles.h>

#include <clocale>
#include <cstdlib>
#include <thread>

#include "DrivePicture.h"

namespace semantic_map_drive {

using mrpt::gui::CDisplayWindow3D;
using mrpt::math::TPoint3D;
using mrpt::math::TPoint3Df;
using mrpt::math::TPose2D;
using namespace mrpt::opengl;

namespace {

constexpr double kMapPeriod = 1;  // s: its mesh takes a while
constexpr double kLift = 0.3;     // m: bands lie above the voxels of the ground
constexpr float kWidth = 0.16f;   // m
constexpr semantic_types::Color kTrackColor{250, 210, 40};

mrpt::img::TColor mrptColor(const semantic_types::Color& c) { return {c.r, c.g, c.b}; }

bool hasDisplay() {
  for (const char* name : {"DISPLAY", "WAYLAND_DISPLAY"})
    if (const char* value = std::getenv(name); value && *value) return true;
  return false;
}

CDisplayWindow3D::Ptr openWindow() {
  const std::string what = "--live: there is no display to open a window on";
  if (!hasDisplay()) throw std::runtime_error(what + " (DISPLAY is not set)");
  auto window = CDisplayWindow3D::Create("semantic-map-drive", 1100, 800);
  std::setlocale(LC_NUMERIC, "C");  // GTK has set the user's: commas in numbers
  if (!window->isOpen()) throw std::runtime_error(what);
  return window;
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

TFontParams captionFont() {
  TFontParams font;
  font.vfont_scale = 16;
  font.color = {0.1f, 0.1f, 0.1f};
  return font;
}

CCylinder::Ptr postAt(const TPoint3D& place) {
  const auto post = CCylinder::Create(0.12f, 0.12f, 3.f);
  post->setLocation(place);
  post->setColor_u8(mrptColor(kGoalColor));
  return post;
}

}  // namespace

LiveWindow::LiveWindow(const synthetic_world::World& world, const TPose2D& start,
                       const TPose2D& goal)
    : m_window(openWindow()) {
  const double z = world.groundHeight(goal.x, goal.y);
  CDisplayWindow3D& window = *m_window;
  COpenGLScene::Ptr scene;
  const mrpt::gui::CDisplayWindow3DLocker locker(window, scene);
  scene->getViewport()->setCustomBackgroundColor({0.96f, 0.96f, 0.96f});
  scene->insert(m_map);
  scene->insert(m_drive);
  scene->insert(postAt({goal.x, goal.y, z}));
  window.setCameraPointingToPoint(float(start.x + goal.x) / 2, float(start.y + goal.y) / 2,
                                  float(z));
  window.setCameraAzimuthDeg(-90);  // north is up
  window.setCameraElevationDeg(50);
  window.setCameraZoom(float(1.5 * std::hypot(start.x - goal.x, start.y - goal.y) + 20));
}

void LiveWindow::onSensed(const DriveLoop& loop, const std::vector<Observation>&) {
  if (!m_window->isOpen() || loop.time() < m_nextMap - 1e-6) return;
  m_nextMap = loop.time() + kMapPeriod;
  map_pictures::PictureStyle style;
  style.maxAboveGround = kCutAbove;
  const auto mesh = map_pictures::meshOf(loop.mapper().map(), style);
  const mrpt::gui::CDisplayWindow3DLocker locker(*m_window);
  m_map->clear();
  m_map->insert(mesh);
}

void LiveWindow::onDriven(const DriveLoop& loop) {
  if (!m_window->isOpen()) return;
  {
    const mrpt::gui::CDisplayWindow3DLocker locker(*m_window);
    m_drive->clear();
    m_drive->insert(trackOf(loop));
    m_drive->insert(pathOf(loop));
    m_drive->insert(robotOf(loop));
    m_window->addTextMessage(8, -24, caption(loop), 0, captionFont());
  }
  m_window->forceRepaint();
  pace(loop.config().controlPeriod);
}

void LiveWindow::pace(double period) {
  using std::chrono::steady_clock;
  m_due +=
      std::chrono::duration_cast<steady_clock::duration>(std::chrono::duration<double>(period));
  m_due = std::max(m_due, steady_clock::now());
  std::this_thread::sleep_until(m_due);
}

}  // namespace semantic_map_drive
