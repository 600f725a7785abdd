#pragma once
#include <labeled_cloud/ScanConverter.h>
#include <mrpt/maps/CMetricMap.h>
#include <mrpt/math/TBoundingBox.h>
#include <mrpt/system/COutputLogger.h>
#include <mrpt_compat/Maps.h>
#include <semantic_abstraction/Abstraction.h>
#include <semantic_map/MapOptions.h>
#include <semantic_octree/MapFollower.h>
#include <semantic_octree/SemanticOcTree.h>

#include <memory>
#include <mutex>
#include <optional>
#include <string>

namespace semantic_map {

/** How much time passes from observation to observation, by their stamps: what a map ages by
 * (semantic_octree::SemanticOcTree::age()). */
class ObservationClock {
 public:
  /** \param maxGap seconds: after a longer silence, or a step back by more, another recording has
   * begun, and the time between is not counted; 0: all of it is */
  explicit ObservationClock(double maxGap = 0) : m_maxGap(maxGap) {}
  void setMaxGap(double seconds) { m_maxGap = seconds; }

  /** Seconds to count since the latest observation; 0 for the first, for one that is not later, for
   * one without a stamp, and in another recording. */
  double secondsUntil(mrpt::Clock::time_point stamp) const;
  /** An observation was inserted. */
  void note(mrpt::Clock::time_point stamp);

 private:
  bool beginsRecording(mrpt::Clock::time_point stamp) const;

  double m_maxGap;
  std::optional<mrpt::Clock::time_point> m_latest;
};

struct CachedConverter;
struct LikelihoodCache;

/** What came of an observation. */
struct InsertionResult {
  /** Why it was refused; empty: it was not. */
  std::string refusal;
  /** What became of its pixels or points on the way to a cloud. */
  labeled_cloud::ScanCounts conversion;
  /** What became of the cloud's points in the map. */
  semantic_octree::InsertionReport map;

  bool inserted() const { return refusal.empty(); }
};

/** A semantic octree map as MRPT knows maps: in an .ini file, as part of a CMultiMetricMap, in an
 * archive, in a scene.
 *
 * In an .ini file it is `semanticOctoMap_count=1`, with the sections
 *
 *     [<prefix>_semanticOctoMap_00_creationOpts]     TCreationOptions
 *     [<prefix>_semanticOctoMap_00_folderOpts]       TFolderOptions
 *     [<prefix>_semanticOctoMap_00_insertOpts]       TInsertionOptions
 *     [<prefix>_semanticOctoMap_00_likelihoodOpts]   TLikelihoodOptions
 *     [<prefix>_semanticOctoMap_00_abstractionOpts]  TAbstractionOptions
 *     [<prefix>_semanticOctoMap_00_renderOpts]       TRenderingOptions
 *
 * All of them may be absent. Other sections with this prefix, keys that are not options, and values
 * that are out of range are errors that name section, key and value.
 *
 * The library is a plugin for MRPT's applications, by the name of libmrpt_semantic_octree.so:
 * icp-slam, rbpf-slam, observations2map and pf-localization take it by LD_PRELOAD, rawlog-edit and
 * rawlog-grabber by -p, RawLogViewer and SceneViewer3D by -l.
 *
 * Observations: see labeled_cloud::ScanConverter for the kinds and their labels, and
 * TLikelihoodOptions for their likelihood. canComputeObservationLikelihood() is false for other
 * kinds, and for observations that cannot be used (no points, an unknown class). Their likelihood
 * is 0 at every pose, and the reason goes to logger() as a warning.
 *
 * Reading, drawing and likelihoods are safe from several threads at a time; all else is not.
 *
 * A map may be in a folder of tiles (TFolderOptions, openFolder()), and larger than memory. What an
 * observation or a question needs comes in, and leaves by least use. It answers as a map in memory
 * does, to the last bit. But
 * - it is saved by saveMetricMapRepresentationToFile() or folder()->save(), and not when it is
 * gone;
 * - one map writes into a folder: another one, of this process or another, is refused;
 * - a copy, and what is read from its archive, is a map of its own in memory, which no folder knows
 *   of. It is made if there is memory for all of it, else std::runtime_error says how much it
 * takes;
 * - clear() of what has content, and becoming another map (assignment, reading an archive) are
 *   std::logic_error, so that nothing is lost by them;
 * - threads that read it wait for each other; tree() is for one at a time;
 * - what is drawn of it is in memory, as a whole. */
class CSemanticOctoMap : public mrpt::maps::CMetricMap,
                         public mrpt_compat::NearestByPoints<CSemanticOctoMap> {
  DEFINE_SERIALIZABLE(CSemanticOctoMap, semantic_map)
 public:
  /** A map of one class, "occupied", with voxels of 0.1 m. */
  CSemanticOctoMap();
  /** \param resolution edge of a voxel, m
   * \throw std::invalid_argument resolution not positive, no classes, or bad filter parameters. */
  CSemanticOctoMap(double resolution, const semantic_types::ClassTable& classes,
                   const semantic_octree::FilterParameters& filter = {});
  explicit CSemanticOctoMap(semantic_octree::SemanticOcTree tree);
  ~CSemanticOctoMap() override;
  CSemanticOctoMap(const CSemanticOctoMap& o);
  CSemanticOctoMap& operator=(const CSemanticOctoMap& o);

  /** The class table of maps for which none is given: "occupied". */
  static semantic_types::ClassTable occupancyOnly();

  const semantic_octree::SemanticOcTree& tree() const { return m_tree; }
  semantic_octree::SemanticOcTree& tree() { return m_tree; }

  TInsertionOptions insertionOptions;
  TLikelihoodOptions likelihoodOptions;
  TRenderingOptions renderingOptions;

  /** Becomes the map of a folder, see there.
   * \throw std::exception as MapFolder's constructor: also if the map is not empty, or the folder's
   * has another resolution, other classes or parameters; the map is then as it was. */
  void openFolder(const TFolderOptions& options);
  /** Null: the map is in memory. */
  semantic_octree::MapFolder* folder() const;

  /** Keeps G-values from now on, or no longer if no weights are set.
   * \throw std::invalid_argument naming the option and its value. */
  void setAbstraction(const TAbstractionOptions& options);
  const TAbstractionOptions& abstractionOptions() const { return m_abstractionOptions; }
  /** The optimal tree for the abstraction options: its leaves, measures, changes; see there.
   * \throw std::logic_error no weights are set. */
  semantic_octree::Abstraction abstraction() { return semantic_octree::Abstraction(m_tree); }
  /** The optimal tree as a map with the same options. \throw std::logic_error as above. */
  Ptr compress();

  /** What came of the last observation given to insertObservation().
   *
   * insertObservation() returns false for an observation that it refuses. Observations of other
   * classes than those above pass in silence. For any other the reason goes to logger() as a
   * warning, unless it is that of the one before. */
  const InsertionResult& lastInsertion() const { return m_lastInsertion; }
  mrpt::system::COutputLogger& logger() { return m_logger; }

  /** Inserts a scan that was converted already; fires no event. The map ages first, by the time
   * since the scan before (see TInsertionOptions::maxGap); a map that was loaded goes on where it
   * stopped. \throw std::exception the reason why it is refused; the map is then as it was. */
  semantic_octree::InsertionReport insertScan(const labeled_cloud::LabeledScan& scan,
                                              const mrpt::poses::CPose3D& T_map_robot);

  bool isEmpty() const override;
  /** One line: resolution, classes, leaves, bytes. */
  std::string asString() const override;
  /** The box around all nodes, also free ones; from 0 to 0 if the map is empty. */
  mrpt::math::TBoundingBoxf boundingBox() const MSO_OVERRIDE_SINCE_2_11_3;
  /** Boxes in the classes' colors, see renderingOptions; nothing if
   * genericMapParams.enableSaveAs3DObject is false. */
  void getVisualizationInto(mrpt_compat::drawing::CSetOfObjects& o) const override;
  /** Pairs the points of a points map with those of getAsSimplePointsMap(), as that does, for ICP.
   * \throw std::invalid_argument the other map is not, and has not, a points map. */
  void determineMatching2D(const mrpt::maps::CMetricMap* other,
                           const mrpt::poses::CPose2D& T_this_other,
                           mrpt::tfest::TMatchingPairList& pairs,
                           const mrpt::maps::TMatchingParams& params,
                           mrpt::maps::TMatchingExtraResults& extra) const override;
  void determineMatching3D(const mrpt::maps::CMetricMap* other,
                           const mrpt::poses::CPose3D& T_this_other,
                           mrpt::tfest::TMatchingPairList& pairs,
                           const mrpt::maps::TMatchingParams& params,
                           mrpt::maps::TMatchingExtraResults& extra) const override;
  /** Share of the other's points with an occupied voxel's center within params.maxDistForCorr.
   * \throw std::invalid_argument as determineMatching2D(). */
  float compute3DMatchingRatio(const mrpt::maps::CMetricMap* other,
                               const mrpt::poses::CPose3D& T_this_other,
                               const mrpt::maps::TMatchingRatioParams& params) const override;
  /** m^2, from above, to the center of an occupied voxel. \throw std::logic_error there is none. */
  float squareDistanceToClosestCorrespondence(float x, float y) const override;

  using CMetricMap::getAsSimplePointsMap;
  /** The centers of all occupied voxels, for who knows points maps alone (MRPT's map server, ICP
   * and filters of mp2p_icp). They are made at the first call after the map changed, and stay until
   * the next one that finds it changed. */
  const mrpt::maps::CSimplePointsMap* getAsSimplePointsMap() const override;

  /** Forgets the scan of the last observation whose likelihood was asked for. */
  void auxParticleFilterCleanUp() override;
  /** Writes PREFIX.semantic, the map's own file, and PREFIX.3Dscene. A map in a folder saves what
   * changed there instead, and writes no other files.
   * \throw std::runtime_error a file cannot be written. */
  void saveMetricMapRepresentationToFile(const std::string& prefix) const override;

  MAP_DEFINITION_START(CSemanticOctoMap)
  TCreationOptions creationOpts;
  TFolderOptions folderOpts;
  TInsertionOptions insertionOpts;
  TLikelihoodOptions likelihoodOpts;
  TAbstractionOptions abstractionOpts;
  TRenderingOptions renderOpts;
  void saveToConfigFile(mrpt::config::CConfigFileBase& target,
                        const std::string& sectionPrefix) const override;
  MAP_DEFINITION_END(CSemanticOctoMap)

 private:
  void internal_clear() override;
  bool internal_insertObservation(
      const mrpt::obs::CObservation& observation,
      const std::optional<const mrpt::poses::CPose3D>& T_map_robot) override;
  double internal_computeObservationLikelihood(
      const mrpt::obs::CObservation& observation,
      const mrpt::poses::CPose3D& T_map_robot) const override;
  bool internal_canComputeObservationLikelihood(
      const mrpt::obs::CObservation& observation) const override;

  /** Tiles come and go while the map is read. */
  struct Folder {
    semantic_octree::MapFolder tiles;
    bool readOnly;
    std::mutex mutex = {};
  };
  /** Held while a map in a folder is read: tiles come and go. Others have nothing to wait for. */
  std::unique_lock<std::mutex> reading() const;
  /** In memory. \throw std::runtime_error there is not enough. */
  semantic_octree::SemanticOcTree wholeTree() const;
  /** \throw std::logic_error it is in a folder. */
  void checkMayBecomeAnother() const;
  mrpt::math::TBoundingBoxf knownBox() const;
  void draw(const semantic_octree::SemanticOcTree& tree,
            mrpt_compat::drawing::CSetOfObjects& o) const;
  void copyAllButTree(const CSemanticOctoMap& o);
  /** The centers of occupied voxels, which another thread may replace meanwhile. */
  std::shared_ptr<const mrpt::maps::CSimplePointsMap> centers() const;
  /** For questions in the plane: a points map of MRPT's that was asked one in space answers none of
   * these, and the other way round. */
  std::shared_ptr<const mrpt::maps::CSimplePointsMap> centersFromAbove() const;
  labeled_cloud::ScanConverter& converter();
  std::shared_ptr<const labeled_cloud::LabeledScan> scanForLikelihood(
      const mrpt::obs::CObservation& observation) const;
  void insertAccepted(const mrpt::obs::CObservation& observation,
                      const mrpt::poses::CPose3D& T_map_robot);
  /** \throw std::logic_error the options ask for another filter than that of a map with content. */
  void useFilterOfOptions();

  semantic_octree::SemanticOcTree m_tree;
  std::unique_ptr<Folder> m_folder;  ///< null: the map is in memory
  TAbstractionOptions m_abstractionOptions;
  InsertionResult m_lastInsertion;
  ObservationClock m_observationClock;
  mutable mrpt::system::COutputLogger m_logger{"CSemanticOctoMap"};
  std::unique_ptr<CachedConverter> m_converter;
  std::unique_ptr<LikelihoodCache> m_likelihoodCache;
  mutable std::mutex m_centersMutex;
  mutable std::optional<semantic_octree::MapFollower> m_changes;  ///< since the centers were made
  mutable std::shared_ptr<mrpt::maps::CSimplePointsMap> m_centers, m_centersFromAbove;
};

}  // namespace semantic_map
