#include <semantic_slam/Registration.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <random>
#include <unordered_map>

namespace semantic_slam {

using semantic_types::ClassId;
using semantic_types::kNoClass;

namespace {

constexpr int kMostIterations = 40;
/** Steps, m, at which the iteration ends; in coarse cubes, as a share of their edge; 1/m of turns.
 */
constexpr double kStill = 2e-4, kStillCoarse = 2e-3, kPerMeter = 0.1;
/** A distribution has as many points at least as its covariance has numbers. */
constexpr int kFewestInSpace = 6, kFewestInPlane = 3;
/** Least standard deviation of a surface, of a cube's edge: in small cubes it counts as thin as it
 * is, and those of large ones reach out to points that are far off yet. */
constexpr double kThinnest = 0.03;
/** The least ratio of a surface's two widths, squared. A narrow one is but a ring that a LiDAR left
 * on it. */
constexpr double kNarrowest = 0.3;
/** Squared distances, in standard deviations, at which a point's weight is a quarter, and up to
 * which it matches. */
constexpr double kScale = 9, kMatch = 9;
/** Sines of beams' heights, up to which they are horizontal: a laser scanner, somewhat tilted. */
constexpr float kHorizontal = 0.03f;

Eigen::Array3i cubeOf(const Eigen::Vector3d& p, double edge) {
  return (p.array() / edge).floor().cast<int>();
}

/** 18 bits a coordinate: enough for cubes of centimeters. */
std::uint64_t pack(const Eigen::Array3i& cube) {
  std::uint64_t key = 0;
  for (int i = 0; i < 3; ++i) key = key << 18 | (static_cast<unsigned>(cube[i]) & 0x3ffff);
  return key;
}

ClassId classOf(const LabeledCloud& cloud, std::size_t i) {
  return cloud.classes.empty() ? kNoClass : cloud.classes[i];
}

/** One iteration's sums. */
struct Normals {
  Matrix6 H = Matrix6::Zero();
  Vector6 b = Vector6::Zero();
  std::size_t covered = 0, matched = 0;

  Normals(const Submap& submap, const LabeledCloud& scan, const Eigen::Isometry3d& T) {
    for (std::size_t i = 0; i < scan.size(); ++i) {
      const Eigen::Vector3d p = scan.points[i].cast<double>(), q = T * p;
      double squared = 0;
      const Submap::Distribution* d = submap.find(q, classOf(scan, i), squared);
      if (!d) continue;
      ++covered;
      matched += squared < kMatch;
      const double root = 1 + squared / kScale, weight = 1 / (root * root);
      Eigen::Matrix<double, 3, 6> J;  // of T poseOf(x) p
      Eigen::Matrix3d cross;
      cross << 0, -p.z(), p.y(), p.z(), 0, -p.x(), -p.y(), p.x(), 0;
      J << T.linear(), -T.linear() * cross;
      const Eigen::Matrix<double, 6, 3> JtW = J.transpose() * d->evidence * weight;
      H += JtW * J;
      b -= JtW * (q - d->mean);
    }
  }
};

}  // namespace

auto Submap::cellOf(const Eigen::Vector3d& point) const -> Eigen::Array3i {
  Eigen::Array3i cell = cubeOf(point, m_cellSize);
  if (m_isPlanar) cell.z() = 0;
  return cell;
}

auto Submap::keyOf(const Eigen::Array3i& cell, ClassId id) const -> Key {
  return pack(cell) << 8 | (m_useClasses ? id : kNoClass);
}

void Submap::add(const LabeledCloud& cloud, const Eigen::Isometry3d& T_submap_cloud,
                 double deviation) {
  const Eigen::Matrix3d spread = deviation * deviation * Eigen::Matrix3d::Identity();
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const Eigen::Vector3d p = T_submap_cloud * cloud.points[i].cast<double>();
    const Key key = keyOf(cellOf(p), classOf(cloud, i));
    Sum& s = m_sums[key];
    if (!s.isNew) m_new.push_back(key);
    s.isNew = true;
    // Relative to the cube, so that squares stay exact far from the origin.
    const Eigen::Vector3d r = p - cellOf(p).cast<double>().matrix() * m_cellSize;
    s.n += 1;
    s.sum += r;
    s.squares += r * r.transpose() + spread;
  }
}

auto Submap::distributionOf(const Sum& s) const -> Distribution {
  const double ofFilledCube = 12 / (m_cellSize * m_cellSize);
  const Eigen::Vector3d mean = s.sum / s.n;
  Eigen::Matrix3d covariance = s.squares / s.n - mean * mean.transpose();
  // What a plane of beams says of height is zero: it is made the widest axis, then left out.
  if (m_isPlanar) {
    covariance.row(2).setZero();
    covariance.col(2).setZero();
    covariance(2, 2) = covariance.trace() + 1;
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(covariance);
  const double thinnest = kThinnest * m_cellSize;
  Eigen::Vector3d variances = axes.eigenvalues().cwiseMax(thinnest * thinnest);
  if (!m_isPlanar) variances[1] = std::max(variances[1], kNarrowest * variances[2]);
  const auto along = [&axes](const Eigen::Vector3d& values) -> Eigen::Matrix3d {
    return axes.eigenvectors() * values.asDiagonal() * axes.eigenvectors().transpose();
  };
  Eigen::Vector3d information = variances.cwiseInverse();
  if (m_isPlanar) information[2] = 0;
  return {mean, along(information), along((information.array() - ofFilledCube).max(0).matrix())};
}

void Submap::finish() {
  for (const Key key : m_new) {
    Sum& s = m_sums[key];
    s.isNew = false;
    if (s.n < (m_isPlanar ? kFewestInPlane : kFewestInSpace)) continue;
    Eigen::Vector3d corner;
    for (int i = 0; i < 3; ++i) {
      const auto bits = static_cast<std::int64_t>(key >> (8 + 18 * (2 - i)) & 0x3ffff);
      corner[i] = static_cast<double>(bits >= 0x20000 ? bits - 0x40000 : bits) * m_cellSize;
    }
    Distribution d = distributionOf(s);
    d.mean += corner;
    m_distributions[key] = d;
  }
  m_new.clear();
}

auto Submap::find(const Eigen::Vector3d& point, ClassId id, double& squaredDistance) const
    -> const Distribution* {
  const Eigen::Array3i cell = cellOf(point);
  const Distribution* best = nullptr;
  const auto look = [&](const Eigen::Array3i& c) {
    const auto found = m_distributions.find(keyOf(c, id));
    if (found == m_distributions.end()) return;
    const Eigen::Vector3d e = point - found->second.mean;
    const double squared = e.dot(found->second.information * e);
    if (best && squared >= squaredDistance) return;
    best = &found->second;
    squaredDistance = squared;
  };
  look(cell);
  for (int axis = 0; axis < (m_isPlanar ? 2 : 3); ++axis)
    for (const int side : {-1, 1}) {
      Eigen::Array3i beside = cell;
      beside[axis] += side;
      look(beside);
    }
  return best;
}

bool isHorizontal(const LabeledCloud& cloud, const Eigen::Isometry3d& T_robot_sensor) {
  const Eigen::Vector3f up = T_robot_sensor.linear().row(2).transpose().cast<float>();
  return std::all_of(cloud.points.begin(), cloud.points.end(), [&up](const Eigen::Vector3f& p) {
    return std::abs(up.dot(p)) <= kHorizontal * p.norm();
  });
}

LabeledCloud thinned(const LabeledCloud& cloud, double cubeSize, double maxRange) {
  struct Drawn {
    std::size_t at;        // among the thinned
    unsigned numSeen = 0;  // in the cube
  };
  LabeledCloud thin;
  std::unordered_map<std::uint64_t, Drawn> cubes;
  std::minstd_rand random;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const Eigen::Vector3d p = cloud.points[i].cast<double>();
    if (!(p.norm() <= maxRange)) continue;
    Drawn& drawn = cubes.try_emplace(pack(cubeOf(p, cubeSize)), Drawn{thin.size()}).first->second;
    if (random() % ++drawn.numSeen != 0) continue;
    if (drawn.at == thin.size()) {
      thin.points.emplace_back();
      thin.classes.emplace_back();
    }
    thin.points[drawn.at] = cloud.points[i];
    thin.classes[drawn.at] = classOf(cloud, i);
  }
  return thin;
}

Registration registerScan(const std::vector<const Submap*>& submaps, const LabeledCloud& scan,
                          const Eigen::Isometry3d& T_submap_guess, const Matrix6& prior) {
  Registration result{T_submap_guess, Matrix6::Zero(), 0, 0};
  for (const Submap* submap : submaps)
    for (int i = 0; i < kMostIterations; ++i) {
      const Normals n(*submap, scan, result.T_submap_scan);
      result.information = n.H;
      result.coveredShare = static_cast<double>(n.covered) / std::max<std::size_t>(1, scan.size());
      result.matchedShare = static_cast<double>(n.matched) / std::max<std::size_t>(1, n.covered);
      const Vector6 off = vectorOf(T_submap_guess.inverse() * result.T_submap_scan);
      const Vector6 step =
          (n.H + prior + 1e-6 * Matrix6::Identity()).ldlt().solve(n.b - prior * off);
      if (!step.allFinite()) return result;
      result.T_submap_scan = rigid(result.T_submap_scan * poseOf(step));
      const double still = submap == submaps.back() ? kStill : kStillCoarse * submap->cellSize();
      if (step.head<3>().norm() < still && step.tail<3>().norm() < still * kPerMeter) break;
    }
  return result;
}

}  // namespace semantic_slam
