#pragma once
#include <semantic_driving/DriveOptions.h>
#include <semantic_planning/vehicle/Footprint.h>
#include <semantic_types/ClassTable.h>
#include <semantic_types/LabeledCloud.h>
#include <strict_files/OptionList.h>
#include <Eigen/Geometry>

#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace semantic_driving {

/** How those who move are told from the points of scans, and followed. */
struct DynamicObstacleOptions {
  std::string classes = "person";  ///< names, with commas between; empty: nobody is followed
  double radius = 12;  ///< how far from the sensor, meters; Navigator sets it by the vehicle

  void describe(strict_files::OptionList& list);
  /** \throw std::invalid_argument naming the option and its value. */
  void validate() const;
};

/** Somebody who moves, or could. */
struct DynamicObstacle {
  Eigen::Vector2d place = Eigen::Vector2d::Zero();     ///< meters
  Eigen::Vector2d velocity = Eigen::Vector2d::Zero();  ///< m/s; zero: stands
  double size = 0;                                     ///< radius, meters
  double speedNoise = 0;  ///< standard deviation of either component of the velocity, m/s

  bool stands() const { return velocity.isZero(); }
  Eigen::Vector2d placeAfter(double seconds) const { return place + seconds * velocity; }
};
using DynamicObstacles = std::vector<DynamicObstacle>;

/** Follows people and vehicles from scan to scan. Points of their classes make clusters, and the
 * nearest goes with the nearest. Each has a Kalman filter of constant velocity and white
 * acceleration (Bar-Shalom, Li and Kirubarajan, "Estimation with applications to tracking and
 * navigation", 2001, 6.3.2). Nothing but scans is asked. */
class DynamicObstacleTracker {
 public:
  /** \throw std::invalid_argument bad options, or a name that no class has. */
  DynamicObstacleTracker(const DynamicObstacleOptions& options,
                         const semantic_types::ClassTable& classes);

  /** By class: whether it moves. */
  const std::vector<bool>& isMover() const { return m_isMover; }

  /** Adds a sensor's points to the scan that the next update() takes. */
  void see(const semantic_types::LabeledCloud& cloud, const Eigen::Isometry3d& T_map_sensor);
  /** The scan is complete. \param seconds when it was taken */
  void update(double seconds);

  /** A scan without those who walk, or were seen for the first time just now. They are soon
   * somewhere else, and may be left in the map where no sensor looks again. Who stands stays.
   * \param T_map_sensor where the scan was taken, at the last update() */
  semantic_types::LabeledCloud withoutPassing(const semantic_types::LabeledCloud& cloud,
                                              const Eigen::Isometry3d& T_map_sensor) const;
  /** Where somebody stood who walks away now, map frame; told once. */
  std::vector<Eigen::Vector2d> takeLeft() { return std::exchange(m_left, {}); }

  /** Where they are at a time at or after the last update(), map frame. */
  DynamicObstacles at(double seconds) const;

 private:
  struct Track {
    Eigen::Vector2d place, velocity;
    double pp, pv, vv;  ///< covariance of place and velocity, the same along both axes
    double seenAt;
    double walkedAt;                        ///< last
    std::optional<Eigen::Vector2d> stands;  ///< where, for a while
  };
  bool isOfMover(const semantic_types::LabeledCloud& cloud, std::size_t i) const;
  void noteStanding(Track& track, double seconds);
  std::vector<Eigen::Vector2d> middles() const;
  static void predict(Track& track, double seconds);
  static void correct(Track& track, const Eigen::Vector2d& middle);

  DynamicObstacleOptions m_options;
  std::vector<bool> m_isMover;  ///< by class id
  std::vector<Eigen::Vector2d> m_seen;
  std::vector<Track> m_tracks;
  std::vector<Eigen::Vector2d> m_left;
  double m_updatedAt = 0;
};

/** Speed and separation: the highest speed up to a wanted one at which nobody who moves on as now
 * meets a vehicle that moves.
 *
 * For each of those who move the speed must be such that
 * - while the vehicle brakes to a standstill, after its time of reaction, nobody's predicted place
 *   touches it before it is as slow as DriveOptions::kSlowest. The place grows with what is not
 *   known of the velocity. This is passive safety: if there is contact, the vehicle is at rest.
 *   (Bouraine, Fraichard and Salhi, "Provably safe navigation for mobile robots with limited
 *   field-of-views in dynamic environments", 2012; that persons come on during reaction and
 *   braking is ISO 13855's distance.)
 * - nobody who walks meets the vehicle where it would stand then, either, for a
 *   second, or else not where it would be if it went on. So it lets others pass, or passes before
 *   them, and goes on beside and behind them.
 *
 * Where braking comes too late it goes on if that helps.
 * \param poseAfter where the vehicle is after some meters along its way, map frame
 * \param speed, acceleration now along the way, m/s and m/s^2, not negative for the speed
 * \param wanted m/s, not negative
 * \param movers now, map frame
 * \return 0 to wanted, m/s */
double separationSpeed(const std::function<mrpt::math::TPose2D(double)>& poseAfter, double speed,
                       double acceleration, double wanted, const DynamicObstacles& movers,
                       const semantic_planning::Footprint& footprint, const DriveOptions& options);

}  // namespace semantic_driving
