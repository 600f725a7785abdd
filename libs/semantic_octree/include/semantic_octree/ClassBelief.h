#pragma once
#include <semantic_types/ClassTable.h>
#include <algorithm>
#include <array>
#include <cmath>

namespace semantic_octree {

using semantic_types::ClassId;
using semantic_types::kNoClass;

/** Truncated class distribution of one cell: the log-odds h_k = ln(p(class k) / p(free)) of the
 * three likeliest classes, and one value that each of the other classes has.
 *
 * Named classes are sorted by (h descending, id ascending). All operations take K, the number of
 * classes of the map. It is the exact K-class distribution as long as no more than three classes
 * were ever seen in the cell. */
struct ClassBelief {
  static constexpr int kNamed = 3;

  std::array<float, kNamed> logOdds{};
  /** Log-odds of each class that is not named. */
  float rest = 0;
  /** Ids of the named classes; kNoClass beyond `count`. */
  std::array<ClassId, kNamed> ids{};
  std::uint8_t count = 0;

  /** Position of a class among the named ones, or -1. */
  int indexOf(ClassId id) const {
    for (int i = 0; i < count; ++i)
      if (ids[i] == id) return i;
    return -1;
  }
  float logOddsOf(ClassId id) const {
    const int i = indexOf(id);
    return i < 0 ? rest : logOdds[i];
  }
  int unnamed(int K) const { return K - count; }

  /** All classes are equally likely. */
  bool isUniform() const {
    return std::all_of(logOdds.begin(), logOdds.begin() + count,
                       [this](float h) { return h == rest; });
  }

  /** ln(p(occupied) / p(free)) = ln sum_k e^h_k. */
  float occupancyLogOdds(int K) const {
    const double m = maxLogOdds(K);
    double sum = unnamed(K) * std::exp(rest - m);
    for (int i = 0; i < count; ++i) sum += std::exp(logOdds[i] - m);
    return static_cast<float>(m + std::log(sum));
  }

  struct Probabilities {
    double free = 1;
    double rest = 0;  ///< of each class that is not named
    std::array<double, kNamed> named{};
  };
  /** Softmax of the log-odds (free space has log-odds 0). */
  Probabilities probabilities(int K) const {
    const double m = std::max(0.0, maxLogOdds(K));
    Probabilities p;
    p.free = std::exp(-m);
    p.rest = std::exp(rest - m);
    double sum = p.free + unnamed(K) * p.rest;
    for (int i = 0; i < count; ++i) sum += p.named[i] = std::exp(logOdds[i] - m);
    p.free /= sum;
    p.rest /= sum;
    for (int i = 0; i < count; ++i) p.named[i] /= sum;
    return p;
  }

  /** Writes K + 1 probabilities, p[0] = free. */
  void distribution(int K, double* p) const {
    const Probabilities q = probabilities(K);
    p[0] = q.free;
    std::fill(p + 1, p + K + 1, q.rest);
    for (int i = 0; i < count; ++i) p[ids[i]] = q.named[i];
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
};

}  // namespace semantic_octree
