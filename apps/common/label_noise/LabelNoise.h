#pragma once
#include <semantic_types/LabeledCloud.h>

#include <CLI/CLI.hpp>

#include <Eigen/Geometry>
#include <cstdint>
#include <random>
#include <vector>

namespace label_noise {

/** Replaces a share of the labels by other classes. The same seed gives the same labels everywhere.
 * Points without a class keep none. */
class LabelNoise {
 public:
  enum class Kind {
    Points,  ///< each label by itself, by any other class
    /** Patches, as networks err: what is of a class within a cube of 1.5 to 4 m is wrong as a
     * whole, anew in each scan. Classes are wrong with 1/4 to 7/4 of the share, and are taken for
     * three others, in a half, a third and a sixth of the cases. */
    Blobs,
    Persistent  ///< blobs, half of which are wrong in the same way in all scans
  };
  /** \param share Probability of each label to be replaced, 0..1; of blobs, up to 4/7.
   * \param classes Number of classes to choose from.
   * \throw std::invalid_argument share out of range, or noise without a second class. */
  LabelNoise(double share, Kind kind, std::uint64_t seed, int classes);

  void apply(semantic_types::LabeledCloud& cloud, const Eigen::Isometry3d& T_map_sensor);
  /** To labels without points. \throw std::invalid_argument blobs, which need points. */
  void apply(std::vector<semantic_types::ClassId>& labels);

 private:
  /** Cubes that cut the map. */
  struct Cubes {
    std::uint64_t seed;
    double edge;  ///< m
  };
  Cubes drawCubes();
  semantic_types::ClassId inCube(semantic_types::ClassId id, const Eigen::Vector3d& point,
                                 const Cubes& cubes, double share) const;
  semantic_types::ClassId mistakenFor(semantic_types::ClassId id, double u) const;

  double m_share;
  Kind m_kind;
  std::uint64_t m_seed;
  std::uint32_t m_classes;
  std::mt19937_64 m_random;
  Cubes m_fixed;
};

void addLabelNoiseKind(CLI::App& app, LabelNoise::Kind& kind);

}  // namespace label_noise
