#pragma once
#include <labeled_cloud/ScanStream.h>
#include <map_operations/Calibrator.h>
#include <semantic_abstraction/Abstraction.h>
#include <semantic_map/CSemanticOctoMap.h>
#include <semantic_slam/Mapper.h>

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "Signals.h"
#include "Summary.h"

namespace rawlog2semantic_map {

/** Inserts a stream of scans into a map; the next scans are made meanwhile. */
class MapBuilder {
 public:
  /** Is told of each scan that was inserted, and where: as odometry has it, if there is any. */
  using OnScan = std::function<void(const labeled_cloud::LabeledScan& scan,
                                    const mrpt::poses::CPose3D& T_map_robot)>;

  /** Map and trajectory must outlive the builder. \param trajectory of the rawlogs: scans whose
   * points have times are deskewed by it, unless poses are corrected */
  MapBuilder(semantic_map::CSemanticOctoMap& map, const labeled_cloud::Trajectory& trajectory,
             OnScan onScan = {});

  /** Also inserts each scan into a map that keeps no abstraction, for comparison. */
  void timeWithoutAbstraction();

  /** Scans go where SLAM finds them. Those of a map that has content stay there.
   * \param folder where they are kept meanwhile
   * \param reference map (.semantic, or a folder of tiles) into whose frame they go; may be empty
   * \throw std::runtime_error naming the reference: it cannot be read, or has other classes */
  void correctPoses(const semantic_slam::SlamOptions& options, const std::filesystem::path& folder,
                    const std::filesystem::path& reference);
  /** The rawlogs have no poses: with correctPoses(), scans are registered without a guess. */
  void withoutOdometry() { m_hasOdometry = false; }
  /** Poses of all scans, if poses are corrected, in the format of the TUM data sets. */
  std::string trajectory() const;

  /** Counts the observations that hold poses as used: those of the robot are from the rawlogs. */
  void countPoses() { m_summary.posesAreUsed = true; }

  /** Inserts all scans of the rawlogs, or those up to when it is to stop, saying how far it is.
   * \throw std::runtime_error naming the file: it is damaged, or a scan of it cannot be used; with
   * correctPoses(), nothing was found in a map that had content. */
  void insert(const std::vector<std::filesystem::path>& rawlogs, labeled_cloud::ScanStream& stream,
              const StopRequest& stop);

  const Summary& summary() const { return m_summary; }

 private:
  void add(const labeled_cloud::StreamedObservation& observation);
  /** By the motion between the scan's time and that of the point farthest from it. */
  void deskew(labeled_cloud::StreamedObservation& observation) const;
  /** Tells if labels contradict each other more than their parameters say. */
  void noteLabels() const;
  void insertScan(const labeled_cloud::StreamedObservation& observation);
  void noteAbstraction(const labeled_cloud::LabeledScan& scan,
                       const mrpt::poses::CPose3D& T_map_robot);

  /** \param T_map_robot of odometry; without any, where the scan was found */
  semantic_octree::InsertionReport insertIntoMap(const labeled_cloud::LabeledScan& scan,
                                                 mrpt::poses::CPose3D& T_map_robot);
  void noteSlam();
  /** \throw std::runtime_error */
  void checkFoundInMap() const;

  semantic_map::CSemanticOctoMap& m_map;
  const labeled_cloud::Trajectory& m_trajectory;
  semantic_octree::LeafFollower m_follower;
  semantic_octree::Calibrator m_calibrator;       ///< the mapper has its own
  std::optional<semantic_slam::Mapper> m_mapper;  ///< if poses are corrected
  bool m_hasOdometry = true;
  const bool m_hadContent;                 ///< the map, before the first scan
  semantic_map::ObservationClock m_clock;  ///< of its scans
  double m_seconds = 0;                    ///< that passed, by the clock
  struct PlacedScan {
    double seconds;
    std::size_t keyframe;
    Eigen::Isometry3d T_keyframe_robot;
  };
  std::vector<PlacedScan> m_placed;
  OnScan m_onScan;
  std::unique_ptr<semantic_map::CSemanticOctoMap> m_plainMap;
  Summary m_summary;
};

}  // namespace rawlog2semantic_map
