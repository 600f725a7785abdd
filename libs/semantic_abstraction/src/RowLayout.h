#pragma once
#include <semantic_abstraction/AbstractionOptions.h>
#include <semantic_octree/store/ClassRecord.h>
#include <semantic_octree/store/Cubes.h>
#include <tree_abstraction/AbstractionWeights.h>

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <new>
#include <vector>

namespace semantic_octree {

/** Sizes of the rows that the abstraction keeps per node, in doubles, padded to whole vectors.
 *
 * A row holds the probabilities of the terms' outcomes: first those of yes-or-no terms (one each),
 * then those of terms with more outcomes. Behind it stand the terms' entropies in the same order:
 * `probabilities[width] | entropies[terms]`. An inner node appends its divergences. */
struct RowSizes {
  static constexpr int kLanes = 4;
  static constexpr int pad(int n) { return (n + kLanes - 1) / kLanes * kLanes; }
  int width = 0;   ///< padded number of probabilities
  int terms = 0;   ///< padded number of terms
  int binary = 0;  ///< padded number of yes-or-no terms

  int row() const { return width + terms; }
};

/** Sorts 64 values eight by eight, in ascending order. */
void sortOctants(const Units* values, Units* sorted);

/** How a node's class distribution becomes a row of outcome probabilities and entropies (see
 * RowSizes), and what the row of unknown space is. */
class RowLayout {
 public:
  RowLayout(const AbstractionOptions& options, int numClasses);

  const RowSizes& sizes() const { return m_sizes; }
  /** Doubles of a row: probabilities and entropies. */
  int rowSize() const { return m_sizes.row(); }
  /** Where term t of the options stands among the entropies and divergences. */
  int positionOf(int term) const { return m_order[term]; }

  /** Row of a cell. */
  void rowOf(const Belief& belief, double* row) const;
  const double* unknownRow() const { return m_unknownRow.data(); }
  /** Row and divergences of a node from its children's rows and shares (null: each is 1/8).
   * \return the weighted sum of the divergences */
  double mix(const double* const children[8], const double* shares, const double* weights,
             double* row, double* js) const;

 private:
  /** Entry of a row = p(free) * free + number of classes * p(rest) + what named classes exceed it
   * by. */
  struct Entry {
    double free = 0, classes = 0;
  };
  struct WideTerm {
    int position, first, width;
  };
  /** Fills in the entropies behind the probabilities. */
  void fillEntropies(double* row) const;
  void fillWideEntropies(double* row) const;
  void addTerm(const tree_abstraction::TermSet& terms, std::size_t term, int firstEntry);

  int m_numClasses;
  RowSizes m_sizes;
  std::vector<int> m_order;
  std::vector<Entry> m_entries;
  std::vector<std::vector<int>> m_entriesOfClass;
  std::vector<WideTerm> m_wideTerms;
  std::vector<double> m_unknownRow;
};

/** An octant's eight values, in ascending order. */
struct OctantPattern {
  Units values[8];
  bool operator==(const OctantPattern& o) const { return std::memcmp(this, &o, sizeof o) == 0; }
};

/** Rows (see RowLayout), and G-values, of leaves by their values or class records, and of octants
 * by their patterns. Each is computed when first asked for, and kept: there are many leaves and
 * octants, and few kinds of them. A table that is full begins anew. \tparam Key of at most 16
 * bytes, none of which is padding */
template <typename Key>
class RowTable {
 public:
  struct Entry {
    Key key;
    double gValue;
    const double* row;  ///< null: there is none yet
  };

  explicit RowTable(std::size_t rowSize)
      : m_rowSize(rowSize),
        m_entries(kEntries),
        m_rows(static_cast<double*>(std::aligned_alloc(kLine, kMost * rowSize * sizeof(double)))) {
    if (!m_rows) throw std::bad_alloc();
  }

  void clear() {
    std::fill(m_entries.begin(), m_entries.end(), Entry());
    m_size = 0;
  }
  /** Entries asked for up to now are not in use any more. Eight may be asked for until the next
   * time. */
  void release() {
    if (m_size > kMost - 8) clear();
  }

  /** \param compute computes what is not there: a row, and its G-value, compute(key, row) */
  template <typename F>
  const Entry& find(const Key& key, const F& compute) {
    std::size_t i = hashOf(key) >> (64 - kBits);
    while (m_entries[i].row && !(m_entries[i].key == key)) i = (i + 1) % kEntries;
    Entry& entry = m_entries[i];
    if (entry.row) return entry;
    double* const row = m_rows.get() + m_size * m_rowSize;
    const double gValue = compute(key, row);
    ++m_size;
    return entry = {key, gValue, row};
  }

 private:
  static constexpr int kBits = 12;
  static constexpr std::size_t kEntries = std::size_t(1) << kBits, kMost = kEntries / 2;
  static constexpr std::size_t kLine = 64;  ///< bytes that a processor fetches at once, as a rule
  struct Free {
    void operator()(double* p) const { std::free(p); }
  };

  static std::size_t hashOf(const Key& key) {
    std::uint64_t bits[2] = {};
    static_assert(sizeof(Key) <= sizeof bits);
    std::memcpy(bits, &key, sizeof key);
    return (bits[0] * 0x9e3779b97f4a7c15u ^ bits[1]) * 0xd6e8feb86659fd93u;
  }

  std::size_t m_rowSize, m_size = 0;
  std::vector<Entry> m_entries;
  std::unique_ptr<double, Free> m_rows;
};

}  // namespace semantic_octree
