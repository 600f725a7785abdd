#pragma once
#include <labeled_cloud/ScanConverter.h>

#include "Classes.h"
#include "TemporaryFolder.h"

/** Classes 1, 2, 3. */
inline semantic_types::ClassTable abc() { return tableOf({"a", "b", "c"}); }

inline labeled_cloud::LabeledScan convert(const mrpt::obs::CObservation& obs,
                                          const labeled_cloud::ScanConverterOptions& options = {}) {
  return *labeled_cloud::ScanConverter(abc(), options).convert(obs);
}

inline std::string errorConverting(const mrpt::obs::CObservation& obs,
                                   const semantic_types::ClassTable& table = abc()) {
  return errorOf([&] { labeled_cloud::ScanConverter(table).convert(obs); });
}
