#pragma once
#include <mrpt/poses/CPose3D.h>

#include <fstream>

#include <strict_files/OutputFiles.h>
#include <synthetic_world/Scene.h>
#include "Cli.h"
#include "WorldClasses.h"

namespace synth_rawlog {

/** Writes which world the rawlog shows: scene, seed, hills and classes, in YAML. */
void writeTruth(const Cli& cli, const WorldClasses& classes, int frames,
                const std::filesystem::path& file);

/** The robot's true poses in the format of the TUM data sets: time x y z qx qy qz qw. */
class TrajectoryWriter {
 public:
  explicit TrajectoryWriter(const std::filesystem::path& target);
  void write(double time, const mrpt::poses::CPose3D& T_map_robot);
  void commit();

 private:
  strict_files::StagedFile m_file;
  std::ofstream m_stream;
};

}  // namespace synth_rawlog
