#pragma once
#include <labeled_cloud/ScanConverter.h>
#include <map_folders/MapFolder.h>
#include <mrpt/config/CLoadableOptions.h>
#include <mrpt/serialization/CArchive.h>
#include <semantic_abstraction/AbstractionOptions.h>
#include <semantic_octree/FilterParameters.h>
#include <semantic_octree/InsertionOptions.h>
#include <semantic_types/ClassTable.h>

#include <limits>
#include <string>

namespace semantic_map {

/** Options that go into a section of an .ini file, into an archive, and onto a screen, as their
 * describe() lists them.
 *
 * Reading is strict where MRPT is silent: unknown keys of the section, and values that cannot be
 * read or are out of range, are errors. The options are then what they were before. Keys that are
 * absent leave their option as it is. */
template <class Derived>
class TNamedOptions : public mrpt::config::CLoadableOptions {
 public:
  /** \throw std::runtime_error naming section, key and value. */
  void loadFromConfigFile(const mrpt::config::CConfigFileBase& source,
                          const std::string& section) override;
  void saveToConfigFile(mrpt::config::CConfigFileBase& target,
                        const std::string& section) const override;
  void dumpToTextStream(std::ostream& out) const override;

  /** Names and values, as text. */
  void writeTo(mrpt::serialization::CArchive& out) const;
  /** Options that the archive does not have become their defaults.
   * \throw std::exception the archive ends, holds values that are out of range, or options that
   * there are not. */
  void readFrom(mrpt::serialization::CArchive& in);
};

/** What a map is made of: section `[..._creationOpts]`. */
struct TCreationOptions : public TNamedOptions<TCreationOptions> {
  /** Edge of a voxel, m. */
  double resolution = 0.1;
  /** File of the class table, relative to the WORKING directory: MRPT does not tell where the .ini
   * file is. Empty: a single class, "occupied". */
  std::string classes;

  void describe(strict_files::OptionList& list);
  /** \throw std::invalid_argument naming the option and its value. */
  void validate() const;
};

/** Where a map is that may be larger than memory: section `[..._folderOpts]`. */
struct TFolderOptions : public TNamedOptions<TFolderOptions> {
  /** Folder of tiles, see semantic_octree::MapFolder; relative to the WORKING directory. Empty: the
   * map is in memory, and the other options mean nothing. */
  std::string folder;
  /** The folder's map is read and takes no observations. Otherwise the map is the one that may
   * write, and the folder may be new. */
  bool readOnly = false;
  semantic_octree::MapFolderOptions tiles;

  void describe(strict_files::OptionList& list);
  /** \throw std::invalid_argument naming the option and its value. */
  void validate() const;
};

/** How observations become part of the map: section `[..._insertOpts]`. */
struct TInsertionOptions : public TNamedOptions<TInsertionOptions> {
  semantic_octree::InsertionOptions scan;
  /** See ObservationClock, seconds. */
  double maxGap = 60;
  labeled_cloud::ScanConverterOptions conversion;
  /** The filter can change only while the map is empty; otherwise the map refuses observations
   * until the filter is again its own. */
  semantic_octree::FilterParameters filter;

  void describe(strict_files::OptionList& list);
  /** Checks all but what depends on the number of classes.
   * \throw std::invalid_argument naming the option and its value. */
  void validate() const;
};

/** How an observation is compared with the map: section `[..._likelihoodOpts]`.
 *
 * The log-likelihood is that of the map's own filter, for which each cell that a beam meets gives
 * an independent measurement. With S the state of a cell (free, or one of K classes), p_hit and
 * p_fa the filter's hit_probability and false_alarm_probability, a beam that ends in the cell has
 *
 *     p(return, label c | cell) = p(S = free) p_fa + p_hit sum_k p(S = k) K P(label c | k),
 *
 * where P(label c | k) is the accuracy for c = k and the rest of it shared by the others. The
 * factor K makes a label that says nothing equal to none. Without a label, and without useLabels,
 * the sum is p(occupied). A beam that passes has
 *
 *     p(no return | cell) = 1 - p(S = free) p_fa - p(S occupied) p_hit.
 *
 * Unknown space is as likely free as occupied, by any class. Ranges are limited as for insertion
 * (minRange, maxRange, carvingMargin): where a beam longer than maxRange ends does not count. */
struct TLikelihoodOptions : public TNamedOptions<TLikelihoodOptions> {
  /** One of that many points counts. */
  int decimation = 10;
  /** Whether the classes of points are compared with those of the map, or occupancy alone. */
  bool useLabels = true;
  /** Distance between the places at which a beam is seen to pass, m; 0: only its end counts. */
  double beamStep = 0;
  /** Each point's log-likelihood is multiplied by it, for neighboring points are not independent,
   * (0, 1]. */
  double pointWeight = 1.0;

  void describe(strict_files::OptionList& list);
  /** \throw std::invalid_argument naming the option and its value. */
  void validate() const;
};

/** What the map's optimal abstraction keeps: section `[..._abstractionOpts]`. Without any weights
 * the map keeps no G-values. */
struct TAbstractionOptions : public TNamedOptions<TAbstractionOptions>,
                             public semantic_octree::AbstractionOptions {};

/** What the map's 3D object shows: section `[..._renderOpts]`. */
struct TRenderingOptions : public TNamedOptions<TRenderingOptions> {
  enum class Coloring {
    Class,        ///< color of the likeliest class, gray where no class was seen
    Probability,  ///< of the likeliest class: red (0) over yellow to green (1)
    Entropy       ///< of free space and classes: green (certain) over yellow to red (all alike)
  };
  Coloring coloring = Coloring::Class;
  /** Free space, drawn translucent. There is much of it. */
  bool free = false;
  /** The cells of the optimal abstraction, as long as the map keeps one, instead of its own. */
  bool compressed = false;
  /** Cells with their center below or above are left out, m. */
  double minHeight = -std::numeric_limits<double>::infinity();
  double maxHeight = std::numeric_limits<double>::infinity();

  void describe(strict_files::OptionList& list);
  /** \throw std::invalid_argument naming the option and its value. */
  void validate() const;
};

const strict_files::Choices<TRenderingOptions::Coloring>& choicesOf(TRenderingOptions::Coloring);

extern template class TNamedOptions<TCreationOptions>;
extern template class TNamedOptions<TFolderOptions>;
extern template class TNamedOptions<TInsertionOptions>;
extern template class TNamedOptions<TLikelihoodOptions>;
extern template class TNamedOptions<TAbstractionOptions>;
extern template class TNamedOptions<TRenderingOptions>;

}  // namespace semantic_map
