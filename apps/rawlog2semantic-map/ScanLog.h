#pragma once
#include <labeled_cloud/Rawlogs.h>
#include <labeled_cloud/ScanConverter.h>
#include <semantic_types/ClassTable.h>

#include <filesystem>
#include <string>
#include <vector>

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

}  // namespace rawlog2semantic_map
