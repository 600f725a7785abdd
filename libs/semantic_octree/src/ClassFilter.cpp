#include <semantic_octree/ClassFilter.h>

#include <algorithm>
#include <numeric>
#include <stdexcept>
#include <string>

namespace semantic_octree {
namespace {

double logit(double p) { return std::log(p / (1 - p)); }

/** Counts of labels whose rows are kept. */
constexpr std::uint32_t kKeptRows = 65;

}  // namespace

ClassFilter::ClassFilter(int numClasses, const FilterParameters& p)
    : m_numClasses(numClasses),
      m_parameters(p),
      m_evidence(p.accuracy, std::max(2, numClasses), p.labelCorrelation) {
  p.validate(numClasses);
  const double K = numClasses;
  const double unlabeled = std::log(p.hitProbability / p.falseAlarmProbability);
  const double miss = std::log((1 - p.hitProbability) / (1 - p.falseAlarmProbability));
  m_logNumClasses = onGrid(std::log(K));
  m_min = onGrid(logit(p.minOccupancy)) - m_logNumClasses;
  m_max = onGrid(logit(p.maxProbability));
  m_hitUnlabeled = onGrid(unlabeled);
  m_miss = onGrid(miss);
  m_unlabeled = unlabeled;
  if (numClasses == 1) return;
  for (std::uint32_t n = 0; n < kKeptRows; ++n) m_rowsOfFew.push_back(rowOf(n));
  m_rowsOfFew[1] = {onGrid(unlabeled + std::log(p.accuracy * K)),
                    onGrid(unlabeled + std::log((1 - p.accuracy) * K / (K - 1)))};
}

auto ClassFilter::trusting(const LabelReliability& labels) const -> ClassFilter {
  FilterParameters p = m_parameters;
  p.accuracy = labels.accuracy;
  p.labelCorrelation = labels.correlation;
  return ClassFilter(m_numClasses, p);
}

double ClassFilter::incrementWithoutEvidence(double most, double odds) const {
  return m_unlabeled + std::log(m_numClasses / odds) - most;
}

auto ClassFilter::rowOf(std::uint32_t numLabels) const -> Row {
  if (m_numClasses == 1) return {m_hitUnlabeled, m_hitUnlabeled};
  if (numLabels < m_rowsOfFew.size()) return m_rowsOfFew[numLabels];
  const double evidence = m_evidence(numLabels);
  const double odds = 1 + (m_numClasses - 1) * std::exp(-evidence);
  const double other = incrementWithoutEvidence(evidence, odds);
  return {onGrid(other + evidence), onGrid(other)};
}

auto ClassFilter::uniform(float occupancyLogOdds) const -> Belief {
  Belief b;
  b.rest = occupancyLogOdds - m_logNumClasses;
  return b;
}

float ClassFilter::occupancyOf(const Belief& b) const {
  return onGrid(b.occupancyLogOdds(m_numClasses));
}

auto ClassFilter::stated(const Belief& b) const -> Belief {
  const Calibration& calibration = m_parameters.calibration;
  if (b.count == 0 || calibration.isIdentity()) return b;
  if (!calibration.factors.empty()) return statedWithFactors(b);
  const double power = calibration.power, shared = calibration.shared;
  const double most = b.count == m_numClasses ? b.logOdds[0] : std::max(b.logOdds[0], b.rest);
  const auto powered = [&](float h) { return std::exp(power * (h - most)); };
  double sum = b.unnamed(m_numClasses) * powered(b.rest);
  for (int i = 0; i < b.count; ++i) sum += powered(b.logOdds[i]);
  const double occupancy = b.occupancyLogOdds(m_numClasses), own = (1 - shared) / sum;
  Belief s = b;
  s.rest = onGrid(occupancy + std::log(own * powered(b.rest)));
  for (int i = 0; i < b.count; ++i)
    s.logOdds[i] = onGrid(occupancy + std::log(own * powered(b.logOdds[i]) + shared / b.count));
  return s;
}

auto ClassFilter::classesWithFactors(const Belief& b) const
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

auto ClassFilter::statedWithFactors(const Belief& b) const -> Belief {
  auto p = classesWithFactors(b);
  const auto end = p.begin() + m_numClasses;
  const double occupancy = b.occupancyLogOdds(m_numClasses);
  Belief s;
  for (const int named = std::min(Belief::kNamed, m_numClasses); s.count < named; ++s.count) {
    const auto best = std::max_element(p.begin(), end);
    s.ids[s.count] = static_cast<ClassId>(best - p.begin() + 1);
    s.logOdds[s.count] = onGrid(occupancy + std::log(*best));
    *best = 0;
  }
  const double others = std::accumulate(p.begin(), end, 0.0);
  if (others > 0) s.rest = onGrid(occupancy + std::log(others / s.unnamed(m_numClasses)));
  s.sort();
  return s;
}

void ClassFilter::distribution(const Belief& b, double* p) const {
  stated(b).distribution(m_numClasses, p);
  if (b.count == 0 || m_parameters.calibration.factors.empty()) return;
  const auto classes = classesWithFactors(b);
  std::transform(classes.begin(), classes.begin() + m_numClasses, p + 1,
                 [occupied = 1 - p[0]](double ofOccupied) { return occupied * ofOccupied; });
}

void ClassFilter::limit(Belief& b) const {
  float highest = b.unnamed(m_numClasses) > 0 ? b.rest : b.logOdds[0];
  for (int i = 0; i < b.count; ++i) highest = std::max(highest, b.logOdds[i]);
  const float excess = std::max(float(0), highest - m_max);
  for (int i = 0; i < b.count; ++i) b.logOdds[i] = std::max(m_min, b.logOdds[i] - excess);
  b.rest = std::max(m_min, b.rest - excess);
  b.sort();
}

void ClassFilter::addToAll(Belief& b, float increment) const {
  for (int i = 0; i < b.count; ++i) b.logOdds[i] += increment;
  b.rest += increment;
  limit(b);
}

void ClassFilter::hitOf(Belief& b, ClassId id, float same, float other) const {
  const float observed = b.logOddsOf(id) + same;
  const int index = b.indexOf(id);
  for (int i = 0; i < b.count; ++i) b.logOdds[i] += other;
  b.rest += other;
  if (index >= 0)
    b.logOdds[index] = observed;
  else
    name(b, id, observed);
  limit(b);
}

void ClassFilter::name(Belief& b, ClassId id, float logOdds) const {
  if (b.count < Belief::kNamed) {
    b.ids[b.count] = id;
    b.logOdds[b.count++] = logOdds;
    return;
  }
  // The least likely of all that have a name joins the m - 1 classes that stay without.
  const int last = Belief::kNamed - 1;
  const bool newcomerIsLeast =
      logOdds != b.logOdds[last] ? logOdds < b.logOdds[last] : id > b.ids[last];
  const double evicted = newcomerIsLeast ? logOdds : b.logOdds[last];
  const int others = b.unnamed(m_numClasses) - 1;
  const double top = std::max<double>(evicted, b.rest);
  const double odds = others * std::exp(b.rest - top) + std::exp(evicted - top);
  b.rest = onGrid(top + std::log(odds / (others + 1)));
  if (newcomerIsLeast) return;
  b.ids[last] = id;
  b.logOdds[last] = logOdds;
}

void ClassFilter::hit(Belief& b, const ClassVotes* votes, std::size_t numVoted) const {
  if (numVoted > 1) return hitOfSeveral(b, votes, numVoted);
  const Row row = rowOf(votes->count);
  hitOf(b, votes->id, row.named, row.other);
}

void ClassFilter::hitOfSeveral(Belief& b, const ClassVotes* votes, std::size_t numVoted) const {
  const Belief before = b;
  std::array<double, semantic_types::kMaxClasses> evidence;
  double most = 0;
  for (std::size_t i = 0; i < numVoted; ++i)
    most = std::max(most, evidence[i] = m_evidence(votes[i].count));
  double odds = static_cast<double>(m_numClasses - numVoted) * std::exp(-most);
  for (std::size_t i = 0; i < numVoted; ++i) odds += std::exp(evidence[i] - most);
  const double unnamed = incrementWithoutEvidence(most, odds);
  const float other = onGrid(unnamed);
  int numEvicted = 0;
  double evictedOdds = 0;
  const auto evict = [&](float logOdds) {
    ++numEvicted;
    evictedOdds += std::exp(static_cast<double>(logOdds));
  };
  const auto offer = [&](ClassId id, float logOdds) {
    const int last = Belief::kNamed - 1;
    if (b.count < Belief::kNamed) {
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
  std::array<bool, Belief::kNamed> voted{};
  for (std::size_t i = 0; i < numVoted; ++i) {
    const int index = before.indexOf(votes[i].id);
    if (index >= 0) voted[index] = true;
    offer(votes[i].id, before.logOddsOf(votes[i].id) + onGrid(unnamed + evidence[i]));
  }
  for (int i = 0; i < before.count; ++i)
    if (!voted[i]) offer(before.ids[i], before.logOdds[i] + other);
  if (numEvicted > 0) {
    const int members = b.unnamed(m_numClasses);
    const double rest = (members - numEvicted) * std::exp(static_cast<double>(b.rest));
    b.rest = onGrid(std::log((rest + evictedOdds) / members));
  }
  limit(b);
}

void ClassFilter::hit(Belief& b, const float* q) const {
  const double K = m_numClasses;
  std::vector<double> p(q, q + m_numClasses);
  if (const auto& prior = m_parameters.classPrior; b.count == 0 && !prior.empty()) {
    const double all = std::inner_product(p.begin(), p.end(), prior.begin(), 0.0);
    std::transform(p.begin(), p.end(), prior.begin(), p.begin(),
                   [all](double likelihood, double before) { return likelihood * before / all; });
  }
  std::vector<float> h(m_numClasses + 1);
  for (int k = 1; k <= m_numClasses; ++k)
    h[k] = onGrid(b.logOddsOf(static_cast<ClassId>(k)) + m_unlabeled +
                  std::log(K * std::max(p[k - 1], m_parameters.softLabelFloor)));
  const float excess = std::max(float(0), *std::max_element(h.begin() + 1, h.end()) - m_max);
  for (float& x : h) x = std::max(m_min, x - excess);
  std::vector<ClassId> order(m_numClasses);
  std::iota(order.begin(), order.end(), ClassId{1});
  const int named = std::min(Belief::kNamed, m_numClasses);
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
  b.rest = onGrid(std::log(odds / (m_numClasses - named)));
}

}  // namespace semantic_octree
