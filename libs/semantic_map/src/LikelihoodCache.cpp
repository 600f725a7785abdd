#include "LikelihoodCache.h"

#include <labeled_cloud/CObservationLabeledCloud.h>
#include <mrpt/io/CStream.h>
#include <mrpt/obs/CObservation3DRangeScan.h>
#include <mrpt/serialization/CArchive.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <stdexcept>

#include "CachedConverter.h"

namespace semantic_map {

using labeled_cloud::CObservationLabeledCloud;
using labeled_cloud::LabeledScan;
using mrpt::obs::CObservation;
using mrpt::obs::CObservation3DRangeScan;
using mrpt::obs::TPixelLabelInfo;
using mrpt::obs::TPixelLabelInfoBase;

namespace {

/** Takes bytes and makes a number of them. Four lanes, which the processor works on at a time. */
class HashStream : public mrpt::io::CStream {
 public:
  size_t Write(const void* buffer, size_t count) override {
    const char* bytes = static_cast<const char*>(buffer);
    const char* const end = bytes + count;
    for (; end - bytes >= 32; bytes += 32)
      for (int lane = 0; lane < 4; ++lane) mix(lane, wordAt(bytes + 8 * lane, 8));
    for (; bytes < end; bytes += 8) mix(0, wordAt(bytes, std::min<size_t>(8, end - bytes)));
    mix(0, count);
    m_count += count;
    return count;
  }
  template <class T>
  void addAll(const T& values) {
    if (values.size() > 0) Write(values.data(), values.size() * sizeof(values.data()[0]));
  }
  std::uint64_t value() {
    for (int lane = 1; lane < 4; ++lane) mix(0, m_lanes[lane]);
    return m_lanes[0];
  }

  size_t Read(void*, size_t) override { return 0; }
  std::uint64_t Seek(int64_t, TSeekOrigin) override { return m_count; }
  std::uint64_t getTotalBytesCount() const override { return m_count; }
  std::uint64_t getPosition() const override { return m_count; }

 private:
  static std::uint64_t wordAt(const char* bytes, size_t count) {
    std::uint64_t word = 0;
    std::memcpy(&word, bytes, count);
    return word;
  }
  void mix(int lane, std::uint64_t word) {
    m_lanes[lane] = (m_lanes[lane] ^ word) * 0x9E3779B97F4A7C15u;
    m_lanes[lane] ^= m_lanes[lane] >> 29;
  }

  std::array<std::uint64_t, 4> m_lanes{1, 2, 3, 4};
  std::uint64_t m_count = 0;
};

template <unsigned BYTES>
void addIf(const TPixelLabelInfoBase& labels, HashStream& hash) {
  if (const auto* fields = dynamic_cast<const TPixelLabelInfo<BYTES>*>(&labels))
    hash.addAll(fields->pixelLabels);
}

void addLabels(const TPixelLabelInfoBase& labels, HashStream& hash) {
  addIf<1>(labels, hash), addIf<2>(labels, hash), addIf<3>(labels, hash);
  addIf<4>(labels, hash), addIf<8>(labels, hash);
}

void addRangeScan(const CObservation3DRangeScan& scan, HashStream& hash) {
  auto archive = mrpt::serialization::archiveFrom(hash);
  archive << scan.sensorPose << scan.sensorLabel << scan.cameraParams << scan.rangeUnits
          << scan.hasRangeImage << scan.hasPoints3D << scan.range_is_depth
          << scan.rangeImage_getExternalStorageFile("") << scan.points3D_getExternalStorageFile();
  hash.addAll(scan.rangeImage);
  for (const auto* coordinates : {&scan.points3D_x, &scan.points3D_y, &scan.points3D_z})
    hash.addAll(*coordinates);
  if (!scan.pixelLabels) return;
  for (const auto& [id, name] : scan.pixelLabels->pixelLabelNames) archive << id << name;
  addLabels(*scan.pixelLabels, hash);
}

void addLabeledCloud(const CObservationLabeledCloud& observation, HashStream& hash) {
  auto archive = mrpt::serialization::archiveFrom(hash);
  archive << observation.sensorPose << observation.sensorLabel;
  for (const std::string& name : observation.classNames) archive << name;
  hash.addAll(observation.cloud.points);
  hash.addAll(observation.cloud.classes);
  hash.addAll(observation.cloud.probabilities);
}

}  // namespace

std::uint64_t fingerprintOf(const CObservation& observation) {
  HashStream hash;
  if (const auto* scan = dynamic_cast<const CObservation3DRangeScan*>(&observation))
    addRangeScan(*scan, hash);
  else if (const auto* cloud = dynamic_cast<const CObservationLabeledCloud*>(&observation))
    addLabeledCloud(*cloud, hash);
  else
    mrpt::serialization::archiveFrom(hash) << observation;
  return hash.value();
}

LikelihoodCache::LikelihoodCache() = default;
LikelihoodCache::~LikelihoodCache() = default;

std::shared_ptr<const LabeledScan> LikelihoodCache::scanOf(
    const CObservation& observation, const semantic_types::ClassTable& classes,
    const labeled_cloud::ScanConverterOptions& options, mrpt::system::COutputLogger& logger) {
  if (!labeled_cloud::ScanConverter::accepts(observation)) return nullptr;
  const std::uint64_t fingerprint = fingerprintOf(observation);
  const std::lock_guard lock(m_mutex);
  const bool ready = m_converter && m_converter->isFor(classes, options);
  if (ready && fingerprint == m_fingerprint) return m_scan;
  if (!ready) m_converter = std::make_unique<CachedConverter>(classes, options);
  convert(observation, logger);
  m_fingerprint = fingerprint;
  return m_scan;
}

void LikelihoodCache::convert(const CObservation& observation,
                              mrpt::system::COutputLogger& logger) {
  const std::string refusalBefore = m_refusal;
  m_refusal.clear();
  try {
    const auto scan = std::make_shared<LabeledScan>(*m_converter->converter.convert(observation));
    if (scan->cloud.empty()) throw std::invalid_argument("no point with a usable range");
    m_scan = scan;
  } catch (const std::exception& e) {
    m_scan = nullptr;
    m_refusal = e.what();
    if (m_refusal != refusalBefore)
      logger.logStr(mrpt::system::LVL_WARN, "No likelihood: " + m_refusal);
  }
}

void LikelihoodCache::clear() {
  const std::lock_guard lock(m_mutex);
  m_converter.reset();
  m_scan.reset();
  m_refusal.clear();
}

}  // namespace semantic_map
