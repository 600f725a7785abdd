#pragma once
#include <semantic_types/ClassTable.h>

#include <filesystem>
#include <vector>

namespace labeled_cloud {

/** A class table of what the labels in some rawlogs say of themselves, for those that come without
 * one: names of CObservationLabeledCloud and of pixelLabels in the order in which they are met,
 * "class N" for ids that have no name. Colors tell them apart. Empty if there are no labels.
 * \throw std::runtime_error as RawlogReader does, and naming the rawlog: a name that a class table
 * does not take, or more than 254 classes. */
semantic_types::ClassTable classesIn(const std::vector<std::filesystem::path>& rawlogs);

}  // namespace labeled_cloud
