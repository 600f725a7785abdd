#include "ViewWindow.h"

#include <map_pictures/MapCanvas.h>
#include <nanogui/nanogui.h>
#include <nanogui/opengl.h>

#include <algorithm>
#include <clocale>
#include <cstdlib>
#include <opencv2/imgproc.hpp>
#include <stdexcept>

namespace map_window {

using nanogui::Vector2i;

namespace {

constexpr double kIdle = 0.5;  // s between frames without a reason
constexpr int kClick = 3;      // pixels that the mouse may move between press and release
constexpr int kPictureBorder = 8, kBetweenPanels = 8;
constexpr float kRing = 16;  // pixels, radius

const std::string kInstead =
    "; `semantic-map-export MAP -o map.png` draws a map without a window, xvfb-run gives programs "
    "a display";

void closeMenus(nanogui::Widget& widget) {
  if (auto* button = dynamic_cast<nanogui::PopupButton*>(&widget)) button->setPushed(false);
  for (nanogui::Widget* child : widget.children()) closeMenus(*child);
}

/** Name of the display; empty: there is none. */
std::string displayName() {
  for (const char* name : {"DISPLAY", "WAYLAND_DISPLAY"})
    if (const char* value = std::getenv(name); value && *value) return value;
  return {};
}

}  // namespace

WindowSystem::WindowSystem() {
  const std::string display = displayName();
  if (display.empty())
    throw std::runtime_error("there is no display (DISPLAY is not set)" + kInstead);
  try {
    nanogui::init();
  } catch (const std::exception&) {
    throw std::runtime_error("the display '" + display + "' cannot be opened" + kInstead);
  }
  std::setlocale(LC_NUMERIC, "C");
}

WindowSystem::~WindowSystem() { nanogui::shutdown(); }

std::unique_ptr<ViewWindow> ViewWindow::open(const std::string& title, int width, int height) {
  try {
    return std::make_unique<ViewWindow>(title, width, height);
  } catch (const std::exception&) {
    throw std::runtime_error("the display has no OpenGL 3.3" + kInstead);
  }
}

ViewWindow::ViewWindow(const std::string& title, int width, int height)
    : CDisplayWindowGUI(title, unsigned(width), unsigned(height)) {
  const auto scene = mrpt_compat::Scene::Create();
  const auto paper = map_pictures::kPaper;
  scene->getViewport()->setCustomBackgroundColor(
      mrpt::img::TColorf(mrpt::img::TColor(paper.r, paper.g, paper.b)));
  scene->insert(m_marks);
  scene->insert(m_maps);
  background_scene = scene;
  glfwMakeContextCurrent(mGLFWWindow);
}

Panel* ViewWindow::addPanel(Side side, const std::string& title, int width, bool isOpen) {
  auto* panel = new Panel(this, title, width);
  panel->open(isOpen);
  const std::size_t i = m_panels.size();
  m_panels.push_back({panel, side, -int(i)});
  panel->onOpened([this, i] { m_panels[i].opened = ++m_opened; });
  return panel;
}

void ViewWindow::hidePanels() {
  for (const Placed& placed : m_panels) placed.panel->setVisible(false);
}

void ViewWindow::arrangePanels() {
  performLayout();
  for (const Side side : {Side::Left, Side::Right}) {
    std::vector<Placed*> open;
    int bottom = kBetweenPanels;
    for (Placed& placed : m_panels) {
      if (placed.side != side || !placed.panel->visible()) continue;
      bottom += placed.panel->height() + kBetweenPanels;
      if (placed.panel->isOpen()) open.push_back(&placed);
    }
    const auto isOlder = [](const Placed* a, const Placed* b) { return a->opened < b->opened; };
    std::sort(open.begin(), open.end(), isOlder);
    for (std::size_t i = 0; i + 1 < open.size() && bottom > height(); ++i) {
      bottom -= open[i]->panel->height();
      open[i]->panel->open(false);
      bottom += open[i]->panel->preferredSize(mNVGContext).y();
    }
    int y = kBetweenPanels;
    for (const auto& [panel, at, opened] : m_panels) {
      if (at != side || !panel->visible()) continue;
      if (!panel->isOpen()) panel->setHeight(panel->preferredSize(mNVGContext).y());
      const int right = width() - panel->width() - kBetweenPanels;
      panel->setPosition({side == Side::Left ? kBetweenPanels : right, y});
      y += panel->height() + kBetweenPanels;
    }
  }
}

/** Below the panels. */
void ViewWindow::draw(NVGcontext* context) {
  const auto pixel = m_ring ? orbitCamera().pixelOf(*m_ring, mSize.x(), mSize.y()) : std::nullopt;
  for (const float width : {6.f, 3.f}) {
    if (!pixel) break;
    nvgBeginPath(context);
    nvgCircle(context, float(pixel->x()), float(pixel->y()), kRing);
    nvgStrokeWidth(context, width);
    nvgStrokeColor(context, width > 3 ? nanogui::Color(0, 255) : nanogui::Color(255, 215, 0, 255));
    nvgStroke(context);
  }
  CDisplayWindowGUI::draw(context);
}

void ViewWindow::showPicture(const mrpt::img::CImage& picture, int width) {
  const double height = double(width) * double(picture.getHeight()) / double(picture.getWidth());
  auto viewport = background_scene->createViewport("picture");
  viewport->setImageView(picture);
  // Shares of the window, from its lower left corner.
  viewport->setViewportPosition(1 - double(width + kPictureBorder) / mFBSize.x(),
                                double(kPictureBorder) / mFBSize.y(), double(width) / mFBSize.x(),
                                height / mFBSize.y());
  redraw();
}

map_view::OrbitCamera ViewWindow::orbitCamera() const {
  const auto& of = camera();
  map_view::OrbitCamera c;
  c.target = {of.getCameraPointingX(), of.getCameraPointingY(), of.getCameraPointingZ()};
  c.distance = of.getZoomDistance();
  c.azimuth = of.getAzimuthDegrees();
  c.elevation = of.getElevationDegrees();
  c.fieldOfView = of.cameraFOV();
  return c;
}

void ViewWindow::setOrbitCamera(const map_view::OrbitCamera& c) {
  auto& of = camera();
  of.setMinimumZoom(0.1f);
  of.setMaximumZoom(1e5f);
  of.setCameraPointing(float(c.target.x()), float(c.target.y()), float(c.target.z()));
  of.setZoomDistance(float(c.distance));
  of.setAzimuthDegrees(float(c.azimuth));
  of.setElevationDegrees(float(c.elevation));
  of.setCameraFOV(float(c.fieldOfView));
  redraw();
}

bool ViewWindow::drawFrame() {
  glfwMakeContextCurrent(mGLFWWindow);
  m_dirty = false;
  const bool more = m_onFrame && m_onFrame();
  drawAll();
  return more;
}

bool ViewWindow::attend() {
  glfwPollEvents();
  if (glfwWindowShouldClose(mGLFWWindow)) return false;
  if (m_more || m_dirty) m_more = drawFrame();
  return true;
}

void ViewWindow::run() {
  bool more = true;
  double last = 0;
  while (!glfwWindowShouldClose(mGLFWWindow)) {
    if (more || m_dirty)
      glfwPollEvents();
    else
      glfwWaitEventsTimeout(kIdle / 5);
    if (!more && !m_dirty && glfwGetTime() - last < kIdle) continue;
    more = drawFrame();
    last = glfwGetTime();
  }
}

/** As nanogui does it; but what was drawn is kept before it goes to the screen, where other windows
 * may cover it. */
void ViewWindow::drawAll() {
  arrangePanels();
  const float far = float(orbitCamera().distance);
  background_scene->getViewport()->setViewportClipDistances(std::max(0.02f, far / 200), far * 50);
  glClearColor(0, 0, 0, 1);
  glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT | GL_STENCIL_BUFFER_BIT);
  glViewport(0, 0, mFBSize.x(), mFBSize.y());
  drawContents();
  glDisable(GL_CULL_FACE);
  drawWidgets();
  if (m_takesPicture) takePicture();
  glfwSwapBuffers(mGLFWWindow);
}

cv::Mat ViewWindow::drawPicture() {
  m_takesPicture = true;
  drawFrame();
  m_takesPicture = false;
  return m_picture.clone();
}

void ViewWindow::takePicture() {
  m_picture.create(mFBSize.y(), mFBSize.x(), CV_8UC3);
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glReadPixels(0, 0, mFBSize.x(), mFBSize.y(), GL_BGR, GL_UNSIGNED_BYTE, m_picture.data);
  cv::flip(m_picture, m_picture, 0);
}

map_view::Ray ViewWindow::rayThrough(const Vector2i& p) const {
  return orbitCamera().rayThrough(p.x(), p.y(), mSize.x(), mSize.y());
}

bool ViewWindow::mouseMotionEvent(const Vector2i& p, const Vector2i& rel, int button,
                                  int modifiers) {
  redraw();
  if (!m_holds) return CDisplayWindowGUI::mouseMotionEvent(p, rel, button, modifiers);
  m_onMoved(rayThrough(p), false);
  return true;
}

bool ViewWindow::mouseButtonEvent(const Vector2i& p, int button, bool down, int modifiers) {
  redraw();
  const bool beside = findWidget(p) == this, left = button == GLFW_MOUSE_BUTTON_LEFT;
  if (left && m_holds && !down) {
    m_holds = false;
    m_onMoved(rayThrough(p), true);
    return true;
  }
  if (left && down && beside && m_onGrab) m_holds = m_onGrab(rayThrough(p));
  if (m_holds) return true;
  const bool used = CDisplayWindowGUI::mouseButtonEvent(p, button, down, modifiers);
  if (!left) return used;
  const bool click = !down && beside && (p - m_pressed).cwiseAbs().maxCoeff() <= kClick;
  m_pressed = down && beside ? p : Vector2i(-1000, -1000);
  if (click && m_onClick) m_onClick(rayThrough(p));
  return used;
}

bool ViewWindow::scrollEvent(const Vector2i& p, const nanogui::Vector2f& rel) {
  redraw();
  const map_view::OrbitCamera before = orbitCamera();
  const bool used = CDisplayWindowGUI::scrollEvent(p, rel);
  map_view::OrbitCamera after = orbitCamera();
  if (after.distance == before.distance) return used;
  // What is under the pointer, as far away as the target, stays there.
  const map_view::Ray ray = before.rayThrough(p.x(), p.y(), mSize.x(), mSize.y());
  const Eigen::Vector3d place =
      ray.origin + before.distance / ray.direction.dot(before.forward()) * ray.direction;
  after.target = place + after.distance / before.distance * (before.target - place);
  setOrbitCamera(after);
  return used;
}

bool ViewWindow::keyboardEvent(int key, int scancode, int action, int modifiers) {
  redraw();
  if (key == GLFW_KEY_ESCAPE && action == GLFW_PRESS) closeMenus(*this);
  return CDisplayWindowGUI::keyboardEvent(key, scancode, action, modifiers);
}

bool ViewWindow::keyboardCharacterEvent(unsigned int codepoint) {
  redraw();
  return CDisplayWindowGUI::keyboardCharacterEvent(codepoint);
}

bool ViewWindow::resizeEvent(const Vector2i& size) {
  redraw();
  return CDisplayWindowGUI::resizeEvent(size);
}

}  // namespace map_window
