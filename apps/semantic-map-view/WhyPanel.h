#pragma once
#include "CompressPanel.h"

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

  /** More have no place. */
  static constexpr std::size_t kMostNodes = 4, kMostTerms = 6;

 private:
  void update();

  Viewer& m_viewer;
  const CompressPanel& m_compress;
  Panel* m_panel;
  std::array<std::array<nanogui::Label*, kMostNodes + 1>, kMostTerms + 6> m_cells{};
  std::optional<map_view::ViewCell> m_cell;
  std::string m_told;
};

}  // namespace semantic_map_view
