#pragma once
#include <mrpt/poses/CPose3D.h>
#include <strict_files/OutputFiles.h>
#include <strict_files/TextFile.h>
#include <synthetic_world/Sensors.h>
#include <synthetic_world/Solids.h>

#include <filesystem>
#include <fstream>
#include <iosfwd>

#include "Cli.h"

namespace synth_rawlog {

/** The classes that things of the world have in the rawlog. */
class WorldClasses {
 public:
  /** \param file class table (YAML) whose raw ids are the world's classes; empty: the world's own
   * \throw std::runtime_error naming the file: it cannot be read, does not know a class of the
   * world, or has more classes than a camera's labels. */
  explicit WorldClasses(const std::filesystem::path& file);

  const synthetic_world::ClassTable& table() const { return m_table; }
  synthetic_world::ClassId of(synthetic_world::ClassId inWorld) const { return m_ids[inWorld]; }
  synthetic_world::CameraFrame of(synthetic_world::CameraFrame frame) const;
  synthetic_world::LabeledCloud of(synthetic_world::LabeledCloud cloud) const;

 private:
  synthetic_world::ClassTable m_table;
  std::vector<synthetic_world::ClassId> m_ids;  ///< by the world's
};

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
