#pragma once
#include <semantic_types/ClassTable.h>
#include <semantic_types/LabeledCloud.h>
#include <strict_files/OptionList.h>

#include <Eigen/Geometry>
#include <string>
#include <vector>

namespace semantic_driving {

/** How those who move are told from the points of scans, and followed. */
struct MoverOptions {
  std::string classes = "person";  ///< names, with commas between; empty: nobody is followed
  double radius = 12;              ///< how far from the sensor, meters
  double apart = 0.4;              ///< points of one are no farther apart, meters
  int leastPoints = 3;             ///< of one
  double size = 0.35;              ///< radius about the middle, meters
  double placeNoise = 0.1;         ///< of a middle that is seen: standard deviation, meters
  double firstSpeed = 1;           ///< of one who is seen for the first time, likewise, m/s
  double acceleration = 0.6;       ///< of one who walks, likewise, m/s^2
  double fastest = 2.5;            ///< a middle that is seen farther off is somebody else's, m/s
  double still = 0.25;             ///< who is slower stands, m/s
  double forget = 1.5;             ///< seconds until one who is not seen any more is forgotten

  void describe(strict_files::OptionList& list);
  /** \throw std::invalid_argument naming the option and its value. */
  void validate() const;
};

/** Somebody who moves, or could. */
struct Mover {
  Eigen::Vector2d place = Eigen::Vector2d::Zero();     ///< meters
  Eigen::Vector2d velocity = Eigen::Vector2d::Zero();  ///< m/s; zero: stands
  double size = 0;                                     ///< radius, meters
  double speedNoise = 0;  ///< standard deviation of either component of the velocity, m/s

  bool stands() const { return velocity.isZero(); }
  Eigen::Vector2d placeAfter(double seconds) const { return place + seconds * velocity; }
};
using Movers = std::vector<Mover>;

/** Follows those who move from scan to scan: points of their classes make clusters, each with a
 * Kalman filter of constant velocity and white acceleration (Bar-Shalom, Li and Kirubarajan,
 * "Estimation with applications to tracking and navigation", 2001, 6.3.2), the nearest goes with
 * the nearest. Nothing but scans is asked. */
class MoverTracker {
 public:
  /** \throw std::invalid_argument bad options, or a name that no class has. */
  MoverTracker(const MoverOptions& options, const semantic_types::ClassTable& classes);

  /** By class: whether it moves. */
  const std::vector<bool>& isMover() const { return m_isMover; }

  /** Adds a sensor's points to the scan that the next update() takes. */
  void see(const semantic_types::LabeledCloud& cloud, const Eigen::Isometry3d& T_map_sensor);
  /** The scan is complete. \param seconds when it was taken */
  void update(double seconds);

  /** Where they are at a time at or after the last update(), map frame. */
  Movers at(double seconds) const;

 private:
  struct Track {
    Eigen::Vector2d place, velocity;
    double pp, pv, vv;  ///< covariance of place and velocity, the same along both axes
    double seenAt;
  };
  std::vector<Eigen::Vector2d> middles() const;
  void predict(Track& track, double seconds) const;
  void correct(Track& track, const Eigen::Vector2d& middle) const;

  MoverOptions m_options;
  std::vector<bool> m_isMover;  ///< by class id
  std::vector<Eigen::Vector2d> m_seen;
  std::vector<Track> m_tracks;
  double m_updatedAt = 0;
};

}  // namespace semantic_driving
