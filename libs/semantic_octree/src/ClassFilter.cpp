#include <semantic_octree/ClassFilter.h>

#include <algorithm>
#include <numeric>
#include <stdexcept>
#include <string>

namespace semantic_octree {
namespace {

/** Floats are put on the grid, doubles stay as they are. */
template <typename Real>
Real rounded(double x) {
  if constexpr (std::is_same_v<Real, float>) return onGrid(x);
  return static_cast<Real>(x);
}

double logit(double p) { return std::log(p / (1 - p)); }

/** Counts of labels whose rows are kept. */
constexpr std::uint32_t kKeptRows = 65;

}  // namespace

template <typename Real, int Named>
ClassFilter<Real, Named>::ClassFilter(int numClasses, const FilterParameters& p)
    : m_numClasses(numClasses),
      m_parameters(p),
      m_evidence(p.accuracy, std::max(2, numClasses), p.labelCorrelation) {
  p.validate(numClasses);
  const double K = numClasses;
  const double unlabeled = std::log(p.hitProbability / p.falseAlarmProbability);
  const double accuracy = numClasses == 1 ? 1.0 : p.accuracy;
  const double same = unlabeled + std::log(accuracy * K);
  const double other =
      numClasses == 1 ? unlabeled : unlabeled + std::log((1 - accuracy) * K / (K - 1));
  const double miss = std::log((1 - p.hitProbability) / (1 - p.falseAlarmProbability));
  m_logNumClasses = rounded<Real>(std::log(K));
  m_min = rounded<Real>(logit(p.minOccupancy)) - m_logNumClasses;
  m_max = rounded<Real>(logit(p.maxProbability));
  m_hitSame = rounded<Real>(same);
  m_hitOther = rounded<Real>(other);
  m_hitUnlabeled = rounded<Real>(unlabeled);
  m_miss = rounded<Real>(miss);
  m_unlabeled = unlabeled;
  if (numClasses == 1) return;
  for (std::uint32_t n = 0; n < kKeptRows; ++n) m_rowsOfFew.push_back(rowOf(n));
  m_rowsOfFew[1] = {m_hitSame, m_hitOther};
}

template <typename Real, int Named>
auto ClassFilter<Real, Named>::trusting(const LabelReliability& labels) const -> ClassFilter {
  FilterParameters p = m_parameters;
  p.accuracy = labels.accuracy;
  p.labelCorrelation = labels.correlation;
  return ClassFilter(m_numClasses, p);
}

template <typename Real, int Named>
double ClassFilter<Real, Named>::incrementWithoutEvidence(double most, double odds) const {
  return m_unlabeled + std::log(m_numClasses / odds) - most;
}

template <typename Real, int Named>
auto ClassFilter<Real, Named>::rowOf(std::uint32_t numLabels) const -> Row {
  if (numLabels < m_rowsOfFew.size()) return m_rowsOfFew[numLabels];
  const double evidence = m_evidence(numLabels);
  const double odds = 1 + (m_numClasses - 1) * std::exp(-evidence);
  const double other = incrementWithoutEvidence(evidence, odds);
  return {rounded<Real>(other + evidence), rounded<Real>(other)};
}

template <typename Real, int Named>
auto ClassFilter<Real, Named>::uniform(Real occupancyLogOdds) const -> Belief {
  Belief b;
  b.rest = occupancyLogOdds - m_logNumClasses;
  return b;
}

template <typename Real, int Named>
Real ClassFilter<Real, Named>::occupancyOf(const Belief& b) const {
  return rounded<Real>(b.occupancyLogOdds(m_numClasses));
}

template <typename Real, int Named>
auto ClassFilter<Real, Named>::stated(const Belief& b) const -> Belief {
  const Calibration& calibration = m_parameters.calibration;
  if (b.count == 0 || calibration.isIdentity()) return b;
  if (!calibration.factors.empty()) return statedWithFactors(b);
  const double power = calibration.power, shared = calibration.shared;
  const double most = b.count == m_numClasses ? b.logOdds[0] : std::max(b.logOdds[0], b.rest);
  const auto powered = [&](Real h) { return std::exp(power * (h - most)); };
  double sum = b.unnamed(m_numClasses) * powered(b.rest);
  for (int i = 0; i < b.count; ++i) sum += powered(b.logOdds[i]);
  const double occupancy = b.occupancyLogOdds(m_numClasses), own = (1 - shared) / sum;
  Belief s = b;
  s.rest = rounded<Real>(occupancy + std::log(own * powered(b.rest)));
  for (int i = 0; i < b.count; ++i)
    s.logOdds[i] =
        rounded<Real>(occupancy + std::log(own * powered(b.logOdds[i]) + shared / b.count));
  return s;
}

template <typename Real, int Named>
auto ClassFilter<Real, Named>::classesWithFactors(const Belief& b) const
    -> std::array<double, semantic_types::kMaxClasses> {
  const auto& [power, shared, factors] = m_parameters.calibration;
  std::array<double, semantic_types::kMaxClasses> p;
  const double most = b.count == m_numClasses ? b.logOdds[0] : std::max(b.logOdds[0], b.rest);
  const double rest = std::exp(power * (b.rest - most));
  for (int k = 0; k < m_numClasses; ++k) p[k] = factors[k] * rest;
  for (int i = 0; i < b.count; ++i)
    p[b.ids[i] - 1] = factors[b.ids[i] - 1] * std::exp(power * (b.logOdds[i] - most));
  const double sum = std::accumulate(p.begin(), p.begin() + m_numClasses, 0.0);
  for (int k = 0; k < m_numClasses; ++k) p[k] *= (1 - shared) / sum;
  for (int i = 0; i < b.count; ++i) p[b.ids[i] - 1] += shared / b.count;
  return p;
}

template <typename Real, int Named>
auto ClassFilter<Real, Named>::statedWithFactors(const Belief& b) const -> Belief {
  auto p = classesWithFactors(b);
  const auto end = p.begin() + m_numClasses;
  const double occupancy = b.occupancyLogOdds(m_numClasses);
  Belief s;
  for (const int named = std::min(Named, m_numClasses); s.count < named; ++s.count) {
    const auto best = std::max_element(p.begin(), end);
    s.ids[s.count] = static_cast<ClassId>(best - p.begin() + 1);
    s.logOdds[s.count] = rounded<Real>(occupancy + std::log(*best));
    *best = 0;
  }
  const double others = std::accumulate(p.begin(), end, 0.0);
  if (others > 0) s.rest = rounded<Real>(occupancy + std::log(others / s.unnamed(m_numClasses)));
  s.sort();
  return s;
}

template <typename Real, int Named>
void ClassFilter<Real, Named>::distribution(const Belief& b, double* p) const {
  stated(b).distribution(m_numClasses, p);
  if (b.count == 0 || m_parameters.calibration.factors.empty()) return;
  const auto classes = classesWithFactors(b);
  std::transform(classes.begin(), classes.begin() + m_numClasses, p + 1,
                 [occupied = 1 - p[0]](double ofOccupied) { return occupied * ofOccupied; });
}

template <typename Real, int Named>
void ClassFilter<Real, Named>::limit(Belief& b) const {
  Real highest = b.unnamed(m_numClasses) > 0 ? b.rest : b.logOdds[0];
  for (int i = 0; i < b.count; ++i) highest = std::max(highest, b.logOdds[i]);
  const Real excess = std::max(Real(0), highest - m_max);
  for (int i = 0; i < b.count; ++i) b.logOdds[i] = std::max(m_min, b.logOdds[i] - excess);
  b.rest = std::max(m_min, b.rest - excess);
  b.sort();
}

template <typename Real, int Named>
void ClassFilter<Real, Named>::addToAll(Belief& b, Real increment) const {
  for (int i = 0; i < b.count; ++i) b.logOdds[i] += increment;
  b.rest += increment;
  limit(b);
}

template <typename Real, int Named>
void ClassFilter<Real, Named>::hitOf(Belief& b, ClassId id, Real same, Real other) const {
  const Real observed = b.logOddsOf(id) + same;
  const int index = b.indexOf(id);
  for (int i = 0; i < b.count; ++i) b.logOdds[i] += other;
  b.rest += other;
  if (index >= 0)
    b.logOdds[index] = observed;
  else
    name(b, id, observed);
  limit(b);
}

template <typename Real, int Named>
void ClassFilter<Real, Named>::name(Belief& b, ClassId id, Real logOdds) const {
  if (b.count < Named) {
    b.ids[b.count] = id;
    b.logOdds[b.count++] = logOdds;
    return;
  }
  // The least likely of the Named + 1 joins the m - 1 classes that stay unnamed.
  const int last = Named - 1;
  const bool newcomerIsLeast =
      logOdds != b.logOdds[last] ? logOdds < b.logOdds[last] : id > b.ids[last];
  const double evicted = newcomerIsLeast ? logOdds : b.logOdds[last];
  const int others = b.unnamed(m_numClasses) - 1;
  const double top = std::max<double>(evicted, b.rest);
  const double odds = others * std::exp(b.rest - top) + std::exp(evicted - top);
  b.rest = rounded<Real>(top + std::log(odds / (others + 1)));
  if (newcomerIsLeast) return;
  b.ids[last] = id;
  b.logOdds[last] = logOdds;
}

template <typename Real, int Named>
void ClassFilter<Real, Named>::hit(Belief& b, const ClassVotes* votes, std::size_t numVoted) const {
  if (m_rowsOfFew.empty()) return hit(b, votes->id);
  if (numVoted > 1) return hitOfSeveral(b, votes, numVoted);
  const Row row = rowOf(votes->count);
  hitOf(b, votes->id, row.named, row.other);
}

template <typename Real, int Named>
void ClassFilter<Real, Named>::hitOfSeveral(Belief& b, const ClassVotes* votes,
                                            std::size_t numVoted) const {
  const Belief before = b;
  std::array<double, semantic_types::kMaxClasses> evidence;
  double most = 0;
  for (std::size_t i = 0; i < numVoted; ++i)
    most = std::max(most, evidence[i] = m_evidence(votes[i].count));
  double odds = static_cast<double>(m_numClasses - numVoted) * std::exp(-most);
  for (std::size_t i = 0; i < numVoted; ++i) odds += std::exp(evidence[i] - most);
  const double unnamed = incrementWithoutEvidence(most, odds);
  const Real other = rounded<Real>(unnamed);
  int numEvicted = 0;
  double evictedOdds = 0;
  const auto evict = [&](Real logOdds) {
    ++numEvicted;
    evictedOdds += std::exp(static_cast<double>(logOdds));
  };
  const auto offer = [&](ClassId id, Real logOdds) {
    const int last = Named - 1;
    if (b.count < Named) {
      b.ids[b.count] = id;
      b.logOdds[b.count++] = logOdds;
    } else if (logOdds < b.logOdds[last] || (logOdds == b.logOdds[last] && id > b.ids[last])) {
      return evict(logOdds);
    } else {
      evict(b.logOdds[last]);
      b.ids[last] = id;
      b.logOdds[last] = logOdds;
    }
    b.sort();
  };
  b = Belief();
  b.rest = before.rest + other;
  std::array<bool, Named> voted{};
  for (std::size_t i = 0; i < numVoted; ++i) {
    const int index = before.indexOf(votes[i].id);
    if (index >= 0) voted[index] = true;
    offer(votes[i].id, before.logOddsOf(votes[i].id) + rounded<Real>(unnamed + evidence[i]));
  }
  for (int i = 0; i < before.count; ++i)
    if (!voted[i]) offer(before.ids[i], before.logOdds[i] + other);
  if (numEvicted > 0) {
    const int members = b.unnamed(m_numClasses);
    const double rest = (members - numEvicted) * std::exp(static_cast<double>(b.rest));
    b.rest = rounded<Real>(std::log((rest + evictedOdds) / members));
  }
  limit(b);
}

template <typename Real, int Named>
void ClassFilter<Real, Named>::hit(Belief& b, const float* q) const {
  const double K = m_numClasses;
  std::vector<double> p(q, q + m_numClasses);
  if (const auto& prior = m_parameters.classPrior; b.count == 0 && !prior.empty()) {
    const double all = std::inner_product(p.begin(), p.end(), prior.begin(), 0.0);
    std::transform(p.begin(), p.end(), prior.begin(), p.begin(),
                   [all](double likelihood, double before) { return likelihood * before / all; });
  }
  std::vector<Real> h(m_numClasses + 1);
  for (int k = 1; k <= m_numClasses; ++k)
    h[k] = rounded<Real>(b.logOddsOf(static_cast<ClassId>(k)) + m_unlabeled +
                         std::log(K * std::max(p[k - 1], m_parameters.softLabelFloor)));
  const Real excess = std::max(Real(0), *std::max_element(h.begin() + 1, h.end()) - m_max);
  for (Real& x : h) x = std::max(m_min, x - excess);
  std::vector<ClassId> order(m_numClasses);
  std::iota(order.begin(), order.end(), ClassId{1});
  const int named = std::min(Named, m_numClasses);
  std::partial_sort(order.begin(), order.begin() + named, order.end(),
                    [&](ClassId i, ClassId j) { return h[i] != h[j] ? h[i] > h[j] : i < j; });
  b = Belief();
  for (; b.count < named; ++b.count) {
    b.ids[b.count] = order[b.count];
    b.logOdds[b.count] = h[order[b.count]];
  }
  if (named == m_numClasses) return;
  double odds = 0;
  for (int i = named; i < m_numClasses; ++i) odds += std::exp(h[order[i]]);
  b.rest = rounded<Real>(std::log(odds / (m_numClasses - named)));
}

template class ClassFilter<float>;
template class ClassFilter<double>;

}  // namespace semantic_octree
