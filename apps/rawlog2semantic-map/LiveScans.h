#pragma once
#include <labeled_cloud/ScanConverter.h>
#include <semantic_octree/SemanticOcTree.h>

#include "Signals.h"
#include "Summary.h"
#include "map_window/LiveMap.h"

namespace rawlog2semantic_map {

/** The map in a window while it is made, with the points of the scan that was inserted last. */
class LiveScans {
 public:
  /** Opens the window. \throw std::runtime_error there is no display. */
  LiveScans(const semantic_octree::SemanticOcTree& map, const StopRequest& stop, bool paused);

  /** A scan was inserted. \param summary of the scans up to it */
  void show(const labeled_cloud::LabeledScan& scan, const mrpt::poses::CPose3D& T_map_robot,
            const Summary& summary);
  /** Until the window is closed. */
  void stay() { m_window.stay(); }

 private:
  const semantic_octree::SemanticOcTree& m_map;
  map_window::LiveMap m_window;
};

}  // namespace rawlog2semantic_map
