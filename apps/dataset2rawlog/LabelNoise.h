#pragma once
#include <semantic_types/ClassTable.h>

#include <cstdint>
#include <random>
#include <vector>

namespace dataset2rawlog {

/** Replaces a share of the labels by random other classes, each equally likely. The same seed gives
 * the same labels everywhere. Points without a class keep none. */
class LabelNoise {
 public:
  /** \param share Probability of each label to be replaced, 0..1.
   * \param classes Number of classes to choose from.
   * \throw std::invalid_argument share out of range, or noise without a second class. */
  LabelNoise(double share, std::uint64_t seed, int classes);

  void apply(std::vector<semantic_types::ClassId>& labels);

 private:
  double m_share;
  std::uint32_t m_classes;
  std::mt19937_64 m_random;
};

}  // namespace dataset2rawlog
