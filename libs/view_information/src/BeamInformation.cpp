#include <view_information/BeamInformation.h>

#include <tree_abstraction/Information.h>

#include <algorithm>
#include <cmath>
#include <map>

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

double Question::entropyOfRow(const std::vector<double>& row) const {
  double sum = 0;
  for (std::size_t t = 0; t < m_terms.size(); ++t) {
    const auto slot = m_terms.slot(t);
    const double* p = row.data() + slot.offset;
    const double h =
        slot.isBinary() ? -xLogX(*p) - xLogX(1 - *p) : tree_abstraction::entropy(p, slot.width);
    sum += m_weights[t] * h;
  }
  return sum;
}

std::vector<double> Question::rowOf(const double* p) const {
  std::vector<double> row(m_terms.width(), 0);
  for (const auto& c : m_terms.contributions()) row[c.entry] += p[c.classId];
  return row;
}

double Question::entropy(const double* p) const { return entropyOfRow(rowOf(p)); }

double Question::surprise(const BeamModel& model, const double* p, int outcome) const {
  const double pw = model.probability(outcome, p);
  std::vector<double> after(m_entries.size());
  for (std::size_t k = 0; k < after.size(); ++k)
    after[k] = p[k] * model.probability(outcome, static_cast<int>(k)) / pw;
  const std::vector<double> before = rowOf(p), now = rowOf(after.data());
  const auto part = [](double a, double b) { return a > 0 && b > 0 ? a * std::log(a / b) : 0.0; };
  double sum = 0;
  for (std::size_t t = 0; t < m_terms.size(); ++t) {
    const auto slot = m_terms.slot(t);
    double divergence = 0;
    for (std::size_t e = slot.offset; e < slot.offset + slot.width; ++e)
      divergence += part(now[e], before[e]);
    if (slot.isBinary()) divergence += part(1 - now[slot.offset], 1 - before[slot.offset]);
    sum += m_weights[t] * divergence;
  }
  return sum;
}

double Question::entropy(const ClassBelief<float>& belief) const {
  const auto p = belief.probabilities(numClasses());
  std::vector<double> row(m_sizes);
  for (double& entry : row) entry *= p.rest;
  for (const std::size_t e : m_entries[0]) row[e] += p.free;
  for (int i = 0; i < belief.count; ++i)
    for (const std::size_t e : m_entries[belief.ids[i]]) row[e] += p.named[i] - p.rest;
  return entropyOfRow(row);
}

double Question::information(const BeamModel& model, const double* p) const {
  const int K = numClasses();
  std::vector<double> after(m_entries.size());
  double left = 0;
  for (int w = 0; w <= K; ++w) {
    const double pw = model.probability(w, p);
    if (pw <= 0) continue;
    for (int k = 0; k <= K; ++k)
      after[static_cast<std::size_t>(k)] = p[k] * model.probability(w, k) / pw;
    left += pw * entropy(after.data());
  }
  return entropy(p) - left;
}

double Question::fallThrough(const ClassFilter<float>& filter, const BeamModel& model,
                             const ClassBelief<float>& belief) const {
  std::vector<double> p(m_entries.size());
  belief.distribution(numClasses(), p.data());
  auto after = belief;
  filter.miss(after);
  double left = model.pass(p.data()) * entropy(after);
  std::map<int, double> known;  // entropy after a label of a class that the belief does not name
  for (int k = 1; k <= numClasses(); ++k) {
    const auto entropyAfterHit = [&] {
      auto hit = belief;
      filter.hit(hit, static_cast<ClassId>(k));
      return entropy(hit);
    };
    const int kind = m_kinds[static_cast<std::size_t>(k)];
    const bool isNamed = belief.indexOf(static_cast<ClassId>(k)) >= 0;
    const auto found = isNamed ? known.end() : known.find(kind);
    const double h = found != known.end() ? found->second : entropyAfterHit();
    if (!isNamed) known.emplace(kind, h);
    left += model.probability(k, p.data()) * h;
  }
  return entropy(belief) - left;
}

}  // namespace view_information
