#pragma once
#include "Viewer.h"

namespace map_window {

class BarChart;

/** What the map knows about a cell that was clicked. */
class AskPanel {
 public:
  explicit AskPanel(Viewer& viewer);
  AskPanel(const AskPanel&) = delete;
  AskPanel& operator=(const AskPanel&) = delete;

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

}  // namespace map_window
