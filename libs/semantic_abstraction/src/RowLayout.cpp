#include "RowLayout.h"

#include <tree_abstraction/Information.h>

#include <algorithm>

namespace semantic_octree {
namespace {

using tree_abstraction::AbstractionWeights;
using tree_abstraction::TermSet;

/** Unknown as a class of its own is class K + 1, which no term's group names. */
int numOutcomes(const AbstractionOptions& options, int numClasses) {
  return options.unknown == AbstractionOptions::Unknown::OwnClass ? numClasses + 1 : numClasses;
}

std::vector<double> unknownDistribution(const AbstractionOptions& options, int numClasses) {
  std::vector<double> p(numOutcomes(options, numClasses) + 1, 0.0);
  if (options.unknown == AbstractionOptions::Unknown::OwnClass)
    p.back() = 1;
  else
    p.assign(p.size(), 1.0 / (numClasses + 1));
  return p;
}

}  // namespace

RowLayout::RowLayout(const AbstractionOptions& options, int numClasses)
    : m_numClasses(numClasses), m_entriesOfClass(numOutcomes(options, numClasses) + 1) {
  const TermSet terms(options.weights, numOutcomes(options, numClasses));
  int binary = 0;
  for (std::size_t t = 0; t < terms.size(); ++t) binary += terms.slot(t).isBinary();
  m_sizes.binary = RowSizes::pad(binary);
  int nextBinary = 0, nextWide = m_sizes.binary, nextEntry = m_sizes.binary;
  m_entries.resize(m_sizes.binary);
  for (std::size_t t = 0; t < terms.size(); ++t) {
    const bool isBinary = terms.slot(t).isBinary();
    m_order.push_back(isBinary ? nextBinary++ : nextWide++);
    addTerm(terms, t, isBinary ? m_order.back() : nextEntry);
    if (isBinary) continue;
    const int width = static_cast<int>(terms.slot(t).width);
    m_wideTerms.push_back({m_order.back(), nextEntry, width});
    nextEntry += width;
  }
  m_sizes.width = RowSizes::pad(nextEntry);
  m_sizes.terms = RowSizes::pad(nextWide);
  m_entries.resize(m_sizes.width);

  m_unknownRow.assign(rowSize(), 0.0);
  const std::vector<double> unknown = unknownDistribution(options, numClasses);
  for (std::size_t k = 0; k < unknown.size(); ++k)
    for (const int entry : m_entriesOfClass[k]) m_unknownRow[entry] += unknown[k];
  fillEntropies(m_unknownRow.data());
}

void RowLayout::addTerm(const TermSet& terms, std::size_t term, int firstEntry) {
  const auto slot = terms.slot(term);
  m_entries.resize(std::max(m_entries.size(), firstEntry + slot.width));
  for (const TermSet::Contribution& c : terms.contributions()) {
    if (c.entry < slot.offset || c.entry >= slot.offset + slot.width) continue;
    const int entry = firstEntry + static_cast<int>(c.entry - slot.offset);
    m_entriesOfClass[c.classId].push_back(entry);
    if (c.classId == 0)
      m_entries[entry].free = 1;
    else if (static_cast<int>(c.classId) <= m_numClasses)
      ++m_entries[entry].classes;
  }
}

void RowLayout::rowOf(const Belief& belief, double* row) const {
  const auto p = belief.probabilities(m_numClasses);
  for (std::size_t i = 0; i < m_entries.size(); ++i)
    row[i] = m_entries[i].free * p.free + m_entries[i].classes * p.rest;
  for (int i = 0; i < belief.count; ++i)
    for (const int entry : m_entriesOfClass[belief.ids[i]]) row[entry] += p.named[i] - p.rest;
  for (std::size_t i = 0; i < m_entries.size(); ++i) row[i] = std::min(1.0, std::max(0.0, row[i]));
  fillEntropies(row);
}

double RowLayout::mix(const double* const children[8], const double* shares, const double* weights,
                      double* row, double* js) const {
  double weighted = shares ? mixShares(children, shares, m_sizes, weights, row, js)
                           : mixEqualShares(children, m_sizes, weights, row, js);
  if (m_wideTerms.empty()) return weighted;
  fillWideEntropies(row);
  const double* const h = row + m_sizes.width;
  for (int t = m_sizes.binary; t < m_sizes.terms; ++t) {
    js[t] = std::max(0.0, h[t] - js[t]);
    weighted += weights[t] * js[t];
  }
  return weighted;
}

void RowLayout::fillEntropies(double* row) const {
  binaryEntropies(row, m_sizes.binary, row + m_sizes.width);
  fillWideEntropies(row);
}

void RowLayout::fillWideEntropies(double* row) const {
  double* const h = row + m_sizes.width;
  for (int t = m_sizes.binary; t < m_sizes.terms; ++t) h[t] = 0;
  for (const WideTerm& term : m_wideTerms)
    h[term.position] = tree_abstraction::entropy(row + term.first, term.width);
}

}  // namespace semantic_octree
