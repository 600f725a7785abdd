#include "RowLayout.h"

#include <semantic_octree/store/Lanes.h>
#include <tree_abstraction/Information.h>

#include <algorithm>

namespace semantic_octree {
namespace {

static_assert(RowSizes::kLanes == kNumLanes, "rows are padded to whole vectors");

/** Mean of the children's values from i on; eight equal ones give exactly that value. */
MSO_INLINE Lanes meanOfEight(const double* const c[8], int i) {
  return (((load(c[0] + i) + load(c[1] + i)) + (load(c[2] + i) + load(c[3] + i))) +
          ((load(c[4] + i) + load(c[5] + i)) + (load(c[6] + i) + load(c[7] + i)))) *
         0.125;
}

MSO_INLINE Lanes sumOfShares(const double* const c[8], const double s[8], int i) {
  return ((s[0] * load(c[0] + i) + s[1] * load(c[1] + i)) +
          (s[2] * load(c[2] + i) + s[3] * load(c[3] + i))) +
         ((s[4] * load(c[4] + i) + s[5] * load(c[5] + i)) +
          (s[6] * load(c[6] + i) + s[7] * load(c[7] + i)));
}

MSO_INLINE Lanes binaryEntropy(const Lanes& p) { return 0.0 - xLogX(p) - xLogX(1.0 - p); }

/** \param mix gives the mixture of the children's values from an index on */
template <typename Mix>
MSO_INLINE double mixRow(const RowSizes& sizes, const double* weights, double* row, double* js,
                         const Mix& mix) {
  double* const h = row + sizes.width;
  Lanes weighted = {};
  for (int t = 0; t < sizes.binary; t += kNumLanes) {
    const Lanes p = mix(t), entropy = binaryEntropy(p);
    store(p, row + t);
    store(entropy, h + t);
    const Lanes divergence = positivePart(entropy - mix(sizes.width + t));
    store(divergence, js + t);
    weighted += load(weights + t) * divergence;
  }
  for (int i = sizes.binary; i < sizes.width; i += kNumLanes) store(mix(i), row + i);
  for (int t = sizes.binary; t < sizes.terms; t += kNumLanes) store(mix(sizes.width + t), js + t);
  return (weighted[0] + weighted[1]) + (weighted[2] + weighted[3]);
}

/** A value of each octant. */
using UnitVector = Units __attribute__((vector_size(16)));

/** Rows become columns. */
MSO_INLINE void transpose(UnitVector (&v)[8]) {
  // Twice eight values become one row of pairs; after three times, 8 x 8 are transposed.
  for (int step = 0; step < 3; ++step) {
    UnitVector w[8];
    for (int i = 0; i < 4; ++i) {
      w[2 * i] = __builtin_shufflevector(v[i], v[i + 4], 0, 8, 1, 9, 2, 10, 3, 11);
      w[2 * i + 1] = __builtin_shufflevector(v[i], v[i + 4], 4, 12, 5, 13, 6, 14, 7, 15);
    }
    for (int i = 0; i < 8; ++i) v[i] = w[i];
  }
}

}  // namespace

MSO_VECTORIZED void sortOctants(const Units* values, Units* sorted) {
  UnitVector v[8];
  std::memcpy(v, values, sizeof v);
  transpose(v);
  // A sorting network of 19 comparisons, each of all octants at once. Written out: in a loop over
  // pairs of numbers the vectors would be in memory.
  const auto order = [&v](int i, int j) MSO_ALWAYS_INLINE {
    const UnitVector low = v[i] < v[j] ? v[i] : v[j];
    v[j] = v[i] < v[j] ? v[j] : v[i];
    v[i] = low;
  };
  order(0, 2), order(1, 3), order(4, 6), order(5, 7);
  order(0, 4), order(1, 5), order(2, 6), order(3, 7);
  order(0, 1), order(2, 3), order(4, 5), order(6, 7);
  order(2, 4), order(3, 5), order(1, 4), order(3, 6);
  order(1, 2), order(3, 4), order(5, 6);
  transpose(v);
  std::memcpy(sorted, v, sizeof v);
}

namespace {

/** The row of a node from its eight children's: probabilities and entropies of yes-or-no terms, and
 * all divergences. For terms with more outcomes the latter is still the mean of the children's
 * entropies.
 * \return the weighted sum of yes-or-no terms' divergences */
MSO_VECTORIZED double mixEqualShares(const double* const children[8], const RowSizes& sizes,
                                     const double* weights, double* row, double* js) {
  return mixRow(sizes, weights, row, js,
                [children](int i) MSO_ALWAYS_INLINE { return meanOfEight(children, i); });
}

MSO_VECTORIZED double mixShares(const double* const children[8], const double shares[8],
                                const RowSizes& sizes, const double* weights, double* row,
                                double* js) {
  return mixRow(sizes, weights, row, js, [children, shares](int i) MSO_ALWAYS_INLINE {
    return sumOfShares(children, shares, i);
  });
}

/** Entropies of yes-or-no variables, nats; n a multiple of RowSizes::kLanes. */
MSO_VECTORIZED void binaryEntropies(const double* p, int n, double* h) {
  for (int i = 0; i < n; i += kNumLanes) store(binaryEntropy(load(p + i)), h + i);
}

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
