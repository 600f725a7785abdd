#pragma once
#include <labeled_cloud/Rawlogs.h>
#include <labeled_cloud/ScanConverter.h>
#include <semantic_octree/SemanticOcTree.h>
#include <semantic_types/ClassTable.h>

#include <filesystem>
#include <string>
#include <vector>

#include "MapBuilder.h"
#include "Terminal.h"
#include "map_window/LiveMap.h"

namespace rawlog2semantic_map {

/** Writes scans as they go into the map: a robot pose and a CObservationLabeledCloud each, so that
 * a map of that rawlog is the same. */
class ScanLog {
 public:
  /** \throw std::runtime_error naming the file, if it cannot be written. */
  ScanLog(const std::filesystem::path& file, const semantic_types::ClassTable& classes);

  void write(const labeled_cloud::LabeledScan& scan, const mrpt::poses::CPose3D& T_map_robot);
  /** Completes the file; without it there will be none. */
  void finish() { m_writer.finish(); }

 private:
  labeled_cloud::RawlogWriter m_writer;
  std::vector<std::string> m_classNames;
};

/** Pictures that show whether labels and calibration are right. Above are the labels over the
 * image. Below are the scan's points over the image, in their classes' colors, or gray. */
class Preview {
 public:
  /** Creates the folder if need be. \throw std::runtime_error naming it, if it cannot be. */
  Preview(const std::filesystem::path& folder, const semantic_types::ClassTable& classes);

  /** The name of the i-th picture's file. */
  static std::string nameOf(std::size_t i);

  /** Writes a picture for each one that the scan's labels are from.
   * \throw std::runtime_error naming the file, if it cannot be written. */
  void write(const labeled_cloud::LabeledScan& scan);

 private:
  std::filesystem::path m_folder;
  semantic_types::ClassTable m_classes;
  std::size_t m_written = 0;
};

/** The map in a window while it is made, with the points of the scan that was inserted last. */
class LiveScans {
 public:
  /** Opens the window. \throw std::runtime_error there is no display. */
  LiveScans(const semantic_octree::SemanticOcTree& map, const StopRequest& stop, bool paused);

  /** A scan was inserted. \param summary of the scans up to it */
  void show(const labeled_cloud::LabeledScan& scan, const mrpt::poses::CPose3D& T_map_robot,
            const Summary& summary);
  /** Until the window is closed. */
  void stay() { m_window->stay(); }

 private:
  const semantic_octree::SemanticOcTree& m_map;
  std::unique_ptr<map_window::LiveMap> m_window;
};

}  // namespace rawlog2semantic_map
