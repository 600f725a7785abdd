#pragma once
#include <semantic_slam/Slam.h>
#include <strict_files/OutputFiles.h>

#include <functional>
#include <set>
#include <utility>

#include "MotionNoise.h"
#include "PlaneSearch.h"
#include "Reference.h"
#include "SensorScale.h"

namespace semantic_slam {

/** Share of a stretch's points where the place that it is compared with has some, at least. */
constexpr double kCovered = 0.3;
/** Points that all searches of a keyframe look up at most while the robot drives: half a second of
 * a desktop's core. At the end each search of a part has ten times as many. */
constexpr std::size_t kLiveLooks = 300'000'000;

LabeledCloud moved(LabeledCloud cloud, const Eigen::Isometry3d& T);
/** x, y (m) and heading (radians). */
Eigen::Vector3d flatOf(const Eigen::Isometry3d& T);
Eigen::Isometry3d poseOfFlat(const Eigen::Vector3d& flat, double z = 0);

/** What Slam does: tracking (SlamTracking.cpp), loops and the reference
 * (SlamLoops.cpp), pieces (SlamPieces.cpp), what goes (SlamForgetting.cpp). */
class SlamEngine {
 public:
  using Pose = Eigen::Isometry3d;

  SlamEngine(const SlamOptions& options, const std::filesystem::path& folder) : m_options(options) {
    if (!folder.empty()) m_file.emplace(folder);
  }
  void setReference(const semantic_octree::SemanticOcTree& map);
  Slam::Added add(const SensorScan& scan, const std::optional<Pose>& T_odometry_robot,
                  double seconds);
  bool finish();
  std::vector<std::size_t> outnumbered(std::size_t by) const;
  void forget(const std::vector<std::size_t>& keyframes);
  const std::vector<Pose>& poses() const { return m_poses; }
  const std::vector<PoseEdge>& edges() const { return m_edges; }
  SlamReport report() const;

 private:
  /** What one scan brings. */
  struct Seen {
    LabeledCloud cloud;  ///< thinned, frame of the robot
    Pose T_odometry_robot;
  };
  struct Keyframe {
    Seen seen;       ///< without the cloud, if that is in the file
    double way;      ///< from the first one, m
    double lostWay;  ///< of it, where scans fit nothing
    std::uint64_t place;
    std::size_t numPoints;
  };
  /** Appends a keyframe. */
  void keep(Seen seen);
  Seen seenAt(std::size_t keyframe) const;

  // --- Tracking ---
  void setScale(const LabeledCloud& cloud, const Pose& T_robot_sensor);
  /** From the last scan to this one, as odometry or the last steps say. */
  Pose predictedStep(const std::optional<Pose>& T_odometry_robot);
  bool isSmall(const Pose& T_step) const;
  /** From the last scan to this one, if the robot goes on as before. */
  Pose goingOn() const;
  /** A scan that took time counts as one of the middle of it: what is wrong with the velocity then
   * cancels, but for the pose at the time of the scan. \param middle seconds after that */
  Slam::Added addAsOf(double middle, const SensorScan& scan,
                      const std::optional<Pose>& T_odometry_robot, double seconds);
  /** \param velocity what it is deskewed by */
  Seen seenIn(const SensorScan& scan, double middle, const Vector6& velocity,
              const Pose& T_odometry) const;
  /** The robot's first motion is known now: the first scan is deskewed by it. */
  void straightenFirst(const Vector6& velocity);
  Slam::Added beginFirst(const Seen& seen);
  void begin(const Seen& seen, const Pose& T_map_robot, const Pose& T_last_keyframe);
  bool beginsKeyframe(const Pose& T_last_robot) const;
  void noteFound(const Pose& T_step, const Pose& T_last_robot, const Registration& registered);
  void noteLost(const Pose& T_step);
  /** Whether a scan tells more of the robot's place, in each direction, than wheels do over the
   * length of what it is registered to. */
  bool isHeld(const Matrix6& ofScan) const;
  /** Whether scans move while odometry does not. \param T_moved by this scan */
  void noteStanding(const Pose& T_moved);
  /** Whether scans fit nothing, one after the other, and there is no odometry: what follows is
   * registered to each other. */
  bool isTorn() const;
  /** Information of a step that was not registered, frame of its end. */
  Matrix6 guessed(const Pose& T_step) const;
  /** Where the last keyframes' points have a scan, frame of the last one; nothing: it fits badly.
   */
  std::optional<Registration> track(const Seen& seen, const Pose& T_step);
  std::optional<Registration> searchAround(const Seen& seen, const Pose& T_local_guess,
                                           const PlaneSearch::Window& window) const;
  PlaneSearch::Window windowAround(const Pose& T_step, const Matrix6& information) const;
  /** Whether enough of a scan's points are where others saw some, of those that can be. */
  bool isCovered(const Registration& r, const Seen& seen) const;
  /** \param T_step as it was predicted; m_T_step is as it was registered. */
  void learn(const Pose& T_step, const Registration& registered);
  /** Height and tilt are odometry's: as was said, or because no beam ever told of them. */
  bool isLevel() const { return (m_options.level && m_hasOdometry) || m_scale.isPlanar; }
  /** Information of height and tilt that are known, frame of the robot. */
  Matrix6 levelOf(const Pose& T_odometry_robot) const;
  /** Height, roll and pitch as odometry has them. */
  Pose levelled(const Pose& T_map_robot, const Pose& T_odometry_robot) const;
  std::vector<Submap> submapsOf(const LabeledCloud& cloud, const std::vector<double>& cells) const {
    return semantic_slam::submapsOf(cloud, cells, m_options.useClasses, m_scale.isPlanar);
  }
  /** What a search in a plane compares, see there. */
  PlanePoints upright(const LabeledCloud& cloud) const {
    return uprightPoints(cloud, m_scale.isPlanar, m_scale.gridCell);
  }
  Registration match(const std::vector<Submap>& submaps, const Seen& seen,
                     const Pose& T_submap_guess, const Matrix6& prior) const;

  /** A column of ground (x, y), as wide as the coarse cubes that scans are registered to. */
  using Column = std::pair<double, double>;
  std::set<Column> columnsSeenFrom(std::size_t keyframe) const;
  /** What is left of the graph. \param isGone by keyframe \param now by keyframe: its number */
  std::vector<PoseEdge> edgesOfOthers(const std::vector<bool>& isGone,
                                      const std::vector<std::size_t>& now) const;

  // --- Pieces: where scans were lost, the robot may have been carried, or a part of the log is
  // missing (SlamPieces.cpp) ---
  /** So that a scan that fits nothing is an event, in a plane. Where many fit nothing, something
   * else is wrong. */
  bool lossIsRare() const;
  /** Looks whether what follows a loss, so many keyframes, fits what was before it. */
  void settleDoubt(std::size_t later);
  bool holdsAcross(std::size_t first) const;
  /** A piece begins, which nothing but odometry connects to what was before. */
  void tearAt(std::size_t first);
  /** Between pieces, by more than odometry errs in a step: m from where it leads across. */
  std::vector<double> gaps() const;
  /** Keyframes, in their order, that more than odometry connects. */
  using Part = std::vector<std::size_t>;
  /** All keyframes are in one; the largest first. */
  std::vector<Part> parts() const;
  /** While the robot drives: searches the piece that it is in. \return whether poses moved */
  bool joinPiece();
  /** At the end: searches all that is not in the largest part. \return whether poses moved */
  bool joinParts();
  /** Whether its frame is that of the map: looks at a reference connect it, or, where there are
   * none, it has the first keyframe. */
  bool holdsMap(const Part& part) const;
  /** \param finds of keyframes of the part that agree with each other; one is enough if it is where
   * odometry has it. \return whether it is in its place now */
  bool join(const Part& part, const std::vector<PoseEdge>& finds);
  /** Stretches of a part that were found in another, most of those that agree. */
  std::vector<PoseEdge> findPart(const Part& others, const Part& part) const;
  struct Places {
    Part keyframes;
    PlaneSearch search;  ///< of what they saw
    Eigen::Vector3d middle;
    PlaneSearch::Window window;  ///< all of it
  };
  Places placesOf(const Part& part) const;
  using Stretch = std::pair<std::size_t, std::size_t>;  ///< first and last keyframe
  /** Each has three quarters of its keyframes in common with the next one. */
  static std::vector<Stretch> stretchesOf(const Part& part);
  /** Where what a stretch saw fits best. */
  std::optional<PoseEdge> findStretch(const Places& places, const Stretch& keyframes,
                                      std::size_t& looks) const;

  // --- Loops and the reference ---
  bool closeLoops();
  /** Keyframes of before a keyframe that it may be near, one of each visit; the nearest first.
   * \param farthest from each, m */
  std::vector<std::size_t> placesOf(std::size_t keyframe,
                                    const std::function<double(std::size_t)>& farthest) const;
  /** Where a stretch fits best. */
  struct Look {
    Pose T_map;         ///< of the keyframe whose frame the stretch is in
    double off, score;  ///< m from where the poses have it; share of the highest
    bool isAlone;
    std::size_t first, last;  ///< keyframes that it was compared with
  };
  std::optional<Look> lookAround(std::size_t place, std::size_t keyframe, const Seen& stretch,
                                 const PlaneSearch::Window& window, std::size_t& looks) const;
  std::optional<PoseEdge> edgeOf(const Look& look, const Seen& stretch, std::size_t keyframe) const;
  /** At the end, where nothing leads from a place to one of before beside it: drift that hid it
   * from the robot is gone with other loops. \return whether poses moved */
  bool closeLeftLoops();
  /** Whether a loop leads from beside one to beside the other. */
  bool isClosed(std::size_t place, std::size_t keyframe) const;
  /** What two looks at least contradict the poses by, m; 0: next to nothing. */
  double apartBy(const std::vector<PoseEdge>& looks) const;
  /** Searches the newest keyframe's stretch around a place. */
  std::optional<PoseEdge> edgeTo(std::size_t place, const Seen& stretch, double way,
                                 std::size_t& looks);
  /** Registers a keyframe's stretch to what some keyframes saw, nearest to a guess.
   * \param beside so many of them to each side */
  std::optional<PoseEdge> edgeNear(const Pose& T_map_guess, std::size_t first, std::size_t last,
                                   std::size_t beside, const Seen& stretch, std::size_t keyframe,
                                   double leastMatched) const;
  /** From a keyframe to each, m: the shortest way along steps and loops. The poses of both
   * are off by what was driven on it (Bosse et al., "Simultaneous Localization and Map Building in
   * Large-Scale Cyclic Environments Using the Atlas Framework", 2004). */
  std::vector<double> waysFrom(std::size_t keyframe) const;
  /** To each side, in a stretch. */
  std::size_t keyframesBeside() const {
    return static_cast<std::size_t>(m_scale.submapKeyframes / 2);
  }
  /** Share of the highest score of every other keyframe of the newest stretch in those between: as
   * well it fits where it was before. */
  double ownScore() const;
  /** Where the robot may be off after a way (m). */
  PlaneSearch::Window windowAfter(double way) const;
  /** Information of what was found, by its points and by what is known of such finds at most. */
  Matrix6 bothErrors(const Matrix6& most, const Registration& found, std::size_t keyframe) const;
  /** Points of some keyframes in the frame of one of them. */
  Seen pointsOf(std::size_t first, std::size_t last, std::size_t frame) const;
  std::optional<Registration> findInReference(const Seen& seen, const Pose& T_map_guess);
  /** The edge that says where in the reference a keyframe was found. */
  PoseEdge lookOf(std::size_t keyframe, const Registration& found) const;
  bool followReference();
  /** Takes an edge of the newest keyframe, and those before it that say the same of where the robot
   * is; one alone has to wait. \return whether poses moved */
  bool confirm(std::vector<PoseEdge>& pending, const PoseEdge& edge);
  /** Where an edge has its second pose. */
  Pose T_map_b(const PoseEdge& edge) const;
  bool agree(const PoseEdge& before, const PoseEdge& edge) const;
  /** \param added edges at the end that are new \return whether they are kept */
  bool optimizeWith(std::size_t added);
  void optimizePoses();
  double worstStep() const;

  SlamOptions m_options;
  std::optional<strict_files::ScratchFile> m_file;  ///< of keyframes' clouds
  SensorScale m_scale;
  std::vector<Keyframe> m_keyframes;
  std::vector<Pose> m_poses;
  std::vector<PoseEdge> m_edges;
  SlamReport m_report;
  LocalMap m_local;
  MotionNoise m_noise;
  bool m_hasOdometry = true;
  /** The last scan: in the frame of the last keyframe, where odometry had it, and how it got there.
   */
  Pose m_T_keyframe_last = Pose::Identity(), m_T_odometry_last = Pose::Identity(),
       m_T_step = Pose::Identity();
  Pose m_T_odometry_step = Pose::Identity();   ///< to this scan, as odometry says
  Pose m_T_keyframe_found = Pose::Identity();  ///< of the last scan that was registered
  Pose m_T_standing = Pose::Identity();        ///< by scans, since odometry moved
  double m_lastSeconds = 0;                    ///< when
  Vector6 m_velocity = Vector6::Zero();        ///< then, robot's frame
  double m_unmeasured = 0;                     ///< s since the velocity was measured
  Pose m_T_unmeasured = Pose::Identity();      ///< and how the robot moved meanwhile
  SensorScan m_first;                          ///< until its velocity is known, if it has times
  int m_lostInRow = 0;                         ///< scans since then
  int m_stepScans = 1;                         ///< scans from the registration before to the last
  int m_numSmall = 0;                          ///< small steps since the last registration
  double m_wayOfOdometry = 0, m_wayOfScans = 0, m_turnOfOdometry = 0, m_turnOfScans = 0;
  double m_lastLook = 0, m_lastReferenced = 0;  ///< m of the way
  std::size_t m_looked = 0;                     ///< keyframes whose loops may have gone
  double m_lastWholeLook = 0;                   ///< when all of a window was searched
  double m_lostWay = 0;                         ///< m where scans fit nothing
  std::size_t m_looks = 0;                      ///< left for this keyframe
  std::vector<PoseEdge> m_pendingLoops, m_pendingReferences;  ///< they may be wrong
  bool m_isOptimized = true;
  std::optional<std::size_t> m_doubted;  ///< first keyframe after a loss
  std::vector<std::size_t> m_tears;      ///< first keyframes of all pieces but the first, in order
  double m_nextJoin = 0;                 ///< m of the last one's way, when it is searched
  std::optional<PoseEdge> m_pendingPiece;       ///< where it was found last
  Reference m_reference;                        ///< none: there is no map
  Matrix6 m_mostOfReference = Matrix6::Zero();  ///< information, at most
};

}  // namespace semantic_slam
