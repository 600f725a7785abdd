#include <map_operations/Calibrator.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace semantic_octree {
namespace {

constexpr double kPowers[] = {1, 0.9, 0.8, 0.7, 0.6, 0.5, 0.4, 0.3, 0.2};
constexpr double kShared[] = {0, 0.01, 0.03, 0.1, 0.2, 0.35, 0.5, 0.7};
/** Share of labels that name their voxel's class. */
constexpr double kRight[] = {1, 0.97, 0.94, 0.9, 0.85, 0.78, 0.7, 0.55};
constexpr std::size_t kNumPowers = std::size(kPowers), kNumShared = std::size(kShared),
                      kNumRight = std::size(kRight), kCells = kNumPowers * kNumShared * kNumRight;

constexpr std::uint32_t kScansToAsk = 3;
/** At most so many points of a scan are looked at. */
constexpr std::size_t kMostPoints = 32768;
constexpr double kUnit = 1024;  // of a nat
/** What is fitted is rounded to such parts, so that it does not depend on the machine. */
constexpr double kSteps = 64;
/** No label is less likely than this, so that a few do not decide. */
constexpr double kLeast = 1e-6;
/** Logarithms are taken of products of so many. */
constexpr std::size_t kGroup = 8;

/** One voxel in 16. */
bool asks(const octomap::OcTreeKey& key) {
  const std::uint32_t mixed = key[0] * 73856093u ^ key[1] * 19349669u ^ key[2] * 83492791u;
  return (mixed * 2654435761u) >> 28 == 0;
}

template <std::size_t N>
std::size_t nearest(const double (&values)[N], double x) {
  return std::min_element(values, values + N,
                          [x](double a, double b) { return std::abs(a - x) < std::abs(b - x); }) -
         values;
}

}  // namespace

void Calibrator::begin(const SemanticOcTree& map) {
  // All others together weigh one in kCells of what the map has, until labels are seen.
  m_losses.assign(kCells, std::llround(kUnit * 2 * std::log(static_cast<double>(kCells))));
  const Calibration& now = map.filterParameters().calibration;
  const std::size_t cell =
      (nearest(kPowers, now.power) * kNumShared + nearest(kShared, now.shared)) * kNumRight;
  std::fill_n(m_losses.begin() + static_cast<std::ptrdiff_t>(cell), kNumRight, 0);
}

void Calibrator::ask(const SemanticOcTree& map, const LabeledCloud& cloud,
                     const Eigen::Isometry3d& T_map_sensor, const InsertionOptions& options) {
  const auto K = static_cast<std::size_t>(map.numClasses());
  const std::vector<float>& soft = cloud.probabilities;
  if (soft.empty() ? !cloud.classes.empty() && cloud.classes.size() != cloud.size()
                   : soft.size() != K * cloud.size())
    throw std::invalid_argument("calibration: labels of another number of points");
  if (m_losses.empty()) begin(map);
  if (K == 1 || (soft.empty() && cloud.classes.empty())) return;
  const double farthest = options.maxRange > 0 ? options.maxRange : HUGE_VAL;
  ++m_scans;
  std::vector<Question> questions;
  for (std::size_t i = 0; i < cloud.size(); i += 1 + cloud.size() / kMostPoints) {
    const auto isLabel = [](float share) { return share > 0; };
    const float* const q = soft.data() + (soft.empty() ? 0 : i * K);
    if (soft.empty() ? cloud.classes[i] == kNoClass : std::none_of(q, q + K, isLabel)) continue;
    const double range = cloud.points[i].norm();
    if (!(range >= options.minRange && range <= farthest)) continue;
    const Eigen::Vector3d p = T_map_sensor * cloud.points[i].cast<double>();
    octomap::OcTreeKey key;
    if (!map.coordToKeyChecked(p.x(), p.y(), p.z(), key) || !asks(key)) continue;
    Seen& seen = m_voxels[key];
    if (std::exchange(seen.last, m_scans) == m_scans || ++seen.scans <= kScansToAsk) continue;
    const SemanticOcTreeNode leaf = map.search(key);
    if (!leaf || !leaf.hasClassRecord()) continue;
    Question question{map.belief(leaf), {}, 0};
    for (std::size_t k = 0; k < K; ++k) {
      const double share = soft.empty() ? cloud.classes[i] == k + 1 : q[k];
      const int named = question.belief.indexOf(static_cast<ClassId>(k + 1));
      (named < 0 ? question.others : question.named[named]) += share;
    }
    questions.push_back(question);
  }
  add(questions, map.numClasses());
}

void Calibrator::add(const std::vector<Question>& questions, int numClasses) {
  const double ofOther = 1.0 / (numClasses - 1);
  std::vector<double> product(kCells, 1.0);
  for (std::size_t n = 0; n < questions.size(); ++n) {
    const auto& [belief, named, others] = questions[n];
    const double most = std::max(belief.logOdds[0], belief.rest);
    double ofShared = 0;
    for (int i = 0; i < belief.count; ++i) ofShared += named[i] / belief.count;
    double* cell = product.data();
    for (const double power : kPowers) {
      const double rest = std::exp(power * (belief.rest - most));
      double sum = belief.unnamed(numClasses) * rest, ofLabel = others * rest;
      for (int i = 0; i < belief.count; ++i) {
        const double odds = std::exp(power * (belief.logOdds[i] - most));
        sum += odds;
        ofLabel += named[i] * odds;
      }
      for (const double shared : kShared) {
        const double stated = (1 - shared) * ofLabel / sum + shared * ofShared;
        for (const double right : kRight)
          *cell++ *= std::max(kLeast, right * stated + (1 - right) * (1 - stated) * ofOther);
      }
    }
    if ((n + 1) % kGroup != 0 && n + 1 < questions.size()) continue;
    for (std::size_t i = 0; i < kCells; ++i)
      m_losses[i] -= std::llround(kUnit * std::log(product[i]));
    std::fill(product.begin(), product.end(), 1.0);
  }
}

Calibration Calibrator::best() const {
  if (m_losses.empty()) return {};
  const std::int64_t least = *std::min_element(m_losses.begin(), m_losses.end());
  double all = 0, power = 0, shared = 0;
  for (std::size_t i = 0; i < kCells; ++i) {
    const double weight = std::exp(static_cast<double>(least - m_losses[i]) / kUnit);
    all += weight;
    power += weight * kPowers[i / kNumRight / kNumShared];
    shared += weight * kShared[i / kNumRight % kNumShared];
  }
  const auto onStep = [all](double sum) { return std::round(sum / all * kSteps) / kSteps; };
  return {onStep(power), onStep(shared)};
}

}  // namespace semantic_octree
