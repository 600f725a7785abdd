#include <labeled_cloud/ScanConverter.h>
#include <semantic_abstraction/Abstraction.h>
#include <semantic_map/CSemanticOctoMap.h>
#include <strict_files/TextFile.h>
#include <strict_files/Words.h>

#include <chrono>
#include <cmath>
#include <sstream>
#include <stdexcept>

#include "LikelihoodCache.h"

namespace semantic_map {

using labeled_cloud::LabeledScan;
using labeled_cloud::ScanConverter;
using mrpt::Clock;
using mrpt::poses::CPose3D;
using semantic_octree::SemanticOcTree;
using semantic_types::ClassTable;

namespace {

double secondsBetween(Clock::time_point from, Clock::time_point to) {
  return std::chrono::duration<double>(to - from).count();
}

}  // namespace

CSemanticOctoMap::CSemanticOctoMap()
    : CSemanticOctoMap(TCreationOptions().resolution, occupancyOnly()) {}

CSemanticOctoMap::CSemanticOctoMap(double resolution, const ClassTable& classes,
                                   const semantic_octree::FilterParameters& filter)
    : CSemanticOctoMap(SemanticOcTree(resolution, classes, filter)) {}

CSemanticOctoMap::CSemanticOctoMap(SemanticOcTree tree)
    : m_tree(std::move(tree)), m_likelihoodCache(std::make_unique<LikelihoodCache>()) {
  insertionOptions.filter = m_tree.filterParameters();
}

CSemanticOctoMap::~CSemanticOctoMap() = default;

// Observers of a map do not observe its copies: so the base class is not copied.
CSemanticOctoMap::CSemanticOctoMap(const CSemanticOctoMap& o) : CSemanticOctoMap(o.wholeTree()) {
  copyAllButTree(o);
}

CSemanticOctoMap& CSemanticOctoMap::operator=(const CSemanticOctoMap& o) {
  if (this == &o) return *this;
  checkMayBecomeAnother();
  m_tree = o.wholeTree();
  copyAllButTree(o);
  return *this;
}

void CSemanticOctoMap::copyAllButTree(const CSemanticOctoMap& o) {
  genericMapParams = o.genericMapParams;
  insertionOptions = o.insertionOptions;
  likelihoodOptions = o.likelihoodOptions;
  renderingOptions = o.renderingOptions;
  m_abstractionOptions = o.m_abstractionOptions;
  m_lastInsertion = o.m_lastInsertion;
  m_observationClock = o.m_observationClock;
  auxParticleFilterCleanUp();
}

void CSemanticOctoMap::setAbstraction(const TAbstractionOptions& options) {
  TAbstractionOptions kept = options;
  try {
    if (options.isSet())
      semantic_octree::setAbstraction(m_tree, options);
    else
      semantic_octree::dropAbstraction(m_tree);
  } catch (...) {  // of a map in a folder none is left where a tile cannot be read
    if (!semantic_octree::hasAbstraction(m_tree)) m_abstractionOptions = {};
    throw;
  }
  m_abstractionOptions = std::move(kept);
}

CSemanticOctoMap::Ptr CSemanticOctoMap::compress() {
  auto compressed = std::make_shared<CSemanticOctoMap>(abstraction().compressedMap());
  const auto options = compressed->m_abstractionOptions;
  compressed->copyAllButTree(*this);
  compressed->m_abstractionOptions = options;
  return compressed;
}

void CSemanticOctoMap::internal_clear() {
  m_tree.clear();
  m_observationClock = ObservationClock();
}

std::string CSemanticOctoMap::asString() const {
  const auto lock = reading();
  std::ostringstream text;
  const strict_files::ClassicNumbers classic(text);
  text << "CSemanticOctoMap: voxels of " << m_tree.getResolution() << " m, " << m_tree.numClasses()
       << " classes, " << m_tree.getNumLeafNodes() << " leaves, "
       << strict_files::sizeText(m_tree.memoryUsage());
  return text.str();
}

ScanConverter& CSemanticOctoMap::converter() {
  const auto& options = insertionOptions.conversion;
  if (!m_converter || !m_converter->isFor(m_tree.classes(), options))
    m_converter = std::make_unique<CachedConverter>(m_tree.classes(), options);
  return m_converter->converter;
}

bool CSemanticOctoMap::internal_insertObservation(const mrpt::obs::CObservation& observation,
                                                  const std::optional<const CPose3D>& T_map_robot) {
  const std::string refusalBefore = m_lastInsertion.refusal;
  m_lastInsertion = {};
  if (!ScanConverter::accepts(observation)) {
    m_lastInsertion.refusal =
        std::string("a semantic octree map takes no ") + observation.GetRuntimeClass()->className;
    return false;
  }
  try {
    insertAccepted(observation, T_map_robot.value_or(CPose3D()));
  } catch (const std::exception& e) {
    m_lastInsertion.refusal = e.what();
    if (m_lastInsertion.refusal != refusalBefore)
      m_logger.logStr(mrpt::system::LVL_WARN, "Observation refused: " + m_lastInsertion.refusal);
  }
  return m_lastInsertion.inserted();
}

void CSemanticOctoMap::insertAccepted(const mrpt::obs::CObservation& observation,
                                      const CPose3D& T_map_robot) {
  const LabeledScan scan = *converter().convert(observation);
  m_lastInsertion.conversion = scan.counts;
  m_lastInsertion.map = insertScan(scan, T_map_robot);
}

semantic_octree::InsertionReport CSemanticOctoMap::insertScan(const LabeledScan& scan,
                                                              const CPose3D& T_map_robot) {
  if (scan.cloud.empty() && scan.empty.empty())
    throw std::invalid_argument("no point with a usable range (" +
                                std::to_string(scan.counts.invalid) + " without)");
  const auto T_map_sensor = sensorPose(T_map_robot, scan.T_robot_sensor);
  useFilterOfOptions();
  m_observationClock.setMaxGap(insertionOptions.maxGap);
  const double seconds = m_observationClock.secondsUntil(scan.timestamp);
  auto options = insertionOptions.scan;
  if (!scan.empty.empty() && !(options.maxRange > 0 && options.maxRange < scan.emptyFrom))
    options.maxRange = scan.emptyFrom;
  const auto report = m_tree.insert(scan.empty.empty() ? scan.cloud : scan.withEmpty(),
                                    T_map_sensor, options, seconds);
  m_observationClock.note(scan.timestamp);
  return report;
}

void CSemanticOctoMap::useFilterOfOptions() {
  if (insertionOptions.filter == m_tree.filterParameters()) return;
  if (!m_tree.empty() || m_folder)
    throw std::logic_error(
        "the filter parameters in insertionOptions are not those that the map was built with; they "
        "can change only while the map is empty, and not in a folder");
  SemanticOcTree tree(m_tree.getResolution(), m_tree.classes(), insertionOptions.filter);
  tree.setPruning(m_tree.pruning());
  if (m_abstractionOptions.isSet()) semantic_octree::setAbstraction(tree, m_abstractionOptions);
  m_tree = std::move(tree);
}

void CSemanticOctoMap::openFolder(const TFolderOptions& options) {
  checkMayBecomeAnother();
  useFilterOfOptions();
  using semantic_octree::MapFolder;
  const auto access = options.readOnly ? MapFolder::Access::Read : MapFolder::Access::Write;
  m_folder.reset(new Folder{{m_tree, options.folder, access, options.tiles}, options.readOnly});
}

semantic_octree::MapFolder* CSemanticOctoMap::folder() const {
  return m_folder ? &m_folder->tiles : nullptr;
}

std::unique_lock<std::mutex> CSemanticOctoMap::reading() const {
  return m_folder ? std::unique_lock(m_folder->mutex) : std::unique_lock<std::mutex>();
}

bool CSemanticOctoMap::isEmpty() const {
  const auto lock = reading();
  return m_tree.empty();
}

SemanticOcTree CSemanticOctoMap::wholeTree() const {
  const auto lock = reading();
  return m_tree;
}

void CSemanticOctoMap::checkMayBecomeAnother() const {
  if (m_folder)
    throw std::logic_error(
        "a map in a folder of tiles cannot become another one, by assignment or from an archive");
}

bool ObservationClock::beginsRecording(Clock::time_point stamp) const {
  return !m_latest || (m_maxGap > 0 && std::fabs(secondsBetween(*m_latest, stamp)) > m_maxGap);
}

double ObservationClock::secondsUntil(Clock::time_point stamp) const {
  if (stamp == Clock::time_point() || beginsRecording(stamp) || stamp <= *m_latest) return 0;
  return secondsBetween(*m_latest, stamp);
}

void ObservationClock::note(Clock::time_point stamp) {
  if (stamp == Clock::time_point()) return;
  if (beginsRecording(stamp) || stamp > *m_latest) m_latest = stamp;
}

}  // namespace semantic_map
