#pragma once
#include <labeled_cloud/ScanStream.h>
#include <map_operations/Calibrator.h>
#include <semantic_abstraction/Abstraction.h>
#include <semantic_map/CSemanticOctoMap.h>
#include <semantic_octree/InsertionOptions.h>
#include <semantic_octree/SemanticOcTree.h>
#include <semantic_slam/Mapper.h>
#include <semantic_slam/Slam.h>
#include <nlohmann/json.hpp>

#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "Terminal.h"

namespace rawlog2semantic_map {

/** The abstraction along the way; one entry a scan. */
struct AbstractionSummary {
  std::vector<std::size_t> leaves, compressedLeaves;
  std::vector<double> changeTimes;  ///< telling what changed in the optimal tree, ms
};

/** What became of the observations on their way into the map. */
struct Summary {
  std::vector<std::string> rawlogs;
  std::size_t read = 0, inserted = 0;
  /** Pictures that were there to label scans, and observations that the trajectory is made of. */
  std::size_t pictures = 0, poses = 0;
  /** Whether the trajectory is from the rawlogs. */
  bool posesAreUsed = false;
  /** Whether the end of the rawlogs was not reached: somebody asked to stop. */
  bool stopped = false;
  /** What was wrong with observations that were left out: how often, and the first of them. */
  std::size_t numProblems = 0;
  std::vector<std::string> problems;
  /** Number of observations that were not inserted, by the reason. */
  std::map<std::string, std::size_t> skipped;
  /** Scans for which labels were looked for and not found. */
  std::size_t withoutLabels = 0;
  /** Sums over the scans that were inserted. */
  labeled_cloud::ScanCounts conversion;
  semantic_octree::InsertionReport insertion;  ///< of points that were left out alone
  /** Milliseconds of each inserted scan: making the cloud, inserting it. */
  std::vector<double> conversionTimes, insertionTimes;
  /** Where an abstraction is kept, after each inserted scan. */
  AbstractionSummary abstraction;
  std::optional<semantic_slam::SlamReport> slam;  ///< if poses were corrected

  void add(const labeled_cloud::ScanCounts& counts);
  void addProblems(const std::vector<std::string>& more);
  void add(const semantic_octree::InsertionReport& report);
  /** Counts it. \return what became of it, in words */
  std::string note(const labeled_cloud::StreamedObservation& observation);
  std::size_t numSkipped() const;
  /** What share of the points has a label, with a warning below a half. */
  std::string labeledText() const;
  /** "3 skipped (2 outside the trajectory, 1 CObservationImage)" */
  std::string skippedText() const;
};

/** The summary with what the map holds, for summary.json. \param countVoxels goes through all of
 * the map */
nlohmann::ordered_json toJson(const Summary& summary, const semantic_octree::SemanticOcTree& tree,
                              bool countVoxels);

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
  void insertScan(const labeled_cloud::StreamedObservation& observation);
  void noteAbstraction();

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
  Summary m_summary;
};

}  // namespace rawlog2semantic_map
