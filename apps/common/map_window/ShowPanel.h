#pragma once
#include "Viewer.h"

namespace map_window {

/** What is shown, in which colors, from where. */
class ShowPanel {
 public:
  explicit ShowPanel(Viewer& viewer);
  ShowPanel(const ShowPanel&) = delete;
  ShowPanel& operator=(const ShowPanel&) = delete;

  /** The map has grown. */
  void refresh();

 private:
  /** What the viewer says, and where the camera is. */
  void update();
  void addLayers(nanogui::Widget* parent);
  void addColoring(nanogui::Widget* parent);
  void addClasses(nanogui::Widget* parent);
  void addHeight(nanogui::Widget* parent);
  void addCameras(nanogui::Widget* parent);
  void listClasses();
  /** From the lowest to the highest of what is known. */
  void fitHeight();
  void hide(std::size_t id, bool hidden);

  Viewer& m_viewer;
  nanogui::Window* m_window;
  nanogui::Widget* m_classes = nullptr;
  nanogui::Slider* m_heightSlider = nullptr;
  nanogui::Label *m_name = nullptr, *m_height = nullptr, *m_camera = nullptr, *m_said = nullptr;
};

}  // namespace map_window
