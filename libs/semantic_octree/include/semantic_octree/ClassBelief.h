#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <semantic_octree/ClassTable.h>

namespace semantic_octree {

/** Truncated class distribution of one cell: the log-odds h_k = ln(p(class k) / p(free)) of the
 * `Named` likeliest classes, and one value that each of the other classes has.
 *
 * Named classes are sorted by (h descending, id ascending). All operations take K, the number of
 * classes of the map. It is the exact K-class distribution as long as no more than `Named` classes
 * were ever seen in the cell. */
template <typename Real, int Named = 3>
struct ClassBelief {
  std::array<Real, Named> logOdds{};
  /** Log-odds of each class that is not named. */
  Real rest = 0;
  /** Ids of the named classes; kNoClass beyond `count`. */
  std::array<ClassId, Named> ids{};
  std::uint8_t count = 0;

  /** Position of a class among the named ones, or -1. */
  int indexOf(ClassId id) const {
    for (int i = 0; i < count; ++i)
      if (ids[i] == id) return i;
    return -1;
  }
  Real logOddsOf(ClassId id) const {
    const int i = indexOf(id);
    return i < 0 ? rest : logOdds[i];
  }
  int unnamed(int K) const { return K - count; }

  /** All classes are equally likely. */
  bool isUniform() const {
    return std::all_of(logOdds.begin(), logOdds.begin() + count, [this](Real h) { return h == rest; });
  }

  /** ln(p(occupied) / p(free)) = ln sum_k e^h_k. */
  Real occupancyLogOdds(int K) const {
    const double m = maxLogOdds(K);
    return static_cast<Real>(m + std::log(sumExp(m, K)));
  }

  /** p(free). */
  double freeProbability(int K) const {
    const double m = std::max(0.0, maxLogOdds(K)), free = std::exp(-m);
    return free / (free + sumExp(m, K));
  }

  /** Writes K + 1 probabilities, p[0] = free. */
  void distribution(int K, double* p) const {
    const double m = std::max(0.0, maxLogOdds(K)), free = std::exp(-m);
    const double scale = 1.0 / (free + sumExp(m, K));
    p[0] = free * scale;
    std::fill(p + 1, p + K + 1, std::exp(rest - m) * scale);
    for (int i = 0; i < count; ++i) p[ids[i]] = std::exp(logOdds[i] - m) * scale;
  }

  bool operator==(const ClassBelief& o) const {
    return count == o.count && rest == o.rest && ids == o.ids && logOdds == o.logOdds;
  }

  /** Restores the order (h descending, id ascending) after values changed. */
  void sort() {
    for (int i = 1; i < count; ++i)
      for (int j = i; j > 0 && comesBefore(j, j - 1); --j) {
        std::swap(logOdds[j], logOdds[j - 1]);
        std::swap(ids[j], ids[j - 1]);
      }
  }

 private:
  bool comesBefore(int i, int j) const {
    return logOdds[i] != logOdds[j] ? logOdds[i] > logOdds[j] : ids[i] < ids[j];
  }
  double maxLogOdds(int K) const {
    double m = unnamed(K) > 0 ? rest : logOdds[0];
    for (int i = 0; i < count; ++i) m = std::max<double>(m, logOdds[i]);
    return m;
  }
  double sumExp(double m, int K) const {
    double sum = unnamed(K) * std::exp(rest - m);
    for (int i = 0; i < count; ++i) sum += std::exp(logOdds[i] - m);
    return sum;
  }
};

}  // namespace semantic_octree
