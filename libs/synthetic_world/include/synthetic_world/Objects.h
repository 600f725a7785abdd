#pragma once
#include <synthetic_world/Solids.h>

#include <Eigen/Core>
#include <cmath>
#include <cstdint>

namespace synthetic_world {

/** Scrambles 64 bits (the finalizer of SplitMix64; Steele, Lea, Flood 2014). */
constexpr std::uint64_t scramble(std::uint64_t z) {
  z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ull;
  z = (z ^ (z >> 27)) * 0x94D049BB133111EBull;
  return z ^ (z >> 31);
}

/** Random numbers that are the same with every C++ library, which std's distributions are not.
 *
 * Streams are cheap: one per pixel keeps a picture independent of the order of its pixels. Two
 * draws never stand among one call's arguments: which comes first differs between processors. */
class Random {
 public:
  explicit Random(std::uint64_t seed) : m_state(scramble(seed + kIncrement)) {}

  /** The generator of one of many independent streams. */
  static Random ofStream(std::uint64_t seed, std::uint64_t stream, std::uint64_t index) {
    return Random(scramble(scramble(seed + kIncrement) ^ (stream * kIncrement)) + index);
  }

  std::uint64_t next() { return scramble(m_state += kIncrement); }

  /** In [0, 1). */
  double uniform() { return static_cast<double>(next() >> 11) * 0x1.0p-53; }
  /** In [low, high). */
  double uniform(double low, double high) { return low + (high - low) * uniform(); }
  /** One of 0..count-1. \pre count > 0 */
  int below(int count) { return static_cast<int>(uniform() * count); }
  bool chance(double probability) { return uniform() < probability; }

  /** Mean 0, variance 1 (Box and Muller 1958). */
  double normal() {
    const double radius = std::sqrt(-2.0 * std::log(1.0 - uniform()));
    return radius * std::cos(6.283185307179586 * uniform());
  }

 private:
  static constexpr std::uint64_t kIncrement = 0x9E3779B97F4A7C15ull;
  std::uint64_t m_state;
};

// Things to put into a world. Each stands on `base`, a point of the ground, and reaches some way
// below it, so that a slope leaves no gap. Lengths in meters, yaw in radians.

Solids broadleafTree(const Eigen::Vector3d& base, Random& random);
Solids conifer(const Eigen::Vector3d& base, Random& random);
Solids bush(const Eigen::Vector3d& base, Random& random);
Solids rock(const Eigen::Vector3d& base, Random& random);

/** With a gabled roof; the door looks to the yaw's left side.
 * \param size Length along the yaw, width across it. */
Solids house(const Eigen::Vector3d& base, double yaw, const Eigen::Vector2d& size, int storeys,
             Random& random);
/** With a flat roof and windows all around. */
Solids block(const Eigen::Vector3d& base, double yaw, const Eigen::Vector2d& size, int storeys,
             Color tint);

Solids car(const Eigen::Vector3d& base, double yaw, Color tint);
/** \param stride Where in the cycle of walking, in steps; a person that stands has a whole number.
 */
Solids person(const Eigen::Vector3d& base, double yaw, Color clothes, double stride = 0);
Solids bench(const Eigen::Vector3d& base, double yaw);
/** A lamp post; its arm reaches ahead. */
Solids lamp(const Eigen::Vector3d& base, double yaw);
/** A sign on a pole, facing ahead. */
Solids sign(const Eigen::Vector3d& base, double yaw);
/** A plank fence from a to b (points of the ground). */
Solids fencePanel(const Eigen::Vector3d& a, const Eigen::Vector3d& b);
Solids wallPanel(const Eigen::Vector3d& a, const Eigen::Vector3d& b, double height);
Solids hedgePanel(const Eigen::Vector3d& a, const Eigen::Vector3d& b);
/** A barrier of this length across the yaw's direction that closes a road. */
Solids roadblock(const Eigen::Vector3d& base, double yaw, double length);

}  // namespace synthetic_world
