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

/** The row of a node from its eight children's: probabilities and entropies of yes-or-no terms, and
 * all divergences. For terms with more outcomes the latter is still the mean of the children's
 * entropies.
 * \return the weighted sum of yes-or-no terms' divergences */
double mixEqualShares(const double* const children[8], const RowSizes& sizes, const double* weights,
                      double* row, double* js);
double mixShares(const double* const children[8], const double shares[8], const RowSizes& sizes,
                 const double* weights, double* row, double* js);

/** Entropies of yes-or-no variables, nats; n a multiple of RowSizes::kLanes. */
void binaryEntropies(const double* p, int n, double* h);

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

inline std::size_t hashOf(const ClassRecord& record) {
  std::uint32_t bits[3];
  static_assert(sizeof(ClassRecord) == sizeof bits);
  std::memcpy(bits, &record, sizeof bits);
  std::size_t hash = 0;
  for (const std::uint32_t b : bits) hash = (hash ^ b) * 0x9e3779b97f4a7c15u;
  return hash ^ hash << 32;
}

struct FreeMemory {
  void operator()(double* p) const { std::free(p); }
};

/** An octant's eight values, in ascending order. */
struct OctantPattern {
  Units values[8];
  bool operator==(const OctantPattern& o) const { return std::memcmp(this, &o, sizeof o) == 0; }
};

/** What follows from octants' values: it is computed when first asked for, and kept. There are many
 * octants, and few patterns. */
class PatternTable {
 public:
  struct Entry {
    OctantPattern pattern;
    double gValue;
    const double* row;  ///< null: there is none yet
  };

  explicit PatternTable(std::size_t rowSize)
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

  /** A pattern's entry, or where it is to be. */
  Entry& find(const OctantPattern& pattern) {
    std::size_t i = hashOf(pattern) >> (64 - kBits);
    while (m_entries[i].row && !(m_entries[i].pattern == pattern)) i = (i + 1) % kEntries;
    return m_entries[i];
  }
  double* newRow() { return m_rows.get() + m_size++ * m_rowSize; }

 private:
  static constexpr int kBits = 12;
  static constexpr std::size_t kEntries = std::size_t(1) << kBits, kMost = kEntries / 2;
  static constexpr std::size_t kLine = 64;  ///< bytes that a processor fetches at once, as a rule

  static std::size_t hashOf(const OctantPattern& p) {
    std::uint64_t bits[2];
    std::memcpy(bits, &p, sizeof bits);
    return (bits[0] * 0x9e3779b97f4a7c15u ^ bits[1]) * 0xd6e8feb86659fd93u;
  }

  std::size_t m_rowSize, m_size = 0;
  std::vector<Entry> m_entries;
  std::unique_ptr<double, FreeMemory> m_rows;
};

/** Rows of leaves without a class record (see RowLayout), by their log-odds: each is computed when
 * first asked for, and kept. */
class ValueRows {
 public:
  explicit ValueRows(std::size_t rowSize)
      : m_rowSize(rowSize),
        m_known(kValues),
        m_rows(static_cast<double*>(std::calloc(kValues * rowSize, sizeof(double)))) {
    if (!m_rows) throw std::bad_alloc();
  }

  /** \param compute computes a row that is not there: compute(value, row) */
  template <typename F>
  const double* row(Units value, const F& compute) {
    const std::size_t i = static_cast<std::uint16_t>(value);
    double* const row = m_rows.get() + i * m_rowSize;
    if (!m_known[i]) {
      compute(value, row);
      m_known[i] = 1;
    }
    return row;
  }

 private:
  static constexpr std::size_t kValues = 1 << 16;
  std::size_t m_rowSize;
  std::vector<char> m_known;
  /** Pages that no value touches cost nothing. */
  std::unique_ptr<double, FreeMemory> m_rows;
};

/** Rows of leaves with a class record (see RowLayout). A few records make up most of a map, and a
 * row takes exponentials and logarithms to compute. A row stays where it is until release(). */
class RecordRows {
 public:
  explicit RecordRows(std::size_t rowSize)
      : m_rowSize(rowSize), m_slots(kSlots), m_rows((kSlots + kInUse) * rowSize) {}

  /** Rows asked for up to now are not in use any more. At most eight are between two releases. */
  void release() {
    ++m_age;
    m_numSpares = 0;
  }

  /** \param compute computes a row that is not there: compute(key, row) */
  template <typename F>
  const double* row(const ClassRecord& key, const F& compute) {
    const std::size_t i = hashOf(key) >> (64 - kSlotBits);
    Slot& slot = m_slots[i];
    if (slot.usedAt != 0 && slot.key == key) {
      slot.usedAt = m_age;
      return &m_rows[i * m_rowSize];
    }
    return newRow(key, i, compute);
  }

 private:
  static constexpr int kSlotBits = 11, kInUse = 8;
  static constexpr std::size_t kSlots = std::size_t(1) << kSlotBits;
  struct Slot {
    ClassRecord key{};
    std::uint64_t usedAt = 0;  ///< 0: empty
  };

  template <typename F>
  const double* newRow(const ClassRecord& key, std::size_t i, const F& compute) {
    const bool inUse = m_slots[i].usedAt == m_age;
    double* const row = &m_rows[(inUse ? kSlots + m_numSpares++ : i) * m_rowSize];
    compute(key, row);
    if (!inUse) m_slots[i] = {key, m_age};
    return row;
  }

  std::size_t m_rowSize;
  std::uint64_t m_age = 1;
  std::size_t m_numSpares = 0;
  std::vector<Slot> m_slots;
  std::vector<double> m_rows;  ///< of the slots, then spare ones for keys that meet in a slot
};

}  // namespace semantic_octree
