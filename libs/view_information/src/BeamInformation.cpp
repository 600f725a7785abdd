#include <view_information/BeamInformation.h>

#include <tree_abstraction/Information.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

namespace view_information {

using semantic_octree::ClassBelief;
using semantic_octree::ClassFilter;
using tree_abstraction::xLogX;

BeamModel::BeamModel(int numClasses, const semantic_octree::FilterParameters& parameters)
    : m_numClasses(numClasses),
      m_hit(parameters.hitProbability),
      m_falseAlarm(parameters.falseAlarmProbability),
      m_accuracy(numClasses > 1 ? parameters.accuracy : 1) {
  parameters.validate(numClasses);
}

double BeamModel::probability(int outcome, int cell) const {
  const double returns = cell == 0 ? m_falseAlarm : m_hit;
  if (outcome == 0) return 1 - returns;
  if (cell == 0) return returns / m_numClasses;
  return returns * (outcome == cell ? m_accuracy : (1 - m_accuracy) / (m_numClasses - 1));
}

double BeamModel::probability(int outcome, const double* p) const {
  const double occupied = 1 - p[0];
  if (outcome == 0) return p[0] * (1 - m_falseAlarm) + occupied * (1 - m_hit);
  const double other = m_numClasses > 1 ? (1 - m_accuracy) / (m_numClasses - 1) : 0;
  return p[0] * m_falseAlarm / m_numClasses +
         m_hit * (m_accuracy * p[outcome] + other * (occupied - p[outcome]));
}

std::vector<double> BeamModel::after(int outcome, const double* p) const {
  const double pw = probability(outcome, p);
  std::vector<double> after(p, p + m_numClasses + 1);
  for (int k = 0; k <= m_numClasses; ++k)
    after[static_cast<std::size_t>(k)] *= probability(outcome, k) / pw;
  return after;
}

double informationOfBeam(const std::vector<CellRun>& runs) {
  double reached = 1, sum = 0;
  for (const CellRun& run : runs) {
    const double left = std::pow(run.pass, run.count);
    const double observed = run.pass < 1 ? (1 - left) / (1 - run.pass) : run.count;
    sum += reached * run.value * observed;
    reached *= left;
  }
  return sum;
}

double informationOfTree(const std::vector<TreeCell>& cells) {
  std::vector<double> leaves(cells.size());  // P(a beam leaves the cell)
  double sum = 0;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const TreeCell& cell = cells[i];
    const double reached = cell.parent < 0 ? 1 : leaves[static_cast<std::size_t>(cell.parent)];
    sum += reached * cell.value;
    leaves[i] = reached * cell.pass;
  }
  return sum;
}

Bounds informationOfNet(const std::vector<TreeCell>& cells,
                        const std::vector<std::vector<int>>& beams) {
  std::vector<double> most(cells.size(), 0), none(cells.size(), 1);
  for (const std::vector<int>& beam : beams) {
    double reached = 1;
    for (const int c : beam) {
      const auto i = static_cast<std::size_t>(c);
      most[i] = std::max(most[i], reached);
      none[i] *= 1 - reached;
      reached *= cells[i].pass;
    }
  }
  Bounds bounds;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const double a = most[i] * cells[i].value, b = (1 - none[i]) * cells[i].value;
    bounds.lower += std::min(a, b), bounds.upper += std::max(a, b);
  }
  return bounds;
}

Bounds informationOfViews(const std::vector<std::vector<double>>& reached,
                          const std::vector<double>& values) {
  Bounds bounds;
  for (std::size_t i = 0; i < values.size(); ++i) {
    double most = 0, sum = 0;
    for (const std::vector<double>& view : reached) most = std::max(most, view[i]), sum += view[i];
    bounds.lower += most * values[i], bounds.upper += sum * values[i];
  }
  return bounds;
}

/** What is told of each cell grows by its information. That is counted from the mean over all
 * cells, which moves. The mean's expected divergence is at most its expected chi-square distance: a
 * sum over cells, as what moves them is not correlated. */
Bounds growthOfTree(const Question& question, const BeamModel& model,
                    const std::vector<std::vector<double>>& beliefs,
                    const std::vector<double>& reached, const std::vector<double>& counts) {
  const double share = 1 / std::accumulate(counts.begin(), counts.end(), 0.0);
  std::vector<double> mean(static_cast<std::size_t>(question.numClasses()) + 1, 0);
  for (std::size_t i = 0; i < beliefs.size(); ++i)
    for (std::size_t k = 0; k < mean.size(); ++k) mean[k] += share * counts[i] * beliefs[i][k];
  double told = 0;
  Bounds moved;
  for (std::size_t i = 0; i < beliefs.size(); ++i) {
    const double* p = beliefs[i].data();
    const double looks = counts[i] * reached[i];
    told += share * looks * question.information(model, p);
    for (int w = 0; w <= question.numClasses(); ++w) {
      const Bounds far = question.distance(model.after(w, p).data(), p, mean.data());
      const double weight = share * share * looks * model.probability(w, p);
      moved.lower += weight * far.lower, moved.upper += weight * far.upper;
    }
  }
  return {told - moved.upper, told - moved.lower};
}

Question::Question(const tree_abstraction::AbstractionWeights& weights, int numClasses)
    : m_terms(weights, numClasses),
      m_entries(static_cast<std::size_t>(numClasses) + 1),
      m_sizes(m_terms.width(), 0),
      m_kinds(m_entries.size(), 0) {
  for (const auto& term : weights.terms) m_weights.push_back(term.weight);
  for (const auto& c : m_terms.contributions()) {
    m_entries[c.classId].push_back(c.entry);
    m_sizes[c.entry] += c.classId > 0;
  }
  std::map<std::vector<std::size_t>, int> first;
  for (std::size_t k = 1; k < m_entries.size(); ++k)
    m_kinds[k] = first.emplace(m_entries[k], static_cast<int>(k)).first->second;
}

/** Weighted sums over the terms' outcomes: lower of what is to be ignored, upper of what is
 * relevant. \param of, ofRest (entry of a row): of the outcome that it has, and of the rest of a
 * term that has one entry only */
template <class Of, class OfRest>
Bounds Question::sumsOverTerms(Of of, OfRest ofRest) const {
  Bounds sums;
  for (std::size_t t = 0; t < m_terms.size(); ++t) {
    const auto slot = m_terms.slot(t);
    double ofTerm = slot.isBinary() ? ofRest(slot.offset) : 0;
    for (std::size_t e = slot.offset; e < slot.offset + slot.width; ++e) ofTerm += of(e);
    (m_weights[t] < 0 ? sums.lower : sums.upper) += m_weights[t] * ofTerm;
  }
  return sums;
}

Bounds Question::entropiesOfRow(const std::vector<double>& row) const {
  return sumsOverTerms([&](std::size_t e) { return -xLogX(row[e]); },
                       [&](std::size_t e) { return -xLogX(1 - row[e]); });
}

std::vector<double> Question::rowOf(const double* p) const {
  std::vector<double> row(m_terms.width(), 0);
  for (const auto& c : m_terms.contributions()) row[c.entry] += p[c.classId];
  return row;
}

double Question::entropy(const double* p) const {
  const Bounds h = entropiesOfRow(rowOf(p));
  return h.lower + h.upper;
}

double Question::divergence(const double* p, const double* q) const {
  const std::vector<double> now = rowOf(p), before = rowOf(q);
  const auto part = [](double a, double b) { return a > 0 && b > 0 ? a * std::log(a / b) : 0.0; };
  const Bounds sums = sumsOverTerms([&](std::size_t e) { return part(now[e], before[e]); },
                                    [&](std::size_t e) { return part(1 - now[e], 1 - before[e]); });
  return sums.lower + sums.upper;
}

Bounds Question::distance(const double* p, const double* q, const double* mean) const {
  const std::vector<double> a = rowOf(p), b = rowOf(q), m = rowOf(mean);
  Bounds sum;
  for (std::size_t t = 0; t < m_terms.size(); ++t) {
    const auto slot = m_terms.slot(t);
    for (std::size_t e = slot.offset; e < slot.offset + slot.width; ++e) {
      const double far = (a[e] - b[e]) * (a[e] - b[e]);
      const double ofRest = slot.isBinary() && m[e] < 1 ? far / (1 - m[e]) : 0;
      const double ofTerm = m_weights[t] * ((m[e] > 0 ? far / m[e] : 0) + ofRest);
      (ofTerm > 0 ? sum.upper : sum.lower) += ofTerm;
    }
  }
  return sum;
}

double Question::surprise(const BeamModel& model, const double* p, int outcome) const {
  return divergence(model.after(outcome, p).data(), p);
}

double Question::entropy(const ClassBelief& belief) const {
  const Bounds h = entropies(belief);
  return h.lower + h.upper;
}

Bounds Question::entropies(const ClassBelief& belief) const {
  const auto p = belief.probabilities(numClasses());
  std::vector<double> row(m_sizes);
  for (double& entry : row) entry *= p.rest;
  for (const std::size_t e : m_entries[0]) row[e] += p.free;
  for (int i = 0; i < belief.count; ++i)
    for (const std::size_t e : m_entries[belief.ids[i]]) row[e] += p.named[i] - p.rest;
  return entropiesOfRow(row);
}

double Question::information(const BeamModel& model, const double* p) const {
  double left = 0;
  for (int w = 0; w <= numClasses(); ++w) {
    const double pw = model.probability(w, p);
    if (pw > 0) left += pw * entropy(model.after(w, p).data());
  }
  return entropy(p) - left;
}

double Question::fallThrough(const ClassFilter& filter, const BeamModel& model,
                             const ClassBelief& belief) const {
  std::vector<double> p(m_entries.size());
  belief.distribution(numClasses(), p.data());
  auto after = belief;
  filter.miss(after);
  Bounds fall = entropies(belief);
  const auto take = [&](double probability, const Bounds& left) {
    fall.lower -= probability * left.lower, fall.upper -= probability * left.upper;
  };
  take(model.pass(p.data()), entropies(after));
  std::map<int, Bounds> known;  // entropy after a label of a class that the belief does not name
  for (int k = 1; k <= numClasses(); ++k) {
    const auto entropyAfterHit = [&] {
      auto hit = belief;
      filter.hit(hit, static_cast<ClassId>(k));
      return entropies(hit);
    };
    const int kind = m_kinds[static_cast<std::size_t>(k)];
    const bool isNamed = belief.indexOf(static_cast<ClassId>(k)) >= 0;
    const auto found = isNamed ? known.end() : known.find(kind);
    const Bounds h = found != known.end() ? found->second : entropyAfterHit();
    if (!isNamed) known.emplace(kind, h);
    take(model.probability(k, p.data()), h);
  }
  return fall.upper + std::min(0.0, fall.lower);
}

}  // namespace view_information
