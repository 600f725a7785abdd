#pragma once
#include <map_view/CellSource.h>
#include <map_view/OrbitCamera.h>
#include <mrpt/img/CImage.h>
#include <mrpt_compat/Drawing.h>
#include <semantic_octree/SemanticOcTree.h>

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace map_window {

/** How a window begins. */
struct Beginning {
  /** Without, all of the map is seen. */
  std::optional<map_view::OrbitCamera> camera;
  bool top = false;  ///< from above, north up
  map_view::ViewStyle style;
};

/** The viewer's window while a program makes a map: turn it, ask it, pause. What is made does not
 * depend on it. Everything is drawn by the thread that calls it. */
class LiveMap {
 public:
  /** Opens the window. The map must outlive it.
   * \throw std::runtime_error "--live: ...": there is no display, or nothing to open windows with.
   */
  static std::unique_ptr<LiveMap> open(const std::string& title,
                                       const semantic_octree::SemanticOcTree& map,
                                       const Beginning& beginning = {});
  virtual ~LiveMap() = default;

  /** What lies upon the map. */
  virtual mrpt_compat::drawing::CSetOfObjects& marks() = 0;
  /** Lines that say how far it is. */
  virtual void say(const std::vector<std::string>& lines) = 0;
  /** A camera's picture, in the lower right corner. */
  virtual void showPicture(const mrpt::img::CImage& picture) = 0;
  /** What is in a box may have changed: m, map frame. */
  virtual void changed(const Eigen::AlignedBox3d& box) = 0;
  virtual bool isOpen() const = 0;
  /** Nobody waits any more once this says so: somebody wants the program to end. */
  virtual void stopWhen(const std::function<bool()>& isToEnd) = 0;
  /** As if somebody had clicked "pause". */
  virtual void pause() = 0;
  /** Draws, and returns after some time (s), or when the hand on the window lets it go on; at once
   * if the window was closed. */
  virtual void show(double seconds) = 0;
  /** Returns when the window was closed: the work is done. */
  virtual void stay() = 0;
};

}  // namespace map_window
