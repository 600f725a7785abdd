#pragma once
#include <mrpt/poses/CPose3D.h>

#include <fstream>
#include <iosfwd>

#include <strict_files/OutputFiles.h>
#include <strict_files/TextFile.h>
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

/** Prints for each line "x y z": x y z, state, class id, class name.
 * \throw std::runtime_error naming the line that is not three numbers. */
void answerTruth(const synthetic_world::World& world, const WorldClasses& classes, double tolerance,
                 const std::vector<strict_files::TextLine>& points, std::ostream& out);

}  // namespace synth_rawlog
