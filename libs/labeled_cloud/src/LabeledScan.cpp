#include <labeled_cloud/ScanConverter.h>

#include <algorithm>

namespace labeled_cloud {

using semantic_types::ClassId;
using semantic_types::kNoClass;

void LabeledScan::countLabels() {
  counts.labeled = 0;
  if (cloud.probabilities.empty()) {
    for (const ClassId id : cloud.classes) counts.labeled += id != kNoClass;
    return;
  }
  const std::size_t k = cloud.probabilities.size() / cloud.size();
  for (auto row = cloud.probabilities.begin(); row != cloud.probabilities.end(); row += k)
    counts.labeled += std::any_of(row, row + k, [](float p) { return p > 0; });
}

}  // namespace labeled_cloud
