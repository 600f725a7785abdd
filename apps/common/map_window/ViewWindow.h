#pragma once
#include <map_view/OrbitCamera.h>
#include <mrpt/gui/CDisplayWindowGUI.h>
#include <mrpt_compat/Drawing.h>

#include <functional>
#include <opencv2/core.hpp>
#include <optional>

#include "Widgets.h"

namespace map_window {

/** The system of MRPT's windows; there is one at a time. */
class WindowSystem {
 public:
  /** \throw std::runtime_error there is no display. */
  WindowSystem();
  ~WindowSystem();
  WindowSystem(const WindowSystem&) = delete;
  WindowSystem& operator=(const WindowSystem&) = delete;
};

/** A window with a scene that is looked at by an orbit camera, drawn when there is a reason. */
class ViewWindow : public mrpt::gui::CDisplayWindowGUI {
 public:
  /** \throw std::runtime_error the display has no OpenGL 3.3. */
  static std::unique_ptr<ViewWindow> open(const std::string& title, int width, int height);
  ViewWindow(const std::string& title, int width, int height);

  const mrpt_compat::drawing::CSetOfObjects::Ptr& maps() const { return m_maps; }
  /** What lies upon the maps. */
  const mrpt_compat::drawing::CSetOfObjects::Ptr& marks() const { return m_marks; }
  /** Panels stand below each other at the left or the right. Where the window is too low for them,
   * those fold that were opened longest ago; before a hand did, the last ones.
   * \param width of what is in it, pixels */
  enum class Side { Left, Right };
  Panel* addPanel(Side side, const std::string& title, int width, bool isOpen = true);
  /** What panels do goes on without a hand. */
  void hidePanels();

  /** A ring around a place (m, map frame), whatever hides it; none: no place. */
  void setRing(const std::optional<Eigen::Vector3d>& place) { m_ring = place; }
  /** In the lower right corner, so many pixels wide. */
  void showPicture(const mrpt::img::CImage& picture, int width);

  map_view::OrbitCamera orbitCamera() const;
  void setOrbitCamera(const map_view::OrbitCamera& camera);
  /** Called for clicks beside all panels: the ray through the pixel. */
  void onClick(const std::function<void(const map_view::Ray&)>& f) { m_onClick = f; }
  /** Called when the left button goes down beside all panels; \return whether the hand takes
   * something there, which then follows it instead of the camera. */
  void onGrab(const std::function<bool(const map_view::Ray&)>& f) { m_onGrab = f; }
  /** Called while the hand moves what it took, and when it lets go. */
  using OnMoved = std::function<void(const map_view::Ray&, bool letsGo)>;
  void onMoved(const OnMoved& f) { m_onMoved = f; }
  /** Called before each frame; \return whether there is more to do for this frame. */
  void onFrame(const std::function<bool()>& f) { m_onFrame = f; }
  /** Draws again soon. */
  void redraw() { m_dirty = true; }

  /** Until the window is closed. */
  void run();
  /** Sees to what hands did, and draws what there is to be drawn. \return false: it was closed */
  bool attend();
  /** Whether the last frame of attend() left nothing to do. */
  bool isComplete() const { return !m_more; }
  /** Draws one frame. \return whether there is more to do. */
  bool drawFrame();
  /** Draws one, and returns what it shows, BGR. */
  cv::Mat drawPicture();
  int pixelWidth() const { return mFBSize.x(); }
  int pixelHeight() const { return mFBSize.y(); }

 protected:
  bool mouseMotionEvent(const nanogui::Vector2i& p, const nanogui::Vector2i& rel, int button,
                        int modifiers) override;
  bool mouseButtonEvent(const nanogui::Vector2i& p, int button, bool down, int modifiers) override;
  bool scrollEvent(const nanogui::Vector2i& p, const nanogui::Vector2f& rel) override;
  bool keyboardEvent(int key, int scancode, int action, int modifiers) override;
  bool keyboardCharacterEvent(unsigned int codepoint) override;
  bool resizeEvent(const nanogui::Vector2i& size) override;

 private:
  void drawAll() override;
  void draw(NVGcontext* context) override;
  void arrangePanels();
  map_view::Ray rayThrough(const nanogui::Vector2i& p) const;
  void takePicture();

  mrpt_compat::drawing::CSetOfObjects::Ptr m_maps = mrpt_compat::drawing::CSetOfObjects::Create();
  mrpt_compat::drawing::CSetOfObjects::Ptr m_marks = mrpt_compat::drawing::CSetOfObjects::Create();
  struct Placed {
    Panel* panel;
    Side side;
    int opened;  ///< the larger, the later
  };
  std::vector<Placed> m_panels;
  int m_opened = 0;
  std::optional<Eigen::Vector3d> m_ring;
  std::function<void(const map_view::Ray&)> m_onClick;
  std::function<bool(const map_view::Ray&)> m_onGrab;
  OnMoved m_onMoved;
  std::function<bool()> m_onFrame;
  bool m_dirty = true, m_more = true;
  nanogui::Vector2i m_pressed{-1, -1};  ///< where a button went down beside all panels
  bool m_holds = false;                 ///< the hand has taken something
  bool m_takesPicture = false;
  cv::Mat m_picture;
};

}  // namespace map_window
