#include "MapBuilder.h"

#include <labeled_cloud/MrptMessage.h>
#include <labeled_cloud/RawlogReader.h>
#include <mrpt/img/CImage.h>

#include <chrono>
#include <stdexcept>

#include "Progress.h"

namespace rawlog2semantic_map {

namespace fs = std::filesystem;
using labeled_cloud::LabeledScan;
using labeled_cloud::RawlogReader;
using mrpt::obs::CObservation;
using mrpt::poses::CPose3D;

namespace {

/** Milliseconds that an action takes. */
template <typename Action>
double timeOf(Action action) {
  const auto begin = std::chrono::steady_clock::now();
  action();
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin)
      .count();
}

std::uint64_t totalSize(const std::vector<fs::path>& files) {
  std::uint64_t bytes = 0;
  for (const fs::path& file : files) bytes += fs::file_size(file);
  return bytes;
}

/** Where the images are that a rawlog holds only the names of. */
fs::path imagesFolder(const fs::path& rawlog) {
  return fs::absolute(rawlog).parent_path() / (rawlog.stem().string() + "_Images");
}

}  // namespace

MapBuilder::MapBuilder(semantic_map::CSemanticOctoMap& map, labeled_cloud::ScanConverter& converter,
                       const labeled_cloud::Trajectory& trajectory)
    : m_map(map), m_converter(converter), m_trajectory(trajectory) {}

void MapBuilder::timeWithoutAbstraction() {
  m_plainMap = std::make_unique<semantic_map::CSemanticOctoMap>(m_map);
  m_plainMap->setAbstraction({});
}

void MapBuilder::insert(const std::vector<fs::path>& rawlogs) {
  Progress progress("Mapping", totalSize(rawlogs));
  std::uint64_t bytesBefore = 0;
  for (const fs::path& file : rawlogs) {
    m_summary.rawlogs.push_back(file.string());
    insertRawlog(file, [&](std::uint64_t bytes) {
      progress.update(bytesBefore + bytes, std::to_string(m_summary.inserted) + " scans");
    });
    bytesBefore += fs::file_size(file);
  }
  progress.finish(std::to_string(m_summary.inserted) + " scans inserted, " +
                  m_summary.skippedText());
}

void MapBuilder::insertRawlog(const fs::path& file,
                              const std::function<void(std::uint64_t)>& onBytesRead) {
  RawlogReader reader(file);
  mrpt::img::CImage::setImagesPathBase(imagesFolder(file).string());
  std::size_t number = 0;
  while (const auto entry = reader.next()) {
    for (const CObservation::Ptr& observation : entry->observations) {
      ++number;
      try {
        insertObservation(*observation);
      } catch (const std::exception& e) {
        throw std::runtime_error(file.string() + ": observation " + std::to_string(number) + " (" +
                                 observation->GetRuntimeClass()->className + " '" +
                                 observation->sensorLabel + "'): " + labeled_cloud::messageOf(e));
      }
    }
    onBytesRead(reader.bytesRead());
  }
}

void MapBuilder::insertObservation(const CObservation& observation) {
  ++m_summary.read;
  if (!labeled_cloud::ScanConverter::accepts(observation)) {
    ++m_summary.skipped[std::string("of a kind without points: ") +
                        observation.GetRuntimeClass()->className];
    return;
  }
  if (const auto T_map_robot = m_trajectory.at(observation.timestamp))
    insertScan(observation, *T_map_robot);
  else
    ++m_summary.skipped["outside the trajectory"];
}

void MapBuilder::insertScan(const CObservation& observation, const CPose3D& T_map_robot) {
  LabeledScan scan;
  const double conversionTime = timeOf([&] { scan = *m_converter.convert(observation); });
  if (scan.cloud.empty()) {
    ++m_summary.skipped["without a point of usable range"];
    return;
  }
  const double insertionTime = timeOf([&] { m_summary.add(m_map.insertScan(scan, T_map_robot)); });
  m_summary.add(scan.counts);
  m_summary.withoutLabels += scan.labelsMissing;
  m_summary.conversionTimes.push_back(conversionTime);
  m_summary.insertionTimes.push_back(insertionTime);
  ++m_summary.inserted;
  if (m_map.tree().hasAbstraction()) noteAbstraction(scan, T_map_robot);
}

void MapBuilder::noteAbstraction(const LabeledScan& scan, const CPose3D& T_map_robot) {
  AbstractionSummary& a = m_summary.abstraction;
  semantic_octree::TreeChange change;
  a.changeTimes.push_back(timeOf([&] { change = m_map.abstraction().takeChange(); }));
  const std::size_t before = a.compressedLeaves.empty() ? 0 : a.compressedLeaves.back();
  a.compressedLeaves.push_back(before + change.added.size() - change.removed.size());
  a.leaves.push_back(m_map.tree().getNumLeafNodes());
  if (m_plainMap)
    a.insertionTimesWithout.push_back(timeOf([&] { m_plainMap->insertScan(scan, T_map_robot); }));
}

}  // namespace rawlog2semantic_map
