#pragma once
#include <labeled_cloud/ScanConverter.h>
#include <labeled_cloud/Trajectory.h>
#include <semantic_map/CSemanticOctoMap.h>

#include <filesystem>
#include <functional>
#include <memory>
#include <vector>

#include "Summary.h"

namespace rawlog2semantic_map {

/** Streams rawlogs into a map, observation by observation. */
class MapBuilder {
 public:
  /** All three must outlive the builder. */
  MapBuilder(semantic_map::CSemanticOctoMap& map, labeled_cloud::ScanConverter& converter,
             const labeled_cloud::Trajectory& trajectory);

  /** Also inserts each scan into a map that keeps no abstraction, for comparison. */
  void timeWithoutAbstraction();

  /** Inserts all scans of the rawlogs, saying on the standard output how far it is.
   * \throw std::runtime_error naming the file: it is damaged, or a scan of it cannot be used. */
  void insert(const std::vector<std::filesystem::path>& rawlogs);

  const Summary& summary() const { return m_summary; }

 private:
  void insertRawlog(const std::filesystem::path& file,
                    const std::function<void(std::uint64_t)>& onBytesRead);
  void insertObservation(const mrpt::obs::CObservation& observation);
  void insertScan(const mrpt::obs::CObservation& observation,
                  const mrpt::poses::CPose3D& T_map_robot);

  void noteAbstraction(const labeled_cloud::LabeledScan& scan,
                       const mrpt::poses::CPose3D& T_map_robot);

  semantic_map::CSemanticOctoMap& m_map;
  std::unique_ptr<semantic_map::CSemanticOctoMap> m_plainMap;
  labeled_cloud::ScanConverter& m_converter;
  const labeled_cloud::Trajectory& m_trajectory;
  Summary m_summary;
};

}  // namespace rawlog2semantic_map
