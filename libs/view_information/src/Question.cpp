#include <tree_abstraction/Information.h>
#include <view_information/BeamInformation.h>

#include <cmath>
#include <map>

namespace view_information {

using semantic_octree::ClassBelief;
using semantic_octree::ClassFilter;
using tree_abstraction::xLogX;

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
