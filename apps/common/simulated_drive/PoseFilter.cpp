#include "PoseFilter.h"

#include <mrpt/math/wrap2pi.h>
#include <semantic_map/PointLikelihood.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace simulated_drive {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using mrpt::math::TPose2D;
using semantic_octree::SemanticOcTree;

namespace {

constexpr double kDegree = M_PI / 180;

/** Variances of x, y (m^2) and heading. */
Matrix3d uncertaintyOfMap(const PoseOptions& options) {
  const double place = options.mapPlace, heading = options.mapHeading * kDegree;
  return Vector3d(place * place, place * place, heading * heading).asDiagonal();
}

Vector3d placed(const TPose2D& pose, const Vector3d& point) {
  const double c = std::cos(pose.phi), s = std::sin(pose.phi);
  return {pose.x + c * point.x() - s * point.y(), pose.y + s * point.x() + c * point.y(),
          point.z()};
}

bool isKnown(const SemanticOcTree& map, const Vector3d& point) {
  octomap::OcTreeKey key;
  return map.coordToKeyChecked(point.x(), point.y(), point.z(), key) && map.search(key);
}

/** Whether the map tells where a point is: beside it is free space, or all around it is known and
 * of several classes. Points on even ground of one class tell nothing, and at the border of what is
 * known they would draw the robot back to where all their places are known. */
bool tells(const SemanticOcTree& map, const Vector3d& point) {
  using Status = semantic_octree::CellState::Status;
  const auto at = [&](double x, double y) {
    return map.query(point.x() + x, point.y() + y, point.z());
  };
  const auto here = at(0, 0);
  if (here.status == Status::Unknown) return false;
  const double side = 1.5 * map.getResolution();
  bool unknown = false, free = false, differs = false;
  for (const auto& beside : {at(side, 0), at(-side, 0), at(0, side), at(0, -side)}) {
    unknown = unknown || beside.status == Status::Unknown;
    free = free || beside.status == Status::Free;
    differs = differs || beside.likeliestClass != here.likeliestClass;
  }
  return free || (differs && !unknown);
}

}  // namespace

void PoseOptions::describe(strict_files::OptionList& list) {
  using strict_files::above;
  using strict_files::atLeast;
  using strict_files::between;
  list.add("odometry_noise", odometryNoise, "m", between(0, 1),
           "standard deviation of the way after a meter; grows with its square root");
  list.add("turn_noise", turnNoise, "degrees", between(0, 90),
           "of the heading after a meter; grows alike");
  list.add("correct", correct, "", "by the map's likelihood of each scan; or odometry alone");
  list.add("particles", particles, "", atLeast(10), "of the filter");
  list.add("points", points, "", atLeast(30), "of all scans of a moment");
  list.add("point_weight", pointWeight, "", {0, 1, false},
           "of each point's log-likelihood, as neighbors are not independent");
  list.add("fewest_points", fewestPoints, "", atLeast(1),
           "that tell where they are, to be worth a correction");
  list.add("map_place", mapPlace, "m", above(0), "what the map itself is uncertain by");
  list.add("map_heading", mapHeading, "degrees", above(0), "and in its heading");
}

void PoseOptions::validate() const { strict_files::checkOptions(*this, "PoseOptions"); }

PoseFilter::PoseFilter(const TPose2D& start, const PoseOptions& options, std::uint64_t seed)
    : m_options(options),
      m_pose(start),
      m_odometry(start),
      m_noise(synthetic_world::Random::ofStream(seed, 1, 0)),
      m_draws(synthetic_world::Random::ofStream(seed, 2, 0)) {
  m_options.validate();
}

void PoseFilter::move(const TPose2D& motion) {
  const double root = std::sqrt(std::hypot(motion.x, motion.y));
  const double alongDeviation = m_options.odometryNoise * root;
  const double turnDeviation = m_options.turnNoise * kDegree * root;
  TPose2D measured = motion;
  measured.x += alongDeviation * m_noise.normal();
  measured.phi += turnDeviation * m_noise.normal();

  const double c = std::cos(m_pose.phi), s = std::sin(m_pose.phi);
  const TPose2D before = m_pose;
  m_pose = m_pose + measured;
  m_odometry = m_odometry + measured;
  Matrix3d change = Matrix3d::Identity();
  change(0, 2) = before.y - m_pose.y;
  change(1, 2) = m_pose.x - before.x;
  const Vector3d along = alongDeviation * Vector3d(c, s, 0), turn(0, 0, turnDeviation);
  m_covariance = change * m_covariance * change.transpose() + along * along.transpose() +
                 turn * turn.transpose();
}

void PoseFilter::correct(const SemanticOcTree& map, const std::vector<Observation>& seen,
                         const Eigen::Isometry3d& T_level_robot) {
  const Points points = select(map, seen, T_level_robot);
  if (points.size() < static_cast<std::size_t>(m_options.fewestPoints)) return;
  const semantic_map::PointLikelihood likelihood(map);
  // Behind what it saw the map is unknown, before it free. If the one were likelier than the other,
  // the robot, which sees most ahead, would believe to be ahead of where it is.
  const double nowhere = map.filterParameters().falseAlarmProbability;
  const Particles particles = drawParticles();
  std::vector<double> logWeights;
  for (const Vector3d& particle : particles) {
    const TPose2D pose = shifted(particle);
    double sum = 0;
    for (const Point& p : points) {
      const Vector3d point = placed(pose, p.place);
      sum += std::log(isKnown(map, point) ? likelihood(point, p.id) : nowhere);
    }
    logWeights.push_back(m_options.pointWeight * sum);
  }
  fit(particles, std::move(logWeights));
}

PoseFilter::Points PoseFilter::select(const SemanticOcTree& map,
                                      const std::vector<Observation>& seen,
                                      const Eigen::Isometry3d& T_level_robot) const {
  Points selected;
  for (const Observation& o : seen) {
    const Eigen::Isometry3d T_level_sensor = T_level_robot * o.T_robot_sensor;
    const auto most = static_cast<std::size_t>(m_options.points) / seen.size();
    const std::size_t step = std::max<std::size_t>(1, o.cloud.size() / most);
    for (std::size_t i = step / 2; i < o.cloud.size(); i += step) {
      const Vector3d place = T_level_sensor * o.cloud.points[i].cast<double>();
      if (tells(map, placed(m_pose, place))) selected.push_back({place, o.cloud.classes[i]});
    }
  }
  return selected;
}

/** In pairs on both sides of the mean: where the map tells nothing, nothing changes. */
PoseFilter::Particles PoseFilter::drawParticles() {
  m_covariance += uncertaintyOfMap(m_options);
  const Matrix3d root = m_covariance.llt().matrixL();
  Particles particles;
  for (int i = 0; i < m_options.particles / 2; ++i) {
    const double x = m_draws.normal(), y = m_draws.normal(), turn = m_draws.normal();
    particles.push_back(root * Vector3d(x, y, turn));
    particles.push_back(-particles.back());
  }
  return particles;
}

TPose2D PoseFilter::shifted(const Vector3d& difference) const {
  return {m_pose.x + difference.x(), m_pose.y + difference.y(),
          mrpt::math::wrapToPi(m_pose.phi + difference.z())};
}

void PoseFilter::fit(const Particles& particles, std::vector<double> weights) {
  const double largest = *std::max_element(weights.begin(), weights.end());
  double sum = 0;
  for (double& w : weights) sum += w = std::exp(w - largest);
  Vector3d mean = Vector3d::Zero();
  for (std::size_t i = 0; i < particles.size(); ++i) mean += weights[i] / sum * particles[i];
  m_covariance.setZero();
  for (std::size_t i = 0; i < particles.size(); ++i) {
    const Vector3d d = particles[i] - mean;
    m_covariance += weights[i] / sum * d * d.transpose();
  }
  m_pose = shifted(mean);
}

}  // namespace simulated_drive
