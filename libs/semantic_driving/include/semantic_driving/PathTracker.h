#pragma once
#include <semantic_abstraction/AbstractionOptions.h>
#include <semantic_driving/DriveOptions.h>
#include <semantic_driving/DrivePath.h>
#include <semantic_planning/vehicle/Footprint.h>

namespace semantic_driving {

/** Drives a path as it is, forward and backward stretches alike, and stops before what stands in
 * its way. The path's curvature steers; errors in place and heading are corrected as in Samson,
 * "Control of chained systems", 1995 (the law for a path given by its curvature). */
class PathTracker {
 public:
  /** \throw std::invalid_argument bad options. */
  PathTracker(const DriveOptions& options, semantic_planning::Footprint footprint);

  void setPath(DrivePath path);
  /** \param speeds highest ones by class id, m/s (DriveOptions::classSpeeds()); without, the same
   * on all. */
  void setClassSpeeds(std::vector<double> speeds) { m_classSpeeds = std::move(speeds); }
  const DrivePath& path() const { return m_path; }
  /** Arc length of the place on the path where the vehicle was last. */
  double progress() const { return m_progress; }
  /** Nothing is left of the path. */
  bool finished() const;
  /** Distance from the path at the last locate(), meters. */
  double offset() const { return m_offset; }

  /** Looks for the vehicle on the path, from where it was on. */
  void locate(const DriveState& state);
  /** Meters of the path ahead that are free of obstacles, up to the look-ahead and the end of the
   * stretch. */
  double freeAhead(const DriveState& state, const ObstaclePoints& obstacles) const;
  /** \param speedLimit m/s */
  DriveCommand command(const DriveState& state, const ObstaclePoints& obstacles,
                       double speedLimit) const;

  /** The highest speed up to a limit that brakes in time for curves, classes and the end of the
   * stretch, m/s. \param free meters without an obstacle, if less than the look-ahead */
  double speedBefore(double free, double limit) const;

  /** Whether a command brings the footprint's middle nearer to an obstacle that is within a margin
   * of the footprint. */
  bool approaches(const DriveCommand& command, const ObstaclePoints& obstacles,
                  double margin) const;
  /** Whether the footprint at a pose in the vehicle's frame, with a margin around it, is free. */
  bool isFree(const mrpt::math::TPose2D& relative, const ObstaclePoints& obstacles,
              double margin) const;
  const DriveOptions& options() const { return m_options; }
  const semantic_planning::Footprint& footprint() const { return m_footprint; }

 private:
  double curvatureAt(double s) const;
  double speedAt(double s) const;

  DriveOptions m_options;
  semantic_planning::Footprint m_footprint;
  DrivePath m_path;
  std::vector<double> m_classSpeeds;
  double m_progress = 0, m_offset = 0;
};

/** Where a drive wants all detail of the compressed tree: p(x) is 1 around the vehicle and along
 * the path ahead, else 0. */
struct FocusOptions {
  double corridor = 0;  ///< on both sides of the path ahead, meters; 0: p(x) is 1 everywhere
  double around = 0;    ///< around the vehicle, meters; 0: a Navigator takes where obstacles matter

  bool isOn() const { return corridor > 0; }
  void describe(strict_files::OptionList& list);
  /** \throw std::invalid_argument naming the option and its value. */
  void validate() const;
};

/** The regions of p(x) for a vehicle (map frame, meters) on its path; none without a focus. A
 * stretch of the path keeps its region as long as any of it is ahead, so that little changes from
 * call to call. */
std::vector<semantic_octree::Region> regionsAhead(const DrivePath& path, double progress,
                                                  const Eigen::Vector3d& vehicle,
                                                  const FocusOptions& options);

}  // namespace semantic_driving
