#pragma once
#include <labeled_cloud/ScanConverter.h>

namespace labeled_cloud {

/** The source that reads this observation, null if there is none. */
std::shared_ptr<const PointSource> pointSourceOf(const mrpt::obs::CObservation& observation);

/** The class of each point of a CObservationPointCloud with colors (CColouredPointsMap), if each
 * color is that of a class of the table, or black, which is none. Empty: there are no colors, or
 * they are those of a photograph. */
std::vector<semantic_types::ClassId> classesByColor(const mrpt::obs::CObservation& observation,
                                                    const semantic_types::ClassTable& table);

}  // namespace labeled_cloud
