#include <semantic_octree/Keys.h>
#include <semantic_slam/Registration.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <random>
#include <utility>

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
/** Least standard deviation of a surface, of a cube's edge. In small cubes it counts as thin as it
 * is; large ones reach out to points that are far off yet. */
constexpr double kThinnest = 0.03;
/** A filled cube's evidence up to so many standard deviations of its points' variance is chance.
 * Else an endless wall would tell of the way along it. */
constexpr double kByChance = 2;
/** The least ratio of a surface's two widths, squared. A narrow one is but a ring that a LiDAR left
 * on it. */
constexpr double kNarrowest = 0.3;
/** Squared distances, in standard deviations, at which a point's weight is a quarter, and up to
 * which it matches. */
constexpr double kScale = 9, kMatch = 9;
/** Sines of beams' heights, up to which they are horizontal: a laser scanner, somewhat tilted. */
constexpr float kHorizontal = 0.03f;

Eigen::Array3i cubeIn(const Eigen::Vector3d& p, double perMeter) {
  using semantic_octree::floorOf;
  return {floorOf(p.x() * perMeter), floorOf(p.y() * perMeter), floorOf(p.z() * perMeter)};
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

  /** \param near of each point, in this submap or at first of none */
  Normals(const Submap& submap, const LabeledCloud& scan, const Eigen::Isometry3d& T,
          std::vector<Submap::Near>& near) {
    for (std::size_t i = 0; i < scan.size(); ++i) {
      const Eigen::Vector3d r = T.linear() * scan.points[i].cast<double>(), q = r + T.translation();
      submap.look(q, classOf(scan, i), near[i]);
      double squared = 0;
      const Submap::Distribution* d = near[i].find(q, squared);
      if (!d) continue;
      ++covered;
      matched += squared < kMatch;
      const double root = 1 + squared / kScale;
      add(d->evidence / (root * root), r, q - d->mean);
    }
    // Turned so that they belong to T poseOf(x) p: until here x is along the submap's axes.
    H.bottomLeftCorner<3, 3>() = H.topRightCorner<3, 3>().transpose();
    Matrix6 turn = Matrix6::Zero();
    turn.topLeftCorner<3, 3>() = turn.bottomRightCorner<3, 3>() = T.linear();
    H = turn.transpose() * H * turn;
    b = turn.transpose() * b;
  }

 private:
  /** J^T E J and J^T E off, J = (I, -r x), for a symmetric E. */
  void add(const Eigen::Matrix3d& E, const Eigen::Vector3d& r, const Eigen::Vector3d& off) {
    Eigen::Matrix3d F;  // E (r x)
    for (int i = 0; i < 3; ++i) F.row(i) = E.col(i).cross(r);
    H.topLeftCorner<3, 3>() += E;
    H.topRightCorner<3, 3>() -= F;
    for (int i = 0; i < 3; ++i) H.block<3, 1>(3, 3 + i) += F.col(i).cross(r);
    const Eigen::Vector3d pull = E * off;
    b.head<3>() -= pull;
    b.tail<3>() -= r.cross(pull);
  }
};

}  // namespace

std::size_t KeyNumbers::slotOf(Key key) const {
  const std::size_t last = m_slots.size() - 1;
  std::size_t slot = (key * 0x9e3779b97f4a7c15u >> 32) & last;
  while (m_slots[slot].key != key && m_slots[slot].number != kNone) slot = (slot + 1) & last;
  return slot;
}

std::uint32_t KeyNumbers::add(Key key) {
  const std::size_t slot = slotOf(key);
  if (m_slots[slot].number != kNone) return m_slots[slot].number;
  m_slots[slot] = {key, m_size++};
  if (2 * m_size < m_slots.size()) return m_size - 1;
  std::vector<Slot> before(2 * m_slots.size());
  before.swap(m_slots);
  for (const Slot& taken : before)
    if (taken.number != kNone) m_slots[slotOf(taken.key)] = taken;
  return m_size - 1;
}

Eigen::Array3i Submap::cubeOf(const Eigen::Vector3d& point) const {
  Eigen::Array3i cube = cubeIn(point, m_perMeter);
  if (m_isPlanar) cube.z() = 0;
  return cube;
}

auto Submap::keyOf(const Eigen::Array3i& cube, ClassId id) const -> Key {
  return pack(cube) << 8 | (m_useClasses ? id : kNoClass);
}

auto Submap::cellOf(const Eigen::Array3i& cube, ClassId id) -> Cell& {
  const std::uint32_t number = m_numbers.add(keyOf(cube, id));
  if (number == m_cells.size()) {
    m_cells.emplace_back();
    m_cells.back().cube = cube;
    m_cells.back().id = id;
  }
  Cell& cell = m_cells[number];
  if (!std::exchange(cell.isNew, true)) m_new.push_back(number);
  return cell;
}

void Submap::add(const LabeledCloud& cloud, const Eigen::Isometry3d& T_submap_cloud,
                 double deviation) {
  const Eigen::Matrix3d spread = deviation * deviation * Eigen::Matrix3d::Identity();
  Cell* cell = nullptr;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const Eigen::Vector3d p = T_submap_cloud * cloud.points[i].cast<double>();
    const Eigen::Array3i cube = cubeOf(p);
    const ClassId id = classOf(cloud, i);
    // Neighbors in a scan often share a cube.
    if (!cell || id != cell->id || (cube != cell->cube).any()) cell = &cellOf(cube, id);
    Sum& s = cell->sum;
    // Relative to the cube, so that squares stay exact far from the origin.
    const Eigen::Vector3d r = p - cube.cast<double>().matrix() * m_cellSize;
    s.n += 1;
    s.sum += r;
    s.squares += r * r.transpose() + spread;
  }
}

auto Submap::distributionOf(const Sum& s) const -> Distribution {
  // Variances of n points all over a cube scatter by sqrt(0.8 / n) of their mean.
  const double ofFilledCube =
      12 / (m_cellSize * m_cellSize) * (1 + kByChance * std::sqrt(0.8 / s.n));
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
  for (const std::uint32_t number : m_new) {
    Cell& cell = m_cells[number];
    cell.isNew = false;
    cell.isEnough = cell.sum.n >= (m_isPlanar ? kFewestInPlane : kFewestInSpace);
    if (!cell.isEnough) continue;
    cell.distribution = distributionOf(cell.sum);
    cell.distribution.mean += cell.cube.cast<double>().matrix() * m_cellSize;
  }
  m_new.clear();
}

void Submap::look(const Eigen::Vector3d& point, ClassId id, Near& near) const {
  const Eigen::Array3i cube = cubeOf(point);
  const Key key = keyOf(cube, id);
  if (std::exchange(near.key, key) == key) return;
  near.size = 0;
  const auto lookIn = [&](Key k) {
    const std::uint32_t number = m_numbers.find(k);
    if (number != KeyNumbers::kNone && m_cells[number].isEnough)
      near.distributions[near.size++] = &m_cells[number].distribution;
  };
  lookIn(key);
  for (int axis = 0; axis < (m_isPlanar ? 2 : 3); ++axis)
    for (const int side : {-1, 1}) {
      Eigen::Array3i beside = cube;
      beside[axis] += side;
      lookIn(keyOf(beside, id));
    }
}

auto Submap::Near::find(const Eigen::Vector3d& point, double& squaredDistance) const
    -> const Distribution* {
  const Distribution* best = nullptr;
  for (int i = 0; i < size; ++i) {
    const Eigen::Vector3d e = point - distributions[i]->mean;
    const double squared = e.dot(distributions[i]->information * e);
    if (best && squared >= squaredDistance) continue;
    best = distributions[i];
    squaredDistance = squared;
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
  LabeledCloud thin;
  KeyNumbers cubes;
  std::vector<unsigned> numSeen;  // in each cube
  std::minstd_rand random;
  const double perMeter = 1 / cubeSize;
  std::uint64_t last = UINT64_MAX;
  std::uint32_t cube = 0;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const Eigen::Vector3d p = cloud.points[i].cast<double>();
    if (!(p.norm() <= maxRange)) continue;
    const std::uint64_t key = pack(cubeIn(p, perMeter));
    if (std::exchange(last, key) != key) cube = cubes.add(key);
    if (cube == numSeen.size()) {
      numSeen.push_back(0);
      thin.points.emplace_back();
      thin.classes.emplace_back();
    }
    if (static_cast<unsigned>(random()) % ++numSeen[cube] != 0) continue;
    thin.points[cube] = cloud.points[i];
    thin.classes[cube] = classOf(cloud, i);
  }
  return thin;
}

namespace {

/** What of a scan is registered to each submap. */
std::vector<LabeledCloud> samplesOf(const LabeledCloud& scan,
                                    const std::vector<const Submap*>& submaps) {
  std::vector<LabeledCloud> samples(submaps.size(), scan);
  if (submaps.empty() || submaps[0]->isPlanar()) return samples;
  samples.back() = thinned(scan, submaps.back()->cellSize() / 2, HUGE_VAL);
  for (std::size_t i = submaps.size() - 1; i > 0; --i)
    samples[i - 1] = thinned(samples[i], submaps[i]->cellSize() / 2, HUGE_VAL);
  return samples;
}

}  // namespace

Registration registerScan(const std::vector<const Submap*>& submaps, const LabeledCloud& scan,
                          const Eigen::Isometry3d& T_submap_guess, const Matrix6& prior) {
  Registration result{T_submap_guess, Matrix6::Zero(), 0, 0};
  const std::vector<LabeledCloud> samples = samplesOf(scan, submaps);
  for (std::size_t k = 0; k < submaps.size(); ++k) {
    const LabeledCloud& sample = samples[k];
    const bool isLast = k + 1 == submaps.size();
    const double still = isLast ? kStill : kStillCoarse * submaps[k]->cellSize();
    std::vector<Submap::Near> near(sample.size());
    for (int i = 0; i < kMostIterations; ++i) {
      const Normals n(*submaps[k], sample, result.T_submap_scan, near);
      result.information = n.H;
      result.coveredShare =
          static_cast<double>(n.covered) / std::max<std::size_t>(1, sample.size());
      result.matchedShare = static_cast<double>(n.matched) / std::max<std::size_t>(1, n.covered);
      const Vector6 off = vectorOf(T_submap_guess.inverse() * result.T_submap_scan);
      const Vector6 step =
          (n.H + prior + 1e-6 * Matrix6::Identity()).ldlt().solve(n.b - prior * off);
      if (!step.allFinite()) return result;
      result.T_submap_scan = rigid(result.T_submap_scan * poseOf(step));
      if (step.head<3>().norm() < still && step.tail<3>().norm() < still * kPerMeter) break;
    }
  }
  return result;
}

}  // namespace semantic_slam
