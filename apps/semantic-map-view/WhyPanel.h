#pragma once
#include "CompressPanel.h"

namespace map_window {
class Table;
}

namespace semantic_map_view {

/** Why the compressed tree expands the cell that was clicked and its ancestors, or does not: what
 * each G-value is made of. */
class WhyPanel {
 public:
  WhyPanel(Viewer& viewer, CompressPanel& compress);
  WhyPanel(const WhyPanel&) = delete;
  WhyPanel& operator=(const WhyPanel&) = delete;

  /** \param cell none: nothing was clicked */
  void show(const std::optional<map_view::ViewCell>& cell);

 private:
  void update();

  Viewer& m_viewer;
  const CompressPanel& m_compress;
  nanogui::Window* m_window;
  Table* m_table;
  std::optional<map_view::ViewCell> m_cell;
  std::string m_told;
};

}  // namespace semantic_map_view
