#include "LabelProcess.h"

#include <algorithm>
#include <numeric>

namespace semantic_octree {
namespace {

/** Triples of labels before any are seen, which repeat nothing. Right labels differ at borders
 * alone: of a few dozen such triples, chance makes a share that says nothing. */
constexpr double kTriplesBefore = 100;
/** Rounds of the search. Where one of two classes is taken for the other in every second case, the
 * rare one slowly loses what it has of the frequent one. */
constexpr int kExpectations = 25, kExpectationsFromRight = 100;
/** Rounds in which shares of classes are told from what places look like. More of them take all of
 * a rare class for places of a frequent one. */
constexpr int kExpectationsOfLooks = 5;
/** Where the search for the correlation begins, and how far it goes. */
constexpr double kCorrelationBefore = 0.1, kMostCorrelation = 0.9, kFirstStride = 1,
                 kNextStride = 0.85;

std::size_t columnOf(char label) { return static_cast<unsigned char>(label) - std::size_t{1}; }

void normalize(std::vector<double>& values) {
  const double all = std::accumulate(values.begin(), values.end(), 0.0);
  for (double& value : values) value /= all;
}

/** Rows, weighed and added. */
std::vector<double> mixed(const std::vector<std::vector<double>>& rows,
                          const std::vector<double>& weights) {
  std::vector<double> sum(weights.size());
  for (std::size_t i = 0; i < rows.size(); ++i)
    for (std::size_t k = 0; k < sum.size(); ++k) sum[k] += weights[i] * rows[i][k];
  return sum;
}

double repeatedIn(const LabeledVoxels& voxels) {
  double triples = kTriplesBefore, more = 0;
  for (const auto& [labels, number] : voxels)
    for (std::size_t i = 2; i < labels.size(); ++i) {
      if (labels[i - 1] == labels[i - 2]) continue;
      triples += number;
      if (labels[i] == labels[i - 1]) more += number;
      if (labels[i] == labels[i - 2]) more -= number;
    }
  return std::max(0.0, more / triples);
}

}  // namespace

LabelProcess::LabelProcess(const LabeledVoxels& voxels, int numClasses, double accuracy,
                           double labelsBefore, double labelsAtFirst)
    : m_repeated(repeatedIn(voxels)) {
  const double least = std::min(leastCorrelation(), kMostCorrelation);
  m_correlation = std::max(least, kCorrelationBefore);
  const auto K = static_cast<std::size_t>(numClasses);
  const double wrong = (1 - accuracy) / (numClasses - 1);
  const auto rightLabels = [&](double labels) {
    Table before(K, std::vector<double>(K, labels * wrong));
    for (std::size_t k = 0; k < K; ++k) before[k][k] = labels * accuracy;
    return before;
  };
  const Table before = rightLabels(labelsBefore),
              atFirst = rightLabels(std::max(labelsBefore, labelsAtFirst));
  m_counts = before;
  m_shares.assign(K, 1.0);
  double stride = kFirstStride;
  const int rounds = labelsAtFirst > 0 ? kExpectationsFromRight : kExpectations;
  for (int round = 0; round < rounds; ++round) {
    const double slope = step(voxels, round < rounds / 2 ? atFirst : before);
    m_correlation *= slope > 0 ? 1 + stride : 1 / (1 + stride);
    m_correlation = std::clamp(m_correlation, least, kMostCorrelation);
    stride *= kNextStride;
  }
}

double LabelProcess::step(const LabeledVoxels& voxels, const Table& before) {
  m_rows = std::move(m_counts);
  for (auto& row : m_rows) normalize(row);
  normalize(m_shares);
  m_counts = before;
  std::vector<double> shares(m_shares.size(), 1.0);
  std::vector<Origin> origins;
  double slope = 0;
  for (const auto& [labels, number] : voxels) {
    const std::vector<double> p = looksOf(labels, &origins);
    for (std::size_t k = 0; k < p.size(); ++k) shares[k] += number * p[k];
    for (std::size_t i = 0; i < labels.size(); ++i) {
      const double expected = shareDrawn(i);
      for (std::size_t k = 0; k < p.size(); ++k) {
        const auto& [drawn, urn] = origins[i * p.size() + k];
        m_counts[k][columnOf(labels[i])] += number * p[k] * drawn;
        slope += number * p[k] * (expected * (drawn + urn) - drawn);
      }
    }
  }
  m_shares = std::move(shares);
  return slope;
}

double LabelProcess::shareDrawn(std::size_t earlier) const {
  return (1 - m_correlation) / (1 - m_correlation + m_correlation * static_cast<double>(earlier));
}

void LabelProcess::setAlwaysWrong(double always) {
  const std::size_t K = m_shares.size();
  Table looks = m_counts;
  for (std::size_t k = 0; k < K; ++k) {
    normalize(looks[k]);
    for (double& look : looks[k]) look *= always;
    looks[k][k] += 1 - always;
  }
  std::vector<double> seen = m_shares, is = m_shares;
  normalize(seen);
  m_given.assign(K, std::vector<double>(K));
  for (int round = 0; round < kExpectationsOfLooks; ++round) {
    for (std::size_t look = 0; look < K; ++look) {
      for (std::size_t k = 0; k < K; ++k) m_given[look][k] = is[k] * looks[k][look];
      normalize(m_given[look]);
    }
    is = mixed(m_given, seen);
  }
}

std::vector<double> LabelProcess::classesOf(const std::string& labels) const {
  const std::vector<double> looks = looksOf(labels, nullptr);
  return m_given.empty() ? looks : mixed(m_given, looks);
}

std::vector<double> LabelProcess::looksOf(const std::string& labels,
                                          std::vector<Origin>* origins) const {
  std::vector<double> p = m_shares;
  if (origins) origins->clear();
  for (std::size_t i = 0; i < labels.size(); ++i) {
    const auto now = labels.begin() + static_cast<std::ptrdiff_t>(i);
    const bool again = i > 0 && now[-1] == labels[i];
    const double repeated = i > 0 ? m_repeated : 0, drawn = (1 - repeated) * shareDrawn(i);
    const auto same = static_cast<double>(std::count(labels.begin(), now, labels[i]));
    const double urn = i > 0 ? (1 - repeated - drawn) * same / static_cast<double>(i) : 0;
    for (std::size_t k = 0; k < p.size(); ++k) {
      const double draw = drawn * m_rows[k][columnOf(labels[i])];
      const double any = (again ? repeated : 0) + draw + urn;
      if (origins) origins->push_back({draw / any, urn / any});
      p[k] *= any;
    }
    normalize(p);
  }
  return p;
}

}  // namespace semantic_octree
