#pragma once
#include <semantic_octree/ClassFilter.h>

#include <algorithm>
#include <random>
#include <vector>

#include "ExactFilter.h"

/** One observation of a cell. */
struct Observation {
  enum class Kind { Hit, UnlabeledHit, Miss };
  Kind kind;
  semantic_types::ClassId id;
};

/** A stream of hits of at most `distinct` classes out of K, unlabeled hits and misses. */
inline std::vector<Observation> randomStream(std::mt19937& random, int length, int K,
                                             int distinct) {
  std::vector<semantic_types::ClassId> ids(K);
  for (int k = 0; k < K; ++k) ids[k] = static_cast<semantic_types::ClassId>(k + 1);
  std::shuffle(ids.begin(), ids.end(), random);
  ids.resize(std::min(distinct, K));
  std::vector<Observation> stream;
  for (int i = 0; i < length; ++i) {
    const unsigned kind = random() % 10;
    const auto id = ids[random() % ids.size()];
    if (kind < 6)
      stream.push_back({Observation::Kind::Hit, id});
    else
      stream.push_back({kind < 8 ? Observation::Kind::UnlabeledHit : Observation::Kind::Miss, 0});
  }
  return stream;
}

inline void apply(const semantic_octree::ClassFilter& filter, const Observation& z,
                  semantic_octree::ClassBelief& belief) {
  if (z.kind == Observation::Kind::Hit) return filter.hit(belief, z.id);
  if (z.kind == Observation::Kind::UnlabeledHit) return filter.hit(belief);
  filter.miss(belief);
}

inline void apply(const Observation& z, ExactFilter& filter) {
  if (z.kind == Observation::Kind::Hit) return filter.hit(z.id);
  if (z.kind == Observation::Kind::UnlabeledHit) return filter.hit();
  filter.miss();
}

inline std::vector<double> distributionOf(const semantic_octree::ClassBelief& belief, int K) {
  std::vector<double> p(K + 1);
  belief.distribution(K, p.data());
  return p;
}

/** Limits that no short stream reaches. */
inline semantic_octree::FilterParameters wideLimits(double accuracy = 0.9) {
  semantic_octree::FilterParameters p;
  p.accuracy = accuracy;
  p.minOccupancy = 0.0001;
  p.maxProbability = 0.9999;
  return p;
}
