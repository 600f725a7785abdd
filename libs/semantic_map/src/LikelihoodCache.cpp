#include "LikelihoodCache.h"

#include <stdexcept>

#include "CachedConverter.h"
#include "ObservationFingerprint.h"

namespace semantic_map {

using labeled_cloud::LabeledScan;
using mrpt::obs::CObservation;

LikelihoodCache::LikelihoodCache() = default;
LikelihoodCache::~LikelihoodCache() = default;

std::shared_ptr<const LabeledScan> LikelihoodCache::scanOf(const CObservation& observation,
                                                           const Conversion& conversion,
                                                           mrpt::system::COutputLogger& logger) {
  if (!labeled_cloud::ScanConverter::accepts(observation)) return nullptr;
  const std::uint64_t fingerprint = fingerprintOf(observation);
  const std::lock_guard lock(m_mutex);
  const bool ready = m_converter && m_converter->isFor(conversion.classes, conversion.options);
  if (ready && fingerprint == m_fingerprint) return m_scan;
  if (!ready)
    m_converter = std::make_unique<CachedConverter>(conversion.classes, conversion.options);
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
