#pragma once
#include <mrpt/img/CImage.h>
#include <mrpt_compat/Drawing.h>
#include <semantic_octree/SemanticOcTree.h>

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "Beginning.h"

namespace map_window {

/** The viewer's window while a program makes a map: turn it, ask it, pause. What is made does not
 * depend on it. Everything is drawn by the thread that calls it. */
class LiveMap {
 public:
  /** Opens the window. The map must outlive it.
   * \throw std::runtime_error "--live: ...": there is no display, or nothing to open windows with.
   */
  LiveMap(const std::string& title, const semantic_octree::SemanticOcTree& map,
          const Beginning& beginning = {});
  ~LiveMap();
  LiveMap(const LiveMap&) = delete;
  LiveMap& operator=(const LiveMap&) = delete;

  /** What lies upon the map. */
  mrpt_compat::drawing::CSetOfObjects& marks();
  /** Lines that say how far it is. */
  void say(const std::vector<std::string>& lines);
  /** A camera's picture, in the lower right corner. */
  void showPicture(const mrpt::img::CImage& picture);
  /** What is in a box may have changed: m, map frame. */
  void changed(const Eigen::AlignedBox3d& box);
  bool isOpen() const;
  /** Nobody waits any more once this says so: somebody wants the program to end. */
  void stopWhen(const std::function<bool()>& isToEnd);
  /** As if somebody had clicked "pause". */
  void pause();
  /** Draws, and returns after some time (s), or when the hand on the window lets it go on; at once
   * if the window was closed. */
  void show(double seconds);
  /** Returns when the window was closed: the work is done. */
  void stay();

 private:
  class Window;
  std::unique_ptr<Window> m_window;
};

}  // namespace map_window
