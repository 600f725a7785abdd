#pragma once
#include <labeled_cloud/ScanConverter.h>

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "RunProgram.h"

ProgramRun dataset2rawlog(const std::string& arguments);
/** Runs dataset2rawlog and expects failure; returns the message. */
std::string failureOf(const std::string& arguments);

std::string quoted(const std::filesystem::path& path);
std::filesystem::path shippedTable(const std::string& name);

/** A scan and where the robot was, as the map applications see them. */
struct PosedScan {
  labeled_cloud::LabeledScan scan;
  mrpt::poses::CPose3D T_map_robot;

  Eigen::Vector3d inMap(std::size_t i) const;
};

std::vector<PosedScan> readScans(const std::filesystem::path& rawlog,
                                 const semantic_types::ClassTable& table,
                                 std::shared_ptr<labeled_cloud::ImageLabeler> labeler = nullptr);
/** Runs dataset2rawlog with these arguments and the rawlog as its output, and reads that. */
std::vector<PosedScan> convertAndRead(const std::string& arguments,
                                      const std::filesystem::path& rawlog,
                                      const semantic_types::ClassTable& table);

/** Share of the labeled points, in voxels seen by two scans or more, that have the class of most of
 * their voxel's points. */
double agreement(const std::vector<PosedScan>& scans, double resolution);

/** Raw ids 0; 40; 70; 10 and 252 for no class, road, grass, car. */
extern const char* const kThreeClasses;
