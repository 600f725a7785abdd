#pragma once
#include <memory>
#include <vector>

#include "Beginning.h"
#include "Layer.h"
#include "ViewWindow.h"

namespace map_window {

/** Open maps, which of them is shown, and how. */
class Viewer {
 public:
  Viewer(ViewWindow& window, std::vector<std::unique_ptr<Layer>> layers,
         const Beginning& beginning);

  ViewWindow& window() { return m_window; }
  const std::vector<std::unique_ptr<Layer>>& layers() const { return m_layers; }
  Layer& layer() { return *m_layers[m_active]; }
  /** Another map, seen from the same place. */
  void activate(std::size_t layer);
  /** Called after another map was activated. */
  void onActivated(const std::function<void()>& f) { m_onActivated.push_back(f); }

  const map_view::ViewStyle& style() const { return m_layers[m_active]->look().style(); }
  void setStyle(const map_view::ViewStyle& style);
  /** The leaves of the map, or of its compressed tree. */
  void showFull();
  void showCompressed(const map_view::LiveCompression& compression);
  /** Cells in some boxes look otherwise from now on: the next frame shows that, if coarsely, those
   * after it all of it. */
  void changed(const std::vector<map_view::KeyBox>& boxes);
  /** All of the map, from a direction; degrees. */
  void lookFrom(double azimuth, double elevation);
  /** FOLDER/STEM-1ENDING, -2, ..., the first that is not there. */
  static std::filesystem::path newFile(const std::filesystem::path& folder, const std::string& stem,
                                       const std::string& ending);
  /** Writes what the window shows into a new file. \return its path */
  std::filesystem::path savePicture(const std::filesystem::path& folder);
  /** Called before each frame. */
  void onFrame(const std::function<void()>& f) { m_onFrame.push_back(f); }

  /** A line below the map. */
  void say(const std::string& text);
  const std::string& said() const { return m_said; }

 private:
  bool frame();

  ViewWindow& m_window;
  std::vector<std::unique_ptr<Layer>> m_layers;
  std::size_t m_active = 0;
  std::vector<std::function<void()>> m_onActivated, m_onFrame;
  std::string m_said, m_camera;
  bool m_hurries = false;
  double m_restAt = 0;  ///< s of GLFW's clock: the camera has come to rest
};

}  // namespace map_window
