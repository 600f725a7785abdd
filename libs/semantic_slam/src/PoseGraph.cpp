#include <semantic_slam/PoseGraph.h>

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace semantic_slam {
namespace {

constexpr int kMostSteps = 50;
/** Cauchy's c^2: beyond some standard deviations of six values together an edge counts less. */
constexpr double kDoubt = 16;
/** A right edge may be far off at first. So doubt begins with the largest error and grows in such
 * steps (Yang et al., "Graduated Non-Convexity for Robust Spatial Perception", 2020). */
constexpr double kStage = 16;
constexpr double kConverged = 1e-6;

Eigen::Matrix3d crossMatrix(const Eigen::Vector3d& v) {
  Eigen::Matrix3d m;
  m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return m;
}

/** Takes a small motion in one frame into another. */
Matrix6 adjoint(const Eigen::Isometry3d& T) {
  Matrix6 m = Matrix6::Zero();
  m.topLeftCorner<3, 3>() = m.bottomRightCorner<3, 3>() = T.linear();
  m.topRightCorner<3, 3>() = crossMatrix(T.translation()) * T.linear();
  return m;
}

/** How the vector of a turn changes with a small turn behind it. */
Eigen::Matrix3d turnDerivativeAt(const Eigen::Vector3d& turn) {
  const Eigen::Matrix3d cross = crossMatrix(turn);
  const double angle = turn.norm();
  const double factor =
      angle < 1e-4 ? 1.0 / 12
                   : 1 / (angle * angle) - (1 + std::cos(angle)) / (2 * angle * std::sin(angle));
  return Eigen::Matrix3d::Identity() + 0.5 * cross + factor * cross * cross;
}

/** How vectorOf(T poseOf(x)) changes with x, at x = 0 and v = vectorOf(T). */
Matrix6 derivativeAt(const Vector6& v) {
  Matrix6 m = Matrix6::Zero();
  m.topLeftCorner<3, 3>() = poseOf(v).linear();
  m.bottomRightCorner<3, 3>() = turnDerivativeAt(v.tail<3>());
  return m;
}

using Poses = std::vector<Eigen::Isometry3d>;

Eigen::Isometry3d T_a_b(const PoseEdge& edge, const Poses& poses) {
  return edge.a == PoseEdge::kMap ? poses[edge.b] : poses[edge.a].inverse() * poses[edge.b];
}

Vector6 errorOf(const PoseEdge& edge, const Poses& poses) {
  return vectorOf(edge.T_a_b.inverse() * T_a_b(edge, poses));
}

double costOf(const std::vector<PoseEdge>& edges, const Poses& poses, double doubt) {
  double cost = 0;
  for (const PoseEdge& edge : edges) {
    const double squared = squaredError(edge, poses);
    cost += edge.isDoubtful ? doubt * std::log1p(squared / doubt) : squared;
  }
  return cost;
}

/** The normal equations of all poses from the first that moves on; of H the lower triangle. */
struct Equations {
  double m_doubt;
  std::size_t m_first;
  Eigen::SparseMatrix<double> H;
  Eigen::VectorXd b;

  Equations(std::size_t numPoses, std::size_t first, double doubt)
      : m_doubt(doubt), m_first(first), b(6 * static_cast<int>(numPoses - first)) {
    H.resize(b.size(), b.size());
  }
  void update(const std::vector<PoseEdge>& edges, const Poses& poses) {
    m_entries.clear();
    b.setZero();
    for (const PoseEdge& edge : edges) add(edge, poses);
    H.setFromTriplets(m_entries.begin(), m_entries.end());
  }

 private:
  void add(const PoseEdge& edge, const Poses& poses) {
    const Vector6 e = errorOf(edge, poses);
    const double squared = e.dot(edge.information * e);
    const Matrix6 weight = edge.information * (edge.isDoubtful ? 1 / (1 + squared / m_doubt) : 1.0);
    const Matrix6 ofB = derivativeAt(e);
    const Matrix6 ofA = -ofB * adjoint(T_a_b(edge, poses).inverse());
    addBlock(edge.a, edge.a, ofA.transpose() * weight * ofA);
    edge.a > edge.b ? addBlock(edge.a, edge.b, ofA.transpose() * weight * ofB)
                    : addBlock(edge.b, edge.a, ofB.transpose() * weight * ofA);
    addBlock(edge.b, edge.b, ofB.transpose() * weight * ofB);
    if (moves(edge.a)) b.segment<6>(6 * rowOf(edge.a)) -= ofA.transpose() * weight * e;
    if (moves(edge.b)) b.segment<6>(6 * rowOf(edge.b)) -= ofB.transpose() * weight * e;
  }
  bool moves(std::size_t pose) const { return pose >= m_first && pose != PoseEdge::kMap; }
  int rowOf(std::size_t pose) const { return static_cast<int>(pose - m_first); }
  void addBlock(std::size_t i, std::size_t j, const Matrix6& block) {
    if (!moves(i) || !moves(j)) return;
    for (int r = 0; r < 6; ++r)
      for (int c = 0; c < 6; ++c)
        m_entries.emplace_back(6 * rowOf(i) + r, 6 * rowOf(j) + c, block(r, c));
  }
  std::vector<Eigen::Triplet<double>> m_entries;
};

/** To the minimum for a doubt, by Gauss-Newton with Levenberg's damping. */
void descend(Poses& poses, const std::vector<PoseEdge>& edges, double doubt) {
  const bool isInMap = std::any_of(edges.begin(), edges.end(),
                                   [](const PoseEdge& e) { return e.a == PoseEdge::kMap; });
  const std::size_t first = isInMap ? 0 : 1;
  if (poses.size() <= first) return;
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver;
  Equations equations(poses.size(), first, doubt);
  double cost = costOf(edges, poses, doubt), damping = 1e-6;
  for (int i = 0; i < kMostSteps && damping < 1e12; ++i) {
    equations.update(edges, poses);
    for (int k = 0; k < equations.H.rows(); ++k) equations.H.coeffRef(k, k) *= 1 + damping;
    if (i == 0) solver.analyzePattern(equations.H);
    solver.factorize(equations.H);
    const Eigen::VectorXd step = solver.solve(equations.b);
    Poses next = poses;
    for (std::size_t p = first; p < poses.size(); ++p)
      next[p] = rigid(poses[p] * poseOf(step.segment<6>(6 * static_cast<int>(p - first))));
    const double nextCost = costOf(edges, next, doubt);
    if (solver.info() != Eigen::Success || !(nextCost <= cost)) {
      damping = std::max(1e-6, damping * 10);
      continue;
    }
    const bool isLast = cost - nextCost < kConverged * (cost + kConverged);
    poses.swap(next);
    cost = nextCost;
    damping *= 0.1;
    if (isLast) return;
  }
}

}  // namespace

Matrix6 informationOf(double meters, double radians) {
  Vector6 d;
  d << Eigen::Vector3d::Constant(1 / (meters * meters)),
      Eigen::Vector3d::Constant(1 / (radians * radians));
  return d.asDiagonal();
}

Eigen::Isometry3d poseOf(const Vector6& v) {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  const Eigen::Vector3d axis = v.tail<3>();
  const double angle = axis.norm();
  if (angle > 0) T.linear() = Eigen::AngleAxisd(angle, axis / angle).toRotationMatrix();
  T.translation() = v.head<3>();
  return T;
}

Vector6 vectorOf(const Eigen::Isometry3d& T) {
  const Eigen::AngleAxisd turn(T.linear());
  Vector6 v;
  v << T.translation(), turn.angle() * turn.axis();
  return v;
}

Eigen::Isometry3d movedFor(double seconds, const Vector6& velocity) {
  const Vector6 v = seconds * velocity;
  Eigen::Isometry3d T = poseOf(v);
  T.translation() = turnDerivativeAt(-v.tail<3>()).inverse() * v.head<3>();
  return T;
}

Vector6 velocityOf(const Eigen::Isometry3d& T_before_after, double seconds) {
  Vector6 v = vectorOf(T_before_after);
  v.head<3>() = turnDerivativeAt(-v.tail<3>()) * v.head<3>();
  return v / seconds;
}

Eigen::Isometry3d rigid(const Eigen::Isometry3d& T) {
  Eigen::Isometry3d result = T;
  result.linear() = Eigen::Quaterniond(T.linear()).normalized().toRotationMatrix();
  return result;
}

Matrix6 inSeries(const Matrix6& step, const PoseEdge& then) {
  const Matrix6 turn = adjoint(then.T_a_b), turned = turn.transpose() * step * turn;
  const Matrix6 both = turned * (turned + then.information).inverse() * then.information;
  return (both + both.transpose()) / 2;
}

double squaredError(const PoseEdge& edge, const Poses& poses) {
  const Vector6 e = errorOf(edge, poses);
  return e.dot(edge.information * e);
}

void optimize(Poses& poses, const std::vector<PoseEdge>& edges) {
  double doubt = kDoubt;
  for (const PoseEdge& edge : edges) {
    if ((edge.a >= poses.size() && edge.a != PoseEdge::kMap) || edge.b >= poses.size() ||
        edge.a == edge.b)
      throw std::invalid_argument("pose graph: an edge of pose " + std::to_string(edge.a) +
                                  " and pose " + std::to_string(edge.b) + ", of " +
                                  std::to_string(poses.size()));
    if (edge.isDoubtful) doubt = std::max(doubt, squaredError(edge, poses));
  }
  // Stages find right loops that are far off, where the way between is well known. Where it is not,
  // wrong ones bend it before doubt sets in, and going there directly is better.
  Poses staged = poses;
  descend(poses, edges, kDoubt);
  if (doubt == kDoubt) return;
  for (; doubt > kDoubt; doubt /= kStage) descend(staged, edges, doubt);
  descend(staged, edges, kDoubt);
  if (costOf(edges, staged, kDoubt) < costOf(edges, poses, kDoubt)) poses.swap(staged);
}

}  // namespace semantic_slam
