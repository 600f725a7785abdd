#pragma once
#include <map_view/LiveCompression.h>

#include <array>
#include <optional>

#include "map_window/Viewer.h"
#include "map_window/Widgets.h"

namespace semantic_map_view {

using namespace map_window;

/** The compressed tree of the map that is shown, which follows the sliders of alpha and of the
 * weights. */
class CompressPanel {
 public:
  /** \param weights the first solution of such a file, from which the sliders begin; empty: all
   * classes with weight 1 */
  CompressPanel(Viewer& viewer, std::filesystem::path weights);
  CompressPanel(const CompressPanel&) = delete;

  /** Shows the compressed tree, or the full map again. */
  void switchOn(bool on);
  void setAlpha(double alpha);
  void setLeaves(std::size_t leaves);
  void setBytes(std::size_t bytes);
  /** Says at once what takes longer and is else said when the hand rests: what the tree retains,
   * and how many bytes its file has. */
  void measure();
  /** None before the compressed tree was first shown. */
  const map_view::LiveCompression* compression() const { return m_live ? &*m_live : nullptr; }
  /** Called after the compressed tree has changed, has come or has gone. */
  void onFollowed(const std::function<void()>& f) { m_onFollowed = f; }
  /** Writes the weights into FOLDER/weights-1.yaml, -2, ..., the first that is not there.
   * \return its path */
  std::filesystem::path save(const std::filesystem::path& folder) const;

 private:
  struct TermLine {
    nanogui::Label *weight = nullptr, *kept = nullptr;
  };
  void begin();
  void forget();
  /** Before each frame. */
  void update();
  /** Says what is new. \param bytes of the file; 0: not known yet */
  void tell(std::size_t bytes);
  void addAlpha();
  void addWanted();
  bool isThere(std::size_t term) const;
  void addTerms();
  void addSave();
  void follow();
  float sliderOf(double alpha) const;
  double alphaOf(float slider) const;

  Viewer& m_viewer;
  std::filesystem::path m_weights;
  std::optional<map_view::LiveCompression> m_live;
  nanogui::CheckBox* m_on;
  nanogui::Widget* m_controls;
  nanogui::Slider* m_alpha = nullptr;
  nanogui::Label *m_alphaText = nullptr, *m_leaves = nullptr, *m_bytes = nullptr;
  nanogui::IntBox<int>*m_wantedLeaves = nullptr, *m_wantedKilobytes = nullptr;
  std::vector<TermLine> m_lines;
  std::function<void()> m_onFollowed = [] {};
  std::string m_told;
  double m_measureAt = 0;  ///< s of GLFW's clock; 0: measured
};

/** Why the compressed tree expands the cell that was clicked and its ancestors, or does not: what
 * each G-value is made of. */
class WhyPanel {
 public:
  WhyPanel(Viewer& viewer, CompressPanel& compress);
  WhyPanel(const WhyPanel&) = delete;

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
