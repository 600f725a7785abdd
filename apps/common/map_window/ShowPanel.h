#pragma once
#include "Viewer.h"

namespace map_window {

class BarChart;

/** What the map knows about a cell that was clicked. */
class AskPanel {
 public:
  explicit AskPanel(Viewer& viewer);
  AskPanel(const AskPanel&) = delete;

  /** \return the cell that the ray meets, if there is one */
  std::optional<map_view::ViewCell> ask(const map_view::Ray& ray);

 private:
  void show(const map_view::ViewCell& cell);
  void clear();

  Viewer& m_viewer;
  std::array<nanogui::Label*, 3> m_lines{};
  BarChart* m_shares;
  mrpt_compat::drawing::CSetOfObjects::Ptr m_mark = mrpt_compat::drawing::CSetOfObjects::Create();
};

/** What is shown, in which colors, from where. */
class ShowPanel {
 public:
  explicit ShowPanel(Viewer& viewer);
  ShowPanel(const ShowPanel&) = delete;

  /** The map has grown. */
  void refresh();

 private:
  /** What the viewer says, and where the camera is. */
  void update();
  void addLayers();
  void listLayers();
  void addColoring(nanogui::Widget* parent);
  void addClasses(nanogui::Widget* parent);
  void addSpace(nanogui::Widget* parent, const std::string& name,
                bool map_view::ViewStyle::*isShown);
  void addClip();
  void addCameras(nanogui::Widget* parent);
  void listClasses();
  /** Sliders lead from the lowest to the highest of what is known. */
  void fitClip();
  void clip(int axis, bool isHigh, double to);
  void hide(std::size_t id, bool hidden);

  Viewer& m_viewer;
  nanogui::Widget* m_content;
  nanogui::Widget* m_classes = nullptr;
  ScaleBar* m_scale = nullptr;
  /** The lower and the higher side, along x, y or z, of the box outside of which nothing is shown.
   */
  struct ClipLine {
    nanogui::Slider* slider;
    nanogui::FloatBox<double>* number;
  };
  std::array<std::array<ClipLine, 2>, 3> m_clip{};
  nanogui::Widget *m_layers = nullptr, *m_activeRow = nullptr;
  nanogui::ComboBox* m_active = nullptr;
  std::vector<nanogui::CheckBox*> m_shown;  ///< one for each layer, if there are several
  nanogui::Label *m_name = nullptr, *m_camera = nullptr;
  nanogui::Window* m_said = nullptr;  ///< at the lower border
};

}  // namespace map_window
