#pragma once
#include <semantic_octree/FilterParameters.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <vector>

inline double logit(double p) { return std::log(p / (1 - p)); }
inline double sigmoid(double h) { return 1 / (1 + std::exp(-h)); }
/** A map keeps log-odds as multiples of it. */
constexpr double kTick = 1.0 / 1024;
inline double stored(double logOdds) { return std::nearbyint(logOdds / kTick) * kTick; }

/** Bayes filter over {free, class 1, ..., class K} that keeps every class's log-odds: the oracle of
 * the truncated filter, written from the formulas. */
class ExactFilter {
 public:
  ExactFilter(int K, const semantic_octree::FilterParameters& p) : m_h(K, -stored(std::log(K))) {
    m_lowest = stored(logit(p.minOccupancy)) - stored(std::log(K));
    m_highest = stored(logit(p.maxProbability));
    m_floor = p.softLabelFloor;
    m_accuracy = p.accuracy;
    m_correlation = p.labelCorrelation;
    m_votesAreRows = K > 1;
    m_unlabeled = std::log(p.hitProbability / p.falseAlarmProbability);
    m_same = m_unlabeled + (K > 1 ? std::log(K * p.accuracy) : 0);
    m_other = m_unlabeled + (K > 1 ? std::log(K * (1 - p.accuracy) / (K - 1)) : 0);
    m_miss = std::log((1 - p.hitProbability) / (1 - p.falseAlarmProbability));
  }

  void hit(int id) {
    for (int k = 1; k <= K(); ++k) m_h[k - 1] += stored(k == id ? m_same : m_other);
    limit();
  }
  void hit() { addToAll(m_unlabeled); }
  void miss() { addToAll(m_miss); }
  void hit(const std::vector<float>& q) {
    for (int k = 1; k <= K(); ++k)
      m_h[k - 1] += stored(m_unlabeled + std::log(K() * std::max<double>(q[k - 1], m_floor)));
    limit();
  }

  /** A scan's labels: class, how many. */
  void hit(const std::map<int, int>& votes) {
    if (votes.empty()) return hit();
    const auto fewer = [](const auto& a, const auto& b) { return a.second < b.second; };
    if (!m_votesAreRows) return hit(std::max_element(votes.begin(), votes.end(), fewer)->first);
    std::vector<double> logLikelihoods;
    for (int k = 1; k <= K(); ++k) logLikelihoods.push_back(logLikelihoodOf(labelsOf(votes), k));
    const double most = *std::max_element(logLikelihoods.begin(), logLikelihoods.end());
    double sum = 0;
    for (const double l : logLikelihoods) sum += std::exp(l - most);
    for (int k = 1; k <= K(); ++k)
      m_h[k - 1] += stored(m_unlabeled + logLikelihoods[k - 1] - most + std::log(K() / sum));
    limit();
  }

  static std::vector<int> labelsOf(const std::map<int, int>& votes) {
    std::vector<int> labels;
    for (const auto& [id, count] : votes) labels.insert(labels.end(), count, id);
    return labels;
  }
  /** ln p(labels | class k) by the chain rule. Polya's urn holds a share 1 - r of balls as the
   * class has them. It takes r more of the color of each that is drawn (r / (1 - r) = 1 / s). */
  double logLikelihoodOf(const std::vector<int>& labels, int k) const {
    const double r = m_correlation, wrong = (1 - m_accuracy) / (K() - 1);
    std::map<int, int> drawn;
    double sum = 0;
    for (std::size_t i = 0; i < labels.size(); ++i) {
      const double share = (1 - r) * (labels[i] == k ? m_accuracy : wrong);
      const double balls = 1 - r + r * static_cast<double>(i);
      // The first is drawn by its share alone, also if r = 1.
      sum += i == 0 ? std::log(labels[i] == k ? m_accuracy : wrong)
                    : std::log((share + r * drawn[labels[i]]) / balls);
      ++drawn[labels[i]];
    }
    return sum;
  }

  int K() const { return static_cast<int>(m_h.size()); }
  double logOdds(int k) const { return m_h[k - 1]; }
  double occupancyLogOdds() const {
    double odds = 0;
    for (const double h : m_h) odds += std::exp(h);
    return std::log(odds);
  }
  /** [0] = free. */
  std::vector<double> distribution() const {
    std::vector<double> p{1};
    double sum = 1;
    for (const double h : m_h) p.push_back(std::exp(h)), sum += p.back();
    for (double& x : p) x /= sum;
    return p;
  }

 private:
  void addToAll(double increment) {
    for (double& h : m_h) h += stored(increment);
    limit();
  }
  void limit() {
    const double excess = *std::max_element(m_h.begin(), m_h.end()) - m_highest;
    for (double& h : m_h) h = std::max(m_lowest, h - std::max(0.0, excess));
  }

  std::vector<double> m_h;
  double m_lowest, m_highest, m_floor, m_accuracy, m_correlation, m_same, m_other, m_unlabeled,
      m_miss;
  bool m_votesAreRows;
};

/** Total variation distance of two distributions. */
inline double totalVariation(const std::vector<double>& p, const std::vector<double>& q) {
  double sum = 0;
  for (std::size_t i = 0; i < p.size(); ++i) sum += std::fabs(p[i] - q[i]);
  return sum / 2;
}
