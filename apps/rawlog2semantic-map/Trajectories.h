#pragma once
#include <labeled_cloud/Trajectory.h>

#include <filesystem>
#include <vector>

namespace rawlog2semantic_map {

/** Holds at all times. */
labeled_cloud::Trajectory restAtOrigin();

/** Poses of a file: in the TUM format (see labeled_cloud::loadTumTrajectory()), or in KITTI's, 3x4
 * matrices [R|t] in rows of twelve numbers, T_map_robot at each of the rawlogs' scans in the order
 * of their times.
 * \throw std::runtime_error naming the file, and the line: it is neither, or has another number of
 * poses than there are scans. */
labeled_cloud::Trajectory loadTrajectory(const std::filesystem::path& file,
                                         const std::vector<std::filesystem::path>& rawlogs);

/** The rawlogs' own poses; empty: there are none. \throw std::runtime_error as RawlogReader */
labeled_cloud::Trajectory ownTrajectory(const std::vector<std::filesystem::path>& rawlogs,
                                        bool isNeeded);

}  // namespace rawlog2semantic_map
