#pragma once
#include <mrpt/maps/CSimpleMap.h>

/** The first frames of rawlog-samples/village.rawlog with their true poses: in each a labeled depth
 * image and a labeled LiDAR scan. */
mrpt::maps::CSimpleMap villageFrames(std::size_t count);
