#pragma once
#include <labeled_cloud/ScanConverter.h>
#include <mrpt/config/CLoadableOptions.h>
#include <mrpt/serialization/CArchive.h>
#include <semantic_octree/FilterParameters.h>
#include <semantic_octree/InsertionOptions.h>

#include <limits>
#include <string>

namespace semantic_map {

/** Options with names, which go into an .ini section, into an archive, and onto a screen.
 *
 * Reading is strict where MRPT is silent: a key of the section that is not an option, and a value
 * that cannot be read or is out of range, are std::runtime_error naming section, key and value. The
 * options are then what they were before. Keys that are absent leave their option as it is. */
class TOptions : public mrpt::config::CLoadableOptions {
 public:
  void loadFromConfigFile(const mrpt::config::CConfigFileBase& source,
                          const std::string& section) override = 0;
  void saveToConfigFile(mrpt::config::CConfigFileBase& target,
                        const std::string& section) const override = 0;
  void dumpToTextStream(std::ostream& out) const override = 0;
  virtual void writeTo(mrpt::serialization::CArchive& out) const = 0;
  /** \throw std::exception the archive ends, or holds values that are out of range. */
  virtual void readFrom(mrpt::serialization::CArchive& in) = 0;
};

/** How observations become part of the map: section `[..._insertOpts]`. */
struct TInsertionOptions : public TOptions {
  /** Keys: rays (All or EndVoxels), maxRange, minRange, carvingMargin, threads. */
  semantic_octree::InsertionOptions scan;
  /** Keys: decimation, flyingPixelThreshold. */
  labeled_cloud::ScanConverterOptions conversion;
  /** Keys: increments (LikelihoodConsistent or Ssmi), accuracy, hitProbability,
   * falseAlarmProbability, minOccupancy, maxProbability, softLabelFloor. A map that is not empty
   * refuses observations if they are no longer those that it was built with. */
  semantic_octree::FilterParameters filter;

  /** \throw std::invalid_argument naming the option and its value. */
  void validate() const;
  void loadFromConfigFile(const mrpt::config::CConfigFileBase& source,
                          const std::string& section) override;
  void saveToConfigFile(mrpt::config::CConfigFileBase& target,
                        const std::string& section) const override;
  void dumpToTextStream(std::ostream& out) const override;
  void writeTo(mrpt::serialization::CArchive& out) const override;
  void readFrom(mrpt::serialization::CArchive& in) override;
};

/** How an observation is compared with the map: section `[..._likelihoodOpts]`. */
struct TLikelihoodOptions : public TOptions {
  /** Only one of that many points counts. */
  int decimation = 10;
  /** Whether the classes of points are compared with those of the map, or occupancy alone. */
  bool useLabels = true;
  /** Each point's log-likelihood is multiplied by it: neighboring points are not independent, (0,
   * 1]. */
  double pointWeight = 1.0;

  /** \throw std::invalid_argument naming the option and its value. */
  void validate() const;
  void loadFromConfigFile(const mrpt::config::CConfigFileBase& source,
                          const std::string& section) override;
  void saveToConfigFile(mrpt::config::CConfigFileBase& target,
                        const std::string& section) const override;
  void dumpToTextStream(std::ostream& out) const override;
  void writeTo(mrpt::serialization::CArchive& out) const override;
  void readFrom(mrpt::serialization::CArchive& in) override;
};

/** What the map's 3D object shows: section `[..._renderOpts]`. */
struct TRenderingOptions : public TOptions {
  enum class Coloring {
    Class,        ///< color of the likeliest class; gray where no class was seen
    Probability,  ///< of the likeliest class: red (0) over yellow to green (1)
    Height        ///< blue (lowest) to red (highest)
  };
  Coloring coloring = Coloring::Class;
  bool occupied = true;
  /** Free space, drawn translucent: much of it, so off by default. */
  bool free = false;
  /** Cells count as occupied from this occupancy on. */
  double minOccupancy = 0.5;
  /** Occupied cells whose likeliest class is less probable than this are left out. */
  double minProbability = 0;
  /** Cells with their center below or above are left out, m. */
  double minHeight = -std::numeric_limits<double>::infinity();
  double maxHeight = std::numeric_limits<double>::infinity();

  /** \throw std::invalid_argument naming the option and its value. */
  void validate() const;
  void loadFromConfigFile(const mrpt::config::CConfigFileBase& source,
                          const std::string& section) override;
  void saveToConfigFile(mrpt::config::CConfigFileBase& target,
                        const std::string& section) const override;
  void dumpToTextStream(std::ostream& out) const override;
  void writeTo(mrpt::serialization::CArchive& out) const override;
  void readFrom(mrpt::serialization::CArchive& in) override;
};

}  // namespace semantic_map
