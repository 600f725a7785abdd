#pragma once
#include <semantic_types/ClassTable.h>
#include <semantic_types/LabeledCloud.h>
#include <strict_files/OptionList.h>

#include <Eigen/Geometry>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace semantic_driving {

/** How those who move are told from the points of scans, and followed. */
struct MoverOptions {
  std::string classes = "person";  ///< names, with commas between; empty: nobody is followed
  double radius = 12;              ///< how far from the sensor, meters

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

  /** A scan without those who walk, or were seen for the first time just now: what is left of them
   * is soon somewhere else, and may be where no sensor sees it again. Who stands stays.
   * \param T_map_sensor where the scan was taken, at the last update() */
  semantic_types::LabeledCloud withoutPassing(const semantic_types::LabeledCloud& cloud,
                                              const Eigen::Isometry3d& T_map_sensor) const;
  /** Where somebody stood who walks away now, map frame; told once. */
  std::vector<Eigen::Vector2d> takeLeft() { return std::exchange(m_left, {}); }

  /** Where they are at a time at or after the last update(), map frame. */
  Movers at(double seconds) const;

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

  MoverOptions m_options;
  std::vector<bool> m_isMover;  ///< by class id
  std::vector<Eigen::Vector2d> m_seen;
  std::vector<Track> m_tracks;
  std::vector<Eigen::Vector2d> m_left;
  double m_updatedAt = 0;
};

}  // namespace semantic_driving
