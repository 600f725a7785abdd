#include <semantic_abstraction/AbstractionOptions.h>

#include <algorithm>

namespace semantic_octree {

using tree_abstraction::InformationTerm;

namespace {

/** Terms beyond the weighed ones in a batch; up to 24 classes and free space need but one. */
constexpr std::size_t kMeasuredAtOnce = 25;

}  // namespace

TermCatalog::TermCatalog(const semantic_types::ClassTable& classes,
                         const std::vector<Solution>& solutions)
    : m_numClasses(static_cast<std::size_t>(classes.size())) {
  add({kFreeSpace, 0, {{0}}});
  for (int id = 1; id <= classes.size(); ++id)
    add({classes.name(static_cast<semantic_types::ClassId>(id)), 0, {{id}}});
  for (const Solution& solution : solutions)
    for (const InformationTerm& term : solution.terms)
      if (indexOf(term) == size()) add(term);
  std::vector<bool> isWeighed(size(), false);
  for (const Solution& solution : solutions)
    for (const InformationTerm& term : solution.terms) isWeighed[indexOf(term)] = true;
  makeBatches(isWeighed);
}

std::size_t TermCatalog::indexOf(const InformationTerm& term) const {
  const auto same = [&](const InformationTerm& t) { return t.groups == term.groups; };
  return static_cast<std::size_t>(std::find_if(m_terms.begin(), m_terms.end(), same) -
                                  m_terms.begin());
}

/** Solutions may mean different groups by one name. */
void TermCatalog::add(InformationTerm term) {
  const std::string name = term.name;
  const auto isTaken = [&](const InformationTerm& t) { return t.name == term.name; };
  for (int n = 2; std::any_of(m_terms.begin(), m_terms.end(), isTaken); ++n)
    term.name = name + " (" + std::to_string(n) + ")";
  term.weight = 0;
  m_terms.push_back(std::move(term));
}

void TermCatalog::makeBatches(const std::vector<bool>& isWeighed) {
  std::vector<std::size_t> weighed, measured;
  for (std::size_t t = 0; t < size(); ++t) (isWeighed[t] ? weighed : measured).push_back(t);
  std::size_t next = 0;
  do {
    const std::size_t end = std::min(next + kMeasuredAtOnce, measured.size());
    m_batches.push_back(weighed);
    for (; next < end; ++next) m_batches.back().push_back(measured[next]);
  } while (next < measured.size());
}

std::vector<InformationTerm> TermCatalog::terms(std::size_t b) const {
  std::vector<InformationTerm> terms;
  for (const std::size_t t : m_batches[b]) terms.push_back(m_terms[t]);
  return terms;
}

std::vector<InformationTerm> TermCatalog::weighedTerms(const Solution& solution,
                                                       std::size_t b) const {
  std::vector<InformationTerm> weighed = terms(b);
  const std::vector<double> weights = this->weights(solution, b);
  for (std::size_t t = 0; t < weighed.size(); ++t) weighed[t].weight = weights[t];
  return weighed;
}

std::vector<double> TermCatalog::allWeights(const Solution& solution) const {
  std::vector<double> weights(size(), 0.0);
  for (const InformationTerm& term : solution.terms) weights[indexOf(term)] += term.weight;
  return weights;
}

std::vector<double> TermCatalog::weights(const Solution& solution, std::size_t b) const {
  const std::vector<double> all = allWeights(solution);
  std::vector<double> weights;
  for (const std::size_t t : m_batches[b]) weights.push_back(all[t]);
  return weights;
}

}  // namespace semantic_octree
