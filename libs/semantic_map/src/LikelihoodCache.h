#pragma once
#include <labeled_cloud/ScanConverter.h>
#include <mrpt/system/COutputLogger.h>

#include <cstdint>
#include <memory>
#include <mutex>
#include <string>

namespace semantic_map {

struct CachedConverter;

/** Keeps the scan of the observation whose likelihood was asked for last: particle filters ask for
 * it at many poses, some of them from several threads. */
class LikelihoodCache {
 public:
  /** What an observation's scan depends on. */
  struct Conversion {
    const semantic_types::ClassTable& classes;
    const labeled_cloud::ScanConverterOptions& options;
  };

  LikelihoodCache();
  ~LikelihoodCache();

  /** The observation's scan; null if it cannot be used. The reason goes to the logger as a warning,
   * unless it is the same as the last. Safe to call from several threads. */
  std::shared_ptr<const labeled_cloud::LabeledScan> scanOf(
      const mrpt::obs::CObservation& observation, const Conversion& conversion,
      mrpt::system::COutputLogger& logger);
  /** Forgets the scan, and what it depends on. */
  void clear();

 private:
  void convert(const mrpt::obs::CObservation& observation, mrpt::system::COutputLogger& logger);

  std::mutex m_mutex;
  std::unique_ptr<CachedConverter> m_converter;
  /** Of the observation that m_scan was made of; there is none without a converter. */
  std::uint64_t m_fingerprint = 0;
  std::shared_ptr<const labeled_cloud::LabeledScan> m_scan;
  std::string m_refusal;
};

}  // namespace semantic_map
